//! Streaks along a direction, as the broad side of a stick leaves them: noise averaged along lines (Cabral and Leedom 1993,
//! with straight lines, which serve over a few pitches).

use crate::elementary::unit_at;
use crate::geometry::Point;
use crate::raster::{Raster, paper_texture};

/// Side of the tile of noise, in pixels.
const TILE: usize = 256;
/// Steps along half a streak.
const STEPS: i32 = 7;

/// Noise from which streaks are made; lengths in working pixels.
pub(super) struct Streaks {
    tile: Raster<f32>,
    half: f64,
}

impl Streaks {
    pub(super) fn new(width: f64, length: f64, seed: u64) -> Self {
        Self { tile: paper_texture(TILE, TILE, width as f32, seed), half: 0.5 * length }
    }

    /// The streak at a pixel along a direction in radians: from -0.5 to 0.5, 0 in the mean, most values within a fourth of that.
    pub(super) fn at(&self, x: usize, y: usize, angle: f32) -> f32 {
        let place = Point::new(x as f64 + 0.5, y as f64 + 0.5);
        let step = unit_at(f64::from(angle)) * (self.half / f64::from(STEPS));
        let on_tile = |v: f64| (v.rem_euclid(TILE as f64) as usize).min(TILE - 1);
        let value = |i: i32| {
            let p = place + step * f64::from(i);
            self.tile.get(on_tile(p.x), on_tile(p.y))
        };
        (-STEPS..=STEPS).map(value).sum::<f32>() / (2 * STEPS + 1) as f32 - 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streaks_are_long_along_their_direction_and_narrow_across() {
        let streaks = Streaks::new(6.0, 40.0, 3);
        let step = |dx: usize, dy: usize| {
            let pairs = (20..200).flat_map(|y| (20..200).map(move |x| (x, y)));
            let squares = pairs.map(|(x, y)| (streaks.at(x + dx, y + dy, 0.0) - streaks.at(x, y, 0.0)).powi(2));
            squares.sum::<f32>()
        };
        assert!(step(0, 3) > 3.0 * step(3, 0), "{} {}", step(0, 3), step(3, 0));
    }
}
