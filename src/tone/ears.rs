//! Ears: their folds are flat in a tone made for the face, and at the size of a dot they are lost; they are raised.

use super::zones::{Zones, polygon};
use crate::elementary::Elementary as _;
use crate::geometry::convex_hull;
use crate::raster::{Raster, dilate, fast_gaussian};
use crate::source::{Landmarks, outlines};

/// Where ears are: skin beside the face's oval, at these heights above the chin in heights of the face (heads that are raised or lowered
/// included), with a border so soft.
const HEIGHTS: [f64; 2] = [0.15, 0.85];
const SOFT: f64 = 0.08;
/// Distances from the oval in widths of the face: its border is a cheek's shade, and farther away are hands and other people.
const BESIDE: f64 = 0.02;
const FARTHEST: f64 = 0.32;
/// Eyes, nose and mouth stand out beside the oval of a turned face, with a border so wide, in widths of the face: they are no ears.
const ROUND_FRONT: f64 = 0.08;
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
    face: &Landmarks,
    above_chin: impl Fn(usize, usize) -> f64 + Sync,
) -> Raster<f32> {
    let pixels = |share: f64| (share * zones.width) as f32;
    let within = |reach: f64| dilate(&zones.oval, pixels(reach).round().max(1.0) as usize);
    let beside = within(FARTHEST).zip_map(&within(BESIDE), |near, face| near * (1 - face));
    let front =
        polygon(tone.width(), tone.height(), &convex_hull(outlines::FRONT.iter().flat_map(|line| face.line(line)).collect()));
    let front = dilate(&front, pixels(ROUND_FRONT).round().max(1.0) as usize);
    let beside = beside.zip_map(&front, |beside, front| f32::from(beside * (1 - front)));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;
    use crate::geometry::Point;
    use crate::source::{Iris, POINTS};
    use std::f64::consts::TAU;

    #[test]
    fn folds_beside_the_oval_are_raised_and_the_mouth_of_a_turned_face_is_left() {
        let middle = Point::new(120.0, 80.0);
        let mut points = vec![[middle.x, middle.y, 0.0]; POINTS];
        let round = |points: &mut Vec<[f64; 3]>, line: &[usize], centre: Point, radius: f64| {
            for (i, index) in line.iter().enumerate() {
                let p = centre + radius * unit_at(TAU * i as f64 / line.len() as f64);
                points[*index] = [p.x, p.y, 0.0];
            }
        };
        round(&mut points, &outlines::OVAL, middle, 50.0);
        let (ear, mouth) = (Point::new(60.0, 80.0), Point::new(180.0, 80.0));
        outlines::FRONT.iter().for_each(|line| round(&mut points, line, mouth, 8.0));
        let face = Landmarks { points, irises: [Iris { centre: middle, radius: 1.0 }; 2], spectacles: None, pearls: Vec::new() };
        let is_fold = |p: Point, x: usize, y: usize| p.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5)) < 2.0;
        let tone = Raster::from_fn(260, 160, |x, y| if is_fold(ear, x, y) || is_fold(mouth, x, y) { 0.4 } else { 0.6 });
        let zones = Zones::new(&face, &tone).expect("skin");
        let after = with_ears(&zones, &tone, &tone.map(|_| 1.0), &face, |_, _| 0.5);
        let at = |p: Point| after.get(p.x as usize, p.y as usize);
        assert!(at(ear) < 0.35, "{}", at(ear));
        assert!((at(mouth) - 0.4).abs() < 1e-3, "{}", at(mouth));
    }
}
