//! Segmentation into skin, hair and clothing: the appearance of each is learned where it certainly is, and its likely places are
//! known from the shape of heads.

use super::baldness::{Crown, crown};
use super::ears::ears_in_shade;
use super::facial_hair::Beard;
use super::falling::{falls_past_jaw, fringe, over_face};
use super::hair::Hair;
use super::lighting::Lighting;
use super::mane::manes;
use super::mixture::Mixture;
use super::path::path_from;
use super::plate::{Feature, LIGHTNESS_WEIGHT, Plate};
use super::skin_model::{BARE, BARE_REACH, FOREHEAD, LEAST_SEEDS, NO_SKIN, Place, Skin, apart, median, shadeless};
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
    pub(super) plate: &'a Plate,
    pub(super) skin: Skin,
    pub is_bald: bool,
    /// Whether hair is cropped so short that skin in shade is nearly its colour.
    pub is_cropped: bool,
    /// Squared deviation of each pixel from skin.
    pub(super) from_skin: Raster<f32>,
    /// Cost of the colour path from the bare skin of the face.
    pub(super) path: Raster<f32>,
    pub(super) lighting: Lighting,
    pub(super) hair: Option<Hair>,
    pub(super) clothing: Option<Mixture>,
    /// Ears in shade, which look like hair.
    pub(super) ears: Raster<bool>,
}

/// Distance from hair's median up to which a pixel beside the face is like it.
const LIKE_HAIR: f32 = 22.0;

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

/// How much darker than the skin, in L*, a place on the forehead may be a fringe of its colour: nothing is known to be bare there. Fringes of
/// two heads are 20 to 37 darker; of sixteen portraits at most 0.15 % of the picture changes.
const FRINGE: f32 = 20.0;

/// The squared deviation of each pixel from skin, and the cost of its colour path from the bare skin of the face.
fn away_from_skin(plate: &Plate, skin: &Skin) -> (Raster<f32>, Raster<f32>) {
    /// Squared deviation of pixels outside the person.
    const FARTHEST: f32 = 1000.0;
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
    let forehead = plate.round(&FOREHEAD, BARE_REACH);
    let darkest = skin.middle[0] - FRINGE * LIGHTNESS_WEIGHT;
    let bare = plate.round(&BARE, BARE_REACH);
    let bare = plate.pixels_where(|_, i| {
        let may_be_fringe = forehead.pixels()[i] && plate.features.pixels()[i][0] < darkest;
        bare.pixels()[i] && from_skin.pixels()[i] < NO_SKIN && !may_be_fringe
    });
    let path = path_from(&smooth, &plate.inside, &bare);
    let from_skin = Raster::from_fn(plate.width(), plate.height(), |x, y| {
        let (d, [u, v]) = (from_skin.get(x, y), plate.at.get(x, y));
        let is_forehead = (0.9..1.15).contains(&v) && u.abs() < 0.6 && path.get(x, y) < 2.0;
        let f = plate.features.get(x, y);
        if is_forehead { d.min(skin.shaded_distance(f)).min(skin.shine_distance(f)) } else { d }
    });
    (from_skin, path)
}

impl<'a> Segmentation<'a> {
    pub(super) fn learned(plate: &'a Plate, beard: Option<&Beard>) -> Self {
        /// Distance of the shoulders' median from the hair's from which they cannot be confused.
        const UNLIKE: f32 = 15.0;
        let skin = Skin::learned(plate);
        let (from_skin, path) = away_from_skin(plate, &skin);
        let crown = match crown(plate) {
            Crown::Cropped | Crown::Bare if has_another_crown(plate, &skin) => Crown::Hair,
            crown => crown,
        };
        let mut parting = Self {
            plate,
            skin,
            is_bald: crown == Crown::Bare,
            is_cropped: crown == Crown::Cropped,
            from_skin,
            path,
            lighting: Lighting::of(plate),
            hair: None,
            clothing: None,
            ears: plate.oval.map(|_| false),
        };
        parting.hair = parting.hair_learned();
        let worn = plate.samples(&parting.shoulders());
        if let (Some(hair), Some(worn)) = (&mut parting.hair, median(&worn)) {
            hair.is_unlike_clothing = hair.distance(worn, 0.35, 0.6) > UNLIKE;
        }
        parting.let_hair_fall(beard);
        parting.let_fringe_hang();
        if let Some(hair) = &parting.hair {
            parting.ears = ears_in_shade(plate, hair);
        }
        parting.clothing = parting.clothing_learned();
        parting
    }

    /// Logarithm of the density of skin at a pixel.
    pub(super) fn skin_density(&self, i: usize) -> f32 {
        -0.5 * self.from_skin.pixels()[i] - self.skin.level()
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
        let (mane, stands_out) = manes(plate, &self.skin, &self.from_skin);
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
            self.is_out(i) && if self.is_bald { beside && is_dark } else { beside || crown || mane.pixels()[i] }
        });
        let samples = plate.samples(&self.without_ears(seeds));
        let middle = median(&samples).filter(|_| samples.len() > LEAST_SEEDS)?;
        let mut hair = Hair::of(Mixture::fitted(&samples, HAIRS)?, middle, (plate.width(), plate.height()));
        hair.stands_out = stands_out;
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
                    && hair.distance(f, 0.35, 0.6) < LIKE_HAIR
            };
            hair.beside_jaw[side] = ((0..plate.at.len()).filter(|i| is_it(*i)).count() as f64 / room) as f32;
        }
        Some(hair)
    }

    /// Finds out where hair falls past the jaw, and over the face. A full beard looks the same beside the jaw, and in black and white much does.
    fn let_hair_fall(&mut self, beard: Option<&Beard>) {
        /// The squared deviation from skin above which a pixel of the face may be hair, and the distance from hair's median below which it is:
        /// hair over cheeks has 20 to 80 and up to 24 in blue light, cheeks in shade of thirty heads up to 16 of deviation.
        const COVERED: f32 = 20.0;
        const LIKE: f32 = 24.0;
        /// How much likelier hair is than skin, in natural logarithms, where hair is fair.
        const SURE: f32 = 1.0;
        let plate = self.plate;
        let Some(hair) = &self.hair else { return };
        if self.is_bald || plate.is_grey || beard.is_some_and(|beard| beard.is_dense) {
            return;
        }
        let distance = |i: usize| hair.distance(plate.features.pixels()[i], 0.35, 0.6);
        let is_no_skin = |i: usize| {
            let far = self.from_skin.pixels()[i];
            far > NO_SKIN || hair.mixture.log_density(plate.features.pixels()[i]) > self.skin_density(i) + SURE
        };
        let beside = plate
            .pixels_where(|_, i| plate.inside.pixels()[i] && !plate.core.pixels()[i] && is_no_skin(i) && distance(i) < LIKE_HAIR);
        let falls = falls_past_jaw(plate, &beside);
        let falls = [-1.0, 1.0].map(|side| {
            let which = usize::from(side > 0.0);
            !self.lighting.is_black(side) && (falls[which] || hair.stands_out[which])
        });
        let covering = plate.pixels_where(|_, i| {
            let is_covered = self.from_skin.pixels()[i] > COVERED && !self.lighting.is_shadow(plate, i);
            plate.inside.pixels()[i] && is_covered && distance(i) < LIKE
        });
        let over_face = over_face(plate, &covering, falls);
        let is_like_shoulders = falls != [false; 2] && [-1.0, 1.0].iter().all(|side| self.is_like_shoulder(hair, *side));
        if let Some(hair) = &mut self.hair {
            (hair.falls, hair.over_face, hair.is_like_shoulders) = (falls, over_face, is_like_shoulders);
        }
    }

    /// Finds a fringe that only its darkness tells from the forehead. Black hair has a colour of its own.
    fn let_fringe_hang(&mut self) {
        /// L* of the darkest hair that may have the colour of skin.
        const LIGHT: f32 = 22.0;
        /// Distance from hair's median below which a pixel may be hair, and its least path from bare skin: it begins at an edge. Fringes of two
        /// heads have 9 to 26, and 0.6 to 5.
        const LIKE: f32 = 26.0;
        const EDGE: f32 = 0.6;
        let plate = self.plate;
        let Some(hair) = &self.hair else { return };
        if self.is_bald || plate.is_grey || hair.middle[0] < LIGHT * LIGHTNESS_WEIGHT {
            return;
        }
        let darkest = self.skin.middle[0] - FRINGE * LIGHTNESS_WEIGHT;
        let may_be = plate.pixels_where(|_, i| {
            let f = plate.features.pixels()[i];
            plate.inside.pixels()[i]
                && f[0] < darkest
                && self.path.pixels()[i] > EDGE
                && hair.distance(f, 0.35, 0.6) < LIKE
                && !self.lighting.is_shadow(plate, i)
        });
        let fringe = fringe(plate, &may_be);
        if let Some(hair) = &mut self.hair {
            hair.fringe = fringe;
        }
    }

    /// True if a shoulder, farther out than hair lies, looks like it.
    fn is_like_shoulder(&self, hair: &Hair, side: f32) -> bool {
        /// Where shoulders are, in `u` and `v`, and the least share of them.
        const ASIDE: [f32; 2] = [0.95, 1.8];
        const BELOW: f32 = -0.35;
        const MOST: f32 = 0.5;
        let plate = self.plate;
        let shoulder =
            plate.pixels_where(|[u, v], i| plate.inside.pixels()[i] && v < BELOW && (ASIDE[0]..ASIDE[1]).contains(&(side * u)));
        let samples = plate.samples(&shoulder);
        let like = samples.iter().filter(|f| hair.distance(**f, 0.25, 0.4) < 18.0).count();
        samples.len() > LEAST_SEEDS && like as f32 > MOST * samples.len() as f32
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
        /// The least likelihood of curls in light, in natural logarithms, and how much less texture than the hair they have at most.
        const LIKELY: f32 = -12.0;
        const AS_ROUGH: f32 = 3.0;
        let plate = self.plate;
        let is_curl = |hair: &Hair, f: Feature| {
            !hair.is_like_shoulders && f[3] > hair.middle[3] - AS_ROUGH && hair.mixture.log_density(f) > LIKELY
        };
        let seeds = self.shoulders();
        let without_hair = plate.pixels_where(|[u, v], i| {
            seeds.pixels()[i]
                && !self.hair.as_ref().is_some_and(|hair| {
                    let f = plate.features.pixels()[i];
                    let is_long = hair.hangs(u) && u.abs() < hair.widest();
                    (hair.distance(f, 0.35, 0.6) < 9.0 && v > -0.35)
                        || (hair.distance(f, 0.25, 0.4) < 18.0 && v > -0.85 && is_long)
                        || (is_curl(hair, f) && v > -0.85 && hair.falls(u) && u.abs() < hair.widest())
                })
        });
        let samples = Some(plate.samples(&without_hair)).filter(|s| s.len() > 60).unwrap_or_else(|| plate.samples(&seeds));
        if samples.len() > LEAST_SEEDS { Mixture::fitted(&samples, CLOTHS) } else { None }
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

    /// Whether hair falls past the jaw on the side of `u`.
    pub(super) fn falls(&self, u: f32) -> bool {
        self.hair.as_ref().is_some_and(|hair| hair.falls(u))
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
