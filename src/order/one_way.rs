//! Paths that must keep their direction, among others that may be reversed.

use super::tour::Tour;

/// Up to this many are looked up one by one. More are found by walking along the segment in question, where one turns up soon.
/// Both cost at most a few hundred steps in a patch of 4000.
const FEW: usize = 32;

/// The paths that may not be reversed.
pub(super) struct OneWay {
    /// True for each one-way path; empty if there is none.
    is: Vec<bool>,
    /// All one-way paths, if they are few.
    few: Vec<u32>,
    /// True if there are also reversible paths, so that a change of the tour has to be checked. Without any, every link joins an
    /// exit to an entry, which by itself keeps all directions.
    is_mixed: bool,
}

impl OneWay {
    pub(super) fn new(is: Vec<bool>) -> Self {
        let count = is.iter().filter(|one_way| **one_way).count();
        if count == 0 {
            return Self { is: Vec::new(), few: Vec::new(), is_mixed: false };
        }
        let few = if count <= FEW { (0..).zip(&is).filter(|(_, is)| **is).map(|(path, _)| path).collect() } else { Vec::new() };
        Self { few, is_mixed: count < is.len(), is }
    }

    /// The one-way paths of a patch. Among paths of which some may be reversed, directions have to be checked also where a patch has
    /// none of these: its bundles may begin with one.
    pub(super) fn part(&self, is: Vec<bool>) -> Self {
        let part = Self::new(is);
        Self { is_mixed: self.is_mixed && !part.is_empty(), ..part }
    }

    pub(super) fn contains(&self, path: usize) -> bool {
        self.is.get(path).copied().unwrap_or(false)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.is.is_empty()
    }

    pub(super) fn is_mixed(&self) -> bool {
        self.is_mixed
    }

    /// True if one of them is in these seats, which wrap around past the last one.
    pub(super) fn is_within(&self, tour: &Tour, first: usize, len: usize) -> bool {
        if self.few.is_empty() {
            return (first..first + len).any(|seat| self.contains(tour.entry(seat) as usize >> 1));
        }
        self.few.iter().any(|&path| (tour.seat_of(2 * path) + tour.len() - first % tour.len()) % tour.len() < len)
    }
}
