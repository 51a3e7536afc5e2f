//! One tone beside another.

use crate::raster::Raster;

/// Linear mix: the first where the share is 0, the second where it is 1.
pub(super) fn mixed(first: &Raster<f32>, second: &Raster<f32>, share: &Raster<f32>) -> Raster<f32> {
    let off = second.zip_map(first, |second, first| second - first).zip_map(share, |off, share| off * share);
    first.zip_map(&off, |first, off| first + off)
}
