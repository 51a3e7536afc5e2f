//! Clipping by straight lines: convex polygons by a half plane, polygons, discs and polylines by a rectangle.

use crate::elementary::{Elementary as _, unit_at};
use kurbo::{BezPath, Point, Rect, Vec2};
use std::f64::consts::{FRAC_PI_2, TAU};

/// The part of a polygon on the side of `origin` that `normal` points away from: `(p - origin) . normal <= 0`.
/// Written to `out`, so that callers in a loop need not allocate.
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

/// The part of a polygon inside a rectangle (Sutherland and Hodgman 1974). If a concave polygon falls into several pieces, they
/// stay joined along the rectangle's border; the area is correct.
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

/// The part of a disc inside a rectangle, as arcs (cubics, with an error of at most 3e-4 of the radius) and straight borders;
/// empty if nothing is inside.
///
/// ```text
///   +-----------+      arcs run with increasing angle; where the circle leaves over one side and returns over
///   |      .--. |      another, the border turns at the corner between them
///   |     (    )|
///   +------`--'-+
/// ```
pub fn clip_disc(centre: Point, radius: f64, rect: Rect) -> BezPath {
    let on_circle = |angle: f64| centre + unit_at(angle) * radius;
    let mut angles = crossings(centre, radius, rect);
    angles.sort_unstable_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
    let mut path = BezPath::new();
    if angles.len() < 2 {
        if rect.contains(centre) && rect.inflate(1e-9, 1e-9).contains(on_circle(angles.first().map_or(0.3, |a| a + 0.3))) {
            append_arc(&mut path, centre, radius, 0.0, TAU);
            path.close_path();
        }
        return path;
    }
    for (i, &from) in angles.iter().enumerate() {
        let to = if i + 1 < angles.len() { angles[i + 1] } else { angles[0] + TAU };
        if !rect.contains(on_circle(0.5 * (from + to))) {
            continue;
        }
        if let Some(corner) =
            path.elements().last().and_then(kurbo::PathEl::end_point).and_then(|last| corner_between(last, on_circle(from), rect))
        {
            path.line_to(corner);
        }
        append_arc(&mut path, centre, radius, from, to);
    }
    let (first, last) =
        (path.elements().first().and_then(kurbo::PathEl::end_point), path.elements().last().and_then(kurbo::PathEl::end_point));
    if let (Some(first), Some(last)) = (first, last) {
        if let Some(corner) = corner_between(last, first, rect) {
            path.line_to(corner);
        }
        path.close_path();
    }
    path
}

/// Angles at which a circle crosses the sides of a rectangle.
fn crossings(centre: Point, radius: f64, rect: Rect) -> Vec<f64> {
    let mut angles = Vec::new();
    for x in [rect.x0, rect.x1] {
        let cosine = (x - centre.x) / radius;
        if cosine.abs() < 1.0 {
            let angle = cosine.arc_cosine();
            angles.extend([angle, -angle].into_iter().filter(|a| (rect.y0..=rect.y1).contains(&(centre.y + radius * a.sine()))));
        }
    }
    for y in [rect.y0, rect.y1] {
        let sine = (y - centre.y) / radius;
        if sine.abs() < 1.0 {
            let angle = sine.arc_sine();
            let both = [angle, 2.0 * FRAC_PI_2 - angle];
            angles.extend(both.into_iter().filter(|a| (rect.x0..=rect.x1).contains(&(centre.x + radius * a.cosine()))));
        }
    }
    angles.into_iter().map(|a| a.rem_euclid(TAU)).collect()
}

/// The corner between a point on one side and a point on an adjacent side.
fn corner_between(a: Point, b: Point, rect: Rect) -> Option<Point> {
    let side_x = |p: Point| [rect.x0, rect.x1].into_iter().find(|x| (p.x - x).abs() < 1e-9);
    let side_y = |p: Point| [rect.y0, rect.y1].into_iter().find(|y| (p.y - y).abs() < 1e-9);
    match ((side_x(a), side_y(a)), (side_x(b), side_y(b))) {
        ((Some(x), None), (None, Some(y))) | ((None, Some(y)), (Some(x), None)) => Some(Point::new(x, y)),
        _ => None,
    }
}

/// Appends an arc as cubics of at most a quarter turn; starts the path if it is empty.
fn append_arc(path: &mut BezPath, centre: Point, radius: f64, from: f64, to: f64) {
    let count = ((to - from) / FRAC_PI_2 - 1e-9).ceil().max(1.0);
    let step = (to - from) / count;
    let handle = radius * 4.0 / 3.0 * (step / 4.0).tangent();
    let start = centre + unit_at(from) * radius;
    if path.elements().is_empty() {
        path.move_to(start);
    } else {
        path.line_to(start);
    }
    for i in 0..count as usize {
        let (a, b) = (unit_at(from + step * i as f64), unit_at(from + step * (i as f64 + 1.0)));
        let (p, q) = (centre + a * radius, centre + b * radius);
        path.curve_to(p + a.turn_90() * handle, q - b.turn_90() * handle, q);
    }
}

/// The pieces of a polyline inside a rectangle, in order and direction. Each point has its position along the line (vertex index
/// plus fraction), for interpolating widths and pressure.
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
        if let Some(piece) = pieces.last_mut()
            && t1 > t0
        {
            piece.push(at(t1));
        }
        open = t1 == 1.0;
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

/// The parameter range of a segment inside a rectangle (Liang and Barsky 1984).
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
    fn a_disc_is_cut_at_sides_and_corners() {
        use kurbo::Shape;
        let page = Rect::new(0.0, 0.0, 10.0, 10.0);
        let whole = std::f64::consts::PI;
        for (x, y, expected) in [
            (5.0, 5.0, whole),
            (0.0, 5.0, 0.5 * whole),
            (10.0, 10.0, 0.25 * whole),
            (0.0, 10.0, 0.25 * whole),
            (5.0, 10.0, 0.5 * whole),
            (-0.9999, 5.0, 0.0),
            (-3.0, 5.0, 0.0),
            (
                9.5,
                9.5,
                crate::geometry::disc_area_in(
                    &[Point::ORIGIN, Point::new(10.0, 0.0), Point::new(10.0, 10.0), Point::new(0.0, 10.0)],
                    Point::new(9.5, 9.5),
                    1.0,
                ),
            ),
        ] {
            let cut = clip_disc(Point::new(x, y), 1.0, page);
            assert!((cut.area().abs() - expected).abs() < 2e-3, "({x}, {y}): {} for {expected}", cut.area());
            assert!(cut.elements().is_empty() || page.inflate(1e-3, 1e-3).union(cut.bounding_box()) == page.inflate(1e-3, 1e-3));
        }
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
