//! Lin-Kernighan search: exchanges a few links for shorter ones until no such exchange is left.
//!
//! ```text
//!      t1  t2        Cut t1-t2, join t2 with a near t3, cut t3's link to t4, and so on, as long as what was cut is longer than
//!      |   | \       what was joined; close the exchange with t4-t1 when that still leaves a gain and a single tour. With two
//!      |   |  \      links this is a 2-opt move; with three, the or-opt moves (a segment put elsewhere, either way round) are
//!      t4--t3  ...   among them. Paths are never cut, so t4 follows from t3: every end has just one link.
//! ```

use std::collections::VecDeque;

use super::ends::End;
use super::neighbours::Neighbours;
use super::rearrangement::{MAX_LINKS, Rearrangement};
use super::sites::Sites;
use super::tour::Tour;

/// Number of continuations tried after the first, second ... link is cut; an exchange replaces at most one link more than this
/// has entries. Tuned on 10,000 dots, segments and hatch lines, kicks included: `[5, 3]` leaves dots 0.6 % longer, as the ends of
/// a dot come in pairs; `[10, 5, 1]` gains at most 0.2 % and takes twice as long on dots, `[10, 5, 3, 1]` six times.
const BREADTH: [usize; 2] = [10, 5];

/// The maximum of [`BREADTH`].
const MOST_CONTINUATIONS: usize = 10;

/// The search with its tour.
pub(super) struct LinKernighan<'a> {
    pub(super) sites: &'a Sites,
    pub(super) tour: Tour,
    pub(super) neighbours: &'a Neighbours,
    /// Ends whose surroundings have changed since they were last tried. All others have their don't-look bit set.
    waiting: VecDeque<End>,
    is_waiting: Vec<bool>,
    /// The exchange under consideration: t1, t2, ... with links t1-t2, t3-t4, ... cut and t2-t3, ... joined.
    ends: [End; 2 * MAX_LINKS],
}

/// One continuation of an exchange: join to `next`, then cut its link to `after`.
#[derive(Clone, Copy, Default)]
struct Continuation {
    next: End,
    after: End,
    /// Millimetres gained before the exchange is closed.
    open_gain: f64,
}

impl<'a> LinKernighan<'a> {
    /// A search that starts from this tour.
    pub(super) fn new(sites: &'a Sites, neighbours: &'a Neighbours, tour: Tour) -> Self {
        let ends = [0; 2 * MAX_LINKS];
        Self { sites, tour, neighbours, waiting: VecDeque::new(), is_waiting: vec![false; sites.end_count()], ends }
    }

    /// Adds an end to the list of those to be tried.
    pub(super) fn look_at(&mut self, end: End) {
        if !std::mem::replace(&mut self.is_waiting[end as usize], true) {
            self.waiting.push_back(end);
        }
    }

    /// Total length of the links of these ends, which must be the ends of whole links.
    pub(super) fn length_at(&self, ends: &[End]) -> f64 {
        ends.iter().map(|&end| self.sites.distance(end, self.tour.link(end))).sum::<f64>() / 2.0
    }

    /// Improves the tour until no end is waiting or the search is interrupted, and returns the millimetres gained. `after_each`
    /// is called with the tour after every exchange.
    pub(super) fn improve(&mut self, mut after_each: impl FnMut(&mut Tour)) -> f64 {
        let mut gained = 0.0;
        while let Some(end) = self.waiting.pop_front().filter(|_| !self.sites.interrupt().is_raised()) {
            self.is_waiting[end as usize] = false;
            while let Some(gain) = self.improve_at(end) {
                gained += gain;
                after_each(&mut self.tour);
            }
        }
        gained
    }

    /// Makes the first improving exchange found that cuts the link of this end.
    fn improve_at(&mut self, end: End) -> Option<f64> {
        self.ends[0] = end;
        self.ends[1] = self.tour.link(end);
        let length = self.sites.distance(self.ends[0], self.ends[1]);
        let (links, gain) = self.deepen(1, length)?;
        for i in 0..2 * links {
            self.look_at(self.ends[i]);
        }
        Some(gain)
    }

    /// With `cut` links cut and a gain of `open_gain` so far, joins and cuts until closing the exchange gives a gain, and makes
    /// it. Returns the number of links exchanged and the gain.
    fn deepen(&mut self, cut: usize, open_gain: f64) -> Option<(usize, f64)> {
        let (continuations, count) = self.continuations(cut, open_gain);
        for continuation in &continuations[..count] {
            self.ends[2 * cut] = continuation.next;
            self.ends[2 * cut + 1] = continuation.after;
            let gain = continuation.open_gain - self.sites.distance(continuation.after, self.ends[0]);
            if gain > self.sites.tolerance() && self.close(cut + 1) {
                return Some((cut + 1, gain));
            }
            if cut < BREADTH.len()
                && let Some(done) = self.deepen(cut + 1, continuation.open_gain)
            {
                return Some(done);
            }
        }
        None
    }

    /// The most promising continuations, the best first.
    fn continuations(&self, cut: usize, open_gain: f64) -> ([Continuation; MOST_CONTINUATIONS], usize) {
        let from = self.ends[2 * cut - 1];
        let breadth = BREADTH[cut - 1];
        let mut best = [Continuation::default(); MOST_CONTINUATIONS];
        let mut count = 0;
        for &next in self.neighbours.of(from) {
            let joined = open_gain - self.sites.distance(from, next);
            // The list is sorted: all that follow are farther.
            if joined <= self.sites.tolerance() {
                break;
            }
            if self.ends[..2 * cut].contains(&next) {
                continue;
            }
            let after = self.tour.link(next);
            let open_gain = joined + self.sites.distance(next, after);
            if count == breadth && open_gain <= best[count - 1].open_gain {
                continue;
            }
            let mut rank = count.min(breadth - 1);
            while rank > 0 && best[rank - 1].open_gain < open_gain {
                best[rank] = best[rank - 1];
                rank -= 1;
            }
            best[rank] = Continuation { next, after, open_gain };
            count = (count + 1).min(breadth);
        }
        (best, count)
    }

    /// Makes the exchange of the first `links` links if it leaves one tour.
    fn close(&mut self, links: usize) -> bool {
        let new = Rearrangement::new(&self.tour, &self.ends[..2 * links], self.sites.one_way());
        if let Some(new) = &new {
            self.tour.rearrange(new);
        }
        new.is_some()
    }
}
