//! The area of a disc inside a convex cell, and its inverse: the radius that gives a wanted area of ink in the cell.
//!
//! This makes the dots' tone exact (Bruehl 2023, section 4.4 asks for it; Son et al. 2011, appendix B approximates it for the
//! square cell).

use crate::elementary::Elementary as _;
use kurbo::Point;

/// Area of the disc around `centre` that lies inside the polygon (any simple polygon, either orientation).
///
/// Sums over the edges the signed area between the centre, the edge and the circle; exact up to rounding.
pub fn disc_area_in(polygon: &[Point], centre: Point, radius: f64) -> f64 {
    disc_in(polygon, centre, radius).0
}

/// Area of the disc inside the polygon, and the total angle of its arcs inside, which gives the derivative: `dA/dr = r * angle`.
fn disc_in(polygon: &[Point], centre: Point, radius: f64) -> (f64, f64) {
    let (mut area, mut angle) = (0.0, 0.0);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (triangle, sector) = wedge((a.x - centre.x, a.y - centre.y), (b.x - centre.x, b.y - centre.y), radius);
        area += triangle + 0.5 * radius * radius * sector;
        angle += sector;
    }
    (area.abs(), angle.abs())
}

/// The part of the triangle (origin, a, b) within the circle of `radius` around the origin: the area of its straight-sided middle
/// and the angle of its sectors, both signed.
fn wedge(a: (f64, f64), b: (f64, f64), radius: f64) -> (f64, f64) {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length_squared = dx * dx + dy * dy;
    if length_squared == 0.0 {
        return (0.0, 0.0);
    }
    let cross = a.0 * b.1 - a.1 * b.0;
    let sector = |p: (f64, f64), q: (f64, f64)| (p.0 * q.1 - p.1 * q.0).angle_over(p.0 * q.0 + p.1 * q.1);
    // Where the line through a and b meets the circle: parameters t0 <= t1 of a + t (b - a).
    let half_chord_squared = radius * radius * length_squared - cross * cross;
    if half_chord_squared <= 0.0 {
        return (0.0, sector(a, b));
    }
    let middle = -(a.0 * dx + a.1 * dy) / length_squared;
    let half = half_chord_squared.sqrt() / length_squared;
    let (t0, t1) = ((middle - half).clamp(0.0, 1.0), (middle + half).clamp(0.0, 1.0));
    let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    let before = if t0 > 0.0 { sector(a, at(t0)) } else { 0.0 };
    let after = if t1 < 1.0 { sector(at(t1), b) } else { 0.0 };
    (0.5 * cross * (t1 - t0), before + after)
}

/// The radius of the disc around `centre` that covers `wanted` area of the polygon: 0 if `wanted` is 0 or less, the farthest
/// corner's distance if it is the whole polygon or more. Accurate to 1e-9 of the farthest corner's distance.
pub fn radius_for_area(polygon: &[Point], centre: Point, wanted: f64) -> f64 {
    let farthest = polygon.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
    if wanted <= 0.0 || polygon.len() < 3 {
        return 0.0;
    }
    if wanted >= disc_area_in(polygon, centre, farthest) {
        return farthest;
    }
    let (mut low, mut high) = (0.0, farthest);
    let mut radius = (wanted / std::f64::consts::PI).sqrt().min(farthest);
    for _ in 0..60 {
        let (area, angle) = disc_in(polygon, centre, radius);
        let error = area - wanted;
        if error > 0.0 {
            high = radius;
        } else {
            low = radius;
        }
        // Newton's step if it stays between the bounds, else bisection.
        let step = radius - error / (angle * radius);
        let next = if step > low && step < high { step } else { 0.5 * (low + high) };
        if (next - radius).abs() <= 1e-9 * farthest {
            return next;
        }
        radius = next;
    }
    radius
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn square() -> Vec<Point> {
        vec![Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(1.0, 1.0), Point::new(0.0, 1.0)]
    }

    #[test]
    fn known_areas() {
        let centre = Point::new(0.5, 0.5);
        assert!((disc_area_in(&square(), centre, 0.3) - PI * 0.09).abs() < 1e-12);
        assert!((disc_area_in(&square(), centre, 0.8) - 1.0).abs() < 1e-12);
        assert!((disc_area_in(&square(), Point::new(0.0, 0.0), 1.0) - PI / 4.0).abs() < 1e-12);
        let outside = disc_area_in(&square(), Point::new(-1.0, 0.5), 0.5);
        assert!(outside.abs() < 1e-12, "a disc that does not reach: {outside}");
    }

    #[test]
    fn matches_counting_points() {
        let cell = [Point::new(0.1, 0.0), Point::new(1.3, 0.2), Point::new(0.9, 1.1), Point::new(0.0, 0.7)];
        let (centre, radius) = (Point::new(0.7, 0.4), 0.55);
        let steps = 1200;
        let mut hits = 0;
        for i in 0..steps {
            for j in 0..steps {
                let p = Point::new(1.5 * (f64::from(i) + 0.5) / f64::from(steps), 1.5 * (f64::from(j) + 0.5) / f64::from(steps));
                let inside = (0..4).all(|k| {
                    let (a, b) = (cell[k], cell[(k + 1) % 4]);
                    (b - a).cross(p - a) >= 0.0
                });
                hits += i32::from(inside && p.distance(centre) < radius);
            }
        }
        let counted = f64::from(hits) * (1.5 / f64::from(steps)).powi(2);
        assert!((disc_area_in(&cell, centre, radius) - counted).abs() < 2e-4);
    }

    #[test]
    fn radius_inverts_area() {
        let centre = Point::new(0.45, 0.6);
        for percent in 1..100 {
            let wanted = f64::from(percent) / 100.0;
            let radius = radius_for_area(&square(), centre, wanted);
            assert!((disc_area_in(&square(), centre, radius) - wanted).abs() < 1e-7);
        }
        assert_eq!(radius_for_area(&square(), centre, 0.0), 0.0);
        assert!((radius_for_area(&square(), centre, 2.0) - Point::new(1.0, 0.0).distance(centre)).abs() < 1e-12);
    }
}
