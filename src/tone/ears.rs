//! Ears: their folds are flat in a tone made for the face, and at the size of a dot they are lost; they are raised.

use super::zones::Zones;
use crate::elementary::Elementary as _;
use crate::raster::{Raster, dilate, fast_gaussian};

/// Where ears are: skin beside the face's oval, at these heights above the chin in heights of the face (heads that are raised or lowered
/// included), with a border so soft.
const HEIGHTS: [f64; 2] = [0.15, 0.85];
const SOFT: f64 = 0.08;
/// Distances from the oval in widths of the face: its border is a cheek's shade, and farther away are hands and other people.
const BESIDE: f64 = 0.02;
const FARTHEST: f64 = 0.32;
/// The blurs that folds lie between, in widths of the face: narrower is grain, wider is the light on the whole ear.
const FINEST: f64 = 0.008;
const WIDEST: f64 = 0.05;
/// The gain of a small difference, and the most that a large one changes: hollows more than rims, whose paper would be holes.
const HOLLOW: [f32; 2] = [2.0, 0.30];
const RIM: [f32; 2] = [1.2, 0.10];

/// The tone with its ears raised. `skin` is the person without hair and clothing, `above_chin` the height of a pixel's middle.
pub(super) fn with_ears(
    zones: &Zones,
    tone: &Raster<f32>,
    skin: &Raster<f32>,
    above_chin: impl Fn(usize, usize) -> f64 + Sync,
) -> Raster<f32> {
    let pixels = |share: f64| (share * zones.width) as f32;
    let within = |reach: f64| dilate(&zones.oval, pixels(reach).round().max(1.0) as usize);
    let beside = within(FARTHEST).zip_map(&within(BESIDE), |near, face| f32::from(near * (1 - face)));
    let ears = Raster::from_fn(tone.width(), tone.height(), |x, y| {
        let height = above_chin(x, y);
        let level = ((height - HEIGHTS[0]) / SOFT).min((HEIGHTS[1] - height) / SOFT).clamp(0.0, 1.0) as f32;
        level * skin.get(x, y) * beside.get(x, y)
    });
    let weight = ears.map(|v| v + 1e-5);
    let light = zones.over_skin(tone, &weight, WIDEST);
    let folds = zones.over_skin(tone, &weight, FINEST).zip_map(&light, |fold, light| fold - light);
    let soft = fast_gaussian(&ears, pixels(FINEST));
    let raised = folds.map(|fold| {
        let [gain, most] = if fold < 0.0 { HOLLOW } else { RIM };
        most * (gain * fold / most).hyperbolic_tangent()
    });
    tone.zip_map(&raised.zip_map(&soft, |more, share| more * share), |tone, more| tone + more)
}
