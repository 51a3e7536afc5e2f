//! Chooses where each loop is entered: the point that minimizes the way from the stop before to the stop after.
//!
//! ```text
//!                     ____            The pen comes from a and goes on to b: it enters the loop where the way over it is
//!        a .----->---/    \           shortest, which may be on an edge. As the stops before and after may be loops too,
//!                   |      |---> . b  a loop is seated again whenever one of its neighbours has moved, and moved elsewhere
//!                    \____/           in the tour if it lies nearer to another link.
//! ```

use crate::parallel::collected;
use std::collections::VecDeque;

use kurbo::Point;

use super::ends::End;
use super::sites::Sites;
use super::stops::{PathEnds, Stop};
use super::tour::Tour;
use crate::geometry::kd_tree::KdTree;
use crate::interrupt::Interrupt;

/// Points along a large loop near which links are searched, and ends near each: chosen to reach all sides of it, not tuned yet.
const SAMPLES: usize = 8;
const ENDS_NEAR: usize = 4;

/// Number of ends examined around a loop that is small compared with its distance to them.
const ENDS_AROUND: usize = 8;

/// Maximum seatings per loop, on average: limits the work, as gains shrink with each round.
const MOST_TURNS: usize = 20;

/// Minimum gain in millimetres of an entry between two vertices over one at a vertex, as it adds a vertex.
const EDGE_GAIN: f64 = 1e-3;

/// Chooses new entries for the tour's loops and changes the stops' ends accordingly. Returns the entries from the free end on,
/// and the millimetres gained. The tour never becomes longer. O(n log n) and some hundred evaluations per vertex of a loop.
pub(super) fn with_best_entries(stops: &mut [Stop], numbering: &[usize], sites: &Sites, tour: &Tour) -> (Vec<End>, f64) {
    let mut seating = Seating::new(stops, numbering, sites, tour);
    let gained = seating.settle(tour);
    for (path, &stop) in numbering.iter().enumerate() {
        if stops[stop].ring.is_some() {
            let at = seating.at[2 * path];
            stops[stop].ends = PathEnds { start: at, end: at };
            stops[stop].edge = seating.edge[path];
        }
    }
    let from = sites.free_end();
    let entries = std::iter::successors(Some(from), |&entered| Some(seating.link[(entered ^ 1) as usize]));
    (entries.take(sites.path_count()).collect(), gained)
}

/// Chooses the entries of the loops among a few visits, keeping the order. Returns the millimetres gained.
pub(super) fn choose_loop_entries(stops: &mut [Stop], order: &[usize], home: Point) -> f64 {
    let mut gained = 0.0;
    for i in 0..order.len() {
        let Some(ring) = stops[order[i]].ring else { continue };
        let before = if i == 0 { home } else { stops[order[i - 1]].ends.end };
        let behind = order.get(i + 1).map(|&next| stops[next].ends.start);
        let old = way(Some(before), behind, stops[order[i]].ends.start);
        let seat = best_seat(ring, Some(before), behind);
        if seat.way < old {
            gained += old - seat.way;
            stops[order[i]].ends = PathEnds { start: seat.at, end: seat.at };
            stops[order[i]].edge = seat.edge;
        }
    }
    gained
}

/// A loop with its bounding circle.
struct Ring<'a> {
    points: &'a [Point],
    centre: Point,
    radius: f64,
    /// Ends near it, into whose links it might be inserted.
    near: Vec<End>,
}

/// A point at which to enter a loop.
#[derive(Clone, Copy)]
struct Seat {
    edge: usize,
    at: Point,
    /// Length of the way through it.
    way: f64,
}

struct Seating<'a> {
    free: End,
    tolerance: f64,
    interrupt: Interrupt,
    rings: Vec<Option<Ring<'a>>>,
    at: Vec<Point>,
    edge: Vec<usize>,
    link: Vec<End>,
}

impl<'a> Seating<'a> {
    fn new(stops: &[Stop<'a>], numbering: &[usize], sites: &Sites, tour: &Tour) -> Self {
        let ends = 0..sites.end_count() as End;
        let at: Vec<Point> = ends.clone().map(|end| sites.place(end)).collect();
        let tree = KdTree::new(ends.clone().filter(|&end| end != sites.free_end()).map(|end| (sites.place(end), end)).collect());
        let ring = |path: usize| stops[numbering[path]].ring.map(|points| Ring::new(points, path as End, &tree));
        let rings = collected(numbering.len(), &ring);
        let edge = numbering.iter().map(|&stop| stops[stop].edge).collect();
        let link = ends.map(|end| tour.link(end)).collect();
        Self { free: sites.free_end(), tolerance: sites.tolerance(), interrupt: sites.interrupt().clone(), rings, at, edge, link }
    }

    /// Seats loops until none moves. Returns the millimetres gained.
    fn settle(&mut self, tour: &Tour) -> f64 {
        let is_ring = |rings: &[Option<Ring>], path: usize| rings.get(path).is_some_and(Option::is_some);
        let paths = (0..tour.len()).map(|seat| tour.entry(seat) as usize >> 1);
        let mut waiting: VecDeque<usize> = paths.filter(|&path| is_ring(&self.rings, path)).collect();
        let mut is_waiting: Vec<bool> = self.rings.iter().map(Option::is_some).collect();
        let mut gained = 0.0;
        let mut turns = MOST_TURNS * waiting.len();
        while let Some(path) = waiting.pop_front().filter(|_| turns > 0 && !self.interrupt.is_raised()) {
            turns -= 1;
            is_waiting[path] = false;
            let around = |link: &[End]| [2 * path, 2 * path + 1].map(|end| link[end] as usize >> 1);
            let before = around(&self.link);
            let gain = self.seat(path);
            if gain > 0.0 {
                gained += gain;
                let moved = before.into_iter().chain(around(&self.link)).chain([path]);
                for next in moved.filter(|&next| is_ring(&self.rings, next)) {
                    if !std::mem::replace(&mut is_waiting[next], true) {
                        waiting.push_back(next);
                    }
                }
            }
        }
        gained
    }

    /// Moves one loop to the best position in the tour with the best entry, and returns the millimetres gained.
    fn seat(&mut self, path: usize) -> f64 {
        let Some(ring) = &self.rings[path] else { return 0.0 };
        let ends = [2 * path as End, 2 * path as End + 1];
        let (a, b) = (self.link[ends[0] as usize], self.link[ends[1] as usize]);
        if a >> 1 == b >> 1 {
            return 0.0;
        }
        let saved = way(self.place(a), self.place(b), self.at[2 * path]) - self.gap(a, b);
        let mut best: Option<(End, End, Seat)> = None;
        let mut least = saved - self.tolerance;
        let elsewhere = ring.near.iter().map(|&end| (end, self.link[end as usize]));
        for (u, v) in std::iter::once((a, b)).chain(elsewhere) {
            let gap = self.gap(u, v);
            let is_own = |end: End| end >> 1 == path as End;
            let least_way = |end| self.place(end).map_or(0.0, |p: Point| (p.distance(ring.centre) - ring.radius).max(0.0));
            if is_own(u) || is_own(v) || least_way(u) + least_way(v) - gap >= least {
                continue;
            }
            let seat = best_seat(ring.points, self.place(u), self.place(v));
            if seat.way - gap < least {
                least = seat.way - gap;
                best = Some((u, v, seat));
            }
        }
        let Some((u, v, seat)) = best else { return 0.0 };
        self.join(a, b);
        self.join(u, ends[0]);
        self.join(v, ends[1]);
        self.at[2 * path] = seat.at;
        self.at[2 * path + 1] = seat.at;
        self.edge[path] = seat.edge;
        saved - least
    }

    fn join(&mut self, a: End, b: End) {
        self.link[a as usize] = b;
        self.link[b as usize] = a;
    }

    /// Position of an end; none for the free end, which is 0 mm from everything.
    fn place(&self, end: End) -> Option<Point> {
        (end != self.free).then(|| self.at[end as usize])
    }

    fn gap(&self, a: End, b: End) -> f64 {
        self.place(a).zip(self.place(b)).map_or(0.0, |(a, b)| a.distance(b))
    }
}

impl<'a> Ring<'a> {
    fn new(points: &'a [Point], path: End, tree: &KdTree) -> Self {
        let corner =
            |pick: fn(f64, f64) -> f64| points.iter().copied().fold(points[0], |p, q| Point::new(pick(p.x, q.x), pick(p.y, q.y)));
        let centre = corner(f64::min).midpoint(corner(f64::max));
        let radius = points.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
        let is_other = |end: End| end >> 1 != path;
        let mut nearest = Vec::new();
        tree.nearest((centre, End::MAX), ENDS_AROUND, is_other, &mut nearest);
        let mut near: Vec<End> = nearest.iter().map(|&(_, end)| end).collect();
        if nearest.first().is_some_and(|&(squared, _)| squared.sqrt() < 3.0 * radius) {
            for i in 0..SAMPLES {
                tree.nearest((points[i * (points.len() - 1) / SAMPLES], End::MAX), ENDS_NEAR, is_other, &mut nearest);
                near.extend(nearest.iter().map(|&(_, end)| end));
            }
            near.sort_unstable();
            near.dedup();
        }
        Self { points, centre, radius, near }
    }
}

/// Length of the way from `a` through `p` to `b`; a missing point adds nothing.
fn way(a: Option<Point>, b: Option<Point>, p: Point) -> f64 {
    a.map_or(0.0, |a| a.distance(p)) + b.map_or(0.0, |b| b.distance(p))
}

/// The point on a loop through which the way from `a` to `b` is shortest.
fn best_seat(ring: &[Point], a: Option<Point>, b: Option<Point>) -> Seat {
    let over = |p| way(a, b, p);
    let mut best = Seat { edge: 0, at: ring[0], way: over(ring[0]) };
    for (edge, &at) in ring.iter().enumerate().take(ring.len() - 1) {
        if over(at) < best.way {
            best = Seat { edge, at, way: over(at) };
        }
    }
    let mut at_start = over(ring[0]);
    for (edge, side) in ring.windows(2).enumerate() {
        let at_end = over(side[1]);
        // Along the edge the way shrinks by at most twice the distance moved.
        let least = f64::midpoint(at_start, at_end) - side[0].distance(side[1]);
        at_start = at_end;
        if least + EDGE_GAIN < best.way {
            let at = best_on_edge(side[0], side[1], a, b);
            if over(at) + EDGE_GAIN < best.way {
                best = Seat { edge, at, way: over(at) };
            }
        }
    }
    best
}

/// The best entry on one edge: where the straight line from `a` to `b`, mirrored at the edge if both lie on the same side, crosses the
/// edge. The way is convex along the edge, so beyond its ends the nearer end is best.
fn best_on_edge(from: Point, to: Point, a: Option<Point>, b: Option<Point>) -> Point {
    let along = to - from;
    let length = along.hypot();
    let position = |p: Point| ((p - from).dot(along) / length, ((p - from).cross(along) / length).abs());
    let at = match (a.map(position), b.map(position)) {
        (Some((x, y)), Some((u, v))) if y + v > 0.0 => x + (u - x) * y / (y + v),
        (Some((x, _)), _) | (None, Some((x, _))) => x,
        (None, None) => 0.0,
    };
    let at = (at / length).clamp(0.0, 1.0);
    if at.is_finite() { from + along * at } else { from }
}
