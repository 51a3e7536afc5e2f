//! Clipping by straight borders: convex polygons by a half plane, polygons and polylines by a rectangle.

use kurbo::{Point, Rect, Vec2};

/// The part of a polygon on the side of `origin` that `normal` points away from: `(p - origin) . normal <= 0`.
/// The result is written to `out`, so that callers in a loop allocate nothing.
pub fn half_plane(polygon: &[Point], origin: Point, normal: Vec2, out: &mut Vec<Point>) {
    out.clear();
    let height = |p: Point| (p - origin).dot(normal);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (ha, hb) = (height(a), height(b));
        if ha <= 0.0 {
            out.push(a);
        }
        if (ha < 0.0 && hb > 0.0) || (ha > 0.0 && hb < 0.0) {
            out.push(a.lerp(b, ha / (ha - hb)));
        }
    }
}

/// The part of a polygon inside a rectangle (Sutherland and Hodgman 1974). A concave polygon that falls into several pieces
/// keeps them joined along the rectangle's border, with the right area.
pub fn clip_polygon(polygon: &[Point], rect: Rect) -> Vec<Point> {
    let sides = [
        (Point::new(rect.x0, 0.0), Vec2::new(-1.0, 0.0)),
        (Point::new(rect.x1, 0.0), Vec2::new(1.0, 0.0)),
        (Point::new(0.0, rect.y0), Vec2::new(0.0, -1.0)),
        (Point::new(0.0, rect.y1), Vec2::new(0.0, 1.0)),
    ];
    let mut current = polygon.to_vec();
    let mut next = Vec::with_capacity(current.len() + 4);
    for (origin, normal) in sides {
        half_plane(&current, origin, normal, &mut next);
        std::mem::swap(&mut current, &mut next);
    }
    current
}

/// The pieces of a polyline inside a rectangle, in order and direction, each with the position along the line
/// (vertex index plus fraction) of each of its points, so that widths and pressure can follow.
pub fn clip_polyline(points: &[Point], rect: Rect) -> Vec<Vec<(Point, f64)>> {
    let mut pieces: Vec<Vec<(Point, f64)>> = Vec::new();
    let mut open = false;
    for (i, pair) in points.windows(2).enumerate() {
        let Some((t0, t1)) = segment_in_rect(pair[0], pair[1], rect) else {
            open = false;
            continue;
        };
        let at = |t: f64| (pair[0].lerp(pair[1], t), i as f64 + t);
        if !(open && t0 == 0.0) {
            pieces.push(vec![at(t0)]);
        }
        if t1 > t0 {
            pieces.last_mut().expect("one was pushed").push(at(t1));
        }
        open = t1 == 1.0;
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

/// The parameters between which a segment lies in a rectangle (Liang and Barsky 1984).
fn segment_in_rect(a: Point, b: Point, rect: Rect) -> Option<(f64, f64)> {
    let d = b - a;
    let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
    for (p, q) in [(-d.x, a.x - rect.x0), (d.x, rect.x1 - a.x), (-d.y, a.y - rect.y0), (d.y, rect.y1 - a.y)] {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            t0 = t0.max(q / p);
        } else {
            t1 = t1.min(q / p);
        }
    }
    (t0 <= t1).then_some((t0, t1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon_area;

    #[test]
    fn a_polygon_is_cut_to_the_rectangle() {
        let diamond = [Point::new(0.0, -2.0), Point::new(2.0, 0.0), Point::new(0.0, 2.0), Point::new(-2.0, 0.0)];
        let cut = clip_polygon(&diamond, Rect::new(-1.0, -1.0, 1.0, 1.0));
        assert!((polygon_area(&cut).abs() - 4.0).abs() < 1e-12);
        assert!(clip_polygon(&diamond, Rect::new(5.0, 5.0, 6.0, 6.0)).is_empty());
    }

    #[test]
    fn a_line_that_leaves_and_returns_gives_two_pieces() {
        let line = [Point::new(0.5, 0.5), Point::new(2.0, 0.5), Point::new(2.0, 0.8), Point::new(0.5, 0.8)];
        let pieces = clip_polyline(&line, Rect::new(0.0, 0.0, 1.0, 1.0));
        assert_eq!(pieces.len(), 2);
        assert_eq!(pieces[0][1].0, Point::new(1.0, 0.5));
        assert!((pieces[1][0].1 - (2.0 + 1.0 / 1.5)).abs() < 1e-12);
    }
}
