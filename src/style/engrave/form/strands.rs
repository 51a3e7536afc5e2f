//! Hair that ends in strands: its border with skin is no line, but runs to and fro along the locks.

use super::super::Drawer;
use crate::elementary::unit_at;
use crate::geometry::Point;
use crate::raster::{Raster, gaussian_blur, paper_texture};
use crate::style::form::{OVERLAP, Surfaces};

/// Blur of the border in pitches, over which strands begin; how firm each strand's own border is; and how far strands reach, as a share of the
/// blurred border: a third is a pitch and a half to either side. With less hair is a helmet, with more it is torn.
const BORDER: f64 = 2.0;
const FIRM: f32 = 6.0;
const REACH: f32 = 2.4;
/// How far lines of skin run on under the tips of strands, on the same scale: with none a white seam shows between them.
const UNDER: f32 = 0.32;
/// Width of a strand and half its length, in pitches, and the steps along that half.
const WIDTH: f64 = 1.6;
const LENGTH: f64 = 3.5;
const STEPS: i32 = 7;
/// Side of the tile of noise that strands are made of, in pixels.
const TILE: usize = 256;

impl Drawer<'_> {
    /// The surfaces with hair and skin interlocked along the hair's directions.
    pub(super) fn with_strands(&self, surfaces: Surfaces, directions: &Raster<f32>) -> Surfaces {
        let sigma = (BORDER * self.pitch()) as f32;
        let (hair, skin) = (gaussian_blur(&surfaces.hair, sigma), gaussian_blur(&surfaces.skin, sigma));
        // Each surface overlaps the other everywhere by as much.
        let share = hair.zip_map(&skin, |hair, skin| hair / (hair + skin).max(1e-3));
        let share = share.map(|share| ((share * (1.0 + OVERLAP) - OVERLAP) / (1.0 - OVERLAP)).clamp(0.0, 1.0));
        let noise = paper_texture(TILE, TILE, (WIDTH * self.pitch()) as f32, self.seed ^ 0x57ad);
        let strands = Raster::from_fn(share.width(), share.height(), |x, y| {
            let share = share.get(x, y);
            if !(0.02..0.98).contains(&share) {
                return share - 0.5;
            }
            let strand = along(&noise, Point::new(x as f64 + 0.5, y as f64 + 0.5), directions.get(x, y), LENGTH * self.pitch());
            share - 0.5 + REACH * (strand - 0.5)
        });
        let both = surfaces.hair.zip_map(&surfaces.skin, |hair, skin| (hair + skin).min(1.0));
        let part = |side: f32, over: f32| {
            both.zip_map(&strands, |both, strand| both * ((side * strand + over) * FIRM + 0.5 + OVERLAP).clamp(0.0, 1.0))
        };
        Surfaces { hair: part(1.0, 0.0), skin: part(-1.0, UNDER), cloth: surfaces.cloth }
    }
}

/// Mean of a tiled noise along a direction to both sides of a place.
fn along(noise: &Raster<f32>, place: Point, angle: f32, length: f64) -> f32 {
    let step = unit_at(f64::from(angle)) * (length / f64::from(STEPS));
    let on_tile = |v: f64| (v.rem_euclid(TILE as f64) as usize).min(TILE - 1);
    let at = |i: i32| place + step * f64::from(i);
    let sum: f32 = (-STEPS..=STEPS).map(|i| noise.get(on_tile(at(i).x), on_tile(at(i).y))).sum();
    sum / (2 * STEPS + 1) as f32
}
