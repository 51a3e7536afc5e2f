//! Hair that grows out of skin, as engravers root it: its strokes begin at different heights within the skin's tone and thicken away from
//! it, and the skin's lines run on beneath them. A border where one family ends and the next begins is a seam.

use super::super::Drawer;
use super::shares::part_of;
use crate::elementary::Elementary as _;
use crate::field::nearest_seed;
use crate::raster::{Raster, dilate};
use crate::style::form::{Surface, Surfaces};
use crate::style::streaks::Streaks;

/// Width of the band in which hair and skin share the ink, in pitches.
const BAND: f64 = 5.0;
/// How far roots lie before or behind the border, as a share of the band, in the mean; and width and length of the locks that begin
/// together, in pitches.
const UNEVEN: f32 = 1.6;
const LOCK: [f64; 2] = [2.4, 9.0];
/// Skin narrower than twice this many pitches is hair.
const RIM: f64 = 1.5;
/// Least ink of each of both families where they share a place: thinner lines would be dots among the other's.
const LEAST: f32 = 0.17;

/// How much of the ink is hair's at each place, 0 to 1.
pub(super) struct Roots {
    hair: Raster<f32>,
}

impl Drawer<'_> {
    /// The roots of hair along its directions.
    pub(super) fn roots(&self, surfaces: &Surfaces, directions: &Raster<f32>) -> Roots {
        let streaks = Streaks::new(LOCK[0] * self.pitch(), LOCK[1] * self.pitch(), self.seed ^ 0x4007);
        let band = (BAND * self.pitch()) as f32;
        // Beards grow over the lines of skin.
        let skin = surfaces.skin.zip_map(&surfaces.beard, |skin, beard| if beard > 0.5 { 1.0 } else { skin });
        let is_hair = surfaces.hair.zip_map(&skin, |hair, skin| u8::from(hair > skin));
        let is_cloth = surfaces.cloth.zip_map(&skin, |cloth, skin| u8::from(cloth > skin));
        let is_skin = surfaces.hair.zip_map(&skin, |hair, skin| u8::from(skin >= hair && skin > 0.0));
        // The rim of skin outside a head's hair is none.
        let rim = (RIM * self.pitch()).ceil() as usize;
        let core = dilate(&is_skin.map(|skin| 1 - skin), rim).map(|out| 1 - out);
        let is_skin = dilate(&core, rim).zip_map(&is_skin, |near, skin| near & skin);
        let is_skin = is_skin.zip_map(&is_cloth, |skin, cloth| skin & (1 - cloth));
        let (Some(to_hair), Some(to_skin)) = rayon::join(|| distances(&is_hair), || distances(&is_skin)) else {
            return Roots { hair: is_hair.map(f32::from) };
        };
        let hair = Raster::from_fn(is_hair.width(), is_hair.height(), |x, y| {
            let inside = to_skin.get(x, y) - to_hair.get(x, y);
            if inside.abs() > 1.5 * band {
                return f32::from(u8::from(inside > 0.0));
            }
            let uneven = UNEVEN * streaks.at(x, y, directions.get(x, y));
            (0.5 + inside / band + uneven).clamp(0.0, 1.0)
        });
        Roots { hair }
    }
}

impl Roots {
    /// The ink that a surface's lines make.
    pub(super) fn ink_of(&self, surface: Surface, ink: &Raster<f32>) -> Raster<f32> {
        match surface {
            Surface::Skin => ink.zip_map(&self.hair, |ink, hair| rooted(ink, 1.0 - hair)),
            Surface::Hair | Surface::Beard => ink.zip_map(&self.hair, rooted),
            Surface::Cloth => ink.clone(),
        }
    }

    /// Where a surface's lines run: hair's and skin's both in the band between them.
    pub(super) fn region_of(&self, surface: Surface, surfaces: &Surfaces) -> Raster<f32> {
        let both = surfaces.skin.zip_map(&surfaces.hair, |skin, hair| (skin + hair).min(1.0));
        let within = |share: &(dyn Fn(f32) -> f32 + Sync)| {
            let near = dilate(&self.hair.map(|hair| u8::from(share(hair) > 0.0)), 1);
            near.zip_map(&both, |near, both| f32::from(near) * both)
        };
        match surface {
            Surface::Skin => within(&|hair| 1.0 - hair),
            Surface::Hair => within(&|hair| hair),
            Surface::Beard => surfaces.beard.clone(),
            Surface::Cloth => surfaces.cloth.clone(),
        }
    }
}

/// The ink of a family that has a share of the darkness: where both families cross it is a part, else all or nothing.
fn rooted(ink: f32, share: f32) -> f32 {
    if share <= 0.0 || share >= 1.0 {
        return if share > 0.0 { ink } else { 0.0 };
    }
    let [own, other] = [share, 1.0 - share].map(|share| part_of(ink, share));
    if own >= LEAST && other >= LEAST {
        own
    } else if share >= 0.48 {
        ink
    } else {
        0.0
    }
}

/// Distance of each pixel from the nearest marked one.
fn distances(marked: &Raster<u8>) -> Option<Raster<f32>> {
    let nearest = nearest_seed(marked)?;
    let width = marked.width();
    Some(Raster::from_fn(width, marked.height(), |x, y| {
        let seed = nearest.get(x, y) as usize;
        (x as f32 - (seed % width) as f32).hypotenuse(y as f32 - (seed / width) as f32)
    }))
}
