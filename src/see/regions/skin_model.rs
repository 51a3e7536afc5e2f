//! The appearance of a head's skin, learned from its bare places.

use super::mixture::{Gaussian, Mixture, add_diagonal, covariance, square};
use super::plate::{Feature, LIGHTNESS_WEIGHT, Plate};
use crate::elementary::Elementary as _;
use crate::raster;

/// Fewest pixels to learn a class from.
pub(super) const LEAST_SEEDS: usize = 40;
/// Deviation of skin's a* and b*, in any light.
const SKIN_HUE: f32 = 9.0;
/// Landmarks on cheeks, nose and forehead, where no hair grows, and the radius of the disc sampled at each, in widths of the
/// face.
pub(super) const BARE: [usize; 20] = [50, 101, 205, 123, 36, 280, 330, 425, 352, 266, 6, 197, 195, 9, 8, 151, 108, 337, 69, 299];
pub(super) const BARE_REACH: f32 = 0.045;
/// Landmarks below the eyes, in light or shade, and those of the forehead, where a fringe may hang.
const CHEEKS_AND_NOSE: [usize; 13] = [50, 101, 205, 123, 36, 280, 330, 425, 352, 266, 6, 197, 195];
pub(super) const FOREHEAD: [usize; 7] = [9, 8, 151, 108, 337, 69, 299];
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
/// Number of Gaussians for skin (light and shade), hair and clothing.
const SKINS: usize = 3;
/// Skin with less than this fraction of the deepest skin colour is a highlight.
const MATT: f32 = 0.6;
/// Deviations of shaded skin: of hue, and of L*.
const SHADE_HUE: f32 = 0.03;
const SHADE_DEPTH: f32 = 35.0;

/// Squared deviation from which a pixel is certainly not skin.
pub(super) const NO_SKIN: f32 = 9.0;

/// Position of a pixel, which selects the model of skin.
#[derive(Clone, Copy)]
pub(super) enum Place {
    Face,
    Neck,
    Elsewhere,
}

/// The appearance of skin.
pub(super) struct Skin {
    plain: Vec<Gaussian>,
    /// For the neck: wider for shade, and without the face's highlights, which look like white shirts.
    shaded: Vec<Gaussian>,
    /// Without highlights, with the plain spread.
    matt: Vec<Gaussian>,
    pub(super) middle: Feature,
    is_grey: bool,
}

impl Skin {
    pub(super) fn learned(plate: &Plate) -> Self {
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
        let matt: Vec<Feature> = middles.iter().filter(|m| plate.is_grey || colour(**m) > MATT * most).copied().collect();
        Self { plain: all(&middles, spread), shaded: all(&matt, wide), matt: all(&matt, spread), middle, is_grey: plate.is_grey }
    }

    /// Squared deviation from skin.
    pub(super) fn distance(&self, f: Feature, place: Place) -> f32 {
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
        parts.iter().map(of).fold(f32::INFINITY, f32::min) + self.too_light(f, place)
    }

    /// Squared deviation of what is lighter than the face on a neck in black and white, where nothing else tells a collar.
    fn too_light(&self, f: Feature, place: Place) -> f32 {
        /// L* above the median of the skin at which it is certain.
        const CERTAIN: f32 = 9.0;
        if !self.is_grey || !matches!(place, Place::Neck) {
            return 0.0;
        }
        let over = (f[0] - self.middle[0]).max(0.0) / (CERTAIN * LIGHTNESS_WEIGHT);
        NO_SKIN * over * over
    }

    /// Squared deviation from shaded skin: darker at little cost, but of the same hue and as smooth.
    pub(super) fn shaded_distance(&self, f: Feature) -> f32 {
        if self.is_grey {
            return f32::INFINITY;
        }
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

    /// Squared deviation from a lamp's light on a forehead, of any colour: it is lighter than the skin and as smooth. Fair hair has more texture.
    pub(super) fn shine_distance(&self, f: Feature) -> f32 {
        /// How much more texture than the skin it has at most, and its most: it has 4 to 10 in a portrait, fair curls before a forehead 18. And its deviation.
        const SMOOTH: f32 = 5.0;
        const EVEN: f32 = 13.0;
        const SHINE: f32 = 4.0;
        let is_shine = f[0] > self.middle[0] && f[3] < (self.middle[3] + SMOOTH).min(EVEN) && !self.is_grey;
        if is_shine { SHINE } else { f32::INFINITY }
    }

    pub(super) fn level(&self) -> f32 {
        self.plain.first().map_or(0.0, Gaussian::half_log_determinant)
    }
}

/// The colour without shade: a* and b* divided by L* + 16. They are constant when light falls by a factor, since all three scale
/// with its cube root.
pub(super) fn shadeless(f: Feature) -> [f32; 2] {
    let root = f[0] / LIGHTNESS_WEIGHT + 16.0;
    [f[1] / root, f[2] / root]
}

pub(super) fn apart(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).hypotenuse(a[1] - b[1])
}

/// The discs that show skin: those with the median disc's colour in any light, or with a deeper colour in shade if most of the
/// face is a highlight. Beards, frames of glasses and stray hair have other colours.
fn sound(discs: Vec<Vec<Feature>>) -> Vec<Vec<Feature>> {
    type Look = (f32, [f32; 2]);
    let looks = |disc: &[Feature]| median(disc).map(|f| (f[0], shadeless(f)));
    let all: Vec<Look> = discs.iter().filter_map(|disc| looks(disc)).collect();
    let middle = |of: &dyn Fn(&Look) -> f32| {
        let mut values: Vec<f32> = all.iter().map(of).collect();
        values.sort_unstable_by(f32::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(0.0)
    };
    let (light, usual) = (middle(&|look| look.0), [middle(&|look| look.1[0]), middle(&|look| look.1[1])]);
    let is_skin = |(l, colour): (f32, [f32; 2])| {
        let is_deeper = light > SHINING * LIGHTNESS_WEIGHT && l < light && apart(colour, [0.0; 2]) > apart(usual, [0.0; 2]);
        let turn = colour[1].angle_over(colour[0]) - usual[1].angle_over(usual[0]);
        apart(colour, usual) < SAME_COLOUR || (is_deeper && turn.abs() < SAME_HUE)
    };
    discs.into_iter().filter(|disc| looks(disc).is_some_and(is_skin)).collect()
}

/// A disc's samples without those far from its median.
fn near_median(disc: &[Feature]) -> Vec<Feature> {
    let Some(middle) = median(disc) else { return Vec::new() };
    disc.iter().filter(|f| square(**f, middle) < STRAY * STRAY).copied().collect()
}

/// The median of each component.
pub(super) fn median(samples: &[Feature]) -> Option<Feature> {
    let of = |k: usize| raster::median(samples.iter().map(|s| s[k]).collect());
    Some([of(0)?, of(1)?, of(2)?, of(3)?])
}
