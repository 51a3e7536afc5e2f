//! How well skin, hair and clothing suit a pixel: its colour and texture, and its place on the head.

use super::hair::Hair;
use super::lighting::is_reflection;
use super::mixture::log_sum;
use super::plate::{Feature, LIGHTNESS_WEIGHT};
use super::segmentation::Segmentation;
use super::skin_model::{NO_SKIN, shadeless};
use crate::elementary::Elementary as _;

/// What speaks against skin in a fringe, whose colour says nothing.
const FRINGE: f32 = 6.0;

/// The distance from hair's median from which a pixel is no cropped hair, and what speaks against it from there on: hair of one head has up to 12,
/// its forehead in shade 15 to 30.
const CROPPED: f32 = 12.0;
const CROPPED_SLOPE: f32 = 1.5;

impl Segmentation<'_> {
    /// Log score of each class at a pixel.
    pub(super) fn class_scores(&self, i: usize) -> [f32; 4] {
        let plate = self.plate;
        if !plate.inside.pixels()[i] {
            return [30.0, -60.0, -60.0, -60.0];
        }
        let is_face = plate.oval.pixels()[i] && !self.is_covered(i) && !self.is_fringe(i);
        let ([u, v], f) = (plate.at.pixels()[i], plate.features.pixels()[i]);
        [-60.0, self.skin_suits(i, u, v, f, is_face), self.hair_suits(i, u, v, f, is_face), self.clothing_suits(u, v, f)]
    }

    fn skin_suits(&self, i: usize, u: f32, v: f32, f: Feature, is_face: bool) -> f32 {
        let a = u.abs();
        let (far, path) = (self.from_skin.pixels()[i], self.path.pixels()[i]);
        let is_core = is_face && self.plate.core.pixels()[i] && v < 0.72;
        let is_shadow = self.lighting.is_shadow(self.plate, i);
        let (most, shade) = match (is_shadow, is_core) {
            (true, _) => (8.0, 6.0),
            (false, true) => (24.0, 0.0),
            (false, false) => (40.0, 0.0),
        };
        let mut e = -0.5 * far.min(most) - self.skin.level() + shade;
        e += self.face_suits(i, v, is_face, is_core);
        let is_near = path < 2.0 && far < 5.0 && !self.is_fringe(i);
        if is_near && v > 0.7 && v < 1.3 {
            e += 4.0;
        }
        if v < 0.1 {
            // Shade connects the neck to the face; skin-coloured clothing begins at an edge.
            e -= 0.8 * (path - 4.0).clamp(0.0, 6.0);
        }
        let may_be_hair = v < 0.1 && self.may_be_fallen_hair(i, u, f);
        if a < 0.4 && v < 0.1 && v > -0.35 && far < NO_SKIN && !may_be_hair {
            e += 4.0;
        }
        if v > 1.04 && !self.is_bald && !is_near {
            e -= 4.0;
        }
        if !is_face && self.is_behind_hair(u, v) {
            e -= self.against_skin_behind_hair(i, u, v, f);
        }
        let is_bare = v < 0.1 && far < NO_SKIN && path < 6.0 && !may_be_hair;
        e += self.neck_suits(i, u, v, f) + self.ear_or_fallen_hair(i, may_be_hair && !is_face);
        if self.plate.is_grey {
            e -= self.unlikely_in_grey(u, v, is_face);
        } else if is_bare {
            // Necks, shoulders and arms.
            e += 5.0;
        } else if !((a < 0.6 && v > -0.8) || v > -0.1) {
            e -= 2.5;
        }
        if self.is_bald && v > 0.9 && f[0] > self.skin.middle[0] - 25.0 * LIGHTNESS_WEIGHT {
            e += 6.0;
        }
        e
    }

    /// What speaks for skin in a face, the more the surer its place, and against it in a fringe.
    fn face_suits(&self, i: usize, v: f32, is_face: bool, is_core: bool) -> f32 {
        match (is_core, is_face) {
            _ if self.is_fringe(i) => -FRINGE,
            (true, _) => 14.0,
            // A fringe may cover the forehead.
            (false, true) => 9.0 - 7.0 * ((v - 0.68) / 0.17).clamp(0.0, 1.0),
            (false, false) => 0.0,
        }
    }

    /// What speaks for skin at an ear in shade, whose colour is that of hair, and against it where hair falls beside the chin.
    fn ear_or_fallen_hair(&self, i: usize, may_be_hair: bool) -> f32 {
        /// More than hair suits an ear in shade (09).
        const EAR: f32 = 16.0;
        /// Where texture says nothing. With more, necks beside hair that falls are hair; with less, brown hair beside brown skin is skin in patches.
        /// Tuned on three snapshots.
        const FALLEN: f32 = 3.0;
        let ear = if self.ears.pixels()[i] { EAR } else { 0.0 };
        let fallen = if may_be_hair { FALLEN + self.rougher(self.plate.features.pixels()[i]) } else { 0.0 };
        ear - fallen
    }

    /// What a place speaks against skin where no colour does: beside the neck, above the forehead and beyond the ears.
    fn unlikely_in_grey(&self, u: f32, v: f32, is_face: bool) -> f32 {
        /// Half the width of a neck and that of a head with its ears, in `u`; how far a neck reaches below the chin, in `v`; the slope of the
        /// penalty and its most.
        const NECK: f32 = 0.38;
        const EARS: f32 = 0.56;
        const COLLAR: f32 = 0.3;
        const SLOPE: f32 = 40.0;
        const MOST: f32 = 14.0;
        let a = u.abs();
        let beyond = if v < 0.1 {
            (a - NECK).max(0.0) + (-v - COLLAR).max(0.0)
        } else if is_face || self.is_bald {
            0.0
        } else {
            (a - EARS).max(0.0) + (v - 0.8).max(0.0)
        };
        (SLOPE * beyond).min(MOST)
    }

    /// What speaks for the skin of a neck in a colour that a face does not have.
    fn neck_suits(&self, i: usize, u: f32, v: f32, f: Feature) -> f32 {
        /// More than hair suits shade, which is up to 15.
        const NECK: f32 = 16.0;
        /// Distance across from the chin, in `u`, from which shade lies on hair that stands out, not on a neck.
        const WIDE: f32 = 0.3;
        let is_beside_hair = self.hair.as_ref().is_some_and(|hair| hair.stands_out(u)) && self.aside_of_chin(u) > WIDE;
        let is_neck = self.is_neck_in_shade(i, v, f) || self.is_neck_of_deeper_colour(i, u, v, f);
        if is_neck && !is_beside_hair { NECK } else { 0.0 }
    }

    /// True below the chin where a colour of skin's hue, deeper than a face's that is in strong light, leads to the face without an edge.
    fn is_neck_of_deeper_colour(&self, i: usize, u: f32, v: f32, f: Feature) -> bool {
        /// Greatest difference of hue, in radians, and path from the face.
        const HUE: f32 = 0.4;
        /// L* from which a face is in strong light; three heads with such necks have 71 to 80.
        const LIT: f32 = 60.0;
        const NO_EDGE: f32 = 7.0;
        let is_below = (-0.6..0.1).contains(&v) && self.aside_of_chin(u).min(u.abs()) < 0.5;
        let is_lit = self.skin.middle[0] > LIT * LIGHTNESS_WEIGHT;
        if !(is_below && is_lit && self.path.pixels()[i] < NO_EDGE) {
            return false;
        }
        let (own, skin) = (shadeless(f), shadeless(self.skin.middle));
        let turn = own[1].angle_over(own[0]) - skin[1].angle_over(skin[0]);
        let is_deeper = own[0].hypotenuse(own[1]) > skin[0].hypotenuse(skin[1]);
        is_deeper && turn.abs() < HUE
    }

    fn hair_suits(&self, i: usize, u: f32, v: f32, f: Feature, is_face: bool) -> f32 {
        let Some(hair) = &self.hair else { return -60.0 };
        let a = u.abs();
        let mut e = hair.mixture.log_density(f);
        if (is_face && self.plate.core.pixels()[i] && v < 0.75) || self.lighting.is_shadow(self.plate, i) {
            e -= 12.0;
        } else if is_face && v < 0.78 {
            e -= 6.0;
        }
        e -= (-v - 0.1).max(0.0) * if hair.hangs(u) { 2.0 } else { 9.0 };
        e -= (a - 0.95).max(0.0) * 6.0;
        let is_long = self.may_fall(hair, u) || (hair.beside_jaw(u) > 0.8 && a > 0.25);
        // Beside the chin of a turned head, where hair falls, its place counts from there.
        let aside = if self.may_fall(hair, u) { a.max(self.aside_of_chin(u)) } else { a };
        if v < 0.0 && aside < 0.45 {
            e -= if is_long { 3.0 } else { 9.0 };
        }
        if v < 0.35 && aside < 0.36 {
            e -= if is_long { 3.0 } else { 7.0 };
        }
        let is_lit = self.lighting.is_glowing(v, f, i, hair.middle)
            || is_reflection(v, f, self.path.pixels()[i], [self.skin.middle, hair.middle]);
        if is_lit {
            e -= 12.0;
        }
        if self.is_cropped {
            e -= CROPPED_SLOPE * (hair.distance(f, 0.35, 0.6) - CROPPED).clamp(0.0, CROPPED);
        }
        if v > 1.12 && !self.is_bald && self.path.pixels()[i] > 2.0 {
            e += 3.0;
        }
        if v < 0.12 && a < 0.62 && !is_long {
            e -= 5.0;
        }
        e
    }

    /// True beside and below a jaw where shade, smoother than hair or darker, leads to the face without an edge.
    fn is_neck_in_shade(&self, i: usize, v: f32, f: Feature) -> bool {
        /// L* of the darkest hair of which shade is darker, the fraction of it that shade has at most, and its greatest path from the face.
        const LIGHT_HAIR: f32 = 20.0;
        const DARKER: f32 = 0.5;
        const DARK: f32 = 13.0;
        const NO_EDGE: f32 = 5.0;
        /// Least a* and b*: jackets have less.
        const WARM: f32 = 1.0;
        /// How much less texture than the hair it has, or it is darker.
        const SMOOTHER: f32 = 8.0;
        let Some(hair) = self.hair.as_ref().map(|hair| hair.middle) else { return false };
        let is_darker = f[0] < (DARKER * hair[0]).min(DARK * LIGHTNESS_WEIGHT) && hair[0] > LIGHT_HAIR * LIGHTNESS_WEIGHT;
        let is_smoother = f[3] < hair[3] - SMOOTHER && f[0] < self.skin.middle[0];
        let is_beside_jaw = (-0.05..0.4).contains(&v) && !self.plate.oval.pixels()[i] && self.lighting.is_near_face(i);
        let is_warm = f[1] > WARM && f[2] > WARM;
        (is_darker || is_smoother) && is_warm && is_beside_jaw && self.path.pixels()[i] < NO_EDGE
    }

    fn clothing_suits(&self, u: f32, v: f32, f: Feature) -> f32 {
        let a = u.abs();
        let flat = -self.skin.level() - 12.5;
        let colour = self.clothing.as_ref().map_or(flat, |c| log_sum(&[c.log_density(f), flat]));
        let hairy = self.hair.as_ref().is_some_and(|hair| {
            let is_aside = a > 0.4 || self.may_fall(hair, u);
            hair.hangs(u) && a < hair.widest() && is_aside && hair.distance(f, 0.25, 0.4) < 18.0
        });
        let above = (v + 0.16 - 0.5 * (a - 0.6).clamp(0.0, 0.6)).max(0.0) * 12.0;
        // Shoulders and collars rise beside a head that bends forward.
        let mut e = colour - if a > 0.5 && v < 0.6 { above.min(6.0) } else { above };
        if hairy {
            if v > -0.8 {
                e -= 4.0;
            }
        } else {
            e += (-v - 0.35).clamp(0.0, 2.0) * 4.0;
            if v < -0.05 && a > 0.75 {
                e += 3.0;
            }
        }
        e
    }

    /// True beside a face where hair falls: no skin shows there but ears.
    fn is_behind_hair(&self, u: f32, v: f32) -> bool {
        (0.0..0.9).contains(&v) && self.falls(u) && self.aside_of_chin(u) > 0.4
    }

    /// What speaks against skin beside a face where hair falls. Ears show before it; before hair that stands out few do, and what is
    /// there is hair, the more the rougher it is.
    fn against_skin_behind_hair(&self, i: usize, u: f32, v: f32, f: Feature) -> f32 {
        const BEHIND: f32 = 5.0;
        let stands_out = self.hair.as_ref().is_some_and(|hair| hair.stands_out(u));
        match (self.lighting.may_be_ear(v, i), stands_out) {
            (true, false) => 0.0,
            (false, false) => BEHIND,
            (_, true) => BEHIND + self.rougher(f),
        }
    }

    /// True where hair may fall in front of neck and shoulder.
    fn may_fall(&self, hair: &Hair, u: f32) -> bool {
        hair.falls(u) && self.aside_of_chin(u) > 0.25
    }

    /// True where hair falls in a colour that suits it about as well as skin: brown hair beside brown skin.
    fn may_be_fallen_hair(&self, i: usize, u: f32, f: Feature) -> bool {
        /// How much likelier skin may be, in natural logarithms.
        const ABOUT: f32 = 2.0;
        self.hair.as_ref().is_some_and(|hair| {
            self.may_fall(hair, u) && hair.mixture.log_density(f) > self.skin_density(i) - ABOUT - self.rougher(f)
        })
    }

    /// What texture speaks for hair, where both have the same colour: strands are rougher than the face's skin.
    fn rougher(&self, f: Feature) -> f32 {
        /// How much more texture necks have at most, by their folds, and the most that counts: with more, lace is hair. Tuned on six people whose
        /// hair falls and has the colour of their skin.
        const FOLDS: f32 = 5.0;
        const MOST: f32 = 6.0;
        (f[3] - self.skin.middle[3] - FOLDS).clamp(0.0, MOST)
    }

    /// The distance across from the chin, which a turned head carries to one side.
    fn aside_of_chin(&self, u: f32) -> f32 {
        (u - self.plate.chin()).abs()
    }

    /// True in a fringe that has skin's colour.
    fn is_fringe(&self, i: usize) -> bool {
        self.hair.as_ref().is_some_and(|hair| hair.fringe.pixels()[i])
    }

    /// True where hair covers the face.
    fn is_covered(&self, i: usize) -> bool {
        self.hair.as_ref().is_some_and(|hair| hair.over_face.pixels()[i])
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::plate;
    use super::*;
    use crate::raster::Raster;

    #[test]
    fn strands_rougher_than_folds_of_skin_speak_for_hair_up_to_a_limit() {
        let pixels = Raster::from_fn(200, 200, |x, _| if (60..140).contains(&x) { [150, 110, 90] } else { [60, 90, 160] });
        let plate = plate(&pixels);
        let parting = Segmentation::learned(&plate, None);
        let skin = parting.skin.middle;
        let of = |more: f32| parting.rougher([skin[0], skin[1], skin[2], skin[3] + more]);
        assert_eq!((of(-3.0), of(4.0)), (0.0, 0.0), "skin and the folds of a neck");
        assert!(of(8.0) > of(6.0) && of(6.0) > 0.0);
        assert_eq!(of(30.0), of(60.0), "lace counts no more than hair");
    }
}
