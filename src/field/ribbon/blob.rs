//! The noise above a level around one of its maxima.

use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2};
use crate::raster::Raster;
use std::f64::consts::TAU;

/// Number of rays that measure a blob.
const RAYS: usize = 12;
/// Distance of samples along a ray, in pixels.
const RAY_STEP: f64 = 0.25;
/// Maximum number of samples along a ray: a blob of coarse noise (sigma 12 px) ends long before.
const RAY_SAMPLES: usize = 240;
/// Rise along a ray, as a share of its fall so far, that is ignored as a ripple and not taken as the far side of a valley.
const RIPPLE: f32 = 0.03;

/// A blob's reach from its maximum, in pixels.
pub(super) struct Blob {
    pub maximum: Point,
    /// Direction of the flow there.
    pub along: Vec2,
    /// Downstream and upstream.
    pub front: f64,
    pub back: f64,
    /// To the two sides; `high` is the side of the flow turned by 90 degrees.
    pub low: f64,
    pub high: f64,
}

impl Blob {
    pub(super) fn new(noise: &Raster<f32>, maximum: Point, along: Vec2, level: f32) -> Self {
        let mut blob = Self { maximum, along, front: 0.0, back: 0.0, low: 0.0, high: 0.0 };
        for k in 0..RAYS {
            let (sin, cos) = (TAU * k as f64 / RAYS as f64).sine_and_cosine();
            let reach = reach_above(noise, maximum, along * cos + along.turn_90() * sin, level);
            blob.low = blob.low.max(-reach * sin);
            blob.high = blob.high.max(reach * sin);
            if k == 0 {
                blob.front = reach;
            } else if 2 * k == RAYS {
                blob.back = reach;
            }
        }
        blob
    }
}

/// Distance over which the noise stays above a level and falls; a ripple (of bilinear interpolation) does not end it.
fn reach_above(noise: &Raster<f32>, from: Point, direction: Vec2, level: f32) -> f64 {
    let top = noise.sample(from.x, from.y);
    if top <= level {
        return 0.0;
    }
    let (mut before, mut lowest) = (top, top);
    for i in 1..RAY_SAMPLES {
        let at = RAY_STEP * i as f64;
        let p = from + direction * at;
        let value = noise.sample(p.x, p.y);
        if value < level {
            return at - RAY_STEP * f64::from((level - value) / (before - value).max(1e-12));
        }
        if value > lowest + RIPPLE * (top - lowest) {
            return at;
        }
        lowest = lowest.min(value);
        before = value;
    }
    RAY_STEP * RAY_SAMPLES as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_reaches_as_far_as_the_noise_is_higher() {
        let noise = Raster::from_fn(60, 60, |x, y| {
            let (dx, dy) = ((x as f32 - 30.0) / 8.0, (y as f32 - 30.0) / 3.0);
            (-0.5 * (dx * dx + dy * dy)).exponential()
        });
        let blob = Blob::new(&noise, Point::new(30.5, 30.5), Vec2::new(1.0, 0.0), (-0.5_f32).exponential());
        for (reach, expected) in [(blob.front, 8.0), (blob.back, 8.0), (blob.low, 3.0), (blob.high, 3.0)] {
            assert!((reach - expected).abs() < 0.1, "{reach} for {expected}");
        }
    }
}
