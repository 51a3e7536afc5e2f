//! Bags and folds under eyes are shade that dots draw: as lines they are wires and scars. In a grid they stay as thin lines, as
//! its coarser cells do not show them: without them the face finder's noses lie 3.1 % of the distance of the eyes off in the median of sixteen
//! drawings, with them 2.5 %.

use crate::field::CoherentLine;
use crate::geometry::{Point, Region, convex_hull};
use crate::source::{Landmarks, Portrait, outlines};

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

/// The lines without those within lenses of spectacles that are not lids: folds and reflections, which in a grid hide the eyes (05). What is left
/// of one is at least so long.
pub(super) fn without_lines_in_lenses(portrait: &Portrait, lines: &[CoherentLine], least: f64) -> Vec<CoherentLine> {
    let rims = portrait.faces.iter().filter_map(|face| face.spectacles.as_ref()).flat_map(|frame| frame.rims.iter());
    let lenses = Region::of_polygons(rims.map(|rim| convex_hull(rim.clone())).collect());
    let is_kept = |p: &Point| !lenses.contains(*p) || is_near_lids(portrait, *p);
    let kept = |line: &CoherentLine| {
        let is_whole = line.curve.points.iter().all(is_kept);
        if is_whole { vec![line.clone()] } else { line.parts_where(is_kept, least) }
    };
    lines.iter().flat_map(kept).collect()
}

/// True within the lids of an eye, or as near them as lashes are.
fn is_near_lids(portrait: &Portrait, p: Point) -> bool {
    /// In widths of the face.
    const NEAR: f64 = 0.025;
    portrait.faces.iter().any(|face| {
        [&outlines::LEFT_EYE, &outlines::RIGHT_EYE].iter().any(|eye| {
            let outline = face.line(*eye);
            let near = outline.iter().any(|q| q.distance(p) < NEAR * face.width());
            near || Region::of_polygons(vec![outline]).contains(p)
        })
    })
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
    use crate::elementary::unit_at;
    use crate::field::Curve;
    use crate::source::Spectacles;
    use crate::style::form::mean_portrait;

    #[test]
    fn within_a_lens_lids_stay_and_folds_go() {
        let mut portrait = mean_portrait(6.0, 0.0, |_| 100);
        let place = |i: usize| portrait.faces[0].point(i);
        let (corner, inner, cheek, brow) = (place(263), place(362), place(330), place(334));
        let middle = corner.midpoint(inner);
        let radius = 1.2 * corner.distance(middle);
        let rim = (0..24).map(|i| middle + radius * unit_at(std::f64::consts::TAU * f64::from(i) / 24.0)).collect();
        let frame = Spectacles { rims: [rim, Vec::new()], bridge: Vec::new(), temples: [Vec::new(), Vec::new()], width: 2.0 };
        let line = |from: Point, to: Point| {
            let points = (0..=20).map(|i| from.lerp(to, f64::from(i) / 20.0)).collect();
            CoherentLine::plain(Curve { points, closed: false }, 1.0)
        };
        let bag = line(middle.lerp(cheek, 0.55), corner.lerp(cheek, 0.55));
        let all = [line(corner, inner), bag, line(cheek, cheek + (cheek - brow))];
        assert_eq!(without_lines_in_lenses(&portrait, &all, 1.0).len(), 3, "no spectacles");
        portrait.faces[0].spectacles = Some(frame);
        let left = without_lines_in_lenses(&portrait, &all, 1.0);
        let length = |line: &CoherentLine| line.curve.length();
        assert_eq!(left.len(), 2, "the lid, and the line on the cheek");
        assert!((length(&left[0]) - length(&all[0])).abs() < 1e-6 && (length(&left[1]) - length(&all[2])).abs() < 1e-6);
    }

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
