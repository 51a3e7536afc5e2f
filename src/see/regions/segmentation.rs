//! Segmentation into skin, hair and clothing: the appearance of each is learned where it certainly is, and its likely places are
//! known from the shape of heads.

use super::baldness::is_bald;
use super::mixture::{Gaussian, Mixture, add_diagonal, covariance, log_sum, square};
use super::path::path_from;
use super::plate::{Feature, LIGHTNESS_WEIGHT, Plate};
use super::smoothing::Guide;
use crate::raster::{Raster, dilate, gaussian_blur};

/// Shares of a pixel: background, skin, hair (of any kind, and hats), clothing.
pub(super) type Shares = [f32; 4];
pub(super) const SKIN: usize = 1;
pub(super) const HAIR: usize = 2;
pub(super) const CLOTHING: usize = 3;

/// Landmarks on cheeks, nose and forehead, where no hair grows, and the radius of the disc sampled at each, in widths of the
/// face.
const BARE: [usize; 20] = [50, 101, 205, 123, 36, 280, 330, 425, 352, 266, 6, 197, 195, 9, 8, 151, 108, 337, 69, 299];
const BARE_REACH: f32 = 0.045;
/// Landmarks below the eyes, in light or shade, and those of the forehead, where a fringe may hang.
const CHEEKS_AND_NOSE: [usize; 13] = [50, 101, 205, 123, 36, 280, 330, 425, 352, 266, 6, 197, 195];
const FOREHEAD: [usize; 7] = [9, 8, 151, 108, 337, 69, 299];
/// Greatest difference of a disc's shade-free colour from the median disc's; and of its hue, in radians, if its colour is deeper.
const SAME_COLOUR: f32 = 0.1;
const SAME_HUE: f32 = 0.2;
/// L* of the median disc from which most of the face is a highlight.
const SHINING: f32 = 72.0;
/// Greatest difference of a forehead disc's shade-free colour from a cheek disc's, and of its features.
const FOREHEAD_HUE: f32 = 0.07;
const FOREHEAD_LIKE_CHEEKS: f32 = 40.0;
/// A forehead disc whose texture exceeds the cheeks' by this is a fringe.
const FOREHEAD_ROUGHER: f32 = 2.0;
/// Samples farther than this from their disc's median are brows, frames of glasses or lashes.
const STRAY: f32 = 30.0;
/// Skin of medium lightness, used if no disc is visible.
const ANY_SKIN: Feature = [130.0, 15.0, 18.0, 5.0];
/// The middle of the forehead's upper border.
const TOP: usize = 10;
/// Between the eyes.
const BETWEEN_EYES: usize = 6;
/// The cheek on the picture's left and on its right.
const CHEEKS: [usize; 2] = [50, 280];
/// A cheek below this fraction of the other's lightness may lie in black shadow.
const SHADOW: f32 = 0.45;
/// It does if it is also darker than this L*.
const DARK_CHEEK: f32 = 35.0;
/// Texture up to which black is taken for shadow, not hair.
const SMOOTH: f32 = 14.0;
/// Number of Gaussians for skin (light and shade), hair and clothing.
const SKINS: usize = 3;
const HAIRS: usize = 4;
const CLOTHS: usize = 5;
/// Fewest pixels to learn a class from.
const LEAST_SEEDS: usize = 40;
/// Chroma from which hair can be distinguished from jackets.
const COLOURED: f32 = 10.0;
/// Distance of the shoulders' median from the hair's from which they cannot be confused.
const UNLIKE: f32 = 15.0;
/// Squared deviation of pixels outside the person.
const FARTHEST: f32 = 1000.0;
/// Squared deviation from which a pixel is certainly not skin.
const NO_SKIN: f32 = 9.0;
/// Deviation of skin's a* and b*, in any light.
const SKIN_HUE: f32 = 9.0;

/// L* from which a pixel may be a lamp's reflection, and the least fraction of a crown in other colours than skin that makes it
/// hair.
const FULL: f32 = 88.0;
const OTHER_CROWN: f32 = 0.6;

/// Position of a pixel, which selects the model of skin.
#[derive(Clone, Copy)]
enum Place {
    Face,
    Neck,
    Elsewhere,
}

/// Skin with less than this fraction of the deepest skin colour is a highlight.
const MATT: f32 = 0.6;
/// Deviations of shaded skin: of hue, and of L*.
const SHADE_HUE: f32 = 0.03;
const SHADE_DEPTH: f32 = 35.0;

/// The appearance of skin.
struct Skin {
    plain: Vec<Gaussian>,
    /// For the neck: wider for shade, and without the face's highlights, which look like white shirts.
    shaded: Vec<Gaussian>,
    /// Without highlights, with the plain spread.
    matt: Vec<Gaussian>,
    middle: Feature,
}

impl Skin {
    fn learned(plate: &Plate) -> Self {
        let discs = |indices: &[usize]| -> Vec<Vec<Feature>> {
            let disc = |&i| plate.samples(&plate.round(&[i], BARE_REACH).zip_map(&plate.inside, |a, b| a && b));
            indices.iter().map(disc).collect()
        };
        let lower = sound(discs(&CHEEKS_AND_NOSE));
        let known: Vec<Feature> = lower.iter().filter_map(|disc| median(disc)).collect();
        let even = known.iter().map(|f| f[3]).fold(0.0, f32::max) + FOREHEAD_ROUGHER;
        let upper = discs(&FOREHEAD).into_iter().filter(|disc| {
            let is_like = |m: Feature| {
                let is_near = |k: &Feature| square(*k, m) < FOREHEAD_LIKE_CHEEKS * FOREHEAD_LIKE_CHEEKS;
                known.iter().any(|k| is_near(k) && apart(shadeless(*k), shadeless(m)) < FOREHEAD_HUE)
            };
            median(disc).is_some_and(|m| is_like(m) && m[3] < even)
        });
        let samples: Vec<Feature> =
            lower.iter().flat_map(|disc| near_median(disc)).chain(upper.flat_map(|disc| near_median(&disc))).collect();
        let middle = median(&samples).unwrap_or(ANY_SKIN);
        let parts = Mixture::fitted(&samples, SKINS);
        let middles: Vec<Feature> = parts.iter().flat_map(Mixture::parts).map(Gaussian::mean).chain([middle]).collect();
        let mut spread = [[0.0; 4]; 4];
        if samples.len() > LEAST_SEEDS {
            let around: Vec<Feature> = samples
                .iter()
                .map(|s| {
                    let near = middles.iter().min_by(|a, b| square(**a, *s).total_cmp(&square(**b, *s))).unwrap_or(&middle);
                    [0, 1, 2, 3].map(|k| s[k] - near[k])
                })
                .collect();
            spread = covariance(&around, [0.0; 4]).map(|row| row.map(|v| 1.6 * v));
        }
        add_diagonal(&mut spread, [180.0, 16.0, 16.0, 14.0]);
        let mut wide = spread;
        add_diagonal(&mut wide, [900.0, 0.0, 0.0, 60.0]);
        let all = |middles: &[Feature], spread| middles.iter().map(|m| Gaussian::new(*m, spread)).collect();
        let colour = |f: Feature| apart(shadeless(f), [0.0; 2]);
        let most = middles.iter().map(|m| colour(*m)).fold(0.0, f32::max);
        let matt: Vec<Feature> = middles.iter().filter(|m| colour(**m) > MATT * most).copied().collect();
        Self { plain: all(&middles, spread), shaded: all(&matt, wide), matt: all(&matt, spread), middle }
    }

    /// Squared deviation from skin.
    fn distance(&self, f: Feature, place: Place) -> f32 {
        let parts = match place {
            Place::Face => &self.plain,
            Place::Neck => &self.shaded,
            Place::Elsewhere => &self.matt,
        };
        let of = |part: &Gaussian| {
            let m = part.mean();
            let hue = ((f[1] - m[1]).powi(2) + (f[2] - m[2]).powi(2)) / (SKIN_HUE * SKIN_HUE);
            part.distance(f).max(hue)
        };
        parts.iter().map(of).fold(f32::INFINITY, f32::min)
    }

    /// Squared deviation from shaded skin: darker at little cost, but of the same hue and as smooth.
    fn shaded_distance(&self, f: Feature) -> f32 {
        let of = |part: &Gaussian| {
            let m = part.mean();
            let hue = apart(shadeless(f), shadeless(m)) / SHADE_HUE;
            let dark = (m[0] - f[0]) / (LIGHTNESS_WEIGHT * SHADE_DEPTH);
            let light = (f[0] - m[0]).max(0.0) / (LIGHTNESS_WEIGHT * 10.0);
            let uneven = (f[3] - m[3]).max(0.0) / 8.0;
            hue * hue + dark.max(0.0).powi(2) + light * light + uneven * uneven
        };
        self.plain.iter().map(of).fold(f32::INFINITY, f32::min)
    }

    fn level(&self) -> f32 {
        self.plain.first().map_or(0.0, Gaussian::half_log_determinant)
    }
}

/// The colour without shade: a* and b* divided by L* + 16. They are constant when light falls by a factor, since all three scale
/// with its cube root.
fn shadeless(f: Feature) -> [f32; 2] {
    let root = f[0] / LIGHTNESS_WEIGHT + 16.0;
    [f[1] / root, f[2] / root]
}

fn apart(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The discs that show skin: those with the median disc's colour in any light, or with a deeper colour in shade if most of the
/// face is a highlight. Beards, frames of glasses and stray hair have other colours.
fn sound(discs: Vec<Vec<Feature>>) -> Vec<Vec<Feature>> {
    type Look = (f32, [f32; 2]);
    let looks = |disc: &[Feature]| median(disc).map(|f| (f[0], shadeless(f)));
    let all: Vec<Look> = discs.iter().filter_map(|disc| looks(disc)).collect();
    let middle = |of: &dyn Fn(&Look) -> f32| {
        let mut values: Vec<f32> = all.iter().map(of).collect();
        values.sort_by(f32::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(0.0)
    };
    let (light, usual) = (middle(&|look| look.0), [middle(&|look| look.1[0]), middle(&|look| look.1[1])]);
    let is_skin = |(l, colour): (f32, [f32; 2])| {
        let is_deeper = light > SHINING * LIGHTNESS_WEIGHT && l < light && apart(colour, [0.0; 2]) > apart(usual, [0.0; 2]);
        let turn = colour[1].atan2(colour[0]) - usual[1].atan2(usual[0]);
        apart(colour, usual) < SAME_COLOUR || (is_deeper && turn.abs() < SAME_HUE)
    };
    discs.into_iter().filter(|disc| looks(disc).is_some_and(is_skin)).collect()
}

/// A disc's samples without those far from its median.
fn near_median(disc: &[Feature]) -> Vec<Feature> {
    let Some(middle) = median(disc) else { return Vec::new() };
    disc.iter().filter(|f| square(**f, middle) < STRAY * STRAY).copied().collect()
}

/// What was learned about a head, from which its pixels are classified.
pub(super) struct Segmentation<'a> {
    plate: &'a Plate,
    skin: Skin,
    pub is_bald: bool,
    /// Squared deviation of each pixel from skin.
    from_skin: Raster<f32>,
    /// Cost of the colour path from the bare skin of the face.
    path: Raster<f32>,
    /// Sides of the face in black shadow, where colour is meaningless: the picture's left, then right.
    shadowed: [bool; 2],
    /// The face's oval with the ears beside it.
    with_ears: Raster<bool>,
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
        let is_coloured = self.middle[1].hypot(self.middle[2]) > COLOURED;
        self.beside_jaw(u) > if is_coloured || self.is_unlike_clothing { 0.25 } else { 0.6 }
    }

    fn beside_jaw(&self, u: f32) -> f32 {
        self.beside_jaw[usize::from(u > 0.0)]
    }
}

/// The sides whose cheek is nearly black compared with the other.
fn shadowed(plate: &Plate) -> [bool; 2] {
    let light = CHEEKS.map(|i| median(&plate.samples(&plate.round(&[i], BARE_REACH))).map_or(0.0, |f| f[0]));
    let is_black = |own: f32, other: f32| own < SHADOW * other && own < DARK_CHEEK * LIGHTNESS_WEIGHT;
    [is_black(light[0], light[1]), is_black(light[1], light[0])]
}

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
        let mut parting = Self {
            plate,
            skin,
            is_bald,
            from_skin,
            path,
            shadowed: shadowed(plate),
            with_ears: dilate(&plate.oval.map(u8::from), (0.2 * plate.face_width) as usize).map(|v| v != 0),
            hair: None,
            clothing: None,
        };
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
        let plate = self.plate;
        let outside = plate.inside.map(|is| u8::from(!is));
        let edge = dilate(&outside, (0.12 * plate.face_width) as usize);
        let seeds = plate.pixels_where(|[u, v], i| {
            let (f, a) = (plate.features.pixels()[i], u.abs());
            let is_no_skin = self.from_skin.pixels()[i] > NO_SKIN;
            let is_blush = f[1].hypot(f[2]) > 40.0 && f[1] > 30.0;
            let beside = v > 0.35 && v < 1.25 && a > 0.52 && a < 1.05 && is_no_skin && !is_blush;
            let is_far = self.path.pixels()[i] > 2.0 && self.from_skin.pixels()[i] > 2.0;
            let crown = v > 1.05 && a < 0.55 && (is_no_skin || (v > 1.14 && edge.pixels()[i] != 0 && is_far));
            let is_dark = f[0] < self.skin.middle[0] - 25.0 * LIGHTNESS_WEIGHT
                && self.path.pixels()[i] > 6.0
                && apart(shadeless(f), shadeless(self.skin.middle)) > 0.07;
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
            self.is_out(i) && (is_low || is_last) && self.from_skin.pixels()[i] > NO_SKIN
        })
    }

    /// Learns clothing on the shoulders, where there is no hair.
    fn clothing_learned(&self) -> Option<Mixture> {
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
        let is_shadow = self.is_shadow(i);
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
        if is_bare {
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

    /// True if a pixel may be skin in black shadow: in the face or at an ear, on a shadowed side.
    fn is_shadow(&self, i: usize) -> bool {
        let [u, v] = self.plate.at.pixels()[i];
        let side = usize::from(u > self.plate.coordinates(self.plate.point(BETWEEN_EYES))[0]);
        let is_face = self.with_ears.pixels()[i] && v < 0.97 && u.abs() < 0.35;
        let is_ear = self.with_ears.pixels()[i] && v < 0.72 && v > 0.2;
        self.shadowed[side] && (is_face || is_ear) && self.plate.features.pixels()[i][3] < SMOOTH
    }

    fn hair_suits(&self, i: usize, u: f32, v: f32, f: Feature, is_face: bool) -> f32 {
        let Some(hair) = &self.hair else { return -60.0 };
        let a = u.abs();
        let mut e = hair.mixture.log_density(f);
        if (self.plate.core.pixels()[i] && v < 0.75) || self.is_shadow(i) {
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
            normalised(e.map(|v| (0.5 * (v - greatest)).max(-40.0).exp()))
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

/// The median of each component.
fn median(samples: &[Feature]) -> Option<Feature> {
    let of = |k: usize| {
        let mut values: Vec<f32> = samples.iter().map(|s| s[k]).collect();
        values.sort_by(f32::total_cmp);
        values.get(values.len() / 2).copied()
    };
    Some([of(0)?, of(1)?, of(2)?, of(3)?])
}
