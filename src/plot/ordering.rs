//! Orders a plot: drops repeated paths, joins paths that meet, and minimizes the pen-up travel between the rest.

use super::joining::join_to_loops;
use super::{Plot, Seam, Toolpath, chain, drop_duplicates};
use crate::geometry::Point;
use crate::interrupt::{Interrupt, Interrupted};
use crate::order::{Direction, Effort, PathEnds, Stop, Visit, order_until, shuffled};

/// Tolerance in millimetres within which two paths are the same. Repeats in a file differ by the rounding of its numbers, a
/// thousandth or two; the lines of the densest hatch are a tenth apart, so there is room on both sides.
const DUPLICATE_TOLERANCE: f64 = 0.005;

/// How a plot is ordered.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sequence {
    /// Work spent on the search.
    pub effort: Effort,
    /// The directions in which paths may be drawn.
    pub direction: Direction,
    /// Ends at most this far apart, in millimetres, are joined; 0 joins none.
    pub merge: f64,
    /// How to treat repeated paths.
    pub duplicates: Duplicates,
    /// Where loops begin.
    pub seam: Seam,
    /// The way through the paths.
    pub course: Course,
    /// The corner of the drawing at which the order starts, instead of the machine's home.
    pub start: Option<DrawingCorner>,
}

/// How to treat paths that repeat an earlier one of the same pen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Duplicates {
    /// Draw them once.
    #[default]
    Drop,
    /// Draw them again.
    Keep,
}

/// The way through the paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Course {
    /// The order found.
    #[default]
    Forwards,
    /// From the last path to the first.
    Backwards,
    /// At random, so that ink dries before the pen comes back; determined by the seed.
    Shuffled(u64),
}

/// A corner of the drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DrawingCorner {
    /// Upper left.
    TopLeft,
    /// Upper right.
    TopRight,
    /// Lower left.
    BottomLeft,
    /// Lower right.
    BottomRight,
}

impl DrawingCorner {
    /// The corner of these paths' bounding box.
    fn of(self, paths: &[Toolpath]) -> Option<Point> {
        let all = || paths.iter().flat_map(Toolpath::points);
        let low = all().copied().reduce(|p, q| Point::new(p.x.min(q.x), p.y.min(q.y)))?;
        let high = all().copied().reduce(|p, q| Point::new(p.x.max(q.x), p.y.max(q.y)))?;
        Some(match self {
            Self::TopLeft => low,
            Self::TopRight => Point::new(high.x, low.y),
            Self::BottomLeft => Point::new(low.x, high.y),
            Self::BottomRight => high,
        })
    }
}

impl Plot {
    /// Joins, orders and reverses each pen's paths for the least pen-up travel from `home`, and drops repeated paths.
    pub fn order_paths(&mut self, home: Point, effort: Effort, direction: Direction, merge: f64) {
        let sequence = Sequence { effort, direction, merge, ..Sequence::default() };
        let done = self.put_in_order(home, &sequence, &Interrupt::never());
        debug_assert!(done.is_ok(), "nobody interrupts");
    }

    /// Orders each pen's paths, beginning at `home`, and returns the number of repeated paths dropped.
    ///
    /// Paths of one group stay together, in their given order and direction. Loops are entered wherever travel is shortest,
    /// unless the seam is given. If interrupted, the plot lacks some of its paths.
    pub fn put_in_order(&mut self, home: Point, sequence: &Sequence, interrupt: &Interrupt) -> Result<usize, Interrupted> {
        let mut at = home;
        let mut dropped = 0;
        for pen in &mut self.pens {
            let mut paths = std::mem::take(&mut pen.paths);
            if sequence.duplicates == Duplicates::Drop {
                let before = paths.len();
                paths = drop_duplicates(paths, DUPLICATE_TOLERANCE, interrupt);
                dropped += before - paths.len();
            }
            at = sequence.start.and_then(|corner| corner.of(&paths)).unwrap_or(at);
            pen.paths = in_order(paths, at, sequence, interrupt);
            interrupt.check()?;
            at = pen.paths.last().map_or(at, Toolpath::last);
        }
        Ok(dropped)
    }
}

/// The paths of one pen in drawing order. Once the interrupt is raised, the result may be incomplete and in any order.
fn in_order(paths: Vec<Toolpath>, from: Point, sequence: &Sequence, interrupt: &Interrupt) -> Vec<Toolpath> {
    let mut items = items(paths, sequence, interrupt);
    if interrupt.is_raised() {
        return Vec::new();
    }
    let mut visits = if let Course::Shuffled(seed) = sequence.course {
        shuffled(items.len(), seed).into_iter().map(|path| Visit { path, reversed: false }).collect()
    } else {
        found(&mut items, from, sequence, interrupt)
    };
    if sequence.course == Course::Backwards {
        visits.reverse();
        for visit in &mut visits {
            visit.reversed ^=
                sequence.direction == Direction::Either && sequence.effort != Effort::None && is_single(&items[visit.path]);
        }
    }
    let mut drawn = Vec::with_capacity(items.iter().map(Vec::len).sum());
    for visit in visits {
        let item = std::mem::take(&mut items[visit.path]);
        drawn.extend(item.into_iter().map(|path| if visit.reversed { path.reversed() } else { path }));
    }
    drawn
}

/// The units to order: single paths, joined where they meet, and unchanged groups.
fn items(paths: Vec<Toolpath>, sequence: &Sequence, interrupt: &Interrupt) -> Vec<Vec<Toolpath>> {
    let joins = sequence.merge > 0.0 && sequence.effort != Effort::None;
    let mut slot_of = std::collections::HashMap::new();
    let mut items: Vec<Vec<Toolpath>> = Vec::new();
    let mut singles = Vec::new();
    for path in paths {
        match path.group {
            Some(group) => {
                let slot = *slot_of.entry(group).or_insert_with(|| {
                    items.push(Vec::new());
                    items.len() - 1
                });
                items[slot].push(path);
            }
            None if joins => singles.push(path),
            None => items.push(vec![sequence.seam.place(path)]),
        }
    }
    let chains = chain(singles, sequence.merge, sequence.direction, interrupt);
    let joined = join_to_loops(chains, sequence.merge, sequence.direction, interrupt);
    items.extend(joined.into_iter().map(|path| vec![sequence.seam.place(path)]));
    items
}

fn is_single(item: &[Toolpath]) -> bool {
    item.iter().all(|path| path.group.is_none())
}

/// The order with the least travel; loops are rotated to where they are entered.
fn found(items: &mut [Vec<Toolpath>], from: Point, sequence: &Sequence, interrupt: &Interrupt) -> Vec<Visit> {
    let stop = |item: &Vec<Toolpath>| {
        let ends = PathEnds { start: item[0].first(), end: item[item.len() - 1].last() };
        (ends, if is_single(item) { sequence.direction } else { Direction::AsDrawn })
    };
    let ring = |item: &Vec<Toolpath>| sequence.seam == Seam::Nearest && is_single(item) && item[0].is_free();
    let is_ring: Vec<bool> = items.iter().map(ring).collect();
    let mut stops: Vec<Stop> = items
        .iter()
        .zip(&is_ring)
        .map(|(item, is_ring)| {
            let (ends, direction) = stop(item);
            Stop { ring: is_ring.then(|| item[0].points()), ..Stop::new(ends, direction) }
        })
        .collect();
    let visits = order_until(&mut stops, from, sequence.effort, interrupt);
    let seats: Vec<(usize, Point)> = stops.iter().map(|stop| (stop.edge, stop.ends.start)).collect();
    for ((item, is_ring), (edge, at)) in items.iter_mut().zip(is_ring).zip(seats) {
        if is_ring && at != item[0].first() {
            item[0] = item[0].rotated(edge, at);
        }
    }
    visits
}

#[cfg(test)]
#[path = "ordering_tests.rs"]
mod tests;
