//! A patch of the tour: some paths, with everything between them tied into bundles, as a small tour of its own.

use super::ends::End;
use super::neighbours::Neighbours;
use super::sites::Sites;
use super::tour::Tour;

/// Some paths of a tour as a smaller tour, which is cut behind each of them. So the tour's course outside the patch is tied to the
/// path at which it comes back, as one bundle, which is a path like any other: it has two ends and may be drawn in either direction.
///
/// ```text
///           +----------+
///      -----|-1      6-|-------       1 to 6 are in the patch; the tour's course from behind 3 to 4, and from
///     |     | 2      5 |       |      behind 6 to 1, are two bundles
///      ---  |  3    4  |  -----
///         | +--|----|--+ |
///          ----      ----
/// ```
///
/// Every link belongs to the path before it, so patches without a common path change no link in common. An improvement of the small
/// tour also improves the large one, but a change moves few entries, and everything that the search examines stays in the cache.
pub(super) struct Patch {
    pub(super) sites: Sites,
    pub(super) neighbours: Neighbours,
    /// The ends of the small tour's paths, in the large tour's numbering.
    ends: Vec<End>,
}

impl Patch {
    /// The patch of the links behind these paths. `renumbered` is scratch space with an entry `End::MAX` for each end, and is
    /// restored. O(number of paths in the patch).
    pub(super) fn new(sites: &Sites, neighbours: &Neighbours, tour: &Tour, paths: &[u32], renumbered: &mut [End]) -> Self {
        let pieces = pieces(tour, paths);
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
        Self { sites: sites.part(&ends, sites.one_way().part(one_way)), neighbours, ends }
    }

    /// The small tour before any change.
    pub(super) fn tour(&self) -> Tour {
        Tour::new((0..self.ends.len() as End).step_by(2).collect())
    }

    /// The links of a small tour that are new, in the large tour's numbering. O(number of its paths).
    pub(super) fn new_links(&self, small: &Tour) -> Vec<[End; 2]> {
        let before = self.tour();
        let links = (0..small.len()).map(|seat| [small.entry(seat) ^ 1, small.entry(seat + 1)]);
        links.filter(|link| before.link(link[0]) != link[1]).map(|link| link.map(|end| self.ends[end as usize])).collect()
    }
}

/// The first seats of the patch's pieces, ascending, and the first one's again, one round later.
fn pieces(tour: &Tour, paths: &[u32]) -> Vec<usize> {
    let mut pieces: Vec<usize> = paths.iter().map(|&path| (tour.seat_of(2 * path) + 1) % tour.len()).collect();
    pieces.sort_unstable();
    pieces.extend(pieces.first().map(|first| first + tour.len()));
    pieces
}
