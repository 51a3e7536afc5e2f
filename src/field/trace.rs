//! The edge tracer of Wong 1999, section 6.3.2: from edge pixels to polylines.
//!
//! ```text
//!   . . . . . . . .        1. a seed pixel and its one or two directions, from the connected pixels within radius 3
//!   . . . o-.-.> .         2. a step of 3 along the direction predicts the next point
//!   . o o . .[. .].        3. the edge pixel nearest to it in a 5 x 5 window is the next vertex
//!   o . . . .[. x].        4. the direction is averaged with the step just made; pixels passed are marked as visited
//!   . . . . .[. .].        5. lines whose ends agree in place and direction are linked
//! ```
//!
//! The thesis stops at a crossing that an earlier line has marked. This tracer looks one window further in the same direction, so that
//! lines continue across crossings.

use super::curve::Curve;
use super::linking::{LINK_COSINE, link};
use crate::geometry::{Point, Vec2, distance_to_segment};
use crate::raster::Raster;

/// Radius for reading the first directions, in pixels (Wong: 3).
const SEED_RADIUS: f64 = 3.0;
/// Length of a step, in pixels (Wong: 3).
const STEP: f64 = 3.0;
/// Half the side of the search window, in pixels (Wong: a 5 x 5 window).
const WINDOW: isize = 2;
/// Edge pixels within this distance of a traced segment belong to it: lines must be accurate to 2 px.
const MARK_DISTANCE: f64 = 1.9;

/// Traces a binary raster of lines one or two pixels wide (thin them first) into polylines, each line once.
pub fn trace(edges: &Raster<u8>) -> Vec<Curve> {
    let mut tracer = Tracer { edges, visited: edges.map(|_| false) };
    let mut lines = Vec::new();
    // Crossings fail in the first scan; the second takes up their remains, by their most opposite directions.
    for attempt in [Attempt::PlainLines, Attempt::Remains] {
        for y in 0..edges.height() {
            for x in 0..edges.width() {
                if tracer.is_fresh(x as isize, y as isize)
                    && let Some(line) = tracer.line_through(x as isize, y as isize, attempt)
                {
                    lines.push(line);
                }
            }
        }
    }
    link(lines)
}

#[derive(Clone, Copy, PartialEq)]
enum Attempt {
    PlainLines,
    Remains,
}

struct Tracer<'a> {
    edges: &'a Raster<u8>,
    visited: Raster<bool>,
}

fn centre(x: isize, y: isize) -> Point {
    Point::new(x as f64 + 0.5, y as f64 + 0.5)
}

impl Tracer<'_> {
    fn is_edge(&self, x: isize, y: isize) -> bool {
        self.edges.contains(x, y) && self.edges.get(x as usize, y as usize) != 0
    }

    fn is_fresh(&self, x: isize, y: isize) -> bool {
        self.is_edge(x, y) && !self.visited.get(x as usize, y as usize)
    }

    /// The line through a seed pixel; none if the pixel is isolated or at a crossing.
    fn line_through(&mut self, x: isize, y: isize, attempt: Attempt) -> Option<Vec<Point>> {
        let seed = centre(x, y);
        let directions = self.initial_directions(x, y);
        let chosen = match (directions.len(), attempt) {
            (1 | 2, _) => directions,
            (3.., Attempt::Remains) => most_opposite(&directions),
            _ => return None,
        };
        self.mark_along(seed, seed);
        let mut line: Vec<Point> = self.follow(seed, chosen[0]);
        line.reverse();
        line.push(seed);
        if let Some(&second) = chosen.get(1) {
            line.extend(self.follow(seed, second));
        }
        (line.len() > 1).then_some(line)
    }

    /// Mean directions to the groups of connected fresh pixels on the rim of the seed's neighbourhood.
    fn initial_directions(&self, x: isize, y: isize) -> Vec<Vec2> {
        let reach = SEED_RADIUS as isize;
        let mut connected = vec![(x, y)];
        let mut next = 0;
        while let Some(&(cx, cy)) = connected.get(next) {
            next += 1;
            for (nx, ny) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (cx + dx, cy + dy))) {
                let is_near = (nx - x).abs() <= reach && (ny - y).abs() <= reach;
                if is_near && self.is_fresh(nx, ny) && !connected.contains(&(nx, ny)) {
                    connected.push((nx, ny));
                }
            }
        }
        let on_rim = |&(px, py): &(isize, isize)| (px - x).abs().max((py - y).abs()) == reach;
        let mut rim: Vec<(isize, isize)> = connected.iter().copied().filter(on_rim).collect();
        if rim.is_empty() && connected.len() > 1 {
            // A short remnant: its farthest pixel gives the direction.
            rim = connected[1..]
                .iter()
                .copied()
                .max_by_key(|&(px, py)| ((px - x).pow(2) + (py - y).pow(2), px, py))
                .into_iter()
                .collect();
        }
        grouped(&rim).iter().map(|group| mean_direction(group, x, y)).collect()
    }

    /// Vertices from `from` (not included) in one direction until the line ends.
    fn follow(&mut self, from: Point, direction: Vec2) -> Vec<Point> {
        let mut line = Vec::new();
        let (mut here, mut direction) = (from, direction);
        while let Some(next) = self.next_vertex(here, direction) {
            self.mark_along(here, next);
            let step = (next - here).normalize();
            direction = (direction + step).normalize();
            here = next;
            line.push(next);
        }
        line
    }

    /// The fresh edge pixel nearest to the predicted point; across pixels already visited, the window after that.
    fn next_vertex(&self, here: Point, direction: Vec2) -> Option<Point> {
        let ahead = |next: Point, cosine: f64| (next - here).dot(direction) > cosine * next.distance(here);
        let near = self.nearest_fresh(here + direction * STEP).filter(|&next| ahead(next, 0.0));
        near.or_else(|| {
            let crosses = self.is_visited_edge_near(here + direction * STEP);
            let beyond = self.nearest_fresh(here + direction * (2.0 * STEP));
            beyond.filter(|&next| crosses && ahead(next, LINK_COSINE))
        })
    }

    fn window(around: Point) -> impl Iterator<Item = (isize, isize)> {
        let (cx, cy) = (around.x.floor() as isize, around.y.floor() as isize);
        (-WINDOW..=WINDOW).flat_map(move |dy| (-WINDOW..=WINDOW).map(move |dx| (cx + dx, cy + dy)))
    }

    fn nearest_fresh(&self, predicted: Point) -> Option<Point> {
        Self::window(predicted)
            .filter(|&(x, y)| self.is_fresh(x, y))
            .map(|(x, y)| centre(x, y))
            .min_by(|a, b| a.distance_squared(predicted).total_cmp(&b.distance_squared(predicted)))
    }

    fn is_visited_edge_near(&self, predicted: Point) -> bool {
        Self::window(predicted).any(|(x, y)| self.is_edge(x, y))
    }

    /// Marks the edge pixels that belong to a segment.
    fn mark_along(&mut self, a: Point, b: Point) {
        let reach = MARK_DISTANCE.ceil() as isize;
        let (x0, x1) = (a.x.min(b.x) as isize - reach, a.x.max(b.x) as isize + reach);
        let (y0, y1) = (a.y.min(b.y) as isize - reach, a.y.max(b.y) as isize + reach);
        for y in y0..=y1 {
            for x in x0..=x1 {
                if self.is_fresh(x, y) && distance_to_segment(centre(x, y), a, b) <= MARK_DISTANCE {
                    self.visited.set(x as usize, y as usize, true);
                }
            }
        }
    }
}

/// Rim pixels in groups of neighbours.
fn grouped(rim: &[(isize, isize)]) -> Vec<Vec<(isize, isize)>> {
    let mut groups: Vec<Vec<(isize, isize)>> = Vec::new();
    for &pixel in rim {
        let touches =
            |group: &Vec<(isize, isize)>| group.iter().any(|&(x, y)| (x - pixel.0).abs() <= 1 && (y - pixel.1).abs() <= 1);
        let (touching, mut apart): (Vec<_>, Vec<_>) = groups.into_iter().partition(touches);
        apart.push(touching.into_iter().flatten().chain([pixel]).collect());
        groups = apart;
    }
    groups
}

fn mean_direction(group: &[(isize, isize)], x: isize, y: isize) -> Vec2 {
    let sum = group.iter().fold(Vec2::ZERO, |sum, &(px, py)| sum + Vec2::new((px - x) as f64, (py - y) as f64).normalize());
    if sum.hypot() > 1e-6 { sum.normalize() } else { Vec2::new(1.0, 0.0) }
}

fn most_opposite(directions: &[Vec2]) -> Vec<Vec2> {
    let mut best = (f64::INFINITY, vec![directions[0]]);
    for (i, &a) in directions.iter().enumerate() {
        for &b in &directions[..i] {
            if a.dot(b) < best.0 {
                best = (a.dot(b), vec![a, b]);
            }
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    /// Draws segments one pixel wide.
    fn drawn(size: usize, lines: &[&[(f64, f64)]]) -> Raster<u8> {
        let mut raster = Raster::filled(size, size, 0_u8);
        for line in lines {
            for pair in line.windows(2) {
                let steps = ((pair[1].0 - pair[0].0).abs().max((pair[1].1 - pair[0].1).abs()) * 2.0).ceil().max(1.0);
                for i in 0..=steps as usize {
                    let t = i as f64 / steps;
                    let x = pair[0].0 + t * (pair[1].0 - pair[0].0);
                    let y = pair[0].1 + t * (pair[1].1 - pair[0].1);
                    if raster.contains(x.floor() as isize, y.floor() as isize) {
                        raster.set(x as usize, y as usize, 1);
                    }
                }
            }
        }
        crate::raster::thin(&raster)
    }

    fn circle(x: f64, y: f64, r: f64) -> Vec<(f64, f64)> {
        (0..=120).map(|i| f64::from(i) * std::f64::consts::TAU / 120.0).map(|a| (x + r * a.cosine(), y + r * a.sine())).collect()
    }

    fn distance_to(curve: &Curve, p: Point) -> f64 {
        let mut points = curve.points.clone();
        if curve.closed {
            points.push(points[0]);
        }
        points.windows(2).map(|w| distance_to_segment(p, w[0], w[1])).fold(f64::INFINITY, f64::min)
    }

    /// Every edge pixel lies within 2 px of a line, and the lines are hardly longer than what was drawn: none is traced twice.
    fn check(edges: &Raster<u8>, lines: &[Curve]) {
        let mut pixels = 0.0;
        for y in 0..edges.height() {
            for x in 0..edges.width() {
                if edges.get(x, y) != 0 {
                    pixels += 1.0;
                    let p = centre(x as isize, y as isize);
                    let nearest = lines.iter().map(|line| distance_to(line, p)).fold(f64::INFINITY, f64::min);
                    assert!(nearest <= 2.0, "pixel ({x}, {y}) is {nearest} px from any line");
                }
            }
        }
        let length: f64 = lines.iter().map(Curve::length).sum();
        assert!(length < 1.42 * pixels, "{length} px of line for {pixels} pixels");
    }

    #[test]
    fn a_straight_line_is_one_line() {
        for end in [(90.0, 50.0), (90.0, 90.0), (30.0, 95.0), (12.0, 90.0)] {
            let edges = drawn(100, &[&[(10.5, 10.5), end]]);
            let lines = trace(&edges);
            check(&edges, &lines);
            assert_eq!(lines.len(), 1, "to {end:?}");
            assert!(!lines[0].closed);
        }
    }

    #[test]
    fn a_circle_is_one_closed_line() {
        for r in [8.0, 20.0, 40.0] {
            let edges = drawn(100, &[&circle(50.0, 50.0, r)]);
            let lines = trace(&edges);
            check(&edges, &lines);
            assert_eq!(lines.len(), 1, "radius {r}");
            assert!(lines[0].closed, "radius {r}");
        }
    }

    #[test]
    fn crossings_give_continuous_lines() {
        for (a, b) in [((10.0, 12.0), (90.0, 85.0)), ((50.5, 10.0), (50.5, 90.0)), ((20.0, 90.0), (80.0, 10.0))] {
            let edges = drawn(100, &[&[(5.5, 50.5), (95.0, 50.5)], &[a, b]]);
            let lines = trace(&edges);
            check(&edges, &lines);
            assert_eq!(lines.len(), 2, "{a:?} {b:?}: {lines:?}");
        }
    }

    #[test]
    fn borders_curves_and_parallels() {
        let wave: Vec<(f64, f64)> = (0..100).map(|i| (f64::from(i), 30.0 + 12.0 * (f64::from(i) / 12.0).sine())).collect();
        let edges = drawn(100, &[&wave, &[(0.0, 60.5), (99.9, 60.5)], &[(0.0, 66.5), (99.9, 66.5)], &[(0.5, 80.0), (0.5, 99.9)]]);
        let lines = trace(&edges);
        check(&edges, &lines);
        assert_eq!(lines.len(), 4, "{lines:?}");
    }

    #[test]
    fn lone_pixels_are_no_line() {
        let mut edges = Raster::filled(20, 20, 0_u8);
        edges.set(5, 5, 1);
        assert!(trace(&edges).is_empty());
        assert!(trace(&Raster::filled(0, 0, 0_u8)).is_empty());
    }
}
