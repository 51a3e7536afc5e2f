//! The order in which paths are drawn, for the least travel with the pen up.
//!
//! This is the travelling salesman's problem with a path in place of each city, which may be drawn either way round. A first tour
//! of the shortest links that fit together (`greedy`) is improved by exchanging links (`lin_kernighan`) and, as far as the
//! effort allows, kicked out of its local optimum again and again (`kicks`, `sweeps`).

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "paths are counted in u32, half of what memory holds, and budgets are whole numbers of kicks"
)]

mod exact;
mod exchange;
mod greedy;
mod kd_tree;
mod kicks;
mod lin_kernighan;
mod merge;

pub use merge::{chain, drop_duplicates};
mod neighbours;
mod patch;
mod random;
mod sites;
mod sweeps;
#[cfg(test)]
mod tests;
mod tour;

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

/// Orders the paths for the least pen-up travel from `home` through all of them; the way back home does not count.
///
/// Returns each path once. The result is the same on any number of threads; more effort never gives a longer order. Coordinates
/// must not be NaN. Memory: about 0.9 kB a path. Time: O(n log n) with [`Effort::Fast`] and slightly more
/// with [`Effort::Full`], in practice.
pub fn order(paths: &[PathEnds], home: Point, effort: Effort, direction: Direction) -> Vec<Visit> {
    let mut best: Vec<Visit> = (0..paths.len()).map(|path| Visit { path, reversed: false }).collect();
    if effort == Effort::None || paths.is_empty() {
        return best;
    }
    if paths.len() <= exact::MOST {
        return exact::best_order(paths, home, direction);
    }
    let numbering = sites::numbering(paths);
    let sites = Sites::new(paths, &numbering, home);
    let neighbours = Neighbours::new(&sites, NEIGHBOURS, direction);
    let tour = Tour::new(greedy_tour(&sites, &neighbours, direction));
    let mut work = Workpiece { sites: &sites, neighbours: &neighbours, tour };
    // Gains are right up to rounding, and the order as given may happen to be optimal: what is returned is measured.
    let mut offer = |tour: &Tour| {
        let candidate = visits(&sites, &numbering, tour);
        if pen_up_length(paths, &candidate, home) < pen_up_length(paths, &best, home) {
            best = candidate;
        }
    };
    work.settle();
    work.along_the_tour(FAST_KICKS, 0);
    offer(&work.tour);
    if effort == Effort::Full {
        let kicks_per_path = FULL_KICKS + LEAST_FULL_KICKS / paths.len() as f64;
        work.along_the_tour(kicks_per_path / 2.0, 1);
        work.across_the_paper(kicks_per_path / 2.0);
        offer(&work.tour);
    }
    best
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
fn visits(sites: &Sites, numbering: &[usize], tour: &Tour) -> Vec<Visit> {
    let entries = tour.entries_from(sites.free_end());
    let visit = |&entry: &sites::End| Visit { path: numbering[entry as usize >> 1], reversed: entry & 1 == 1 };
    entries[1..].iter().map(visit).collect()
}
