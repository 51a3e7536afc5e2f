//! Four marks that may be the corners of a sheet.

use super::blobs::Blob;
use super::marks::Mark;
use super::view::View;
use crate::colour::sheet::grid::{COLUMNS, CORNERS, RING, ROWS};
use crate::elementary::{Elementary as _, angle_of};
use crate::geometry::{Point, Vec2};

/// Four marks in their order on the sheet; they may still be turned by half.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quad {
    pub view: View,
    /// How far the rings are from what the perspective makes of them, 0 for not at all.
    fault: f64,
}

/// Logarithm by which the distance of two marks may differ from the sheet's: perspective, and the width that blur gives to rings.
const APART: f64 = 0.3;
/// Largest fault of three marks alone, and of each corner of four.
const MOST_ANGLE: f64 = 0.25;
const MOST_SKEW: f64 = 0.4;
/// Largest ratio of the sizes of two rings.
const SIZES: f64 = 7.0;
/// Largest fault of a quad.
const MOST_FAULT: f64 = 1.2;
/// How far perspective moves a sheet's fourth corner from its place in a parallelogram, in diagonals.
const PERSPECTIVE: f64 = 0.4;
/// Most quads that are returned.
const MOST: usize = 12;

/// The quads among marks whose view is accepted, the best first.
pub(super) fn quads(marks: &[Mark], width: usize, height: usize, accepts: impl Fn(&View) -> bool) -> Vec<Quad> {
    // Each quad is found once, from its mark of the lowest index.
    let fours = corners(marks, MOST_SKEW).filter(|[a, b, c]| a < b && a < c).flat_map(|[a, b, c]| {
        let [p, q, r] = [a, b, c].map(|i| marks[i].ring.centre);
        let (opposite, reach) = (q + (r - p), PERSPECTIVE * q.distance(r));
        let is_fourth = move |d: &usize| {
            let ring = &marks[*d].ring;
            *d != b && *d != c && ring.centre.distance(opposite) < reach && corner_fault(ring, q, r) < MOST_SKEW
        };
        (a + 1..marks.len()).filter(is_fourth).map(move |d| [a, b, c, d])
    });
    let all = fours.flat_map(|four| both_ways(four.map(|i| marks[i]), width, height));
    let mut quads: Vec<Quad> = all.filter(|quad| accepts(&quad.view)).collect();
    quads.sort_by(|a, b| a.fault.total_cmp(&b.fault));
    quads.truncate(MOST);
    quads
}

/// Whether three of the marks could be corners of a sheet whose fourth is missing.
pub(super) fn has_three(marks: &[Mark]) -> bool {
    corners(marks, MOST_ANGLE).next().is_some()
}

/// A corner and its two neighbours, all that are possible.
fn corners(marks: &[Mark], most_fault: f64) -> impl Iterator<Item = [usize; 3]> {
    let count = marks.len();
    let near: Vec<bool> = (0..count * count).map(|k| may_belong(&marks[k / count], &marks[k % count])).collect();
    let ends = (0..count).flat_map(move |a| (0..count).flat_map(move |b| (0..b).map(move |c| [a, b, c])));
    ends.filter(move |[a, b, c]| {
        let may = |i: usize, j: usize| i != j && near[i * count + j];
        may(*a, *b) && may(*a, *c) && may(*b, *c) && {
            corner_fault(&marks[*a].ring, marks[*b].ring.centre, marks[*c].ring.centre) < most_fault
        }
    })
}

/// How far the sides from a ring to its two neighbours are from the sheet's, measured in the ring's own ellipse.
fn corner_fault(ring: &Blob, one: Point, other: Point) -> f64 {
    let ([xx, xy, yy], u, v) = (ring.spread, one - ring.centre, other - ring.centre);
    let whole = (xx * yy - xy * xy).max(1e-9);
    let dot = |u: Vec2, v: Vec2| (yy * u.x * v.x - xy * (u.x * v.y + u.y * v.x) + xx * u.y * v.y) / whole;
    let (a, b) = (dot(u, u).max(1e-9), dot(v, v).max(1e-9));
    let [long, short] = [a.max(b), a.min(b)].map(|square| (square * unit()).sqrt());
    let [wide, high] = sides();
    (dot(u, v).abs() / (a * b).sqrt()).max((short / wide).logarithm().abs()).max((long / high).logarithm().abs())
}

/// Whether the distance of two marks is, by their own measures, a side or the diagonal of the sheet.
fn may_belong(a: &Mark, b: &Mark) -> bool {
    let (s, t) = (a.ring.size(), b.ring.size());
    let apart = (a.ring.distance(b.ring.centre) * b.ring.distance(a.ring.centre)).sqrt() * unit().sqrt();
    let [wide, high] = sides();
    s.max(t) < SIZES * s.min(t) && [wide, high, wide.hypotenuse(high)].iter().any(|side| (apart / side).logarithm().abs() < APART)
}

/// Variance of a ring along each direction, in cells.
fn unit() -> f64 {
    0.25 * (RING[0] * RING[0] + RING[1] * RING[1])
}

/// Distances of the corner marks, in cells.
fn sides() -> [f64; 2] {
    [COLUMNS as f64 - 1.0, ROWS as f64 - 1.0]
}

/// The quad of four marks in order around their middle, with its upright and its lying view, so far as they are possible.
fn both_ways(mut marks: [Mark; 4], width: usize, height: usize) -> impl Iterator<Item = Quad> {
    let middle = marks.iter().fold(Vec2::ZERO, |sum, mark| sum + 0.25 * mark.ring.centre.to_vec2());
    marks.sort_by(|a, b| {
        let [a, b] = [a, b].map(|mark| angle_of(mark.ring.centre.to_vec2() - middle));
        a.total_cmp(&b)
    });
    let at = |i: usize| marks[i % 4].ring;
    let is_sheet = (0..4).all(|i| corner_fault(&at(i), at(i + 1).centre, at(i + 3).centre) < MOST_SKEW);
    (0..2).filter(move |_| is_sheet).filter_map(move |turn| {
        marks.rotate_left(turn);
        let view = View::through(&CORNERS, &marks.map(|mark| mark.ring.centre), width, height)?;
        let fault = view.is_sound(&CORNERS).then(|| fault(&view, &marks))?;
        (fault < MOST_FAULT).then_some(Quad { view, fault })
    })
}

/// The largest difference of a ring's ellipse from the one expected, plus the marks' own faults.
fn fault(view: &View, marks: &[Mark; 4]) -> f64 {
    let differences = marks.iter().zip(CORNERS).map(|(mark, corner)| {
        let [a, b] = view.steps(corner);
        let [xx, xy, yy] = [a.x * a.x + b.x * b.x, a.x * a.y + b.x * b.y, a.y * a.y + b.y * b.y].map(|v| v * unit());
        let [mxx, mxy, myy] = mark.ring.spread;
        let (whole, measured) = ((xx * yy - xy * xy).max(1e-9), (mxx * myy - mxy * mxy).max(1e-9));
        // Both ellipses in one frame: the mean of the axes' squared ratios, against their product.
        let trace = 0.5 * (yy * mxx - 2.0 * xy * mxy + xx * myy) / whole;
        (measured / whole).logarithm().abs().mul_add(0.5, (trace / (measured / whole).sqrt()).logarithm().abs() * 4.0)
    });
    differences.fold(0.0, f64::max) + 0.05 * marks.iter().map(|mark| mark.fault).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The marks of a sheet seen by a view.
    fn seen(view: &View) -> Vec<Mark> {
        let mark = |corner: &Point| {
            let [a, b] = view.steps(*corner);
            let spread = [a.x * a.x + b.x * b.x, a.x * a.y + b.x * b.y, a.y * a.y + b.y * b.y].map(|v| v * unit());
            Mark { ring: Blob { area: 900.0, centre: view.at(*corner), spread }, fault: 0.1 }
        };
        CORNERS.iter().map(mark).collect()
    }

    #[test]
    fn the_corners_are_found_among_other_marks() {
        let corners = [(150.0, 130.0), (820.0, 180.0), (880.0, 1300.0), (90.0, 1200.0)].map(Point::from);
        let view = View::through(&CORNERS, &corners, 1000, 1400).unwrap();
        let mut marks = seen(&view);
        for (i, (x, y)) in [(500.0, 300.0), (700.0, 900.0), (200.0, 700.0)].into_iter().enumerate() {
            let mut other = marks[i];
            other.ring.centre = Point::new(x, y);
            marks.push(other);
        }
        let quads = quads(&marks, 1000, 1400, |_| true);
        assert!(CORNERS.iter().all(|p| quads[0].view.at(*p).distance(view.at(*p)) < 1e-6) && quads[0].fault < 0.1);
        assert_eq!([&marks[4..], &marks[..3], &marks[1..4], &marks[..2]].map(has_three), [false, true, true, false]);
    }
}
