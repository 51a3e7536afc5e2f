//! The tour as an array with the position of each path. Changes move whole segments and can be undone.

use super::ends::End;
use super::rearrangement::Rearrangement;

/// A closed tour of paths. Each path end has exactly one link: to the end before or behind it in the tour.
///
/// ```text
///      seat             0              1              2
///      position      0     1        2     3        4     5
///                 -- entry=exit -- entry=exit -- entry=exit --     == path (pen down), never cut
///                                                                  -- link (pen up)
/// ```
pub(super) struct Tour {
    /// The end at which the path in each seat is entered.
    entry: Vec<End>,
    /// Position of the start of each path: twice its seat, plus one if the path is drawn backwards.
    start_position: Vec<u32>,
    /// Log of the changes since the last [`Tour::keep`]: the overwritten entries, and the place of each run of them.
    overwritten: Vec<End>,
    runs: Vec<Run>,
}

/// A run of overwritten entries: its first seat, and its start in the log.
#[derive(Clone, Copy)]
struct Run {
    seat: usize,
    logged_at: usize,
}

impl Tour {
    /// The tour that enters all paths at the given ends, in this order.
    pub(super) fn new(entry: Vec<End>) -> Self {
        let mut tour = Self { start_position: vec![0; entry.len()], entry, overwritten: Vec::new(), runs: Vec::new() };
        for seat in 0..tour.entry.len() {
            tour.seat(seat, tour.entry[seat]);
        }
        tour
    }

    /// Number of paths.
    pub(super) fn len(&self) -> usize {
        self.entry.len()
    }

    /// Position of an end: twice its path's seat, plus one if the path is left at this end.
    #[inline]
    pub(super) fn position(&self, end: End) -> u32 {
        self.start_position[end as usize >> 1] ^ (end & 1)
    }

    /// Seat of the path with this end.
    pub(super) fn seat_of(&self, end: End) -> usize {
        self.start_position[end as usize >> 1] as usize >> 1
    }

    /// The end linked to this one: where the pen goes next, or came from.
    #[inline]
    pub(super) fn link(&self, end: End) -> End {
        let position = self.position(end);
        let seat = position as usize >> 1;
        if position & 1 == 1 {
            self.entry[if seat + 1 == self.entry.len() { 0 } else { seat + 1 }]
        } else {
            self.entry[if seat == 0 { self.entry.len() - 1 } else { seat - 1 }] ^ 1
        }
    }

    /// The end at which the path in this seat is entered; seats beyond the last wrap around.
    pub(super) fn entry(&self, seat: usize) -> End {
        self.entry[seat % self.entry.len()]
    }

    /// The entered ends in tour order, beginning with this end and in the direction that enters there.
    pub(super) fn entries_from(&self, end: End) -> Vec<End> {
        std::iter::successors(Some(end), |&entered| Some(self.link(entered ^ 1))).take(self.len()).collect()
    }

    /// Changes the tour. O(number of paths outside the longest segment).
    pub(super) fn rearrange(&mut self, new: &Rearrangement) {
        let first_run = self.runs.len();
        for segment in new.moved() {
            self.log(segment.first, segment.len);
        }
        for (run, segment) in (first_run..).zip(new.moved()) {
            let logged = self.runs[run].logged_at;
            for i in 0..segment.len {
                let entry = if segment.reversed {
                    self.overwritten[logged + segment.len - 1 - i] ^ 1
                } else {
                    self.overwritten[logged + i]
                };
                self.seat(segment.to + i, entry);
            }
        }
    }

    /// Makes all changes so far final.
    pub(super) fn keep(&mut self) {
        self.overwritten.clear();
        self.runs.clear();
    }

    /// Undoes all changes since the last [`Tour::keep`], at the cost of making them.
    pub(super) fn take_back(&mut self) {
        while let Some(run) = self.runs.pop() {
            for i in run.logged_at..self.overwritten.len() {
                self.seat(run.seat + i - run.logged_at, self.overwritten[i]);
            }
            self.overwritten.truncate(run.logged_at);
        }
    }

    fn log(&mut self, seat: usize, len: usize) {
        self.runs.push(Run { seat, logged_at: self.overwritten.len() });
        let before_wrap = len.min(self.entry.len() - seat);
        self.overwritten.extend_from_slice(&self.entry[seat..seat + before_wrap]);
        self.overwritten.extend_from_slice(&self.entry[..len - before_wrap]);
    }

    #[inline]
    fn seat(&mut self, seat: usize, entry: End) {
        let seat = if seat >= self.entry.len() { seat - self.entry.len() } else { seat };
        self.entry[seat] = entry;
        self.start_position[entry as usize >> 1] = 2 * seat as u32 + (entry & 1);
    }
}
