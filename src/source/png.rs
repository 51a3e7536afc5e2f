//! Checks on a PNG file before it is decoded.

/// Bytes before the first chunk.
const SIGNATURE: usize = 8;

/// The length in bytes of a palette that is not a multiple of three, if there is one; the decoder fails on it.
pub(super) fn uneven_palette(bytes: &[u8]) -> Option<u32> {
    let mut left = bytes.get(SIGNATURE..)?;
    loop {
        let (length, chunk) = left.split_first_chunk()?;
        let length = u32::from_be_bytes(*length);
        if chunk.starts_with(b"PLTE") && !length.is_multiple_of(3) {
            return Some(length);
        }
        // Four bytes of chunk type before the data, four of checksum after it.
        left = chunk.get(usize::try_from(length).ok()?.checked_add(8)?..)?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_palette_is_of_whole_colours() {
        let file = |palette: u8| {
            let chunk = |name: &[u8], length: u8| [&[0, 0, 0, length], name, &vec![7; usize::from(length) + 4]].concat();
            [b"\x89PNG\r\n\x1a\n".to_vec(), chunk(b"IHDR", 13), chunk(b"PLTE", palette), chunk(b"IDAT", 9)].concat()
        };
        assert_eq!(uneven_palette(&file(49)), Some(49));
        assert_eq!(uneven_palette(&file(48)), None);
        assert_eq!(uneven_palette(&file(48)[..30]), None);
        assert_eq!(uneven_palette(b"\x89PNG"), None);
    }
}
