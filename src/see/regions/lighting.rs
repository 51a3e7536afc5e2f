//! Skin that light, or its absence, makes unlike skin: a side in black shadow, an ear with light through it, a lamp's reflection.

use super::plate::{Feature, LIGHTNESS_WEIGHT, Plate};
use super::skin_model::{BARE_REACH, median};
use crate::elementary::Elementary as _;
use crate::raster::{Raster, dilate};

/// How a head is lit.
pub(super) struct Lighting {
    /// Sides of the face in black shadow, where colour is meaningless: the picture's left, then right.
    shadowed: [bool; 2],
    /// L* below which a pixel on either side is darker than skin in that shadow: hair.
    blackest: [f32; 2],
    /// Where the right side begins, in `u`.
    middle: f32,
    /// The face's oval with the ears beside it.
    with_ears: Raster<bool>,
}

impl Lighting {
    pub(super) fn of(plate: &Plate) -> Self {
        /// Between the eyes.
        const BETWEEN_EYES: usize = 6;
        let reach = (0.2 * plate.face_width) as usize;
        let cheeks = cheeks(plate);
        Self {
            shadowed: shadowed(cheeks),
            blackest: cheeks.map(|light| BLACKEST * light),
            middle: plate.coordinates(plate.point(BETWEEN_EYES))[0],
            with_ears: dilate(&plate.oval.map(u8::from), reach).map(|v| v != 0),
        }
    }

    /// True if a pixel may be skin in black shadow: in the face or at an ear, on a shadowed side.
    pub(super) fn is_shadow(&self, plate: &Plate, i: usize) -> bool {
        /// Texture up to which black is taken for shadow, not hair; the same at the ears, whose folds are texture: in one
        /// portrait an ear in black shadow has 15 to 17, the hair about it 22.
        const SMOOTH: f32 = 14.0;
        const SMOOTH_EAR: f32 = 18.0;
        /// Lightness, as a multiple of the least, from which it is skin of more texture.
        const LIGHT: f32 = 1.3;
        /// And up to which: twice the cheek's. What is lighter lies in light, collars and grey hair.
        const LIT: f32 = 2.0 / BLACKEST;
        /// Texture of hair in light, which is no skin: coils have 28.
        const ROUGH: f32 = 24.0;
        let [u, v] = plate.at.pixels()[i];
        let is_aside = u.abs() >= 0.44;
        let is_ear = v < 0.72 && v > 0.2;
        let texture = plate.features.pixels()[i][3];
        let light = plate.lab.pixels()[i][0] / self.blackest[self.side(u)].max(0.1);
        let is_light = light > LIGHT && light < LIT && texture < ROUGH;
        let is_face = !is_aside && ((v < 0.97 && texture < SMOOTH) || ((0.1..1.12).contains(&v) && is_light));
        let is_skin = is_face || (is_ear && (texture < SMOOTH_EAR || is_light));
        self.is_black(u) && self.with_ears.pixels()[i] && is_skin && light > 1.0
    }

    /// True for a pixel of the face or near it at the height of ears.
    pub(super) fn may_be_ear(&self, v: f32, i: usize) -> bool {
        v < 0.75 && v > 0.2 && self.with_ears.pixels()[i]
    }

    /// True within an ear's width of the face.
    pub(super) fn is_near_face(&self, i: usize) -> bool {
        self.with_ears.pixels()[i]
    }

    /// True if the side of the picture where `u` is lies in black shadow.
    pub(super) fn is_black(&self, u: f32) -> bool {
        self.shadowed[self.side(u)]
    }

    /// The side of the picture where `u` is: 0 left, 1 right.
    fn side(&self, u: f32) -> usize {
        usize::from(u > self.middle)
    }

    /// True for a pixel of an ear that light shines through.
    pub(super) fn is_glowing(&self, v: f32, f: Feature, i: usize, hair: Feature) -> bool {
        /// Light shines through an ear: it is redder than this, and its chroma is so much greater than the hair's.
        const RED: f32 = 18.0;
        const MORE_COLOURED: f32 = 18.0;
        let chroma = |f: Feature| f[1].hypotenuse(f[2]);
        v < 0.75 && self.with_ears.pixels()[i] && f[1] > RED && chroma(f) > chroma(hair) + MORE_COLOURED
    }
}

/// How much lighter than hair and skin a lamp's reflection on a forehead is, in L*; and how much lighter than either one on a forehead under
/// dark hair is, and the share of the skin's chroma that it has left, as it is of the lamp's colour.
const REFLECTION: f32 = 15.0;
const UNDER_DARK_HAIR: [f32; 2] = [4.0, 35.0];
const PALER: f32 = 0.6;
/// Cost of the way from the bare skin of the face up to which a reflection lies on the forehead and not on hair.
const ON_FOREHEAD: f32 = 4.0;

/// True for a reflection on a forehead, `path` from the bare skin of the face; `medians` of skin and hair.
pub(super) fn is_reflection(v: f32, f: Feature, path: f32, [skin, hair]: [Feature; 2]) -> bool {
    let chroma = |f: Feature| f[1].hypotenuse(f[2]);
    let above = [f[0] - skin[0], f[0] - hair[0]].map(|light| light / LIGHTNESS_WEIGHT);
    let is_glare = above[0].min(above[1]) > REFLECTION;
    let is_pale = above[0] > UNDER_DARK_HAIR[0] && above[1] > UNDER_DARK_HAIR[1] && chroma(f) < PALER * chroma(skin);
    v < 1.08 && path < ON_FOREHEAD && (is_glare || is_pale)
}

/// The cheek on the picture's left and on its right.
const CHEEKS: [usize; 2] = [50, 280];
/// A cheek below this fraction of the other's lightness may lie in black shadow.
const SHADOW: f32 = 0.45;
/// It does if it is also darker than this L*.
const DARK_CHEEK: f32 = 35.0;

/// The fraction of a shadowed cheek's L* below which hair is: in one portrait the cheek has 10 to 16, its ear 5 to 9 and the hair 1 to 4.
const BLACKEST: f32 = 0.27;

/// L* of the cheeks; one out of the picture is as light as can be.
fn cheeks(plate: &Plate) -> [f32; 2] {
    CHEEKS.map(|i| median(&plate.samples(&plate.round(&[i], BARE_REACH))).map_or(100.0, |f| f[0] / LIGHTNESS_WEIGHT))
}

/// The sides whose cheek, of L* `light`, is nearly black compared with the other.
fn shadowed(light: [f32; 2]) -> [bool; 2] {
    let is_black = |own: f32, other: f32| own < SHADOW * other && own < DARK_CHEEK;
    [is_black(light[0], light[1]), is_black(light[1], light[0])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_far_above_skin_and_hair_is_a_reflection_near_the_face() {
        let [skin, hair] = [[108.0, 20.0, 26.0, 17.0], [28.0, 2.0, 2.0, 26.0]];
        let spot = [217.0, 0.0, 3.0, 18.0];
        assert!(is_reflection(0.95, spot, 2.9, [skin, hair]));
        assert!(!is_reflection(0.95, spot, 6.5, [skin, hair]), "gloss on hair lies beyond its border");
        assert!(!is_reflection(0.95, spot, 2.9, [skin, [210.0, 0.0, 10.0, 26.0]]), "white hair is as light");
        let [pale, coloured] = [[122.0, 8.0, 10.0, 12.0], [122.0, 16.0, 25.0, 12.0]];
        assert!(is_reflection(0.95, pale, 2.9, [skin, hair]) && !is_reflection(0.95, coloured, 2.9, [skin, hair]));
        assert!(!is_reflection(0.95, pale, 2.9, [skin, [90.0, 2.0, 8.0, 26.0]]), "fair hair is nearly as light");
    }
}
