//! A patch of the tour: some paths, with everything between them tied into bundles, as a small tour of its own.

use super::ends::End;
use super::neighbours::Neighbours;
use super::one_way::OneWay;
use super::sites::Sites;
use super::tour::Tour;

/// Some paths of a tour as a smaller tour. The part of the tour between two of them, outside the patch, is one bundle, which is a
/// path like any other: it has two ends and may be drawn in either direction.
///
/// ```text
///           +---------+
///      -----|-1     4-|-------        1, 2, 3 and 4 are in the patch; the tour's course from 2 to 3 and
///     |     |  \   /  |       |       from 4 to 1 outside of it are two bundles
///      ---  |   2 3   |  -----
///         | +--|--|---+ |
///          ----    -----
/// ```
///
/// Any improvement of the small tour also improves the large one, but a change moves at most some hundred entries, and everything
/// that the search examines stays in the cache.
pub(super) struct Patch {
    pub(super) sites: Sites,
    pub(super) neighbours: Neighbours,
    /// Path `p` of the small tour is the run of seats of the large one from `pieces[p]` up to `pieces[p + 1]`. The first piece is
    /// the first path of the patch.
    pieces: Vec<usize>,
}

impl Patch {
    /// The patch of the paths in these ascending seats. `renumbered` is scratch space with an entry `End::MAX` for each end, and
    /// is restored. O(number of paths in the patch).
    pub(super) fn new(sites: &Sites, neighbours: &Neighbours, tour: &Tour, seats: &[usize], renumbered: &mut [End]) -> Self {
        let mut pieces = Vec::with_capacity(2 * seats.len() + 1);
        for (i, &seat) in seats.iter().enumerate() {
            pieces.push(seat);
            let next = seats.get(i + 1).copied().unwrap_or(seats[0] + tour.len());
            if seat + 1 < next {
                pieces.push(seat + 1);
            }
        }
        pieces.push(seats[0] + tour.len());
        let ends: Vec<End> = pieces.windows(2).flat_map(|piece| [tour.entry(piece[0]), tour.entry(piece[1] - 1) ^ 1]).collect();
        for (new, &end) in (0..).zip(&ends) {
            renumbered[end as usize] = new;
        }
        let neighbours = neighbours.part(&ends, |end| Some(renumbered[end as usize]).filter(|&new| new != End::MAX));
        for &end in &ends {
            renumbered[end as usize] = End::MAX;
        }
        let one_way = sites.one_way();
        let is_one_way = |piece: &[usize]| one_way.is_within(tour, piece[0], piece[1] - piece[0]);
        let one_way = if one_way.is_empty() { Vec::new() } else { pieces.windows(2).map(is_one_way).collect() };
        Self { sites: sites.part(&ends, OneWay::new(one_way)), neighbours, pieces }
    }

    /// The small tour before any change.
    pub(super) fn tour(&self) -> Tour {
        Tour::new((0..self.piece_count() as End).map(|piece| 2 * piece).collect())
    }

    /// Number of paths of the small tour.
    pub(super) fn piece_count(&self) -> usize {
        self.pieces.len() - 1
    }

    /// The end at which the last path of the small tour was entered before any change.
    pub(super) fn last_piece(&self) -> End {
        2 * (self.piece_count() as End - 1)
    }

    /// The entries of the large tour that correspond to these entries of the small one. O(their number).
    pub(super) fn spread(&self, large: &Tour, small: impl IntoIterator<Item = End>) -> Vec<End> {
        let mut entries = Vec::new();
        for entry in small {
            let piece = self.pieces[entry as usize >> 1]..self.pieces[(entry as usize >> 1) + 1];
            if entry & 1 == 0 {
                entries.extend(piece.map(|seat| large.entry(seat)));
            } else {
                entries.extend(piece.rev().map(|seat| large.entry(seat) ^ 1));
            }
        }
        entries
    }
}
