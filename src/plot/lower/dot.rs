//! Fills a dot with one nib: a touch, a ring, or a spiral that ends in a full ring.
//!
//! ```text
//!   r <= w/2      r <= w          r > w
//!      .           ( )         ((( @ )))      the outermost ring's edge is the dot's edge
//! ```

use super::super::Toolpath;
use crate::drawing::Dot;
use crate::elementary::{Elementary as _, unit_at};
use crate::geometry::{BezPath, Point, Vec2, flatten};
use crate::interrupt::Interrupt;
use std::f64::consts::TAU;

/// Overlap of neighbouring turns, as a share of the nib. With 0, a pen that wears or skips leaves hairlines; with a third, the
/// paper is soaked and time is lost.
pub(super) const OVERLAP: f64 = 0.1;

/// The path that fills a dot with a nib of width `nib`, as one pen-down path.
///
/// A radius up to half a nib gives a touch at the centre. A larger one gives a ring half a nib inside the outline; from one nib
/// on, the ring is preceded by a spiral from the centre outwards whose turns are at most `nib (1 - OVERLAP)` apart. Once a disc
/// is 30 nibs wide, its path is at most 6 % longer than its area over that distance.
pub(super) fn fill_dot(dot: &Dot, nib: f64, tolerance: f64, interrupt: &Interrupt) -> Toolpath {
    let inside = dot.radius - 0.5 * nib;
    // A ring smaller than this is lost in the nib's own roundness.
    if inside <= 0.02 * nib {
        return Toolpath::touch(dot.centre);
    }
    let rim = Rim::of(dot, nib);
    let ring = ring(&rim, tolerance);
    if dot.radius > nib {
        let mut path = spiral(&rim, nib * (1.0 - OVERLAP), tolerance, interrupt);
        path.extend(ring.points().iter().copied());
        path
    } else {
        ring
    }
}

/// The ring that the nib's centre follows, as distances from the dot's centre by angle.
struct Rim {
    centre: Point,
    /// At evenly spaced angles from 0; a single value for a circle.
    distances: Vec<f64>,
}

/// Number of directions in which a blob's outline is measured; a blob has six lobes.
const DIRECTIONS: usize = 96;

impl Rim {
    fn of(dot: &Dot, nib: f64) -> Self {
        let distances = match &dot.outline {
            None => vec![dot.radius - 0.5 * nib],
            Some(outline) => {
                let outline = distances(outline, dot.centre);
                // A nib as large as the blob is limited by two directions on either side, a fine one only by its own direction.
                let reach = (nib / dot.radius) as usize;
                (0..DIRECTIONS).map(|i| (least_around(&outline, i, reach.min(2)) - 0.5 * nib).max(0.0)).collect()
            }
        };
        Self { centre: dot.centre, distances }
    }

    /// The point at this angle and share of the way out (0 the centre, 1 the rim).
    fn at(&self, angle: f64, share: f64) -> Point {
        let count = self.distances.len();
        let position = angle.rem_euclid(TAU) / TAU * count as f64;
        let (i, t) = (position as usize % count, position.fract());
        let distance = self.distances[i] * (1.0 - t) + self.distances[(i + 1) % count] * t;
        self.centre + unit_at(angle) * (share * distance)
    }

    fn largest(&self) -> f64 {
        self.distances.iter().copied().fold(0.0, f64::max)
    }
}

/// The least distance within a few directions: where the outline is oblique, the nib's side meets it before its front does.
fn least_around(outline: &[f64], i: usize, reach: usize) -> f64 {
    (DIRECTIONS - reach..=DIRECTIONS + reach).map(|step| outline[(i + step) % DIRECTIONS]).fold(f64::INFINITY, f64::min)
}

/// Distance of an outline from a point inside, by angle; the greatest if it is crossed several times.
fn distances(outline: &BezPath, centre: Point) -> Vec<f64> {
    let polygon: Vec<Point> = flatten(outline, 0.002).into_iter().flat_map(|(points, _)| points).collect();
    (0..DIRECTIONS)
        .map(|i| {
            let ray = unit_at(TAU * i as f64 / DIRECTIONS as f64);
            let crossing = |a: Vec2, b: Vec2| {
                let edge = b - a;
                let (along, across) = (a.cross(edge) / ray.cross(edge), a.cross(ray) / ray.cross(edge));
                ((0.0..=1.0).contains(&across) && along > 0.0).then_some(along)
            };
            let edges = (0..polygon.len()).map(|k| (polygon[k] - centre, polygon[(k + 1) % polygon.len()] - centre));
            edges.filter_map(|(a, b)| crossing(a, b)).fold(0.0, f64::max)
        })
        .collect()
}

/// Turns from the centre outwards, ending on the rim at angle 0.
fn spiral(rim: &Rim, pitch: f64, tolerance: f64, interrupt: &Interrupt) -> Toolpath {
    let turns = (rim.largest() / pitch).ceil().max(1.0);
    let mut points = Vec::new();
    let mut turned = 0.0;
    loop {
        // A chord of a circle of radius r strays from it by r (1 - cos(step / 2)).
        let radius = rim.largest() * turned / turns;
        turned += step(radius.max(0.25 * pitch), tolerance) / TAU;
        if turned >= turns || interrupt.is_raised() {
            return Toolpath::through(rim.centre, points);
        }
        points.push(rim.at(TAU * turned, turned / turns));
    }
}

/// Once round from angle 0 back to it.
fn ring(rim: &Rim, tolerance: f64) -> Toolpath {
    let count = (TAU / step(rim.largest(), tolerance)).ceil();
    // Vertices lie slightly outside, so that the chords' mean distance is the rim's.
    let share = 1.0 / (1.0 - 2.0 / 3.0 * (1.0 - (0.5 * TAU / count).cosine()));
    let start = rim.at(0.0, share);
    Toolpath::through(start, (1..count as usize).map(|i| rim.at(TAU * i as f64 / count, share)).chain([start]))
}

/// The angle whose chord stays within the tolerance; at most a twelfth of a turn, so that small rings stay round.
fn step(radius: f64, tolerance: f64) -> f64 {
    (2.0 * (1.0 - (tolerance / radius).min(1.0)).arc_cosine()).clamp(0.02, TAU / 12.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::blob;
    use rand::SeedableRng;
    use rand::rngs::ChaCha8Rng;

    /// The shares of the dot's grid points that are covered, and of ink outside.
    fn check(dot: &Dot, nib: f64, inside: impl Fn(Point) -> bool) -> (f64, f64) {
        let path = fill_dot(dot, nib, 0.01, &Interrupt::never());
        let path = path.points();
        let steps = 160;
        let reach = 1.6 * dot.radius;
        let (mut asked, mut covered, mut spilt) = (0.0, 0.0, 0.0);
        for i in 0..steps {
            for j in 0..steps {
                let offset =
                    Vec2::new(f64::from(2 * i - steps) / f64::from(steps), f64::from(2 * j - steps) / f64::from(steps)) * reach;
                let p = dot.centre + offset;
                let near = |w: &[Point]| {
                    let d = w[1] - w[0];
                    let t = if d.hypot2() > 0.0 { ((p - w[0]).dot(d) / d.hypot2()).clamp(0.0, 1.0) } else { 0.0 };
                    p.distance(w[0] + d * t) <= 0.5 * nib
                };
                let under = if path.len() == 1 { p.distance(path[0]) <= 0.5 * nib } else { path.windows(2).any(near) };
                asked += f64::from(u8::from(inside(p)));
                covered += f64::from(u8::from(under && inside(p)));
                spilt += f64::from(u8::from(under && !inside(p)));
            }
        }
        (covered / asked, spilt / asked)
    }

    #[test]
    fn discs_are_covered_and_nothing_else_is() {
        for radius in [0.16, 0.2, 0.3, 0.31, 0.45, 0.7, 1.0, 2.0] {
            let dot = Dot::circle(Point::new(3.0, 4.0), radius);
            let (covered, spilt) = check(&dot, 0.3, |p| p.distance(dot.centre) <= radius);
            assert!(covered >= 0.985 && spilt <= 0.03, "radius {radius}: {covered} {spilt}");
        }
    }

    #[test]
    fn blobs_are_covered() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        for radius in [0.4, 0.8] {
            let centre = Point::new(1.0, 1.0);
            let outline = blob(centre, radius, 0.6, &mut random);
            let region = crate::geometry::Region::new(&outline, 0.001);
            let dot = Dot { centre, radius, outline: Some(Box::new(outline)), colour: None };
            let (covered, spilt) = check(&dot, 0.2, |p| region.contains(p));
            assert!(covered >= 0.975 && spilt <= 0.03, "radius {radius}: {covered} {spilt}");
        }
    }

    #[test]
    fn a_ten_millimetre_disc_is_one_path_and_hardly_longer_than_it_must_be() {
        let path = fill_dot(&Dot::circle(Point::ORIGIN, 5.0), 0.3, 0.02, &Interrupt::never());
        let least = std::f64::consts::PI * 25.0 / (0.3 * (1.0 - OVERLAP));
        let length = path.length();
        assert!(length <= 1.06 * least, "{length} for {least}");
        assert_eq!(fill_dot(&Dot::circle(Point::ORIGIN, 0.15), 0.3, 0.02, &Interrupt::never()).points(), [Point::ORIGIN]);
    }
}
