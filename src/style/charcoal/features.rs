//! Step 4: the eyebrows, eyes, nose and mouth (sections 3.1.4, 5 and 6.3.4).

use super::Drawer;
use super::regions::Regions;
use super::shading::{Patch, Pressing};
use crate::drawing::Mark;
use crate::field::{FaceFrame, FacialFeature, FacialFeatures, SkinTone, facial_features, histogram_modes};
use crate::geometry::Point;
use crate::raster::{Raster, gaussian_blur, without_holes};
use crate::style::Picture;
use std::f64::consts::PI;

/// The face's features, in working pixels.
pub(super) struct Features {
    found: Option<(FacialFeatures, FaceFrame)>,
    /// 1 where any feature is drawn.
    pub drawn: Raster<f32>,
    /// 1 in the eyes, which the tone leaves out, so that their lights stay white (section 3.1.5).
    pub eyes: Raster<f32>,
}

/// Bins of the grey values' histogram.
const BINS: usize = 256;
/// A tone of a feature with fewer of its pixels than this share is no tone of its own (section 6.1.1).
const LEAST_SHARE: f64 = 0.06;
/// Direction of the strokes in eyes, nose and mouth, in degrees, and in the left eyebrow; the right one's is opposed (6.3.4).
const FEATURE_ORIENT: f64 = -35.0;
const EYEBROW_ORIENT: f64 = -58.0;
/// Tone against skin's above which a place in an eye is its white or its light.
const EYE_LIGHT: f32 = 0.9;
/// Eyebrows are shaded this much wider (6.3.4).
const EYEBROW_SPACING: f64 = 1.7;
/// Width of a stroke in distances of the eyes: a fifteenth of an eye's opening.
const FEATURE_WIDTH: f64 = 0.01;
/// Tone of the darkest lashes against skin's when a face has nothing darker: pale features stay pale.
const DARKEST: f64 = 0.55;
/// Depth, as a share of that of the darkest lashes, from which a feature's dark core is closed up, and how far its strokes are turned.
const ACCENT: f64 = 0.68;
const ACCENT_TURN: f64 = 0.4;
/// The least share of the pressure in a feature, and the tone against skin's from which it is left to the smudge.
const FAINTEST: f64 = 0.08;
const PALEST: f64 = 0.9;

impl Drawer<'_> {
    pub(super) fn features(&self, regions: &Regions) -> Features {
        self.observer.begin("features");
        let nothing = || regions.face.map(|_| 0.0);
        let none = || Features { found: None, drawn: nothing(), eyes: nothing() };
        let Some(frame) = regions.frame.filter(|_| self.parameters.has_features) else { return none() };
        let (width, height) = self.size();
        let skin: Vec<Point> =
            self.parameters.skin.shares().map(|(across, down)| Point::new(across * width as f64, down * height as f64)).collect();
        let tone = if skin.is_empty() { SkinTone::Found } else { SkinTone::Given(&skin) };
        let found = facial_features(&self.portrait.lightness, &regions.face, &frame, tone);
        self.observer
            .picture("normalised", &|| Picture::Grey(found.normalised.zip_map(&regions.face, |n, f| 1.0 - f + f * n.min(1.0))));
        self.observer.picture("features", &|| Picture::Labels(found.labels.map(i32::from)));
        self.warn_of_missing(&found);
        let of = |wanted: &[u8]| found.labels.map(|label| u8::from(wanted.contains(&label)));
        // Only the lights: round the lids of dark skin a white rim would look like goggles.
        let eyes =
            without_holes(&of(&[3, 4])).zip_map(&found.normalised, |eye, n| f32::from(u8::from(eye != 0 && n > EYE_LIGHT)));
        let drawn = of(&[1, 2, 3, 4, 5, 6]).map(f32::from);
        Features { eyes, drawn, found: Some((found, frame)) }
    }

    fn warn_of_missing(&self, found: &FacialFeatures) {
        let missing: Vec<&str> =
            FacialFeature::ALL.iter().filter(|feature| !found.found.contains(feature)).map(|feature| feature.name()).collect();
        if !missing.is_empty() {
            self.observer.warn(&format!("not found in the face: {}; the rest is drawn", missing.join(", ")));
        }
    }

    /// Each feature's tones by scale-space filtering, each shaded by hand; eyebrows in one tone.
    pub(super) fn draw_features(&self, features: &Features) -> Vec<Mark> {
        let Some((found, frame)) = &features.found else { return Vec::new() };
        let darkest = darkest_tone(found);
        let mut marks = Vec::new();
        for (i, feature) in FacialFeature::ALL.iter().enumerate().filter(|(_, feature)| found.found.contains(feature)) {
            let inside = found.labels.map(|label| u8::from(usize::from(label) == i + 1));
            let patches = match feature {
                FacialFeature::LeftEyebrow => vec![self.eyebrow(&inside, EYEBROW_ORIENT, frame)],
                FacialFeature::RightEyebrow => vec![self.eyebrow(&inside, -180.0 - EYEBROW_ORIENT, frame)],
                _ => {
                    let mut patches = self.tones_of(&inside, found, frame, darkest);
                    patches.push(self.accent(&inside, found, frame, darkest));
                    patches
                }
            };
            // Firmer where it is darker, so that lids, pupils and the parting of the lips keep their shapes.
            let press = |p: Point| ((1.0 - f64::from(found.normalised.sample(p.x, p.y))) / (1.0 - darkest)).clamp(FAINTEST, 1.0);
            for (level, patch) in patches.iter().enumerate() {
                marks.extend(self.shade_patch(patch, "features", (i * 16 + level) as u64, press));
            }
        }
        marks
    }

    /// The stroke's width in a face: a hand takes the stick's edge, so that an eye's lids and pupil keep their shapes.
    fn feature_width(&self, frame: &FaceFrame) -> f64 {
        let eye_mm = frame.eye_distance * self.portrait.placement.mm_per_pixel();
        self.parameters.stroke_width_mm.min(FEATURE_WIDTH * eye_mm).max(0.2 * self.parameters.stroke_width_mm)
    }

    fn eyebrow(&self, inside: &Raster<u8>, degrees: f64, frame: &FaceFrame) -> Patch {
        let width = self.feature_width(frame);
        Patch {
            region: gaussian_blur(&inside.map(f32::from), 1.0),
            width_mm: width,
            spacing_mm: EYEBROW_SPACING * width,
            length_mm: 0.45 * frame.eye_distance * self.portrait.placement.mm_per_pixel(),
            orientation: degrees * PI / 180.0 + frame.tilt,
            pressure: 0.8,
            inset_mm: 0.0,
            pressing: Pressing::Filling,
        }
    }

    /// Pupils, nostrils and the parting of the lips: closed up across the other strokes.
    fn accent(&self, inside: &Raster<u8>, found: &FacialFeatures, frame: &FaceFrame, darkest: f64) -> Patch {
        let limit = (1.0 - ACCENT * (1.0 - darkest)) as f32;
        let region = found.normalised.zip_map(inside, |n, i| f32::from(u8::from(i != 0 && n < limit)));
        let width = self.feature_width(frame);
        Patch {
            region: gaussian_blur(&region, 0.7),
            width_mm: width,
            spacing_mm: 0.7 * width,
            length_mm: 0.5 * frame.eye_distance * self.portrait.placement.mm_per_pixel(),
            orientation: FEATURE_ORIENT * PI / 180.0 + ACCENT_TURN + frame.tilt,
            pressure: 1.0,
            inset_mm: 0.0,
            pressing: Pressing::Filling,
        }
    }

    /// One patch for each tone darker than skin: what is at least as dark, closer and firmer the darker it is.
    fn tones_of(&self, inside: &Raster<u8>, found: &FacialFeatures, frame: &FaceFrame, darkest: f64) -> Vec<Patch> {
        let mut histogram = vec![0_u32; BINS];
        let bin = |n: f32| ((n * BINS as f32 / 1.25) as usize).min(BINS - 1);
        for (n, _) in found.normalised.pixels().iter().zip(inside.pixels()).filter(|(_, i)| **i != 0) {
            histogram[bin(*n)] += 1;
        }
        let total: u32 = histogram.iter().sum();
        let modes = histogram_modes(&histogram, (LEAST_SHARE * f64::from(total)) as u32);
        let tone = |at: f64| at * 1.25 / BINS as f64;
        let width = self.feature_width(frame);
        let size_mm = frame.eye_distance * self.portrait.placement.mm_per_pixel();
        let limits: Vec<f64> =
            modes.windows(2).map(|pair| 0.5 * (pair[0].at + pair[1].at)).chain([PALEST * BINS as f64 / 1.25]).collect();
        modes
            .iter()
            .zip(limits)
            .rev()
            .map(|(mode, limit)| {
                let region = found.normalised.zip_map(inside, |n, i| f32::from(u8::from(i != 0 && (bin(n) as f64) < limit)));
                // 1 for the darkest tone of the face's features, 0 for skin.
                let depth = ((1.0 - tone(mode.at)) / (1.0 - darkest)).clamp(0.1, 1.0);
                Patch {
                    region: gaussian_blur(&region, 0.7),
                    width_mm: width,
                    spacing_mm: width * (0.85 + 1.2 * (1.0 - depth)),
                    length_mm: 0.7 * size_mm,
                    orientation: FEATURE_ORIENT * PI / 180.0 + frame.tilt,
                    pressure: 1.0,
                    inset_mm: 0.0,
                    pressing: Pressing::Filling,
                }
            })
            .collect()
    }
}

/// The tone, against skin's, that a fiftieth of the features stays below.
fn darkest_tone(found: &FacialFeatures) -> f64 {
    let mut tones: Vec<f32> =
        found.normalised.pixels().iter().zip(found.labels.pixels()).filter(|(_, label)| **label != 0).map(|(n, _)| *n).collect();
    tones.sort_by(f32::total_cmp);
    tones.get(tones.len() / 50).map_or(DARKEST, |tone| f64::from(*tone).min(DARKEST))
}
