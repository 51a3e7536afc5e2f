//! A plot is put in order: repeated paths go, paths that meet are joined, and what is left is drawn along the shortest way.

use super::order::{is_free, join_to_loops, order_until, rotated, shuffled};
use super::{Direction, Effort, PathEnds, Plot, Seam, Stop, Toolpath, Visit, chain, drop_duplicates};
use crate::geometry::Point;
use crate::interrupt::{Interrupt, Interrupted};

/// Millimetres within which two paths are the same one. What repeats in a file differs by the rounding of its numbers, a thousandth or two;
/// the lines of the densest hatch lie a tenth apart, so that there is room on both sides.
const SAME: f64 = 0.005;

/// How a plot is put in order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sequence {
    /// Work spent on the search.
    pub effort: Effort,
    /// Whether paths may be drawn backwards.
    pub direction: Direction,
    /// Ends that lie this near, in millimetres, are joined; with 0, none are.
    pub merge: f64,
    /// What becomes of repeated paths.
    pub duplicates: Duplicates,
    /// Where loops begin.
    pub seam: Seam,
    /// The way through the paths.
    pub course: Course,
    /// The corner of the drawing from which the order starts instead of the machine's home.
    pub start: Option<DrawingCorner>,
}

/// What becomes of paths that repeat an earlier one of the same pen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Duplicates {
    /// They are not drawn.
    #[default]
    Drop,
    /// They are drawn again.
    Keep,
}

/// The way through the paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Course {
    /// As found.
    #[default]
    Forwards,
    /// From the last path to the first.
    Backwards,
    /// At random, so that ink dries before the pen comes back; the order follows from the seed.
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
    /// Where it is, around these paths.
    fn of(self, paths: &[Toolpath]) -> Option<Point> {
        let all = || paths.iter().flat_map(|path| &path.points);
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
    /// Joins, orders and turns each pen's paths for the least pen-up travel from `home`, and draws no path twice.
    pub fn ordered(&mut self, home: Point, effort: Effort, direction: Direction, merge: f64) {
        let sequence = Sequence { effort, direction, merge, ..Sequence::default() };
        let done = self.put_in_order(home, &sequence, &Interrupt::never());
        debug_assert!(done.is_ok(), "nobody interrupts");
    }

    /// Puts each pen's paths in order, beginning at `home`, and returns the number of repeated paths that went.
    ///
    /// Paths of one group stay together, in their order and as they stand. Loops are entered where it suits the travel, unless the
    /// seam's place is given. Interrupted, the plot is left without some of its paths.
    pub fn put_in_order(&mut self, home: Point, sequence: &Sequence, interrupt: &Interrupt) -> Result<usize, Interrupted> {
        let mut at = home;
        let mut dropped = 0;
        for pen in &mut self.pens {
            let mut paths = std::mem::take(&mut pen.paths);
            if sequence.duplicates == Duplicates::Drop {
                let before = paths.len();
                paths = drop_duplicates(paths, SAME, interrupt);
                dropped += before - paths.len();
            }
            at = sequence.start.and_then(|corner| corner.of(&paths)).unwrap_or(at);
            pen.paths = in_order(paths, at, sequence, interrupt);
            interrupt.check()?;
            at = pen.paths.last().map_or(at, |last| last.ends().end);
        }
        Ok(dropped)
    }
}

/// The paths of one pen in the order in which they are drawn; once the interrupt is raised, any of them in any order.
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

/// Single paths, joined where they meet, and groups, which stay as they are: what is drawn in one piece.
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

/// The order with the least travel; loops are turned to where they are entered.
fn found(items: &mut [Vec<Toolpath>], from: Point, sequence: &Sequence, interrupt: &Interrupt) -> Vec<Visit> {
    let stop = |item: &Vec<Toolpath>| {
        let ends = PathEnds { start: item[0].ends().start, end: item[item.len() - 1].ends().end };
        (ends, sequence.direction == Direction::Either && is_single(item))
    };
    let ring = |item: &Vec<Toolpath>| sequence.seam == Seam::Nearest && is_single(item) && is_free(&item[0]);
    let is_ring: Vec<bool> = items.iter().map(ring).collect();
    let mut stops: Vec<Stop> = items
        .iter()
        .zip(&is_ring)
        .map(|(item, is_ring)| {
            let (ends, may_turn) = stop(item);
            Stop { ring: is_ring.then(|| &item[0].points[..]), ..Stop::new(ends, may_turn) }
        })
        .collect();
    let visits = order_until(&mut stops, from, sequence.effort, interrupt);
    let seats: Vec<(usize, Point)> = stops.iter().map(|stop| (stop.edge, stop.ends.start)).collect();
    for ((item, is_ring), (edge, at)) in items.iter_mut().zip(is_ring).zip(seats) {
        if is_ring && at != item[0].points[0] {
            let loop_path = std::mem::replace(&mut item[0], Toolpath::new(Vec::new()));
            item[0] = rotated(loop_path, edge, at);
        }
    }
    visits
}

#[cfg(test)]
#[path = "ordering_tests.rs"]
mod tests;
