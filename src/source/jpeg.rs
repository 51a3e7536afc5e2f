//! What the decoder does not report about a JPEG file: whether it is complete (it silently fills missing parts with grey), and
//! whether its samples are inks (CMYK).

/// Iterator over the markers of a JPEG file (ITU T.81, annex B) and their offsets.
struct Markers<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Markers<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 2 }
    }
}

impl Iterator for Markers<'_> {
    type Item = (u8, usize);

    /// The next marker after a segment or after entropy-coded data; `None` if the file ends before it.
    fn next(&mut self) -> Option<(u8, usize)> {
        // 0xFF00 is a stuffed byte, D0 to D7 are restarts, and FF may be padding.
        let is_marker = |pair: &[u8]| pair[0] == 0xFF && !matches!(pair[1], 0x00 | 0xFF | 0xD0..=0xD7);
        let start = self.at + self.bytes.get(self.at..)?.windows(2).position(is_marker)?;
        let marker = self.bytes[start + 1];
        self.at = if matches!(marker, 0x01 | 0xD8 | 0xD9) {
            start + 2
        } else {
            let length = self.bytes.get(start + 2..start + 4)?;
            start + 2 + usize::from(u16::from_be_bytes([length[0], length[1]]))
        };
        Some((marker, start))
    }
}

/// Whether the marker segments run through to the end-of-image marker.
pub(super) fn is_whole(bytes: &[u8]) -> bool {
    Markers::new(bytes).any(|(marker, _)| marker == 0xD9)
}

/// Whether the picture has four components, which are inks.
pub(super) fn is_cmyk(bytes: &[u8]) -> bool {
    let is_frame = |marker: u8| matches!(marker, 0xC0..=0xCF) && !matches!(marker, 0xC4 | 0xC8 | 0xCC);
    let frame = Markers::new(bytes).take_while(|(marker, _)| *marker != 0xD9).find(|(marker, _)| is_frame(*marker));
    frame.is_some_and(|(_, at)| bytes.get(at + 9) == Some(&4))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cut_is_noticed() {
        let mut bytes = Vec::new();
        let picture = image::RgbImage::from_fn(40, 30, |x, y| image::Rgb([x as u8 * 6, y as u8 * 8, 90]));
        image::codecs::jpeg::JpegEncoder::new(&mut bytes).encode_image(&picture).unwrap();
        assert!(is_whole(&bytes));
        for cut in 2..bytes.len() {
            assert!(!is_whole(&bytes[..cut]), "cut at {cut} of {}", bytes.len());
        }
    }
}
