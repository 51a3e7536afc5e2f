//! Step 2: hair (sections 3.1.2, 4 and 6.3.3).

use super::Drawer;
use super::regions::Regions;
use super::strokes::Touch;
use crate::drawing::Mark;
use crate::elementary::{Elementary as _, unit_at};
use crate::field::{Covering, HoughFilter, HoughForm, OrientationField, cover};
use crate::geometry::{Millimetres, Point, Ring, Vec2, smooth_polyline};
use crate::raster::{Raster, fast_gaussian, gaussian_blur, ridges};
use crate::source::MaskRole;
use crate::style::Picture;
use crate::style::declaration::Radians;
use crate::style::random::stream;
use crate::style::rim::rim;

/// Blur before line detection, in pixels (section 3.1.2).
const LINE_BLUR: f32 = 2.0;
/// Quantile of the hair's curvature that a line must exceed: with fewer lines bald patches appear, with more the photograph's noise
/// counts.
const LINE_QUANTILE: f64 = 0.5;
/// Width of a strand at full pressure as a share of the stick's: at full width hair looks cut in wood.
const HAIR_WIDTH: f64 = 0.7;
/// By how much strands are thinner in light hair, as a share: as wide as in dark hair they are stitches along its silhouette (12 and 13).
const THIN_IN_LIGHT: f64 = 0.45;
/// By how much strands of cropped hair are shorter, as a share: long ones comb it (06).
const SHORTER_IF_CROPPED: f64 = 0.8;
/// Median darkness at which hair counts as fully light, and at which it no longer does: in the photograph's own tone light hair is bare
/// paper (judged on white and blond hair).
const LIGHT_HAIR: (f32, f32) = (0.25, 0.45);
/// Ink of the shaded side of a lock in light hair, and the width of a lock.
const LOCK_INK: f32 = 0.45;
const LOCK: Millimetres = Millimetres(2.5);
/// How far along a lock ink is averaged to either side, as a share of a stroke's length, and by how many steps.
const ALONG: f64 = 0.45;
const ALONG_STEPS: u32 = 12;
/// The share of a stroke's turn that is left in long lines: 2 of 15 degrees. With all of it they are a mat of crossing strokes, where an
/// engraver's lie side by side. Beards keep it: combed ones are thumbprints (portraits 04, 11 and 14).
const COMBED: f64 = 2.0 / 15.0;
/// Angles of the Hough accumulator.
const ANGLES: usize = 36;

/// Strokes of hair.
#[derive(Clone, Copy)]
pub(in crate::style) struct Hairs {
    /// Distance from stroke to stroke.
    pub pitch: Millimetres,
    /// Width at full pressure.
    pub width: Millimetres,
    /// Mean length.
    pub length: Millimetres,
    /// Maximum angle to the field.
    pub turn: Radians,
    /// The share of it outside beards.
    pub combed: f64,
    /// The share of the width in beards.
    pub in_beards: f64,
}

/// The direction of hair as it was detected, smoothed, and as strokes follow it.
struct Orientation {
    raw: OrientationField,
    smoothed: OrientationField,
    field: OrientationField,
}

/// What strokes of hair are.
#[derive(Clone, Copy)]
pub(super) enum Strands {
    /// Long lines side by side whose pitch and width are a share of the style's, and hooks on heads that are coiled all over.
    Fine(f64),
    /// Hooks where hair is coiled.
    Curled,
}

impl Drawer<'_> {
    /// Strokes inside a region, 0 to 1, that make a share of its ink, and at least an ink.
    pub(super) fn hair(&self, hair: &Raster<f32>, share: f32, strands: Strands, least: &Raster<f32>) -> Vec<Mark> {
        self.observer.begin("hair");
        if hair.pixels().iter().all(|v| *v < 0.5) {
            return Vec::new();
        }
        let Orientation { raw, smoothed, field } = self.hair_orientation(hair, strands);
        let darkness = self.darkness();
        let levels = levels_inside(&darkness, hair, [0.03, 0.5, 0.97]);
        let ink = self.along_locks(&self.hair_ink(&darkness, hair, levels), hair, lightness_of(levels[1]), &field);
        let ink = ink.zip_map(least, |ink, least| (share * ink).max(least));
        self.show("hair-ink", &ink.map(|ink| 1.0 - ink));
        let (finer, thinner) = match strands {
            Strands::Fine(finer) => (finer, finer),
            Strands::Curled => (1.0, 1.0 - THIN_IN_LIGHT * f64::from(lightness_of(levels[1]))),
        };
        let sizes = Hairs {
            pitch: finer * self.parameters.pitch,
            width: thinner * HAIR_WIDTH * self.parameters.stroke_width,
            length: (1.0 - SHORTER_IF_CROPPED * self.cropped(&self.hair_of_heads(hair))) * self.parameters.hair_length,
            turn: self.parameters.hair_turn,
            combed: if matches!(strands, Strands::Fine(_)) { COMBED } else { 1.0 },
            in_beards: if matches!(strands, Strands::Fine(_)) {
                1.0
            } else {
                1.0 - THIN_IN_LIGHT * self.lightness_of_beards(&darkness)
            },
        };
        let coils = match strands {
            Strands::Fine(_) => self.coiled_hair(&self.hair_of_heads(hair)),
            Strands::Curled => self.coils(hair, &raw, &smoothed),
        };
        // Light hair shows by the shade of its locks, which hooks would crumble.
        let dark = 1.0 - lightness_of(levels[1]);
        self.curled(&field, &coils.map(|coil| dark * coil), hair, &ink, sizes)
    }

    /// The least ink of light hair, at the silhouette: without it hair would be open to the paper, and a line is a wire. None where no lines are
    /// wanted, as of all pens but one.
    pub(super) fn rim_of_light_hair(&self, regions: &Regions) -> Raster<f32> {
        /// Ink at the silhouette: with 0.4 it is a row of stitches around white hair (portraits 12, 13, 15). How far it reaches inside, as a blur in pitches: with 1.5
        /// its strokes are ticks.
        const RIM: f32 = 0.25;
        const REACH: f64 = 3.0;
        /// Ink below which hair is light, that from which it is not, and the blur of it in pitches.
        const LIGHT: (f32, f32) = (0.16, 0.3);
        const BLUR: f64 = 3.0;
        if self.portrait.masks.get(&MaskRole::Edges).is_some_and(|lines| lines.pixels().iter().all(|v| *v == 0.0)) {
            return regions.hair.map(|_| 0.0);
        }
        let sigma = self.pixels(BLUR * self.parameters.pitch) as f32;
        let hair = fast_gaussian(&regions.hair, sigma);
        let ink = fast_gaussian(&self.darkness().zip_map(&regions.hair, |ink, hair| ink * hair), sigma);
        let is_light = ink.zip_map(&hair, |ink, hair| ((LIGHT.1 - ink / hair.max(1e-3)) / (LIGHT.1 - LIGHT.0)).clamp(0.0, 1.0));
        let rim = rim(&regions.subject, REACH * self.pitch(), RIM);
        self.portrait.opened(rim.zip_map(&is_light, |rim, is_light| rim * is_light))
    }

    /// Strokes along a field inside a region whose ink is as given.
    pub(super) fn hairs(&self, field: &OrientationField, region: &Raster<f32>, ink: &Raster<f32>, hairs: Hairs) -> Vec<Mark> {
        let covering = Covering {
            width: self.pixels(hairs.width) * 0.75,
            length: self.pixels(hairs.length),
            length_spread: 0.6,
            turn: hairs.turn.0,
            reach: self.pixels(0.9 * hairs.pitch),
        };
        let soft = gaussian_blur(ink, self.pixels(0.5 * hairs.pitch) as f32);
        let touch = Touch { width: hairs.width, pressure: 1.0, taper: 0.35, node: 2.0 * hairs.pitch };
        let beard = self.portrait.masks.get(&MaskRole::FacialHair);
        let is_beard = |p: Point| beard.is_some_and(|beard| beard.sample(p.x, p.y) > 0.5);
        let looseness = |p: Point| if is_beard(p) { 1.0 } else { hairs.combed };
        cover(field, region, ink, covering, looseness, &mut stream(self.seed, "hair", 0))
            .iter()
            .filter_map(|line| {
                let line = smooth_polyline(line, Ring::Open, self.pixels(hairs.pitch), 1.5);
                let thin = |p: Point| if is_beard(p) { hairs.in_beards } else { 1.0 };
                self.stroke(&line, touch, |p| thin(p) * (0.25 + 0.75 * f64::from(soft.sample(p.x, p.y)).min(1.0)))
            })
            .collect()
    }

    /// Section 3.1.2: blur, lines, Hough filter, smoothing.
    fn hair_orientation(&self, hair: &Raster<f32>, strands: Strands) -> Orientation {
        let blurred = gaussian_blur(&self.portrait.lightness, LINE_BLUR);
        let region = hair.map(|v| u8::from(v >= 0.5));
        let all = ridges(&blurred, 0.0);
        let least = Self::line_strength(&blurred, &region);
        let lines = ridges(&blurred, least).zip_map(&region, |line, inside| line & inside);
        let lines = if lines.pixels().iter().any(|v| *v != 0) { lines } else { all };
        self.observer.picture("hair-lines", &|| Picture::Mask(lines.clone()));
        let radius = (self.pixels(self.parameters.hough_radius).round() as usize).max(2);
        let raw = HoughFilter::new(self.parameters.hough, radius, ANGLES).half_orientations(&lines, &region);
        let raw = if self.parameters.hough == HoughForm::Thesis { raw.squared() } else { raw };
        let smoothed = raw.smoothed(self.smoothing());
        let beard = self.portrait.masks.get(&MaskRole::FacialHair);
        let found = match (strands, beard) {
            (Strands::Curled, None) => smoothed.clone(),
            (Strands::Curled, Some(beard)) => {
                let calm = self.calm(&raw, &smoothed, &self.coherence(hair, &raw, &smoothed).agreement);
                let of_beard = calm.doubled().zip_map(beard, |way, beard| (beard > 0.5).then_some(way));
                OrientationField::new(smoothed.doubled().zip_map(&of_beard, |way, of_beard| of_beard.unwrap_or(way)))
            }
            (Strands::Fine(_), _) => {
                let agreement = self.coherence(hair, &raw, &smoothed).agreement;
                self.observer.picture("hair-coherence", &|| Picture::Grey(agreement.zip_map(hair, |agree, hair| agree * hair)));
                self.calm(&raw, &smoothed, &agreement)
            }
        };
        let field = match self.drawn_directions() {
            Some(drawn) => OrientationField::new(drawn.over_doubled(found.doubled())),
            None => found,
        };
        self.observer.picture("hair-orientation", &|| {
            Picture::Grey(field.doubled().map(|[x, y]| (0.5 * y.angle_over(x) / std::f32::consts::PI + 0.5).clamp(0.0, 1.0)))
        });
        Orientation { raw, smoothed, field }
    }

    /// The curvature at `LINE_QUANTILE` of the hair's pixels.
    fn line_strength(blurred: &Raster<f32>, region: &Raster<u8>) -> f32 {
        let fine = gaussian_blur(blurred, 1.6 * LINE_BLUR);
        let contrast = blurred.zip_map(&fine, |a, b| (a - b).abs());
        let mut strengths: Vec<f32> =
            contrast.pixels().iter().zip(region.pixels()).filter(|(_, r)| **r != 0).map(|(c, _)| *c).collect();
        strengths.sort_unstable_by(f32::total_cmp);
        let at = (LINE_QUANTILE * strengths.len() as f64) as usize;
        // The difference of two Gaussians is about 0.8 sigma^2 times the curvature.
        strengths.get(at).map_or(0.0, |c| c / (0.8 * LINE_BLUR * LINE_BLUR))
    }

    /// Ink of the strokes: the photograph's, with the hair's contrast increased so that strands show between its lightest, median and
    /// darkest level; light hair gets few strokes, along its shaded locks.
    fn hair_ink(&self, darkness: &Raster<f32>, hair: &Raster<f32>, [light, middle, dark]: [f32; 3]) -> Raster<f32> {
        let spread = (dark - light).max(0.08);
        let level = self.parameters.hair_ink * middle;
        let plain = darkness.map(|d| (level * (0.35 + 1.3 * ((d - light) / spread).clamp(0.0, 1.0))).clamp(0.0, 1.2));
        let is_light = lightness_of(middle);
        if is_light == 0.0 {
            return plain;
        }
        let locks = self.locks(hair).map(|lock| self.parameters.hair_ink * LOCK_INK * lock);
        plain.zip_map(&locks, |plain, lock| plain.max(is_light * lock))
    }

    /// How far beards count as light, 0 to 1.
    fn lightness_of_beards(&self, darkness: &Raster<f32>) -> f64 {
        let beard = self.portrait.masks.get(&MaskRole::FacialHair).filter(|beard| beard.pixels().iter().any(|v| *v >= 0.5));
        beard.map_or(0.0, |beard| f64::from(lightness_of(levels_inside(darkness, beard, [0.03, 0.5, 0.97])[1])))
    }

    /// The ink of light hair smooth along its locks, so that its few strokes are long: short ones are crumbs.
    fn along_locks(&self, ink: &Raster<f32>, hair: &Raster<f32>, is_light: f32, field: &OrientationField) -> Raster<f32> {
        if is_light == 0.0 {
            return ink.clone();
        }
        let step = ALONG * self.pixels(self.parameters.hair_length) / f64::from(ALONG_STEPS);
        Raster::from_fn(ink.width(), ink.height(), |x, y| {
            let here = ink.get(x, y);
            if hair.get(x, y) < 0.5 {
                return here;
            }
            let start = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let mean = [-1.0, 1.0].map(|side| mean_along(ink, hair, field, start, side * step)).iter().sum::<f32>() / 2.0;
            here + is_light * (mean - here)
        })
    }

    /// The shaded sides of locks, 0 to 1: places darker than the hair around them.
    fn locks(&self, hair: &Raster<f32>) -> Raster<f32> {
        let fine = gaussian_blur(&self.portrait.lightness, LINE_BLUR);
        let around = self.pixels(LOCK) as f32;
        let sum = gaussian_blur(&fine.zip_map(hair, |v, hair| v * hair), around);
        let mean = sum.zip_map(&gaussian_blur(hair, around), |sum, hair| sum / hair.max(1e-3));
        let shade = mean.zip_map(&fine, |mean, v| mean - v);
        let [_, middle, dark] = levels_inside(&shade, hair, [0.03, 0.5, 0.95]);
        shade.map(|shade| ((shade - middle) / (dark - middle).max(0.01)).clamp(0.0, 1.0))
    }
}

/// Mean ink from a place along the field, as far as the hair goes.
fn mean_along(ink: &Raster<f32>, hair: &Raster<f32>, field: &OrientationField, start: Point, step: f64) -> f32 {
    let (mut here, mut heading) = (start, Vec2::ZERO);
    let (mut sum, mut count) = (ink.sample(here.x, here.y), 1.0);
    for _ in 0..ALONG_STEPS {
        let Some(angle) = field.angle(here.x, here.y) else { break };
        let axis = unit_at(angle);
        let is_back = if heading == Vec2::ZERO { step < 0.0 } else { axis.dot(heading) < 0.0 };
        heading = if is_back { -axis } else { axis };
        here += heading * step.abs();
        if hair.sample(here.x, here.y) < 0.5 {
            break;
        }
        sum += ink.sample(here.x, here.y);
        count += 1.0;
    }
    sum / count
}

/// How far hair of this median darkness counts as light, 0 to 1.
fn lightness_of(middle: f32) -> f32 {
    ((LIGHT_HAIR.1 - middle) / (LIGHT_HAIR.1 - LIGHT_HAIR.0)).clamp(0.0, 1.0)
}

/// Quantiles of the values inside the hair.
fn levels_inside(values: &Raster<f32>, hair: &Raster<f32>, shares: [f64; 3]) -> [f32; 3] {
    let mut inside: Vec<f32> = values.pixels().iter().zip(hair.pixels()).filter(|(_, h)| **h >= 0.5).map(|(v, _)| *v).collect();
    inside.sort_unstable_by(f32::total_cmp);
    shares.map(|share| inside[((inside.len() - 1) as f64 * share) as usize])
}
