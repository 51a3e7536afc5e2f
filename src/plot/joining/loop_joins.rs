//! Joins loops to paths that end on them: the loop is drawn in the same go, which saves a lift.
//!
//! ```text
//!                 ____
//!      a---------p    \          The path from a continues around the loop and ends where it met it. An end that meets the inside
//!                |     |         of an open path saves nothing: cut in two there, one half would still need a lift.
//!                 \____/
//! ```

use std::collections::HashMap;

use kurbo::{Point, Vec2};

use crate::interrupt::Interrupt;
use crate::order::Direction;
use crate::plot::Toolpath;

/// The sharpest turn from the path into the loop, as 1 - cos of the angle: 90 degrees, as where a stem meets a ring head-on.
const SHARPEST: f64 = 1.0 + 1e-6;

/// An end of a path on a loop.
struct Touch {
    turn: f64,
    gap: f64,
    /// The path, and whether it is its end rather than its start that meets the loop.
    path: usize,
    at_end: bool,
    ring: usize,
    edge: usize,
    place: Point,
    /// True if the loop is then drawn backwards.
    reversed: bool,
}

/// Joins each loop to a path with an end at most `tolerance` millimetres from it, if there is one; of several, the one with the
/// least turn. The turn is never above 90 degrees; with [`Direction::AsDrawn`], nothing is reversed. Each end is used once. Paths
/// with heights are left alone. O(number of vertices). Once the interrupt is raised, only some are joined.
pub(in crate::plot) fn join_to_loops(
    mut paths: Vec<Toolpath>,
    tolerance: f64,
    direction: Direction,
    interrupt: &Interrupt,
) -> Vec<Toolpath> {
    let rings: Vec<usize> = (0..paths.len()).filter(|&path| paths[path].is_free() && paths[path].heights().is_none()).collect();
    if rings.is_empty() {
        return paths;
    }
    let edges = Edges::new(&paths, &rings, tolerance, interrupt);
    let is_line = |path: &Toolpath| !path.is_closed() && path.heights().is_none() && path.length() > tolerance;
    let lines = (0..paths.len()).take_while(|_| !interrupt.is_raised()).filter(|&path| is_line(&paths[path]));
    let mut touches: Vec<Touch> = lines
        .flat_map(|path| [(path, false), (path, true)])
        .filter_map(|(path, at_end)| edges.touch(&paths, path, at_end, tolerance, direction))
        .collect();
    touches.sort_by(|a, b| {
        let ends = (a.path, a.at_end).cmp(&(b.path, b.at_end));
        a.turn.total_cmp(&b.turn).then(a.gap.total_cmp(&b.gap)).then(ends)
    });
    let mut is_gone = vec![false; paths.len()];
    for touch in touches {
        if !std::mem::replace(&mut is_gone[touch.ring], true) {
            let ring = paths[touch.ring].rotated(touch.edge, touch.place);
            let ring = if touch.reversed { ring.reversed() } else { ring };
            let line = &mut paths[touch.path];
            if touch.at_end { line.append(ring) } else { line.prepend(ring) }
        }
    }
    let mut is_gone = is_gone.into_iter();
    paths.retain(|_| !is_gone.next().unwrap_or(false));
    paths
}

/// The edges of all loops in the cells of a grid.
struct Edges {
    size: f64,
    cells: HashMap<(i64, i64), Vec<(usize, usize)>>,
}

impl Edges {
    /// Builds the grid. Cells are about as large as the edges, so that an edge lies in a few of them on average.
    fn new(paths: &[Toolpath], rings: &[usize], tolerance: f64, interrupt: &Interrupt) -> Self {
        let (length, count) = rings
            .iter()
            .fold((0.0, 0), |(length, count), &ring| (length + paths[ring].length(), count + paths[ring].points().len()));
        let mut edges = Self { size: (2.0 * tolerance).max(length / count as f64).max(1e-9), cells: HashMap::new() };
        for &ring in rings.iter().take_while(|_| !interrupt.is_raised()) {
            for (edge, side) in paths[ring].points().windows(2).enumerate() {
                let steps = (2.0 * side[0].distance(side[1]) / edges.size).ceil().clamp(1.0, 1e6);
                for step in 0..=steps as usize {
                    let cell = edges.cell(side[0].lerp(side[1], step as f64 / steps));
                    let here = edges.cells.entry(cell).or_default();
                    if here.last() != Some(&(ring, edge)) {
                        here.push((ring, edge));
                    }
                }
            }
        }
        edges
    }

    fn cell(&self, p: Point) -> (i64, i64) {
        ((p.x / self.size).floor() as i64, (p.y / self.size).floor() as i64)
    }

    /// The loop that this end of a path meets with the least turn, if any.
    fn touch(&self, paths: &[Toolpath], path: usize, at_end: bool, tolerance: f64, direction: Direction) -> Option<Touch> {
        let points = paths[path].points();
        let at = if at_end { paths[path].last() } else { paths[path].first() };
        let far = |p: &&Point| p.distance(at) > tolerance;
        let from = if at_end { points.iter().rev().find(far) } else { points.iter().find(far) }?;
        let arriving = (at - *from) / at.distance(*from);
        let (x, y) = self.cell(at);
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x.saturating_add(dx), y.saturating_add(dy))));
        let edges = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        let touches = edges.filter_map(|&(ring, edge)| {
            let (from, to) = (paths[ring].points()[edge], paths[ring].points()[edge + 1]);
            let along = to - from;
            let t = ((at - from).dot(along) / along.hypot2()).clamp(0.0, 1.0);
            let place = from + along * t;
            let gap = place.distance(at);
            if gap.is_nan() || gap > tolerance {
                return None;
            }
            let (turn, reversed) = turn(arriving, along.normalize(), at_end, direction);
            (turn <= SHARPEST).then_some(Touch { turn, gap, path, at_end, ring, edge, place, reversed })
        });
        touches
            .min_by(|a, b| a.turn.total_cmp(&b.turn).then(a.gap.total_cmp(&b.gap)).then((a.ring, a.edge).cmp(&(b.ring, b.edge))))
    }
}

/// The least turn between a path that arrives at a loop and the loop's edge, and whether the loop is drawn backwards for it. A
/// path that starts at the loop is treated as arriving in reverse.
fn turn(arriving: Vec2, along: Vec2, at_end: bool, direction: Direction) -> (f64, bool) {
    let forwards = if at_end { arriving.dot(along) } else { -arriving.dot(along) };
    match direction {
        Direction::Either if forwards < 0.0 => (1.0 + forwards, true),
        _ => (1.0 - forwards, false),
    }
}
