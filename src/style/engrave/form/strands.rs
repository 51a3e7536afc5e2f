//! Hair that ends in strands: its border with skin is no line, but runs to and fro along the locks.

use super::super::Drawer;
use crate::raster::{Raster, gaussian_blur};
use crate::style::form::{OVERLAP, Surfaces};
use crate::style::streaks::Streaks;

/// Blur of the border in pitches, over which strands begin; how firm each strand's own border is; and how far strands reach, as a share of the
/// blurred border: a third is a pitch and a half to either side. With less hair is a helmet, with more it is torn.
const BORDER: f64 = 2.0;
const FIRM: f32 = 6.0;
const REACH: f32 = 2.4;
/// How far lines of skin run on under the tips of strands, on the same scale: with none a white seam shows between them.
const UNDER: f32 = 0.32;
/// Width of a strand and its length, in pitches.
const WIDTH: f64 = 1.6;
const LENGTH: f64 = 7.0;

impl Drawer<'_> {
    /// The surfaces with hair and skin interlocked along the hair's directions.
    pub(super) fn with_strands(&self, surfaces: Surfaces, directions: &Raster<f32>) -> Surfaces {
        let sigma = (BORDER * self.pitch()) as f32;
        let (hair, skin) = (gaussian_blur(&surfaces.hair, sigma), gaussian_blur(&surfaces.skin, sigma));
        // Each surface overlaps the other everywhere by as much.
        let share = hair.zip_map(&skin, |hair, skin| hair / (hair + skin).max(1e-3));
        let share = share.map(|share| ((share * (1.0 + OVERLAP) - OVERLAP) / (1.0 - OVERLAP)).clamp(0.0, 1.0));
        let streaks = Streaks::new(WIDTH * self.pitch(), LENGTH * self.pitch(), self.seed ^ 0x57ad);
        let strands = Raster::from_fn(share.width(), share.height(), |x, y| {
            let share = share.get(x, y);
            if !(0.02..0.98).contains(&share) {
                return share - 0.5;
            }
            share - 0.5 + REACH * streaks.at(x, y, directions.get(x, y))
        });
        let both = surfaces.hair.zip_map(&surfaces.skin, |hair, skin| (hair + skin).min(1.0));
        let part = |side: f32, over: f32| {
            both.zip_map(&strands, |both, strand| both * ((side * strand + over) * FIRM + 0.5 + OVERLAP).clamp(0.0, 1.0))
        };
        Surfaces { hair: part(1.0, 0.0), skin: part(-1.0, UNDER), cloth: surfaces.cloth }
    }
}
