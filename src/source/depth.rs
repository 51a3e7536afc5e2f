//! Depth maps: nearness at the working resolution, with unknown places marked.

use super::decode::Photograph;
use super::placement::{Crop, Placement};
use crate::parallel::shares;
use crate::raster::Raster;

/// Which end of a depth map is near.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthSense {
    /// White is near.
    #[default]
    NearWhite,
    /// White is far.
    FarWhite,
}

/// Least nearness of a known place: one step of 16 bits.
const FARTHEST: f32 = 1.0 / 65535.0;

/// Nearness 0 to 1 on the working grid; 0 is unknown. The file's values are depths, not light, so no transfer curve is applied.
/// Each working pixel is the mean of the known depths under a tent of its size (at least one pixel of the file).
pub(super) fn read_depth(depth: &Photograph, sense: DepthSense, crop: Crop, placement: Placement) -> Raster<f32> {
    let grey = depth.pixels.to_luma16();
    let (width, height) = (grey.width() as usize, grey.height() as usize);
    let nearness = |value: u16| {
        let unit = f32::from(value) / 65535.0;
        if sense == DepthSense::NearWhite { unit } else { (1.0 - unit).max(FARTHEST) }
    };
    let columns = tents(crop.x, crop.width, placement.columns, width);
    let rows = tents(crop.y, crop.height, placement.rows, height);
    let mut out = Raster::filled(placement.columns, placement.rows, 0.0_f32);
    shares(out.pixels_mut(), placement.columns, &|y, out| {
        for (out, column) in out.iter_mut().zip(&columns) {
            let (mut sum, mut known, mut all) = (0.0, 0.0, 0.0);
            for &(y, wy) in &rows[y] {
                let line = &grey.as_raw()[y * width..(y + 1) * width];
                for &(x, wx) in column {
                    let weight = wx * wy;
                    all += weight;
                    if line[x] > 0 {
                        sum += weight * nearness(line[x]);
                        known += weight;
                    }
                }
            }
            *out = if known >= 0.5 * all { sum / known } else { 0.0 };
        }
    });
    out
}

/// For each working pixel along one axis: the file's pixels under its tent, with their weights. Border pixels are repeated.
fn tents(from: f64, length: f64, count: usize, end: usize) -> Vec<Vec<(usize, f32)>> {
    let step = length / count as f64;
    let reach = step.max(1.0);
    (0..count)
        .map(|i| {
            let centre = from + (i as f64 + 0.5) * step - 0.5;
            ((centre - reach).floor() as isize + 1..(centre + reach).ceil() as isize)
                .map(|x| (x.clamp(0, end as isize - 1) as usize, (1.0 - (x as f64 - centre).abs() / reach) as f32))
                .filter(|(_, weight)| *weight > 0.0)
                .collect()
        })
        .collect()
}
