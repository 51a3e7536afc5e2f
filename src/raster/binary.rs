//! Binary rasters (0 or 1): dilation, majority, connected components.

use super::Raster;

/// Grows the marked region by `radius` pixels (a square, by chessboard distance).
pub fn dilate(mask: &Raster<u8>, radius: usize) -> Raster<u8> {
    window_count(mask, radius).map(|count| u8::from(count > 0))
}

/// The median of a binary raster: marked where more than half of the `(2r+1)^2` window is; outside the raster counts as unmarked.
pub fn majority(mask: &Raster<u8>, radius: usize) -> Raster<u8> {
    let half = ((2 * radius + 1) * (2 * radius + 1) / 2) as u32;
    window_count(mask, radius).map(|count| u8::from(count > half))
}

/// How many pixels of the window around each pixel are marked.
fn window_count(mask: &Raster<u8>, radius: usize) -> Raster<u32> {
    let rows = running_count(&mask.map(u32::from), radius).transposed();
    running_count(&rows, radius).transposed()
}

fn running_count(raster: &Raster<u32>, radius: usize) -> Raster<u32> {
    use rayon::prelude::*;
    let width = raster.width();
    let mut out = Raster::filled(width, raster.height(), 0_u32);
    out.pixels_mut().par_chunks_mut(width.max(1)).zip(raster.pixels().par_chunks(width.max(1))).for_each(|(out, row)| {
        let mut sum: u32 = row.iter().take(radius).sum();
        for x in 0..width {
            sum += row.get(x + radius).copied().unwrap_or(0);
            out[x] = sum;
            if x >= radius {
                sum -= row[x - radius];
            }
        }
    });
    out
}

/// Labels the connected components of a mask (eight neighbours): 0 outside, then 1, 2, ... in row order of their first pixel.
/// Returns the labels and the number of components.
pub fn components(mask: &Raster<u8>) -> (Raster<u32>, usize) {
    let pixels: Vec<u8> = mask.pixels().to_vec();
    let image = image::GrayImage::from_raw(mask.width() as u32, mask.height() as u32, pixels).unwrap_or_default();
    let labelled = imageproc::region_labelling::connected_components(
        &image,
        imageproc::region_labelling::Connectivity::Eight,
        image::Luma([0_u8]),
    );
    let labels = Raster::from_vec(mask.width(), mask.height(), labelled.into_raw());
    let count = labels.pixels().iter().copied().max().unwrap_or(0) as usize;
    (labels, count)
}

/// Drops every component of `mask` for which `keep(label)` is false; labels as [`components`] gives them.
pub fn remove_components(mask: &Raster<u8>, labels: &Raster<u32>, keep: impl Fn(u32) -> bool + Sync) -> Raster<u8> {
    mask.zip_map(labels, |marked, label| u8::from(marked != 0 && keep(label)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(rows: &[&str]) -> Raster<u8> {
        let width = rows[0].len();
        Raster::from_vec(width, rows.len(), rows.iter().flat_map(|r| r.bytes().map(|b| u8::from(b == b'#'))).collect())
    }

    #[test]
    fn dilation_grows_a_square() {
        let grown = dilate(&drawn(&[".....", ".....", "..#..", ".....", "....."]), 1);
        assert_eq!(grown, drawn(&[".....", ".###.", ".###.", ".###.", "....."]));
    }

    #[test]
    fn majority_removes_specks_and_fills_pinholes() {
        let cleaned = majority(&drawn(&["#......", "...###.", "...#.#.", "...###.", "......."]), 1);
        assert_eq!(cleaned.get(0, 0), 0);
        assert_eq!(cleaned.get(4, 2), 1);
    }

    #[test]
    fn components_join_over_corners() {
        let (labels, count) = components(&drawn(&["#..#", ".#..", "...#"]));
        assert_eq!(count, 3);
        assert_eq!(labels.get(0, 0), labels.get(1, 1));
        assert_ne!(labels.get(3, 0), labels.get(3, 2));
    }
}
