//! Step 4: the eyebrows, eyes, nose and mouth (sections 3.1.4, 5 and 6.3.4).

use super::Drawer;
use super::feature_tones::FeatureTones;
use super::patch::{LEAST_WIDTHS, Patch, Pressing};
use super::regions::Regions;
use crate::drawing::Mark;
use crate::field::{FaceFrame, FacialFeature, FacialFeatures, SkinTone, facial_features};
use crate::geometry::{Millimetres, Point};
use crate::raster::{Raster, gaussian_blur};
use crate::style::Picture;
use std::f64::consts::PI;

/// The faces' features, in working pixels.
pub(super) struct Features {
    found: Vec<SeenFeatures>,
    /// 1 where any feature is drawn.
    pub drawn: Raster<f32>,
    pub tones: FeatureTones,
}

/// One face's features.
struct SeenFeatures {
    features: FacialFeatures,
    frame: FaceFrame,
    tones: FeatureTones,
}

/// Direction of the strokes in the left eyebrow, in degrees; the right one's is opposed (6.3.4).
const EYEBROW_ORIENT: f64 = -58.0;
/// Eyebrows are shaded this much wider (6.3.4).
const EYEBROW_SPACING: f64 = 1.7;
/// Maximum tone, relative to skin's, that is taken as the darkest brow: pale features stay pale.
const DARKEST: f64 = 0.55;
/// Minimum share of the pressure in a feature, and the tone relative to skin's from which it is left to the smudge.
const FAINTEST: f64 = 0.08;

impl Drawer<'_> {
    pub(super) fn features(&self, regions: &Regions) -> Features {
        self.observer.begin("features");
        let nothing = || regions.face.map(|_| 0.0);
        // Where points are known, features stay in the smudge, which is sharp there.
        let frames = if self.parameters.has_features && self.portrait.faces.is_empty() { &regions.frames[..] } else { &[] };
        let found: Vec<SeenFeatures> = frames.iter().map(|frame| self.features_of(regions, frame)).collect();
        let all =
            |of: &dyn Fn(&SeenFeatures) -> Raster<f32>| found.iter().fold(nothing(), |all, one| all.zip_map(&of(one), f32::max));
        let tones = FeatureTones {
            share: all(&|one| one.tones.share.clone()),
            ink: all(&|one| one.tones.ink.clone()),
            sharp: all(&|one| one.tones.sharp.clone()),
        };
        let drawn = all(&|one| {
            one.features
                .labels
                .zip_map(&one.tones.share, |label, share| f32::from(u8::from(matches!(label, 1 | 2) || share >= 0.5)))
        });
        if !found.is_empty() {
            self.observer.picture("feature-tones", &|| Picture::Grey(tones.ink.map(|ink| 1.0 - ink)));
        }
        Features { found, drawn, tones }
    }

    fn features_of(&self, regions: &Regions, frame: &FaceFrame) -> SeenFeatures {
        let (width, height) = self.size();
        let skin: Vec<Point> =
            self.parameters.skin.shares().map(|(across, down)| Point::new(across * width as f64, down * height as f64)).collect();
        let tone = if skin.is_empty() { SkinTone::Found } else { SkinTone::Given(&skin) };
        let found = facial_features(&self.portrait.lightness, &regions.face, frame, tone);
        self.observer
            .picture("normalised", &|| Picture::Grey(found.normalised.zip_map(&regions.face, |n, f| 1.0 - f + f * n.min(1.0))));
        self.observer.picture("features", &|| Picture::Labels(found.labels.map(i32::from)));
        self.warn_of_missing(&found);
        let tones = self.feature_tones(&found, frame);
        SeenFeatures { features: found, frame: *frame, tones }
    }

    fn warn_of_missing(&self, found: &FacialFeatures) {
        let missing: Vec<&str> =
            FacialFeature::ALL.iter().filter(|feature| !found.found.contains(feature)).map(|feature| feature.name()).collect();
        if !missing.is_empty() {
            self.observer.warn(&format!("not found in the face: {}; the rest is drawn", missing.join(", ")));
        }
    }

    /// Eyebrows in one tone with mirrored strokes; the other features by their tones.
    pub(super) fn draw_features(&self, features: &Features) -> Vec<Mark> {
        (0_u64..).zip(&features.found).flat_map(|(face, one)| self.draw_face(face, one)).collect()
    }

    fn draw_face(&self, face: u64, SeenFeatures { features: found, frame, tones }: &SeenFeatures) -> Vec<Mark> {
        let darkest = darkest_brow(found);
        // Firmer in darker places.
        let press = |p: Point| ((1.0 - f64::from(found.normalised.sample(p.x, p.y))) / (1.0 - darkest)).clamp(FAINTEST, 1.0);
        let brows = [(FacialFeature::LeftEyebrow, EYEBROW_ORIENT), (FacialFeature::RightEyebrow, -180.0 - EYEBROW_ORIENT)];
        let mut marks = Vec::new();
        for (label, (_, degrees)) in (1_u8..).zip(brows).filter(|(_, (feature, _))| found.found.contains(feature)) {
            let inside = found.labels.zip_map(&tones.sharp, |l, sharp| u8::from(l == label && sharp > 0.0));
            let element = u64::from(label) + 2 * face;
            marks.extend(self.shade_patch(&self.eyebrow(&inside, degrees, frame), "eyebrows", element, press));
        }
        marks.extend(self.draw_tones(tones, frame));
        marks
    }

    fn eyebrow(&self, inside: &Raster<u8>, degrees: f64, frame: &FaceFrame) -> Patch {
        let width = self.feature_width(frame);
        Patch {
            region: gaussian_blur(&inside.map(f32::from), 1.0),
            width,
            spacing: EYEBROW_SPACING * width,
            length: 0.45 * self.portrait.placement.mm(frame.eye_distance),
            orientation: degrees * PI / 180.0 + frame.tilt,
            pressure: 0.8,
            inset: Millimetres(0.0),
            pressing: Pressing::Filling,
            least: LEAST_WIDTHS * width,
        }
    }
}

/// Tone relative to skin's below which a fiftieth of the features lies.
fn darkest_brow(found: &FacialFeatures) -> f64 {
    let mut tones: Vec<f32> =
        found.normalised.pixels().iter().zip(found.labels.pixels()).filter(|(_, label)| **label != 0).map(|(n, _)| *n).collect();
    tones.sort_unstable_by(f32::total_cmp);
    tones.get(tones.len() / 50).map_or(DARKEST, |tone| f64::from(*tone).min(DARKEST))
}
