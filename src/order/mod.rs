//! The drawing order of paths with the least pen-up travel.
//!
//! This is the travelling salesman problem with paths instead of cities; each path may be drawn in either direction. A greedy
//! first tour of the shortest compatible links (`greedy`) is improved by exchanging links (`lin_kernighan`) and, as far as the
//! effort allows, repeatedly kicked out of its local optimum (`kicks`), in many patches at the same time (`workpiece`, `patch`,
//! `rings`). Loops may be entered anywhere: their entry points are chosen between their neighbours in the tour (`loop_entries`),
//! and the search continues from there.
//!
//! The objective is distance. Travel time under acceleration (100 mm/s, 250 mm/s^2) was tried instead on 1000 and 10,000 dots,
//! segments and hatch lines: travel time fell by 0.05 to 0.9 %, less than half a percent of a plot's time, and the distance grew
//! by up to 4.5 %. The number of lifts does not depend on the order.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "paths are counted in u32, half of what memory holds, and budgets are whole numbers of kicks"
)]

mod ends;
mod exact;
mod exchange;
mod greedy;
mod kicks;
mod lin_kernighan;
mod links;
mod loop_entries;
mod neighbours;
mod one_way;
mod patch;
mod random;
mod rearrangement;
mod rings;
mod sites;
mod stops;
#[cfg(test)]
mod tests;
mod tiles;
mod tour;
mod workpiece;

pub(crate) use random::shuffled;
#[doc(hidden)]
pub use stops::Stop;
pub use stops::{Direction, Effort, PathEnds, Visit};

use crate::interrupt::Interrupt;
use kurbo::Point;

use greedy::greedy_tour;
use neighbours::{NEIGHBOURS, Neighbours};
use sites::Sites;
use tour::Tour;
use workpiece::Workpiece;

/// Kicks per path with [`Effort::Fast`]. Without any, 100,000 dots take half the time and end up 1.3 % longer, and
/// hatches 3 %.
const FAST_KICKS: f64 = 0.4;

/// Kicks per path with [`Effort::Full`]. One more makes 100,000 dots 0.06 % shorter, for a sixth of the
/// time.
const FULL_KICKS: f64 = 4.0;

/// Additional kicks with [`Effort::Full`], however few the paths: even a thousand paths need many to come within 1 %.
const LEAST_FULL_KICKS: f64 = 60_000.0;

/// Orders paths for the least pen-up travel from `home` through all of them. The way back home does not count.
///
/// Returns each path once. The result is the same on any number of threads; more effort never gives a longer order. Coordinates
/// must not be NaN. Memory: about 0.9 kB per path. Time: O(n log n) with [`Effort::Fast`] and slightly more with
/// [`Effort::Full`], in practice.
///
/// ```
/// use drypoint::{geometry::Point, order::{Direction, Effort, PathEnds, order}};
///
/// let path = |from: f64, to: f64| PathEnds { start: Point::new(from, 0.0), end: Point::new(to, 0.0) };
/// let visits = order(&[path(20.0, 30.0), path(10.0, 0.0)], Point::ORIGIN, Effort::Full, Direction::Either);
/// assert_eq!(visits.iter().map(|visit| (visit.path, visit.reversed)).collect::<Vec<_>>(), [(1, true), (0, false)]);
/// ```
pub fn order(paths: &[PathEnds], home: Point, effort: Effort, direction: Direction) -> Vec<Visit> {
    let mut stops: Vec<Stop> = paths.iter().map(|&ends| Stop::new(ends, direction)).collect();
    order_stops(&mut stops, home, effort)
}

/// As [`order`], for stops of any kind. Moves the ends of loops to where the pen enters them.
#[doc(hidden)]
pub fn order_stops(stops: &mut [Stop], home: Point, effort: Effort) -> Vec<Visit> {
    order_until(stops, home, effort, &Interrupt::never())
}

/// As [`order_stops`]; once the interrupt is raised, returns the shortest order found so far.
pub(crate) fn order_until(stops: &mut [Stop], home: Point, effort: Effort, interrupt: &Interrupt) -> Vec<Visit> {
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

/// The shortest order found so far. It is chosen by measured length, since gains are exact only up to rounding and the given
/// order may already be optimal.
struct Best {
    home: Point,
    visits: Vec<Visit>,
    seats: Vec<(PathEnds, usize)>,
    length: f64,
}

impl Best {
    fn as_given(stops: &[Stop], home: Point) -> Self {
        let mut best = Self { home, visits: Vec::new(), seats: Vec::new(), length: f64::INFINITY };
        let visits: Vec<Visit> = (0..stops.len()).map(|path| Visit { path, reversed: false }).collect();
        let ends: Vec<PathEnds> = stops.iter().map(|stop| stop.ends).collect();
        let length = pen_up_length(&ends, &visits, home);
        best.take(visits, stops, length);
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

/// Maximum rounds of ordering and choosing loop entries for a few stops.
const FEW_ROUNDS: usize = 8;

fn order_few(stops: &mut [Stop], best: &mut Best) {
    for _ in 0..FEW_ROUNDS {
        let visits = exact::best_order(stops, best.home);
        best.offer(visits.clone(), stops);
        let order: Vec<usize> = visits.iter().map(|visit| visit.path).collect();
        if loop_entries::choose_loop_entries(stops, &order, best.home) == 0.0 {
            return;
        }
        best.offer(visits, stops);
    }
}

/// Maximum restarts of the search with new loop entries before kicks begin; not tuned yet.
const SEATINGS: usize = 3;

/// Number of parts into which kicks are divided, with other borders of patches and new loop entries for each. With half as many,
/// 100,000 dots end up 0.03 % longer.
const PARTS: u32 = 8;

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
    work.kick(FAST_KICKS, 0);
    finish(&mut work, stops);
    if effort == Effort::Full {
        let kicks_per_path = (FULL_KICKS + LEAST_FULL_KICKS / stops.len() as f64) / f64::from(PARTS);
        for part in (0..PARTS).take_while(|_| !interrupt.is_raised()) {
            work.kick(kicks_per_path, 1 + part);
            finish(&mut work, stops);
        }
    }
}

/// Pen-up travel in millimetres from `home` through all visits, without the way back home.
///
/// # Panics
/// If a visit's path index is out of range.
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

/// The tour in the caller's numbering, starting from home.
fn visits(sites: &Sites, numbering: &[usize], tour: &Tour, stops: &[Stop]) -> Vec<Visit> {
    let entries = tour.entries_from(sites.free_end());
    let visit = |&entry: &ends::End| {
        let path = numbering[entry as usize >> 1];
        Visit { path, reversed: entry & 1 == 1 && stops[path].may_turn }
    };
    entries[1..].iter().map(visit).collect()
}
