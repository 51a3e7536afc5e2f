//! The order in which paths are drawn, for the least travel with the pen up.
//!
//! This is the travelling salesman's problem with a path in place of each city, which may be drawn either way round. A first tour
//! of the shortest links that fit together (`greedy`) is improved by exchanging links (`lin_kernighan`) and, as far as the
//! effort allows, kicked out of its local optimum again and again (`kicks`, `sweeps`). Loops may be entered anywhere: they are seated between
//! their neighbours in the tour (`seats`), and the search goes on from there.
//!
//! What is made short is the distance. Travel time under acceleration (100 mm/s, 250 mm/s^2) was tried in its place on 1000 and 10,000
//! dots, segments and hatch lines: the time of travel fell by 0.05 to 0.9 %, less than half a percent of a plot's, and the distance grew
//! by up to 4.5 %. Lifts do not depend on the order.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "paths are counted in u32, half of what memory holds, and budgets are whole numbers of kicks"
)]

mod duplicates;
mod exact;
mod exchange;
mod greedy;
mod kd_tree;
mod kicks;
mod lasso;
mod lin_kernighan;
mod merge;
mod neighbours;
mod one_way;
mod patch;
mod random;
mod ring;
mod seats;
mod sites;
mod sweeps;
#[cfg(test)]
mod tests;
mod tour;

pub use duplicates::drop_duplicates;
pub(super) use lasso::join_to_loops;
pub use merge::chain;
pub(super) use random::shuffled;
pub(super) use ring::{is_free, rotated};

use crate::interrupt::Interrupt;
use kurbo::Point;

use greedy::greedy_tour;
use neighbours::Neighbours;
use sites::Sites;
use sweeps::Workpiece;
use tour::Tour;

/// The two ends of one path that is drawn in one go, in millimetres. A closed path has both at the same point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathEnds {
    /// Where the path as given begins.
    pub start: Point,
    /// Where the path as given ends.
    pub end: Point,
}

/// One path in its turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Visit {
    /// Index of the path among those given.
    pub path: usize,
    /// Whether it is drawn from its end to its start.
    pub reversed: bool,
}

/// How much work to spend on the order. Budgets are counted in work and not in seconds, so the result is the same on any machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Effort {
    /// The order as given.
    None,
    /// About 2 % longer than the best known order for dots, 4 % for segments and 8 % for hatches; some 15 microseconds a path.
    #[default]
    Fast,
    /// About 1 % longer than the best known order; some 100 microseconds a path, and a second for the first thousand.
    Full,
}

/// Whether paths may be drawn backwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Direction {
    /// Either way round, whichever is nearer.
    #[default]
    Either,
    /// Always from start to end.
    AsDrawn,
}

/// Neighbours of each path end that links are tried with. Tuned on 10,000 dots, segments and hatch lines: with 10, the order ends 0.2 to 2 %
/// longer; 20 take a third longer on dots and gain nothing worth that.
const NEIGHBOURS: usize = 14;

/// Kicks per path with [`Effort::Fast`]. Without any, 100,000 dots take half the time and end 1.3 % longer, and hatches 3 %.
const FAST_KICKS: f64 = 0.4;

/// Kicks per path with [`Effort::Full`]: one less or one more makes 100,000 dots 0.1 % longer or shorter, and a quarter of the time.
const FULL_KICKS: f64 = 3.0;

/// Kicks that [`Effort::Full`] spends on top however few the paths, as even a thousand take many to come within 1 %.
const LEAST_FULL_KICKS: f64 = 40_000.0;

/// A path, or several that are drawn one after the other, as the search sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop<'a> {
    /// Where the pen comes down and where it is lifted.
    pub ends: PathEnds,
    /// Whether it may be drawn from its end to its start.
    pub may_turn: bool,
    /// The vertices of a loop that may be entered anywhere, the last one equal to the first; `ends` are both on it then.
    pub ring: Option<&'a [Point]>,
    /// The edge of the ring, by its first vertex, on which `ends` lie.
    pub edge: usize,
}

/// A path whose ends are no farther apart than this, in millimetres, is travelled to alike from either end, and the search need not
/// keep its direction. A hundredth of a millimetre is less than the step of most plotters.
const TOUCH: f64 = 0.01;

impl Stop<'_> {
    /// A path with two ends that it keeps.
    pub const fn new(ends: PathEnds, may_turn: bool) -> Self {
        Self { ends, may_turn, ring: None, edge: 0 }
    }

    /// Whether its direction matters to the search.
    fn is_one_way(&self) -> bool {
        !self.may_turn && self.ends.start.distance(self.ends.end) > TOUCH
    }
}

/// Orders the paths for the least pen-up travel from `home` through all of them; the way back home does not count.
///
/// Returns each path once. The result is the same on any number of threads; more effort never gives a longer order. Coordinates
/// must not be NaN. Memory: about 0.9 kB a path. Time: O(n log n) with [`Effort::Fast`] and slightly more
/// with [`Effort::Full`], in practice.
pub fn order(paths: &[PathEnds], home: Point, effort: Effort, direction: Direction) -> Vec<Visit> {
    let mut stops: Vec<Stop> = paths.iter().map(|&ends| Stop::new(ends, direction == Direction::Either)).collect();
    order_stops(&mut stops, home, effort)
}

/// Does what [`order`] does for stops of any kind, and moves the ends of loops to where the pen enters them.
pub fn order_stops(stops: &mut [Stop], home: Point, effort: Effort) -> Vec<Visit> {
    order_until(stops, home, effort, &Interrupt::never())
}

/// The same; once the interrupt is raised, the shortest order found by then.
pub(super) fn order_until(stops: &mut [Stop], home: Point, effort: Effort, interrupt: &Interrupt) -> Vec<Visit> {
    let mut best = Best::as_given(stops, home);
    if effort != Effort::None && !stops.is_empty() {
        if stops.len() <= exact::MOST {
            order_few(stops, &mut best);
        } else {
            order_many(stops, effort, interrupt, &mut best);
        }
    }
    for (stop, (ends, edge)) in stops.iter_mut().zip(best.seats) {
        (stop.ends, stop.edge) = (ends, edge);
    }
    best.visits
}

/// The shortest order found so far. Gains are right up to rounding, and the order as given may happen to be optimal: what is
/// returned is measured.
struct Best {
    home: Point,
    visits: Vec<Visit>,
    seats: Vec<(PathEnds, usize)>,
    length: f64,
}

impl Best {
    fn as_given(stops: &[Stop], home: Point) -> Self {
        let mut best = Self { home, visits: Vec::new(), seats: Vec::new(), length: f64::INFINITY };
        best.take((0..stops.len()).map(|path| Visit { path, reversed: false }).collect(), stops, f64::INFINITY);
        best
    }

    fn offer(&mut self, visits: Vec<Visit>, stops: &[Stop]) {
        let ends: Vec<PathEnds> = stops.iter().map(|stop| stop.ends).collect();
        let length = pen_up_length(&ends, &visits, self.home);
        if length < self.length {
            self.take(visits, stops, length);
        }
    }

    fn take(&mut self, visits: Vec<Visit>, stops: &[Stop], length: f64) {
        self.visits = visits;
        self.seats = stops.iter().map(|stop| (stop.ends, stop.edge)).collect();
        self.length = length;
    }
}

/// Rounds of ordering and seating a few stops: a bound on the work.
const FEW_ROUNDS: usize = 8;

fn order_few(stops: &mut [Stop], best: &mut Best) {
    for _ in 0..FEW_ROUNDS {
        let visits = exact::best_order(stops, best.home);
        best.offer(visits.clone(), stops);
        let order: Vec<usize> = visits.iter().map(|visit| visit.path).collect();
        if seats::seat_in_order(stops, &order, best.home) == 0.0 {
            return;
        }
        best.offer(visits, stops);
    }
}

/// How often the search goes on from new seats before kicks begin; a bound on the work, not tuned yet.
const SEATINGS: usize = 3;

/// Parts into which kicks are divided between seatings where there are loops; not tuned yet.
const PARTS: usize = 4;

fn order_many(stops: &mut [Stop], effort: Effort, interrupt: &Interrupt, best: &mut Best) {
    let has_rings = stops.iter().any(|stop| stop.ring.is_some());
    let numbering = sites::numbering(stops);
    let sites = Sites::new(stops, &numbering, best.home, interrupt);
    let neighbours = Neighbours::new(&sites, NEIGHBOURS);
    let entries = greedy_tour(&sites, &neighbours);
    if interrupt.is_raised() {
        return;
    }
    let tour = Tour::new(entries);
    let mut work = Workpiece { sites, neighbours, tour };
    let parts = if has_rings { PARTS } else { 1 };
    work.settle();
    for _ in 0..SEATINGS {
        if !has_rings || interrupt.is_raised() || work.seat(stops, &numbering, best.home) == 0.0 {
            break;
        }
        work.settle();
    }
    let mut finish = |work: &mut Workpiece, stops: &mut [Stop]| {
        if has_rings && !interrupt.is_raised() && work.seat(stops, &numbering, best.home) > 0.0 {
            work.settle();
            work.seat(stops, &numbering, best.home);
        }
        best.offer(visits(&work.sites, &numbering, &work.tour, stops), stops);
    };
    work.along_the_tour(FAST_KICKS, 0);
    finish(&mut work, stops);
    if effort == Effort::Full {
        let kicks_per_path = (FULL_KICKS + LEAST_FULL_KICKS / stops.len() as f64) / (2 * parts) as f64;
        for part in (0..parts as u64).take_while(|_| !interrupt.is_raised()) {
            work.along_the_tour(kicks_per_path, 1 + part);
            work.across_the_paper(kicks_per_path, part);
            finish(&mut work, stops);
        }
    }
}

/// Pen-up travel in millimetres from `home` through all visits, without the way back home.
///
/// # Panics
/// If a visit is to a path that does not exist.
pub fn pen_up_length(paths: &[PathEnds], visits: &[Visit], home: Point) -> f64 {
    let mut pen = home;
    let mut length = 0.0;
    for visit in visits {
        let PathEnds { start, end } = paths[visit.path];
        let (from, to) = if visit.reversed { (end, start) } else { (start, end) };
        length += pen.distance(from);
        pen = to;
    }
    length
}

/// The tour as the caller knows the paths, from home on.
fn visits(sites: &Sites, numbering: &[usize], tour: &Tour, stops: &[Stop]) -> Vec<Visit> {
    let entries = tour.entries_from(sites.free_end());
    let visit = |&entry: &sites::End| {
        let path = numbering[entry as usize >> 1];
        Visit { path, reversed: entry & 1 == 1 && stops[path].may_turn }
    };
    entries[1..].iter().map(visit).collect()
}
