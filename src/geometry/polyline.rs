//! Polylines and polygons: length, area, even spacing, simplification, flattening of curves.

use crate::interrupt::Interrupt;
use kurbo::{BezPath, PathEl, Point};

/// Length of an open polyline.
pub fn polyline_length(points: &[Point]) -> f64 {
    points.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// The length from a polyline's start to each of its points.
pub fn lengths_along(points: &[Point]) -> Vec<f64> {
    let steps = points.windows(2).scan(0.0, |sum, pair| {
        *sum += pair[0].distance(pair[1]);
        Some(*sum)
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// Signed area of a closed polygon; positive if it turns from x towards y (clockwise on a page with y down).
pub fn polygon_area(points: &[Point]) -> f64 {
    let Some(&origin) = points.first() else { return 0.0 };
    // Relative to a vertex, so that a small polygon far from the origin keeps its precision.
    let twice: f64 = (0..points.len()).map(|i| (points[i] - origin).cross(points[(i + 1) % points.len()] - origin)).sum();
    0.5 * twice
}

/// Resamples a polyline at even arc length, with points about `spacing` apart and both ends kept.
pub fn resample(points: &[Point], spacing: f64) -> Vec<Point> {
    let length = polyline_length(points);
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return Vec::new() };
    let steps = (length / spacing).round().max(1.0) as usize;
    let mut out = Vec::with_capacity(steps + 1);
    out.push(first);
    let (mut travelled, mut next) = (0.0, 1);
    for pair in points.windows(2) {
        let piece = pair[0].distance(pair[1]);
        while next < steps {
            let wanted = length * next as f64 / steps as f64;
            if wanted > travelled + piece || piece == 0.0 {
                break;
            }
            out.push(pair[0].lerp(pair[1], (wanted - travelled) / piece));
            next += 1;
        }
        travelled += piece;
    }
    out.push(last);
    out
}

/// Maximum number of points simplified together: the time is quadratic if every point is a corner, as in a zigzag.
const TOGETHER: usize = 4096;

/// Removes vertices within `tolerance` of the simplified line (Douglas and Peucker 1973). Ends are kept, and in lines of more
/// than 4096 points some vertices between them.
pub fn simplify(points: &[Point], tolerance: f64) -> Vec<Point> {
    simplify_until(points, tolerance, &Interrupt::never())
}

/// [`simplify`] with an interrupt; once it is raised, too many vertices are removed.
pub fn simplify_until(points: &[Point], tolerance: f64, interrupt: &Interrupt) -> Vec<Point> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    let mut ends: Vec<usize> = (0..points.len() - 1).step_by(TOGETHER).collect();
    ends.push(points.len() - 1);
    ends.iter().for_each(|&end| keep[end] = true);
    let mut ranges: Vec<(usize, usize)> = ends.windows(2).map(|pair| (pair[0], pair[1])).collect();
    while let Some((first, last)) = ranges.pop().filter(|_| !interrupt.is_raised()) {
        let farthest = (first + 1..last)
            .map(|i| (distance_to_segment(points[i], points[first], points[last]), i))
            .fold((0.0, 0), |best, next| if next.0 > best.0 { next } else { best });
        if farthest.0 > tolerance {
            keep[farthest.1] = true;
            ranges.push((first, farthest.1));
            ranges.push((farthest.1, last));
        }
    }
    points.iter().zip(keep).filter(|(_, keep)| *keep).map(|(p, _)| *p).collect()
}

/// Distance of a point from a segment.
pub fn distance_to_segment(p: Point, a: Point, b: Point) -> f64 {
    let d = b - a;
    let t = if d.hypot2() > 0.0 { ((p - a).dot(d) / d.hypot2()).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + d * t)
}

/// Each subpath as a polyline within `tolerance`; the flag is true if it is closed (the first point is then not repeated). A bare
/// move gives one point.
pub fn flatten(path: &BezPath, tolerance: f64) -> Vec<(Vec<Point>, bool)> {
    let mut out: Vec<(Vec<Point>, bool)> = Vec::new();
    kurbo::flatten(path.elements().iter().copied(), tolerance, |element| match element {
        PathEl::MoveTo(p) => out.push((vec![p], false)),
        PathEl::LineTo(p) => {
            if let Some((points, _)) = out.last_mut() {
                points.push(p);
            }
        }
        PathEl::ClosePath => {
            if let Some((points, closed)) = out.last_mut() {
                *closed = true;
                if points.len() > 1 && points.first() == points.last() {
                    points.pop();
                }
            }
        }
        // Flattening leaves only lines.
        PathEl::QuadTo(..) | PathEl::CurveTo(..) => {}
    });
    out
}

/// Estimates the number of points that [`flatten`] gives, from the second differences of the control points.
pub fn flattened_points(path: &BezPath, tolerance: f64) -> f64 {
    let mut at = Point::ORIGIN;
    let mut points = 0.0;
    for element in path.elements() {
        let bend = match *element {
            PathEl::QuadTo(a, p) => (at - a).to_point().distance((a - p).to_point()) / 4.0,
            PathEl::CurveTo(a, b, p) => {
                let (first, second) = ((at - a) - (a - b), (a - b) - (b - p));
                0.75 * first.hypot().max(second.hypot())
            }
            _ => 0.0,
        };
        points += 1.0 + (bend / tolerance).sqrt();
        at = element.end_point().unwrap_or(at);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resampling_keeps_ends_and_spacing() {
        let line = [Point::new(0.0, 0.0), Point::new(3.0, 0.0), Point::new(3.0, 4.0)];
        let even = resample(&line, 0.5);
        assert_eq!(even.len(), 15);
        assert_eq!(even[0], line[0]);
        assert_eq!(even[14], line[2]);
        assert_eq!(even[6], Point::new(3.0, 0.0));
    }

    #[test]
    fn simplify_keeps_corners() {
        let line: Vec<Point> =
            (0..=10).map(|i| Point::new(f64::from(i), 0.0)).chain((1..=10).map(|i| Point::new(10.0, f64::from(i)))).collect();
        assert_eq!(simplify(&line, 0.01), vec![Point::new(0.0, 0.0), Point::new(10.0, 0.0), Point::new(10.0, 10.0)]);
    }

    #[test]
    fn points_of_a_curve_are_foretold() {
        for radius in [1.0, 30.0, 1e4] {
            let circle = kurbo::Shape::to_path(&kurbo::Circle::new((3.0, 4.0), radius), 1e-3);
            let (told, made) = (flattened_points(&circle, 0.005), flatten(&circle, 0.005)[0].0.len() as f64);
            assert!(told >= 0.7 * made && told <= 3.0 * made + 10.0, "radius {radius}: {told} for {made}");
        }
    }

    #[test]
    fn flatten_tells_closed_from_open() {
        let path = BezPath::from_svg("M0,0 L1,0 L1,1 Z M5,5 L6,6").unwrap();
        let pieces = flatten(&path, 0.01);
        assert_eq!(pieces.len(), 2);
        assert!(pieces[0].1 && pieces[0].0.len() == 3);
        assert!(!pieces[1].1);
    }
}
