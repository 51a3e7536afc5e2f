//! Beards that end in strands: their border with skin is no line, but runs to and fro along the hairs. Hair of the head keeps a clean
//! border: there, strands would be a frayed seam.

use super::super::Drawer;
use crate::raster::{Raster, gaussian_blur};
use crate::source::MaskRole;
use crate::style::form::{OVERLAP, Surfaces};
use crate::style::streaks::Streaks;

/// Blur of the border in pitches, over which strands begin; how firm each strand's own border is; and how far strands reach, as a share of the
/// blurred border: a third is a pitch and a half to either side. With more a beard is torn.
const BORDER: f64 = 2.0;
const FIRM: f32 = 6.0;
const REACH: f32 = 2.4;
/// How far lines of skin run on under the tips of strands, on the same scale: with none a white seam shows between them.
const UNDER: f32 = 0.32;
/// Width of a strand and its length, in pitches.
const WIDTH: f64 = 1.6;
const LENGTH: f64 = 7.0;
/// Room around a beard in pitches in which its border has strands.
const ROOM: f64 = 3.0;

/// Surfaces whose hair and skin interlock, and where they do, 0 to 1; none without a beard.
pub(super) struct Interlocked {
    pub surfaces: Surfaces,
    pub strands: Option<Raster<f32>>,
}

impl Drawer<'_> {
    /// The surfaces with beards and skin interlocked along the hair's directions.
    pub(super) fn with_strands(&self, surfaces: Surfaces, directions: &Raster<f32>) -> Interlocked {
        let Some(beard) = self.beard_zone() else { return Interlocked { surfaces, strands: None } };
        let sigma = (BORDER * self.pitch()) as f32;
        let (hair, skin) = (gaussian_blur(&surfaces.hair, sigma), gaussian_blur(&surfaces.skin, sigma));
        // Each surface overlaps the other everywhere by as much.
        let share = hair.zip_map(&skin, |hair, skin| hair / (hair + skin).max(1e-3));
        let share = share.map(|share| ((share * (1.0 + OVERLAP) - OVERLAP) / (1.0 - OVERLAP)).clamp(0.0, 1.0));
        let streaks = Streaks::new(WIDTH * self.pitch(), LENGTH * self.pitch(), self.seed ^ 0x57ad);
        let strands = Raster::from_fn(share.width(), share.height(), |x, y| {
            let share = share.get(x, y);
            let is_border = (0.02..0.98).contains(&share) && beard.get(x, y) > 0.0;
            share - 0.5 + if is_border { REACH * streaks.at(x, y, directions.get(x, y)) } else { 0.0 }
        });
        let both = surfaces.hair.zip_map(&surfaces.skin, |hair, skin| (hair + skin).min(1.0));
        let part = |surface: &Raster<f32>, side: f32, over: f32| {
            let own =
                both.zip_map(&strands, |both, strand| both * ((side * strand + over) * FIRM + 0.5 + OVERLAP).clamp(0.0, 1.0));
            let more = own.zip_map(surface, |own, plain| own - plain).zip_map(&beard, |more, beard| more * beard);
            surface.zip_map(&more, |plain, more| plain + more)
        };
        let [hair, skin] = [part(&surfaces.hair, 1.0, 0.0), part(&surfaces.skin, -1.0, UNDER)];
        Interlocked { surfaces: Surfaces { hair, skin, cloth: surfaces.cloth }, strands: Some(beard) }
    }

    /// Beards with their borders, 0 to 1; none if there is no beard.
    fn beard_zone(&self) -> Option<Raster<f32>> {
        let beard = self.portrait.masks.get(&MaskRole::FacialHair)?;
        let zone = gaussian_blur(beard, (ROOM * self.pitch()) as f32).map(|beard| ((beard - 0.1) * 5.0).clamp(0.0, 1.0));
        zone.pixels().iter().any(|v| *v > 0.0).then_some(zone)
    }
}
