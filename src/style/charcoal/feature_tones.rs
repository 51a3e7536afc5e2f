//! Eyes, nose and mouth: removed from the smudge (section 3.1.5), their tones separated by scale-space filtering (section 6.1.1), and
//! each drawn finely, as dark against its skin as in the photograph.

use super::Drawer;
use super::patch::{LEAST_WIDTHS, Patch, Pressing};
use crate::drawing::Mark;
use crate::elementary::Elementary as _;
use crate::field::{FaceFrame, FacialFeature, FacialFeatures, FeatureWindow, histogram_modes};
use crate::geometry::{Millimetres, Point};
use crate::raster::{Raster, gaussian_blur};
use std::f64::consts::PI;

/// Depth inside its oval (1 in its middle) at which a feature starts to be drawn and at which it is drawn fully. White of the eye is
/// accepted in the same range: farther out, places lighter than skin are shining skin.
const DRAWN: (f32, f32) = (0.0, 0.25);
const WHITES: (f32, f32) = (0.3, 0.45);
/// Range of the tone at which a feature ends and its skin begins, found from the feature's tones; and the softness of that end.
const LIMITS: (f32, f32) = (0.75, 0.92);
const GRADUAL: f32 = 0.08;
/// Tone relative to the surroundings (blurred by `AROUND` eye distances) at which a place starts to be drawn, and at which it is drawn
/// fully. Soft shadows stay in the smudge: hatched, they stand out as separate patches.
const AROUND: f64 = 0.1;
const SHARP: (f32, f32) = (0.97, 0.82);
/// The same for a mouth, whose lips are paler than an eye's lids.
const SOFT: (f32, f32) = (1.0, 0.88);
/// Bins of the histogram of tones, and the tone relative to skin's at its end.
const BINS: usize = 256;
const LIGHTEST_TONE: f32 = 1.25;

/// Where a feature is drawn.
struct Oval {
    half: (f64, f64),
    has_white: bool,
    sharp: (f32, f32),
}

/// Drawn tones of the eyes, the nose and the mouth.
pub(super) struct FeatureTones {
    /// Share of each pixel that is drawn here instead of by the smudge, 0 to 1.
    pub share: Raster<f32>,
    /// Their own ink, 0 to 1.
    pub ink: Raster<f32>,
    /// How much darker each pixel of the face is than its surroundings, 0 to 1: hair and lids are, soft shadows are not.
    pub sharp: Raster<f32>,
}

impl Drawer<'_> {
    pub(super) fn feature_tones(&self, found: &FacialFeatures, frame: &FaceFrame) -> FeatureTones {
        /// Tone relative to skin's at which a place starts to count as white of the eye, and at which it counts fully.
        const LIGHT: (f32, f32) = (1.05, 1.25);
        /// Blur of the drawn ink, in eye distances: a third of a lid's thickness.
        const BLUR: f64 = 0.006;
        let sharp = gaussian_blur(&self.portrait.lightness, (BLUR * frame.eye_distance) as f32);
        let tone = Raster::from_fn(sharp.width(), sharp.height(), |x, y| sharp.get(x, y) / found.skin[x].max(0.02));
        let around = gaussian_blur(&tone, (AROUND * frame.eye_distance) as f32);
        let sharp = tone.zip_map(&around, |n, around| ramp(n / around.max(0.02), SHARP));
        let mut tones = FeatureTones { share: tone.map(|_| 0.0), ink: tone.map(|_| 0.0), sharp };
        let inside = |(feature, window): (FacialFeature, FeatureWindow)| {
            let oval = oval_of(feature)?;
            found.found.contains(&feature).then(|| oval.within(frame, window, tone.width(), tone.height()))
        };
        let ovals: Vec<Option<Raster<f32>>> = FacialFeature::ALL.into_iter().zip(frame.windows).map(inside).collect();
        let (darkest, target) = (darkest(&tone, &ovals), self.darkness());
        for (feature, inside) in FacialFeature::ALL.into_iter().zip(&ovals) {
            let (Some(inside), Some(oval)) = (inside, oval_of(feature)) else { continue };
            let limit = limit(&tone, inside);
            // A nose's underside is often in shadow: it gets the ink of its tone, not more. Lips and lids are drawn firmer than they are.
            let room = |i: usize| if feature == FacialFeature::Nose { target.pixels()[i] } else { 1.0 };
            for i in (0..tone.len()).filter(|i| inside.pixels()[*i] > 0.0) {
                let (n, inside) = (tone.pixels()[i], inside.pixels()[i]);
                let sharp = ramp(n / around.pixels()[i].max(0.02), oval.sharp);
                let dark = ramp(inside, DRAWN) * sharp * ramp(n, (limit + GRADUAL, limit - GRADUAL));
                let light = if oval.has_white { ramp(inside, WHITES) * ramp(n, LIGHT) } else { 0.0 };
                let depth = ((1.0 - n) / (1.0 - darkest)).clamp(0.0, 1.0);
                // The ink of the skin, plus a share of the remaining white that grows with the darkness of the place.
                let skin = self.washed(1.0 - found.skin[i % tone.width()].min(1.0));
                let (share, ink) = (&mut tones.share.pixels_mut()[i], &mut tones.ink.pixels_mut()[i]);
                *share = share.max(dark).max(light);
                *ink = ink.max((dark * (skin + (1.0 - skin) * depth)).min(room(i)));
            }
        }
        tones
    }

    /// Strokes with widths that make the ink, crossed where it is black.
    pub(super) fn draw_tones(&self, tones: &FeatureTones, frame: &FaceFrame) -> Vec<Mark> {
        /// Direction of the strokes, and of the cross strokes in the darkest places, in degrees.
        const ORIENT: f64 = -35.0;
        const CROSSING: f64 = -12.0;
        /// Ink below which nothing is drawn: a stroke at its lightest has twice as much.
        const FAINTEST: f32 = 0.2;
        /// Ink from which strokes are crossed: strokes of one direction leave slits.
        const CROSSED: f32 = 0.8;
        /// Distance of strokes in widths, and their length in eye distances.
        const SPACING: f64 = 0.9;
        const LENGTH: f64 = 0.7;
        let ink = &tones.ink;
        let width = self.feature_width(frame);
        let patch = |least: f32, degrees: f64| Patch {
            // One half where the ink is `least`.
            region: ink.map(|ink| (0.5 + 4.0 * (ink - least)).clamp(0.0, 1.0)),
            width,
            spacing: SPACING * width,
            length: LENGTH * self.portrait.placement.mm(frame.eye_distance),
            orientation: degrees * PI / 180.0 + frame.tilt,
            pressure: 1.0,
            inset: Millimetres(0.0),
            pressing: Pressing::Filling,
            least: LEAST_WIDTHS * width,
        };
        let press = |p: Point| super::strokes::pressure_for(SPACING * f64::from(ink.sample(p.x, p.y)));
        let mut marks = self.shade_patch(&patch(FAINTEST, ORIENT), "features", 0, press);
        marks.extend(self.shade_patch(&patch(CROSSED, CROSSING), "features", 1, |_| 1.0));
        marks
    }

    /// Width of a stroke in a face: an artist uses the stick's edge, so that an eye's lids and pupil keep their shapes.
    pub(super) fn feature_width(&self, frame: &FaceFrame) -> Millimetres {
        /// Width of a stroke in eye distances: a fifteenth of an eye's opening.
        const WIDTH: f64 = 0.01;
        let eyes = self.portrait.placement.mm(frame.eye_distance);
        self.parameters.stroke_width.min(WIDTH * eyes).max(0.2 * self.parameters.stroke_width)
    }
}

impl Oval {
    /// How far inside the oval each place lies: 1 in its middle, 0 on its border, less outside.
    fn within(&self, frame: &FaceFrame, window: FeatureWindow, width: usize, height: usize) -> Raster<f32> {
        let [middle, lies_down, half_across, half_down] = window;
        Raster::from_fn(width, height, |x, y| {
            let (across, down) = frame.relative(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            (1.0 - ((across - middle) / (half_across * self.half.0)).hypotenuse((down - lies_down) / (half_down * self.half.1)))
                as f32
        })
    }
}

/// Ovals of an eye with its lids, a nose's underside and a mouth: half sizes across and down as shares of their windows' half sizes;
/// beyond is skin. Smaller loses the outer lashes of an eye found slightly off its place, larger takes in the brow.
const EYE: Oval = Oval { half: (1.0, 0.2 / 0.17), has_white: true, sharp: SHARP };
const NOSE: Oval = Oval { half: (0.4 / 0.36, 1.3), has_white: false, sharp: SHARP };
const MOUTH: Oval = Oval { half: (0.56 / 0.52, 0.3 / 0.22), has_white: false, sharp: SOFT };

/// The oval of a feature, if it is drawn by its tones.
const fn oval_of(feature: FacialFeature) -> Option<Oval> {
    match feature {
        FacialFeature::LeftEye | FacialFeature::RightEye => Some(EYE),
        FacialFeature::Nose => Some(NOSE),
        FacialFeature::Mouth => Some(MOUTH),
        FacialFeature::LeftEyebrow | FacialFeature::RightEyebrow => None,
    }
}

/// Linear from 0 at the first limit to 1 at the second.
fn ramp(value: f32, (none, all): (f32, f32)) -> f32 {
    ((value - none) / (all - none)).clamp(0.0, 1.0)
}

fn bin(tone: f32) -> usize {
    ((tone / LIGHTEST_TONE * BINS as f32) as usize).min(BINS - 1)
}

/// Minimum share of a feature's pixels for a tone to count as a separate tone (section 6.1.1).
const LEAST_SHARE: f64 = 0.02;

/// The tone that separates skin from the darker parts of a feature, from the modes of its histogram (section 6.1.1).
fn limit(tone: &Raster<f32>, inside: &Raster<f32>) -> f32 {
    let mut histogram = vec![0_u32; BINS];
    tone.pixels().iter().zip(inside.pixels()).filter(|(_, inside)| **inside > DRAWN.1).for_each(|(n, _)| histogram[bin(*n)] += 1);
    let total: u32 = histogram.iter().sum();
    let modes = histogram_modes(&histogram, (LEAST_SHARE * f64::from(total)) as u32);
    let tones = modes.iter().map(|mode| (mode.at as f32 + 0.5) / BINS as f32 * LIGHTEST_TONE);
    let darker = tones.filter(|tone| *tone < 1.0 - 2.0 * GRADUAL).fold(0.0, f32::max);
    f32::midpoint(1.0, darker).clamp(LIMITS.0, LIMITS.1)
}

/// Maximum tone, relative to skin's, that is taken as a face's darkest: pale features stay pale.
const DARKEST: f32 = 0.5;
/// Share of the features' pixels that are at least as dark as their darkest tone.
const DARKEST_SHARE: f64 = 0.01;

/// Tone of the features' darkest places, relative to skin's.
fn darkest(tone: &Raster<f32>, ovals: &[Option<Raster<f32>>]) -> f32 {
    let of = |inside: &Raster<f32>| -> Vec<f32> {
        tone.pixels().iter().zip(inside.pixels()).filter(|(_, inside)| **inside > DRAWN.1).map(|(n, _)| *n).collect()
    };
    let mut tones: Vec<f32> = ovals.iter().flatten().flat_map(of).collect();
    tones.sort_unstable_by(f32::total_cmp);
    tones.get((DARKEST_SHARE * tones.len() as f64) as usize).map_or(DARKEST, |tone| tone.min(DARKEST))
}
