//! The same swelling line with fewer nodes.

use kurbo::{BezPath, CubicBez, ParamCurve, ParamCurveArclen, ParamCurveDeriv, PathEl, Point, Vec2};

/// Cosine of the angle by which two segments may turn at a node that can be left out; more is a corner.
const SMOOTH_JOIN: f64 = 0.995;
/// Cosine of the angle by which one cubic may turn in all: with handles of a third of its length it follows such an arc closely.
const MOST_TURN: f64 = 0.5;
/// Accuracy of segments' lengths in millimetres.
const LENGTH_ACCURACY: f64 = 1e-4;
/// Places of each segment at which a fit is checked.
const CHECKED: [f64; 3] = [0.25, 0.5, 1.0];
/// How far a place of the fit may lie along the line from the one that it stands for, in tolerances.
const ALONG: f64 = 8.0;

/// Deviation of the width, as a share of it, beyond the tolerance, and its maximum in millimetres: a swell is seen long after a line's
/// place, but half a millimetre of a wide line has a tone of its own.
const OF_WIDTH: f64 = 0.04;
const MOST_OF_WIDTH: f64 = 0.012;

/// Deviation of the line, as a share of the width, beyond the tolerance.
const OF_LINE: f64 = 0.01;

/// A line with one width per node, with as few nodes as keep the line within `tolerance` and 1 % of its width, and its width between
/// nodes, taken as linear, within that and 4 % of itself. Its ink changes by a few hundredths at most; who needs it exactly corrects it. Ends, corners and closed lines stay.
pub fn with_fewer_nodes(curve: &BezPath, widths: &[f64], tolerance: f64) -> (BezPath, Vec<f64>) {
    let segments: Vec<CubicBez> = curve.segments().map(|segment| segment.to_cubic()).collect();
    let is_closed = matches!(curve.elements().last(), Some(PathEl::ClosePath));
    if is_closed || segments.len() < 2 || widths.len() != segments.len() + 1 || !curve.is_finite() {
        return (curve.clone(), widths.to_vec());
    }
    let lengths: Vec<f64> = segments.iter().map(|segment| segment.arclen(LENGTH_ACCURACY)).collect();
    let line = Line { segments, lengths, widths, tolerance };
    let mut fewer = BezPath::new();
    let mut kept = vec![widths[0]];
    fewer.move_to(line.segments[0].p0);
    let mut from = 0;
    while from < line.segments.len() {
        let (to, cubic) = line.longest(from);
        fewer.curve_to(cubic.p1, cubic.p2, cubic.p3);
        kept.push(widths[to]);
        from = to;
    }
    (fewer, kept)
}

struct Line<'a> {
    segments: Vec<CubicBez>,
    lengths: Vec<f64>,
    widths: &'a [f64],
    tolerance: f64,
}

impl Line<'_> {
    /// The farthest node that one cubic reaches from a node, and the cubic: by steps that double, then halve.
    fn longest(&self, from: usize) -> (usize, CubicBez) {
        let mut best = (from + 1, self.segments[from]);
        let mut step = 1;
        let mut is_growing = true;
        loop {
            let to = best.0 + step;
            let fit = if to <= self.segments.len() { self.fit(from, to) } else { None };
            if let Some(cubic) = fit {
                best = (to, cubic);
                if is_growing {
                    step *= 2;
                }
            } else {
                is_growing = false;
                step /= 2;
                if step == 0 {
                    return best;
                }
            }
        }
    }

    /// One cubic for the segments from a node to another, if it keeps to them.
    fn fit(&self, from: usize, to: usize) -> Option<CubicBez> {
        let (first, last) = (&self.segments[from], &self.segments[to - 1]);
        let (start, end) = (direction(first, 0.0)?, direction(last, 1.0)?);
        if start.dot(end) < MOST_TURN {
            return None;
        }
        let length: f64 = self.lengths[from..to].iter().sum();
        let cubic = CubicBez::new(first.p0, first.p0 + start * (length / 3.0), last.p3 - end * (length / 3.0), last.p3);
        let mut before = 0.0;
        for i in from..to {
            for t in CHECKED {
                let u = (before + t * self.lengths[i]) / length;
                let width = self.widths[i] + t * (self.widths[i + 1] - self.widths[i]);
                let fitted = self.widths[from] + u * (self.widths[to] - self.widths[from]);
                if (width - fitted).abs() > self.tolerance + (OF_WIDTH * width).min(MOST_OF_WIDTH)
                    || !self.is_near(&cubic, u, self.segments[i].eval(t), OF_LINE * width)
                {
                    return None;
                }
            }
            let is_corner =
                i + 1 < to && direction(&self.segments[i], 1.0)?.dot(direction(&self.segments[i + 1], 0.0)?) < SMOOTH_JOIN;
            if is_corner {
                return None;
            }
            before += self.lengths[i];
        }
        Some(cubic)
    }

    /// True if a cubic passes a place closely.
    fn is_near(&self, cubic: &CubicBez, u: f64, place: Point, slack: f64) -> bool {
        let off = cubic.eval(u) - place;
        let Some(along) = direction(cubic, u) else { return false };
        let most = self.tolerance + slack;
        off.cross(along).abs() <= most && off.dot(along).abs() <= ALONG * most
    }
}

/// The unit tangent; none where the cubic stands still.
fn direction(cubic: &CubicBez, t: f64) -> Option<Vec2> {
    let tangent = cubic.deriv().eval(t).to_vec2();
    let near_end = if t < 0.5 { cubic.p2 - cubic.p0 } else { cubic.p3 - cubic.p1 };
    [tangent, near_end, cubic.p3 - cubic.p0].into_iter().find(|v| v.hypot() > 1e-9).map(Vec2::normalize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;
    use crate::geometry::{Ends, Ring, catmull_rom, swelling_outline};
    use kurbo::{ParamCurveNearest, Shape};

    fn wave() -> (BezPath, Vec<f64>) {
        let points: Vec<Point> = (0..60).map(|i| Point::new(0.4 * f64::from(i), (0.05 * f64::from(i)).sine())).collect();
        let widths: Vec<f64> = (0..60).map(|i| 0.3 + 0.1 * (0.1 * f64::from(i)).cosine()).collect();
        (catmull_rom(&points, Ring::Open), widths)
    }

    #[test]
    fn a_long_swelling_line_keeps_its_ink_with_few_nodes() {
        let (curve, widths) = wave();
        let (fewer, kept) = with_fewer_nodes(&curve, &widths, 0.005);
        assert!(kept.len() * 3 < widths.len(), "{} of {}", kept.len(), widths.len());
        assert_eq!(fewer.segments().count() + 1, kept.len());
        let far = fewer.segments().flat_map(|segment| (0..8).map(move |i| segment.eval(f64::from(i) / 8.0)));
        let distance = |p: Point| curve.segments().map(|s| s.nearest(p, 1e-4).distance_sq).fold(f64::MAX, f64::min).sqrt();
        assert!(far.map(distance).fold(0.0, f64::max) < 0.01);
        let area = |curve: &BezPath, widths: &[f64]| swelling_outline(curve, widths, Ends::Round, 0.002).area().abs();
        let change = area(&fewer, &kept) / area(&curve, &widths) - 1.0;
        assert!(change.abs() < 0.03, "{change}");
    }

    #[test]
    fn corners_points_and_closed_lines_stay() {
        let corner = BezPath::from_svg("M0,0 L4,0 L4,4").unwrap();
        assert_eq!(with_fewer_nodes(&corner, &[1.0; 3], 0.005).1.len(), 3);
        let closed = BezPath::from_svg("M0,0 L4,0 L4,4 Z").unwrap();
        assert_eq!(with_fewer_nodes(&closed, &[1.0; 4], 0.005).0, closed);
        let still = BezPath::from_svg("M1,1 L1,1 L1,1 L2,1").unwrap();
        let (fewer, kept) = with_fewer_nodes(&still, &[1.0, 0.5, 1.0, 1.0], 0.005);
        assert!(fewer.is_finite() && kept.first() == Some(&1.0));
    }
}
