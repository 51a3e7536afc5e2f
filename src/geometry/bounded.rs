//! Cuts outlines of any size to a frame before they are flattened. What lies outside costs nothing, and the inside stays exact.

use super::polyline::flatten;
use kurbo::{BezPath, CubicBez, ParamCurve, PathEl, Point, QuadBez, Rect};

/// Replaces the curves of an outline that lie outside a frame by straight lines. Winding numbers inside the frame do not change.
/// `None` if a coordinate is not finite.
///
/// A piece of a curve whose control points all lie beyond one side of the frame is replaced by its chord, which lies there too.
pub fn straightened_outside(outline: &BezPath, frame: Rect) -> Option<BezPath> {
    let mut tame = FrameStraightener { path: BezPath::new(), frame, near: frame.inflate(frame.width(), frame.height()) };
    let mut at = Point::ORIGIN;
    for element in outline.elements() {
        let end = element.end_point().unwrap_or(at);
        let is_finite = match *element {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => p.is_finite(),
            PathEl::QuadTo(a, p) => a.is_finite() && p.is_finite(),
            PathEl::CurveTo(a, b, p) => a.is_finite() && b.is_finite() && p.is_finite(),
            PathEl::ClosePath => true,
        };
        if !is_finite {
            return None;
        }
        match *element {
            PathEl::QuadTo(a, p) => tame.curve(QuadBez::new(at, a, p).raise(), DEEPEST),
            PathEl::CurveTo(a, b, p) => tame.curve(CubicBez::new(at, a, b, p), DEEPEST),
            plain => tame.path.push(plain),
        }
        at = end;
    }
    Some(tame.path)
}

/// The subpaths of a result of [`straightened_outside`] as polygons within its frame; open ones are closed.
pub fn polygons_within(straightened_outside: &BezPath, frame: Rect, tolerance: f64) -> Vec<Vec<Point>> {
    let polygons = flatten(straightened_outside, tolerance).into_iter().map(|(points, _)| cut(points, frame));
    polygons.filter(|polygon| polygon.len() > 2).collect()
}

/// Maximum halvings of a curve before its chord is taken: a curve of 1e38, the maximum of single precision, is then as short as
/// the frame.
const DEEPEST: usize = 120;

struct FrameStraightener {
    path: BezPath,
    frame: Rect,
    /// Curves within this rectangle are kept.
    near: Rect,
}

impl FrameStraightener {
    fn curve(&mut self, curve: CubicBez, depth: usize) {
        let hull =
            [curve.p1, curve.p2, curve.p3].into_iter().fold(Rect::from_points(curve.p0, curve.p0), |hull, p| hull.union_pt(p));
        let is_beyond = hull.x1 < self.frame.x0 || hull.x0 > self.frame.x1 || hull.y1 < self.frame.y0 || hull.y0 > self.frame.y1;
        if is_beyond || depth == 0 {
            self.path.line_to(curve.p3);
        } else if self.near.union(hull) == self.near {
            self.path.curve_to(curve.p1, curve.p2, curve.p3);
        } else {
            let (first, second) = curve.subdivide();
            self.curve(first, depth - 1);
            self.curve(second, depth - 1);
        }
    }
}

/// One side of a frame: a function that splits a point into its coordinate along the side's axis and the other one, the side's
/// position on that axis, and the sign of the outward direction.
type Side = (fn(Point) -> (f64, f64), f64, f64);

/// Clips a polygon to a frame (Sutherland and Hodgman 1974). Coordinates on the border equal the border's exactly, however far
/// away the corners were.
fn cut(polygon: Vec<Point>, frame: Rect) -> Vec<Point> {
    let horizontal = |p: Point| (p.x, p.y);
    let vertical = |p: Point| (p.y, p.x);
    let sides: [Side; 4] =
        [(horizontal, frame.x0, -1.0), (horizontal, frame.x1, 1.0), (vertical, frame.y0, -1.0), (vertical, frame.y1, 1.0)];
    let mut current = polygon;
    for (i, (split, border, sign)) in sides.into_iter().enumerate() {
        let beyond = |p: Point| sign * (split(p).0 - border);
        if current.iter().all(|p| beyond(*p) <= 0.0) {
            continue;
        }
        let mut kept = Vec::with_capacity(current.len() + 4);
        for (j, &a) in current.iter().enumerate() {
            let b = current[(j + 1) % current.len()];
            if beyond(a) <= 0.0 {
                kept.push(a);
            }
            if (beyond(a) < 0.0 && beyond(b) > 0.0) || (beyond(a) > 0.0 && beyond(b) < 0.0) {
                let ((along_a, across_a), (along_b, across_b)) = (split(a), split(b));
                let across = across_a + (across_b - across_a) * ((border - along_a) / (along_b - along_a));
                kept.push(if i < 2 { Point::new(border, across) } else { Point::new(across, border) });
            }
        }
        current = kept;
    }
    current
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon_area;
    use kurbo::{Affine, Circle, Shape};

    const FRAME: Rect = Rect::new(-1000.0, -1000.0, 1000.0, 1000.0);

    fn polygons(outline: &BezPath) -> Vec<Vec<Point>> {
        polygons_within(&straightened_outside(outline, FRAME).unwrap(), FRAME, 0.005)
    }

    fn area(outline: &BezPath) -> f64 {
        polygons(outline).iter().map(|polygon| polygon_area(polygon)).sum::<f64>().abs()
    }

    #[test]
    fn what_covers_the_frame_is_the_frame() {
        for size in [1e4, 1e15, 1e20, 1e38] {
            assert!((area(&Rect::new(-size, -size, size, size).to_path(0.1)) - 4e6).abs() < 1e-3, "square of {size}");
            let circle = Circle::new((0.0, 0.0), size).to_path(1e-3 * size);
            let points: usize = polygons(&circle).iter().map(Vec::len).sum();
            assert!((area(&circle) - 4e6).abs() < 1e-3 && points < 1000, "circle of {size}: {points} points");
        }
    }

    #[test]
    fn a_border_far_away_is_as_straight_as_it_looks() {
        // A circle that reaches from x = 0 a long way to the right covers the right half.
        let circle = Affine::translate((1e9, 0.0)) * Circle::new((0.0, 0.0), 1e9).to_path(1e-3);
        assert!((area(&circle) / 2e6 - 1.0).abs() < 1e-3, "{}", area(&circle));
        assert!(area(&(Affine::translate((1e9, 0.0)) * Circle::new((0.0, 0.0), 1e8).to_path(1e-3))) < 1e-9);
    }

    #[test]
    fn small_outlines_stay_and_numbers_without_end_are_refused() {
        let small = Circle::new((5.0, 5.0), 10.0).to_path(1e-6);
        assert!((area(&small) - std::f64::consts::PI * 100.0).abs() < 0.3);
        for endless in [f64::NAN, f64::INFINITY] {
            let mut path = BezPath::new();
            path.move_to((0.0, 0.0));
            path.curve_to((1.0, endless), (2.0, 2.0), (3.0, 0.0));
            assert!(straightened_outside(&path, FRAME).is_none());
        }
    }
}
