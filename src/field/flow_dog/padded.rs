//! A raster with a margin.

use crate::parallel::shares;
use crate::raster::Raster;

/// A raster with its border repeated outwards, so that reads near the border need no bounds check.
pub(super) struct Padded<T> {
    pub data: Vec<T>,
    pub stride: usize,
    pub margin: usize,
}

impl<T: Copy + Default + Send + Sync> Padded<T> {
    pub(super) fn new(raster: &Raster<T>, margin: usize) -> Self {
        let stride = raster.width() + 2 * margin;
        let mut data = vec![T::default(); stride * (raster.height() + 2 * margin)];
        shares(&mut data, stride, &|y, row| {
            let source = raster.row(y.saturating_sub(margin).min(raster.height() - 1));
            row[..margin].fill(source[0]);
            row[margin..margin + source.len()].copy_from_slice(source);
            row[margin + source.len()..].fill(source[source.len() - 1]);
        });
        Self { data, stride, margin }
    }
}
