//! Circular arcs fitted to polylines.

use crate::elementary::Elementary as _;
use kurbo::{Point, Vec2};
use std::f64::consts::PI;

/// Minimum number of segments that an arc replaces: any three points lie on a circle.
const LEAST_LEGS: usize = 3;
/// Maximum number of segments that one arc replaces, to bound the work.
const MOST_LEGS: usize = 256;
/// Maximum radius. Beyond it a line is as good, and a controller's rounding of the centre becomes visible.
const GREATEST_RADIUS: f64 = 2000.0;

/// A step along a path, from the end of the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A straight line.
    Line {
        /// End point.
        to: Point,
    },
    /// A circular arc.
    Arc {
        /// End point.
        to: Point,
        /// The circle's centre.
        centre: Point,
        /// The angle swept in radians, positive from x towards y; at most half a turn.
        sweep: f64,
    },
}

impl Step {
    /// The end point.
    pub const fn to(&self) -> Point {
        match self {
            Self::Line { to } | Self::Arc { to, .. } => *to,
        }
    }
}

/// Converts a polyline to lines and arcs, starting at its first point. The polyline's points lie within `0.5 * tolerance` of an
/// arc, and an arc within `1.25 * tolerance` of the polyline, because the chords of a flattened curve already lie a tolerance
/// inside it.
///
/// Every arc starts and ends at points of the polyline, reaches as far as it fits, and sweeps at most half a turn.
pub fn fit_arcs(points: &[Point], tolerance: f64) -> Vec<Step> {
    let mut steps = Vec::with_capacity(points.len());
    let mut at = 0;
    while at + 1 < points.len() {
        let most = (at + MOST_LEGS).min(points.len() - 1);
        let mut best = None;
        for end in at + LEAST_LEGS..=most {
            match arc_through(&points[at..=end], tolerance) {
                Some(arc) => best = Some((end, arc)),
                None => break,
            }
        }
        let (end, step) = best.unwrap_or((at + 1, Step::Line { to: points[at + 1] }));
        steps.push(step);
        at = end;
    }
    steps
}

/// The arc from the first point to the last, if all lie on it. Its centre is on the perpendicular bisector of the two, at a
/// height h fitted by least squares: with q relative to their midpoint, `|q|^2 - L^2/4 = 2 h q.n` on the circle.
fn arc_through(points: &[Point], tolerance: f64) -> Option<Step> {
    let (first, last) = (points[0], points[points.len() - 1]);
    let (middle, chord) = (first.midpoint(last), last - first);
    let length = chord.hypot();
    if length < 1e-9 {
        return None;
    }
    let normal = Vec2::new(-chord.y, chord.x) / length;
    let (mut above, mut below) = (0.0, 0.0);
    for p in &points[1..points.len() - 1] {
        let q = *p - middle;
        let slope = 2.0 * q.dot(normal);
        above += (q.hypot2() - 0.25 * length * length) * slope;
        below += slope * slope;
    }
    let centre = middle + normal * (above / below);
    let radius = centre.distance(first);
    if below <= 0.0 || !radius.is_finite() || radius > GREATEST_RADIUS {
        return None;
    }
    let sweep = swept(points, centre)?;
    let lies_on = |p: &Point| (p.distance(centre) - radius).abs() <= 0.5 * tolerance;
    let bulges = |pair: &[Point]| (pair[0].midpoint(pair[1]).distance(centre) - radius).abs() > 1.25 * tolerance;
    (points.iter().all(lies_on) && !points.windows(2).any(bulges)).then_some(Step::Arc { to: last, centre, sweep })
}

/// The angle that points sweep around a centre, if all turn the same way and by at most half a turn in total.
fn swept(points: &[Point], centre: Point) -> Option<f64> {
    let mut sum: f64 = 0.0;
    for pair in points.windows(2) {
        let (a, b) = (pair[0] - centre, pair[1] - centre);
        let angle = a.cross(b).angle_over(a.dot(b));
        if angle == 0.0 || angle * sum < 0.0 {
            return None;
        }
        sum += angle;
    }
    (sum.abs() <= PI).then_some(sum)
}

/// Number of points that [`flatten_arc`] gives for an arc; not finite if the radius or the sweep is not.
pub fn arc_points(radius: f64, sweep: f64, tolerance: f64) -> f64 {
    // The sine of a quarter step keeps its precision where the cosine of a half step rounds to 1.
    let step = if radius > tolerance { 4.0 * (0.5 * tolerance / radius).sqrt().arc_sine() } else { PI };
    (sweep.abs() / step).ceil().max(1.0)
}

/// Points along an arc after its start, including its end, with chords no farther than `tolerance` from it. [`arc_points`] gives
/// their number beforehand. It is capped at ten million, with wider spacing then.
pub fn flatten_arc(from: Point, to: Point, centre: Point, sweep: f64, tolerance: f64) -> Vec<Point> {
    let radius = from.distance(centre);
    let count = arc_points(radius, sweep, tolerance).min(1e7);
    let start = from - centre;
    // The end's radius may differ by rounding.
    let end_radius = to.distance(centre);
    let mut points: Vec<Point> = (1..count as usize)
        .map(|i| {
            let part = i as f64 / count;
            let (sin, cos) = (sweep * part).sine_and_cosine();
            let turned = Vec2::new(start.x * cos - start.y * sin, start.x * sin + start.y * cos);
            let scale = if radius > 0.0 { (radius + (end_radius - radius) * part) / radius } else { 1.0 };
            centre + turned * scale
        })
        .collect();
    points.push(to);
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;
    use crate::geometry::distance_to_segment;
    use proptest::prelude::*;

    fn drawn(start: Point, steps: &[Step]) -> Vec<Point> {
        let mut points = vec![start];
        for step in steps {
            let at = points[points.len() - 1];
            match *step {
                Step::Line { to } => points.push(to),
                Step::Arc { to, centre, sweep } => points.extend(flatten_arc(at, to, centre, sweep, 1e-4)),
            }
        }
        points
    }

    fn farthest(from: &[Point], path: &[Point]) -> f64 {
        let near = |p: &Point| path.windows(2).map(|w| distance_to_segment(*p, w[0], w[1])).fold(f64::INFINITY, f64::min);
        from.iter().map(near).fold(0.0, f64::max)
    }

    fn middles(points: &[Point]) -> Vec<Point> {
        points.windows(2).map(|w| w[0].midpoint(w[1])).collect()
    }

    #[test]
    fn a_circle_becomes_two_or_three_arcs_and_a_square_none() {
        let circle: Vec<Point> = (0..=72)
            .map(|i| Point::new((f64::from(i) * PI / 36.0).cosine() * 3.0, (f64::from(i) * PI / 36.0).sine() * 3.0))
            .collect();
        let steps = fit_arcs(&circle, 0.02);
        assert!(steps.len() <= 3, "{steps:?}");
        assert!(matches!(steps[0], Step::Arc { centre, sweep, .. } if centre.distance(Point::ORIGIN) < 1e-6 && sweep > 3.0));
        let square = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0), (0.0, 0.0)].map(|(x, y)| Point::new(x, y));
        assert!(fit_arcs(&square, 0.02).iter().all(|step| matches!(step, Step::Line { .. })));
    }

    #[test]
    fn a_spiral_that_fills_a_dot_becomes_a_few_arcs() {
        let spiral: Vec<Point> = (0..=400)
            .map(|i| {
                let angle = f64::from(i) * 0.1;
                Point::new(angle.cosine(), angle.sine()).to_vec2() * (0.27 * angle / (2.0 * PI))
            })
            .map(Vec2::to_point)
            .collect();
        let steps = fit_arcs(&spiral, 0.02);
        assert!(steps.len() * 6 < spiral.len(), "{} steps for {} points", steps.len(), spiral.len());
    }

    proptest! {
        #[test]
        fn arcs_stay_with_the_polyline(turns in prop::collection::vec((-0.6_f64..0.6, 0.02_f64..2.0, 1_usize..30), 1..12)) {
            let (mut at, mut heading) = (Point::ORIGIN, 0.0_f64);
            let mut points = vec![at];
            for (turn, leg, legs) in turns {
                for _ in 0..legs {
                    heading += turn;
                    at += unit_at(heading) * leg;
                    points.push(at);
                }
            }
            let tolerance = 0.02;
            let steps = fit_arcs(&points, tolerance);
            prop_assert_eq!(steps.last().map(Step::to), points.last().copied());
            let arcs = drawn(points[0], &steps);
            let limit = 1.25 * tolerance + 1e-3;
            prop_assert!(farthest(&points, &arcs) <= limit);
            prop_assert!(farthest(&middles(&points), &arcs) <= limit);
            prop_assert!(farthest(&arcs, &points) <= limit);
            // The steps' ends are a subsequence of the polyline.
            let mut rest = points.iter();
            prop_assert!(steps.iter().all(|step| rest.any(|p| *p == step.to())));
        }
    }
}
