//! Segmentation into skin, hair and clothing: the appearance of each is learned where it certainly is, and its likely places are
//! known from the shape of heads.

use super::baldness::is_bald;
use super::lighting::{Lighting, is_reflection};
use super::mixture::{Mixture, log_sum};
use super::path::path_from;
use super::plate::{Feature, LIGHTNESS_WEIGHT, Plate};
use super::skin_model::{BARE, BARE_REACH, LEAST_SEEDS, NO_SKIN, Place, Skin, apart, median, shadeless};
use super::smoothing::Guide;
use crate::elementary::Elementary as _;
use crate::raster::{Raster, dilate, gaussian_blur};

/// Shares of a pixel: background, skin, hair (of any kind, and hats), clothing.
pub(super) type Shares = [f32; 4];
pub(super) const SKIN: usize = 1;
pub(super) const HAIR: usize = 2;
pub(super) const CLOTHING: usize = 3;

/// What was learned about a head, from which its pixels are classified.
pub(super) struct Segmentation<'a> {
    plate: &'a Plate,
    skin: Skin,
    pub is_bald: bool,
    /// Squared deviation of each pixel from skin.
    from_skin: Raster<f32>,
    /// Cost of the colour path from the bare skin of the face.
    path: Raster<f32>,
    lighting: Lighting,
    hair: Option<Hair>,
    clothing: Option<Mixture>,
}

/// The appearance of hair, and where it hangs down.
struct Hair {
    mixture: Mixture,
    middle: Feature,
    /// Whether the clothing on the shoulders looks clearly different.
    is_unlike_clothing: bool,
    /// Fraction of the area beside the jaw that it covers: the picture's left, then right.
    beside_jaw: [f32; 2],
}

impl Hair {
    /// Distance of a pixel from the median hair, with lightness and texture weighted by `light` and `texture`.
    fn distance(&self, f: Feature, light: f32, texture: f32) -> f32 {
        let weights = [light, 1.0, 1.0, texture];
        (0..4).map(|k| (weights[k] * (f[k] - self.middle[k])).powi(2)).sum::<f32>().sqrt()
    }

    /// True if hair hangs down on the side of `u`: hair that looks like the jacket must cover the area beside the jaw, of other
    /// hair some is enough.
    fn hangs(&self, u: f32) -> bool {
        /// Chroma from which hair can be distinguished from jackets.
        const COLOURED: f32 = 10.0;
        let is_coloured = self.middle[1].hypotenuse(self.middle[2]) > COLOURED;
        self.beside_jaw(u) > if is_coloured || self.is_unlike_clothing { 0.25 } else { 0.6 }
    }

    fn beside_jaw(&self, u: f32) -> f32 {
        self.beside_jaw[usize::from(u > 0.0)]
    }
}

/// The middle of the forehead's upper border.
const TOP: usize = 10;
/// L* from which a pixel may be a lamp's reflection, and the least fraction of a crown in other colours than skin that makes it
/// hair.
const FULL: f32 = 88.0;
const OTHER_CROWN: f32 = 0.6;

/// True if most of the crown has another colour than skin, however gradual the transition; highlights do not count.
fn has_another_crown(plate: &Plate, skin: &Skin) -> bool {
    let middle = plate.coordinates(plate.point(TOP))[0];
    let crown = plate.pixels_where(|[u, v], i| {
        plate.inside.pixels()[i] && v > 1.1 && (u - middle).abs() < 0.35 && plate.lab.pixels()[i][0] < FULL
    });
    let crown = plate.samples(&crown);
    let other = crown.iter().filter(|f| skin.distance(**f, Place::Face) > NO_SKIN).count();
    crown.len() > LEAST_SEEDS && other as f32 > OTHER_CROWN * crown.len() as f32
}

impl<'a> Segmentation<'a> {
    pub(super) fn learned(plate: &'a Plate) -> Self {
        /// Distance of the shoulders' median from the hair's from which they cannot be confused.
        const UNLIKE: f32 = 15.0;
        /// Squared deviation of pixels outside the person.
        const FARTHEST: f32 = 1000.0;
        let skin = Skin::learned(plate);
        let from_skin = Raster::from_fn(plate.width(), plate.height(), |x, y| {
            if !plate.inside.get(x, y) {
                return FARTHEST;
            }
            let [u, v] = plate.at.get(x, y);
            let place = match (v < 0.12 && u.abs() < 0.62, plate.oval.get(x, y)) {
                (_, true) => Place::Face,
                (true, false) => Place::Neck,
                (false, false) => Place::Elsewhere,
            };
            let f = plate.features.get(x, y);
            let plain = skin.distance(f, place);
            if v < 0.9 && v > -0.6 && u.abs() < 0.75 { plain.min(skin.shaded_distance(f)) } else { plain }
        });
        let smooth = [0, 1, 2].map(|k| gaussian_blur(&plate.lab.map(|c| c[k]), 1.0));
        let smooth = Raster::from_fn(plate.width(), plate.height(), |x, y| {
            let at = |k: usize| smooth[k].get(x, y);
            [0.6 * at(0), at(1), at(2)]
        });
        let bare = plate.round(&BARE, BARE_REACH).zip_map(&from_skin, |is, d| is && d < NO_SKIN);
        let path = path_from(&smooth, &plate.inside, &bare);
        let from_skin = Raster::from_fn(plate.width(), plate.height(), |x, y| {
            let (d, [u, v]) = (from_skin.get(x, y), plate.at.get(x, y));
            let is_forehead = (0.9..1.15).contains(&v) && u.abs() < 0.6 && path.get(x, y) < 2.0;
            if is_forehead { d.min(skin.shaded_distance(plate.features.get(x, y))) } else { d }
        });
        let is_bald = is_bald(plate) && !has_another_crown(plate, &skin);
        let mut parting =
            Self { plate, skin, is_bald, from_skin, path, lighting: Lighting::of(plate), hair: None, clothing: None };
        parting.hair = parting.hair_learned();
        let worn = plate.samples(&parting.shoulders());
        if let (Some(hair), Some(worn)) = (&mut parting.hair, median(&worn)) {
            hair.is_unlike_clothing = hair.distance(worn, 0.35, 0.6) > UNLIKE;
        }
        parting.clothing = parting.clothing_learned();
        parting
    }

    fn is_out(&self, i: usize) -> bool {
        self.plate.inside.pixels()[i] && !self.plate.oval.pixels()[i]
    }

    /// Learns hair beside the temples and on the crown, where there is no skin.
    fn hair_learned(&self) -> Option<Hair> {
        /// Normal distributions in the mixture of a head's hair.
        const HAIRS: usize = 4;
        let plate = self.plate;
        let outside = plate.inside.map(|is| u8::from(!is));
        let edge = dilate(&outside, (0.12 * plate.face_width) as usize);
        let seeds = plate.pixels_where(|[u, v], i| {
            let (f, a) = (plate.features.pixels()[i], u.abs());
            // In black and white places tell, where a pixel is not all like skin.
            let is_no_skin = self.from_skin.pixels()[i] > NO_SKIN
                || (plate.is_grey && self.from_skin.pixels()[i] > 3.0 && !self.is_bald && v > 0.8 && a.max(v - 0.5) > 0.62);
            let is_blush = f[1].hypotenuse(f[2]) > 40.0 && f[1] > 30.0;
            let beside = v > 0.35 && v < 1.25 && a > 0.52 && a < 1.05 && is_no_skin && !is_blush;
            let is_far = self.path.pixels()[i] > 2.0 && self.from_skin.pixels()[i] > 2.0;
            let crown = v > 1.05 && a < 0.55 && (is_no_skin || (v > 1.14 && edge.pixels()[i] != 0 && is_far));
            let is_dark = f[0] < self.skin.middle[0] - 25.0 * LIGHTNESS_WEIGHT
                && self.path.pixels()[i] > 6.0
                && (plate.is_grey || apart(shadeless(f), shadeless(self.skin.middle)) > 0.07);
            self.is_out(i) && if self.is_bald { beside && is_dark } else { beside || crown }
        });
        let samples = plate.samples(&seeds);
        let middle = median(&samples).filter(|_| samples.len() > LEAST_SEEDS)?;
        let mut hair =
            Hair { mixture: Mixture::fitted(&samples, HAIRS)?, middle, is_unlike_clothing: false, beside_jaw: [0.0; 2] };
        let room = 0.09 * plate.head.width * plate.head.height * plate.scale * plate.scale;
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            let is_it = |i: usize| {
                let [u, v] = plate.at.pixels()[i];
                let f = plate.features.pixels()[i];
                v > 0.1
                    && v < 0.4
                    && u * sign > 0.48
                    && u * sign < 0.78
                    && self.is_out(i)
                    && self.from_skin.pixels()[i] > NO_SKIN
                    && hair.distance(f, 0.35, 0.6) < 22.0
            };
            hair.beside_jaw[side] = ((0..plate.at.len()).filter(|i| is_it(*i)).count() as f64 / room) as f32;
        }
        Some(hair)
    }

    /// Where clothing certainly is: the shoulders, below the chin and along the picture's lower border, where there is no skin.
    fn shoulders(&self) -> Raster<bool> {
        let plate = self.plate;
        let (width, height) = (plate.width(), plate.height());
        let border = (0.06 * height as f32).max(4.0) as usize;
        plate.pixels_where(|[u, v], i| {
            let a = u.abs();
            let is_low = ((v < -0.12 && a > 0.62) || v < -0.42) && v < 0.25 - 0.25 * a;
            let is_last = i / width + border > height && v < -0.1;
            self.is_out(i) && (is_low || is_last) && (plate.is_grey || self.from_skin.pixels()[i] > NO_SKIN)
        })
    }

    /// Learns clothing on the shoulders, where there is no hair.
    fn clothing_learned(&self) -> Option<Mixture> {
        /// Normal distributions in the mixture of clothing.
        const CLOTHS: usize = 5;
        let plate = self.plate;
        let seeds = self.shoulders();
        let without_hair = plate.pixels_where(|[u, v], i| {
            seeds.pixels()[i]
                && !self.hair.as_ref().is_some_and(|hair| {
                    let f = plate.features.pixels()[i];
                    let is_long = hair.hangs(u) && u.abs() < 1.3;
                    (hair.distance(f, 0.35, 0.6) < 9.0 && v > -0.35)
                        || (hair.distance(f, 0.25, 0.4) < 18.0 && v > -0.85 && is_long)
                })
        });
        let samples = Some(plate.samples(&without_hair)).filter(|s| s.len() > 60).unwrap_or_else(|| plate.samples(&seeds));
        if samples.len() > LEAST_SEEDS { Mixture::fitted(&samples, CLOTHS) } else { None }
    }

    /// Log score of each class at a pixel.
    fn class_scores(&self, i: usize) -> [f32; 4] {
        let plate = self.plate;
        if !plate.inside.pixels()[i] {
            return [30.0, -60.0, -60.0, -60.0];
        }
        let ([u, v], f, is_face) = (plate.at.pixels()[i], plate.features.pixels()[i], plate.oval.pixels()[i]);
        [-60.0, self.skin_suits(i, u, v, f, is_face), self.hair_suits(i, u, v, f, is_face), self.clothing_suits(u, v, f)]
    }

    fn skin_suits(&self, i: usize, u: f32, v: f32, f: Feature, is_face: bool) -> f32 {
        let a = u.abs();
        let (far, path) = (self.from_skin.pixels()[i], self.path.pixels()[i]);
        let is_core = self.plate.core.pixels()[i] && v < 0.72;
        let is_shadow = self.lighting.is_shadow(self.plate, i);
        let most = if is_shadow {
            8.0
        } else if is_core {
            24.0
        } else {
            40.0
        };
        let mut e = -0.5 * far.min(most) - self.skin.level();
        if is_shadow {
            e += 6.0;
        }
        if is_core {
            e += 14.0;
        } else if is_face {
            // A fringe may cover the forehead.
            e += 9.0 - 7.0 * ((v - 0.68) / 0.17).clamp(0.0, 1.0);
        }
        let is_near = path < 2.0 && far < 5.0;
        if is_near && v > 0.7 && v < 1.3 {
            e += 4.0;
        }
        if v < 0.1 {
            // Shade connects the neck to the face; skin-coloured clothing begins at an edge.
            e -= 0.8 * (path - 4.0).clamp(0.0, 6.0);
        }
        if a < 0.4 && v < 0.1 && v > -0.35 && self.from_skin.pixels()[i] < NO_SKIN {
            e += 4.0;
        }
        if v > 1.04 && !self.is_bald && !is_near {
            e -= 4.0;
        }
        let is_bare = v < 0.1 && far < NO_SKIN && path < 6.0;
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

    fn hair_suits(&self, i: usize, u: f32, v: f32, f: Feature, is_face: bool) -> f32 {
        let Some(hair) = &self.hair else { return -60.0 };
        let a = u.abs();
        let mut e = hair.mixture.log_density(f);
        if (self.plate.core.pixels()[i] && v < 0.75) || self.lighting.is_shadow(self.plate, i) {
            e -= 12.0;
        } else if is_face && v < 0.78 {
            e -= 6.0;
        }
        e -= (-v - 0.1).max(0.0) * if hair.hangs(u) { 2.0 } else { 9.0 };
        e -= (a - 0.95).max(0.0) * 6.0;
        let is_long = hair.beside_jaw(u) > 0.8 && a > 0.25;
        if v < 0.0 && a < 0.45 {
            e -= if is_long { 3.0 } else { 9.0 };
        }
        if v < 0.35 && a < 0.36 {
            e -= if is_long { 3.0 } else { 7.0 };
        }
        let is_lit = self.lighting.is_glowing(v, f, i, hair.middle)
            || is_reflection(v, f, self.path.pixels()[i], [self.skin.middle, hair.middle]);
        if is_lit {
            e -= 12.0;
        }
        if v > 1.12 && !self.is_bald && self.path.pixels()[i] > 2.0 {
            e += 3.0;
        }
        if v < 0.12 && a < 0.62 && !is_long {
            e -= 5.0;
        }
        e
    }

    fn clothing_suits(&self, u: f32, v: f32, f: Feature) -> f32 {
        let a = u.abs();
        let flat = -self.skin.level() - 12.5;
        let colour = self.clothing.as_ref().map_or(flat, |c| log_sum([c.log_density(f), flat].into_iter()));
        let hairy =
            self.hair.as_ref().is_some_and(|hair| hair.hangs(u) && a < 1.3 && a > 0.4 && hair.distance(f, 0.25, 0.4) < 18.0);
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

    /// The shares of each pixel, smoothed along the picture's edges.
    pub(super) fn shares(&self, guides: &[Guide; 2]) -> Raster<Shares> {
        let plate = self.plate;
        let width = plate.width();
        let mut shares = Raster::from_fn(width, plate.height(), |x, y| {
            let e = self.class_scores(y * width + x);
            let greatest = e.iter().copied().fold(f32::MIN, f32::max);
            normalised(e.map(|v| (0.5 * (v - greatest)).max(-40.0).exponential()))
        });
        for guide in guides {
            let planes = [SKIN, HAIR, CLOTHING].map(|k| guide.filtered(&shares.map(|s| s[k])));
            shares = Raster::from_fn(width, plate.height(), |x, y| {
                let [skin, hair, clothing] = [0, 1, 2].map(|k| planes[k].get(x, y));
                normalised([1.0 - skin - hair - clothing, skin, hair, clothing].map(|v| v.max(1e-4)))
            });
        }
        shares
    }

    /// Whether there was hair to learn from.
    pub(super) const fn has_hair(&self) -> bool {
        self.hair.is_some()
    }

    /// Mean squared deviation of a piece from skin.
    pub(super) fn mean_from_skin(&self, pixels: &[usize]) -> f32 {
        pixels.iter().map(|&i| self.from_skin.pixels()[i].min(40.0)).sum::<f32>() / pixels.len().max(1) as f32
    }

    /// Whether hair hangs beside the jaw on the side of `u`.
    pub(super) fn is_long(&self, u: f32) -> bool {
        self.hair.as_ref().is_some_and(|hair| hair.hangs(u))
    }
}

pub(super) fn normalised(shares: Shares) -> Shares {
    let sum: f32 = shares.iter().sum();
    shares.map(|v| v / sum.max(1e-6))
}

/// The class with the greatest share.
pub(super) fn greatest(shares: Shares) -> usize {
    (1..4).fold(0, |best, k| if shares[k] > shares[best] { k } else { best })
}
