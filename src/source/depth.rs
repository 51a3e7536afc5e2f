//! Depth maps: nearness at the working resolution, with what is unknown kept apart.

use super::decode::Photograph;
use super::portrait::{Crop, Placement};
use crate::raster::Raster;
use rayon::prelude::*;

/// Which end of a depth map is near.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthSense {
    /// White is near.
    #[default]
    NearWhite,
    /// White is far.
    FarWhite,
}

/// Least nearness of a place that is known: one step of 16 bits.
const FARTHEST: f32 = 1.0 / 65535.0;

/// Nearness 0 to 1 on the working grid; 0 is unknown. The file's numbers are depths, not light, so no transfer curve is applied;
/// each working pixel is the mean of the known depths under a tent of its size (at least a pixel of the file).
pub(super) fn read_depth(depth: &Photograph, sense: DepthSense, crop: Crop, placement: Placement) -> Raster<f32> {
    let grey = depth.pixels.to_luma16();
    let (width, height) = (grey.width() as isize, grey.height() as isize);
    let nearness = |x: isize, y: isize| -> Option<f32> {
        let value = grey.get_pixel(x.clamp(0, width - 1) as u32, y.clamp(0, height - 1) as u32).0[0];
        let unit = f32::from(value) / 65535.0;
        (value > 0).then(|| if sense == DepthSense::NearWhite { unit } else { (1.0 - unit).max(FARTHEST) })
    };
    let columns = tents(crop.x, crop.width, placement.columns);
    let rows = tents(crop.y, crop.height, placement.rows);
    let mut out = Raster::filled(placement.columns, placement.rows, 0.0_f32);
    out.pixels_mut().par_chunks_mut(placement.columns).zip(&rows).for_each(|(out, row)| {
        for (out, column) in out.iter_mut().zip(&columns) {
            let (mut sum, mut known, mut all) = (0.0, 0.0, 0.0);
            for (y, wy) in row.weights() {
                for (x, wx) in column.weights() {
                    let weight = wx * wy;
                    all += weight;
                    if let Some(near) = nearness(x, y) {
                        sum += weight * near;
                        known += weight;
                    }
                }
            }
            *out = if known >= 0.5 * all { sum / known } else { 0.0 };
        }
    });
    out
}

/// The file's pixels under one working pixel, in one direction.
struct Tent {
    centre: f64,
    reach: f64,
}

impl Tent {
    fn weights(&self) -> impl Iterator<Item = (isize, f32)> + '_ {
        let first = (self.centre - self.reach - 0.5).ceil() as isize;
        let last = (self.centre + self.reach - 0.5).floor() as isize;
        (first..=last).map(|i| (i, (1.0 - (i as f64 + 0.5 - self.centre).abs() / self.reach).max(1e-6) as f32))
    }
}

fn tents(from: f64, length: f64, count: usize) -> Vec<Tent> {
    let step = length / count as f64;
    (0..count).map(|i| Tent { centre: from + (i as f64 + 0.5) * step, reach: step.max(1.0) }).collect()
}
