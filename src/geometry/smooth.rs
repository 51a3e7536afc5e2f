//! Smooths traced polylines into curves.

use super::polyline::resample;
use crate::elementary::Elementary as _;
use kurbo::{BezPath, Point, Vec2};

/// Whether a line's last point is joined to its first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ring {
    /// It has two ends.
    Open,
    /// It is joined all the way round.
    Closed,
}

impl From<bool> for Ring {
    fn from(is_closed: bool) -> Self {
        if is_closed { Self::Closed } else { Self::Open }
    }
}

/// Smooths a polyline by a Gaussian of standard deviation `sigma` along its length, on points `spacing` apart.
/// Open ends stay fixed; a closed line (last point joined to the first) is smoothed all the way round.
pub fn smooth_polyline(points: &[Point], ring: Ring, sigma: f64, spacing: f64) -> Vec<Point> {
    let closed = ring == Ring::Closed;
    let mut line = points.to_vec();
    if closed && let Some(&first) = points.first() {
        line.push(first);
    }
    let mut even = resample(&line, spacing);
    if closed {
        even.pop();
    }
    if even.len() < 3 {
        return even;
    }
    let radius = (3.0 * sigma / spacing).ceil() as isize;
    let weights: Vec<f64> = (0..=radius).map(|i| (-0.5 * (i as f64 * spacing / sigma).powi(2)).exponential()).collect();
    let at = |i: isize| if closed { even[i.rem_euclid(even.len() as isize) as usize] } else { reflected(&even, i) };
    (0..even.len() as isize)
        .map(|i| {
            let (mut sum, mut total) = (Vec2::ZERO, 0.0);
            for j in -radius..=radius {
                let weight = weights[j.unsigned_abs()];
                sum += at(i + j).to_vec2() * weight;
                total += weight;
            }
            (sum / total).to_point()
        })
        .collect()
}

/// The i-th point of a polyline extended beyond its ends by point reflection, which keeps the end and its direction under
/// smoothing.
fn reflected(points: &[Point], i: isize) -> Point {
    let last = points.len() as isize - 1;
    let mirror = |end: Point, inner: isize| end + (end - points[inner.clamp(0, last) as usize]);
    if i < 0 {
        mirror(points[0], -i)
    } else if i > last {
        mirror(points[last as usize], 2 * last - i)
    } else {
        points[i as usize]
    }
}

/// Maximum handle as a share of its chord. Evenly spaced points have a third and never come near it; where a short segment
/// follows a long one, the spline's own handle is many times the chord, and the curve becomes a loop.
const LONGEST_HANDLE: f64 = 0.5;

/// The Catmull-Rom spline through the points as cubic Beziers, with handles of at most half their chords.
pub fn catmull_rom(points: &[Point], ring: Ring) -> BezPath {
    let closed = ring == Ring::Closed;
    let mut path = BezPath::new();
    let n = points.len() as isize;
    let Some(&first) = points.first() else { return path };
    path.move_to(first);
    let at = |i: isize| points[if closed { i.rem_euclid(n) } else { i.clamp(0, n - 1) } as usize];
    for i in 0..if closed { n } else { n - 1 } {
        let (before, from, to, after) = (at(i - 1), at(i), at(i + 1), at(i + 2));
        let longest = LONGEST_HANDLE * from.distance(to);
        let handle = |tangent: Vec2| {
            let handle = tangent / 6.0;
            handle * (longest / handle.hypot().max(1e-12)).min(1.0)
        };
        path.curve_to(from + handle(to - before), to - handle(after - from), to);
    }
    if closed {
        path.close_path();
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;

    #[test]
    fn smoothing_a_staircase_gives_its_slope() {
        let stairs: Vec<Point> = (0..60).map(|i| Point::new(f64::from(i), f64::from(i / 2))).collect();
        let smooth = smooth_polyline(&stairs, Ring::Open, 3.0, 0.5);
        for pair in smooth[20..smooth.len() - 20].windows(2) {
            let step = pair[1] - pair[0];
            assert!((step.y / step.x - 0.5).abs() < 0.05, "{step:?}");
        }
        assert!(smooth[0].distance(stairs[0]) < 1e-9);
    }

    #[test]
    fn the_spline_meets_its_points_and_follows_a_circle() {
        let circle: Vec<Point> =
            (0..24).map(|i| Point::ORIGIN + unit_at(f64::from(i) * std::f64::consts::TAU / 24.0) * 10.0).collect();
        let spline = catmull_rom(&circle, Ring::Closed);
        assert_eq!(spline.elements().len(), 26);
        for piece in spline.segments() {
            use kurbo::ParamCurve;
            assert!((piece.eval(0.5).to_vec2().hypot() - 10.0).abs() < 0.01);
        }
    }
}
