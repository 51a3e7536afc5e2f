//! The surfaces of a portrait, each with lines of its own: skin, hair, cloth.

use crate::raster::{Raster, gaussian_blur};
use crate::source::MaskRole;
use crate::style::Drawer;
use crate::style::drawer::Pitched;

/// Blur of the masks in pitches, and the gain of their edges: borders as smooth as the lines.
const SMOOTH: f64 = 0.6;
const SHARP: f32 = 3.0;

/// How far surfaces overlap, as a share: lines that end side by side at a border would leave a white seam.
const OVERLAP: f32 = 0.15;

/// What lines run over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::style) enum Surface {
    /// Faces, necks, hands; whatever is neither hair nor cloth.
    Skin,
    /// Hair.
    Hair,
    /// Beards and moustaches.
    Beard,
    /// Clothing and hats.
    Cloth,
}

/// Where each surface lies, 0 to 1; together they are the subject and a little more.
pub(in crate::style) struct Surfaces {
    pub skin: Raster<f32>,
    /// Beards included.
    pub hair: Raster<f32>,
    pub beard: Raster<f32>,
    pub cloth: Raster<f32>,
}

impl Surface {
    /// True for hair of heads and of faces.
    pub(in crate::style) fn is_hair(self) -> bool {
        matches!(self, Self::Hair | Self::Beard)
    }
}

impl Surfaces {
    pub(in crate::style) fn of(&self, surface: Surface) -> &Raster<f32> {
        match surface {
            Surface::Skin => &self.skin,
            Surface::Hair => &self.hair,
            Surface::Beard => &self.beard,
            Surface::Cloth => &self.cloth,
        }
    }
}

impl<P: Pitched> Drawer<'_, P> {
    /// The surfaces by their masks; all is skin without them. `cover` is the drawn part, 0 to 1.
    pub(in crate::style) fn surfaces(&self, cover: &Raster<f32>) -> Surfaces {
        let masks = &self.portrait.masks;
        let sigma = (SMOOTH * self.pitch()) as f32;
        let union = |roles: &[MaskRole]| {
            let nothing = cover.map(|_| 0.0);
            let all = roles.iter().filter_map(|role| masks.get(role)).fold(nothing, |all, mask| all.zip_map(mask, f32::max));
            gaussian_blur(&all, sigma).map(|v| ((v - 0.5) * SHARP + 0.5).clamp(0.0, 1.0))
        };
        let cloth = union(&[MaskRole::Clothing, MaskRole::Headwear]);
        let hair = union(&[MaskRole::Hair, MaskRole::FacialHair]).zip_map(&cloth, |hair, cloth| hair.min(1.0 - cloth));
        let beard = union(&[MaskRole::FacialHair]).zip_map(&hair, f32::min);
        let within = |share: Raster<f32>| share.zip_map(cover, |share, cover| (share + OVERLAP).min(1.0) * cover);
        let skin = hair.zip_map(&cloth, |hair, cloth| 1.0 - hair - cloth);
        Surfaces {
            skin: within(skin),
            hair: within(hair),
            beard: beard.zip_map(cover, |beard, cover| beard * cover),
            cloth: within(cloth),
        }
    }
}
