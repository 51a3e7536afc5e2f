//! Bags and folds under eyes are shade that dots draw: as lines they are wires and scars. In a grid they stay as thin lines, as
//! its coarser cells do not show them: without them the face finder's noses lie 3.1 % of the distance of the eyes off in the median of sixteen
//! drawings, with them 2.5 %.

use crate::field::CoherentLine;
use crate::geometry::{Region, convex_hull};
use crate::source::{Landmarks, Portrait};

/// Points of the mesh around the place between the lower lid and the middle of the cheek, beside the person's right eye and left eye.
const PLACES: [[usize; 11]; 2] =
    [[33, 145, 133, 128, 121, 100, 101, 50, 123, 117, 111], [263, 374, 362, 357, 350, 329, 330, 280, 352, 346, 340]];
/// Contrast below which a line there is a fold. On thirteen portraits folds have 0.07 to 0.17; rims of spectacles that were not found have 0.186 and
/// more, but for two bits of them.
const FOLD: f64 = 0.18;

/// Points of the mesh around the outer corner of the person's right eye and left eye, where crow's feet are.
const CORNERS: [[usize; 7]; 2] = [[33, 226, 35, 143, 34, 116, 111], [263, 446, 265, 372, 264, 345, 340]];
/// Width of folds as they are drawn in a grid, in shares of their own: as wide as lids they are scars.
const THIN: f64 = 0.5;

/// The lines with thinner folds under eyes and beside them.
pub(super) fn with_thin_folds(portrait: &Portrait, lines: Vec<CoherentLine>) -> Vec<CoherentLine> {
    let place = |face: &Landmarks, i: usize| convex_hull([face.line(&PLACES[i]), face.line(&CORNERS[i])].concat());
    let beside = Region::of_polygons(portrait.faces.iter().flat_map(|face| [0, 1].map(|i| place(face, i))).collect());
    let is_fold = |line: &CoherentLine| {
        let inside = line.curve.points.iter().filter(|p| beside.contains(**p)).count();
        line.contrast < FOLD && 2 * inside > line.curve.points.len()
    };
    let thin = |line: CoherentLine| {
        let widths = if is_fold(&line) { line.widths.iter().map(|width| THIN * width).collect() } else { line.widths };
        CoherentLine { widths, ..line }
    };
    lines.into_iter().map(thin).collect()
}

/// The lines without folds under eyes; what is left of one is at least so long.
pub(super) fn without_folds_under_eyes(portrait: &Portrait, lines: Vec<CoherentLine>, least: f64) -> Vec<CoherentLine> {
    let hulls = portrait.faces.iter().flat_map(|face| PLACES.map(|place| convex_hull(face.line(&place))));
    let under = Region::of_polygons(hulls.collect());
    let is_fold = |line: &CoherentLine| line.contrast < FOLD && line.curve.points.iter().any(|p| under.contains(*p));
    let (folds, mut kept): (Vec<CoherentLine>, Vec<CoherentLine>) = lines.into_iter().partition(is_fold);
    kept.extend(folds.iter().flat_map(|line| line.parts_where(|p| !under.contains(*p), least)));
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Curve;
    use crate::geometry::Point;
    use crate::style::form::mean_portrait;

    #[test]
    fn a_faint_line_under_an_eye_goes_and_a_rim_or_one_beside_it_stays() {
        let portrait = mean_portrait(6.0, 0.0, |_| 100);
        let place = |i: usize| portrait.faces[0].point(i);
        let (from, to) = (place(111), place(121));
        let line = |from: Point, to: Point, contrast: f64| {
            let points = (0..=20).map(|i| from.lerp(to, f64::from(i) / 20.0)).collect();
            CoherentLine { contrast, ..CoherentLine::plain(Curve { points, closed: false }, 1.0) }
        };
        let left = |line: CoherentLine| {
            without_folds_under_eyes(&portrait, vec![line], 1.0).iter().map(|line| line.curve.length()).sum::<f64>()
        };
        let whole = from.distance(to);
        assert!(left(line(from, to, 0.1)) < 0.2 * whole);
        assert!((left(line(from, to, 0.3)) - whole).abs() < 1e-6, "a rim");
        let mouth = line(place(61), place(291), 0.1);
        let length = mouth.curve.length();
        assert!((left(mouth) - length).abs() < 1e-6);
    }
}
