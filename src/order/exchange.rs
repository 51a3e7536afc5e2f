//! Exchanges k links of a tour for k others: checks that one tour remains, and finds the new positions of its segments.

use super::ends::End;
use super::one_way::OneWay;
use super::rearrangement::{MAX_LINKS, Rearrangement, Segment};
use super::tour::Tour;

impl Rearrangement {
    /// Cuts the links `ends[0] - ends[1]`, `ends[2] - ends[3]` ... and joins `ends[1]` with `ends[2]`, `ends[3]` with `ends[4]`
    /// ... and the last with the first. `None` if the tour would fall apart into several rings, or a `one_way` path would be
    /// reversed. O(k^2) for k links.
    pub(super) fn new(tour: &Tour, ends: &[End], one_way: &OneWay) -> Option<Self> {
        let count = ends.len() / 2;
        let (cuts, sides) = cut(tour, ends);
        let mut joined = [0; 2 * MAX_LINKS];
        for i in 0..count {
            let (a, b) = (sides[2 * i + 1], sides[(2 * i + 2) % (2 * count)]);
            joined[a] = b;
            joined[b] = a;
        }
        // Walk the new tour from segment 0, which keeps its direction.
        let mut walked = [(0, false); MAX_LINKS];
        let mut steps = 1;
        let mut side = joined[1];
        while side >> 1 != 0 {
            walked[steps] = (side >> 1, side & 1 == 1);
            steps += 1;
            side = joined[side ^ 1];
        }
        let is_allowed =
            steps == count && (!one_way.is_mixed() || keeps_directions(tour, &cuts[..count], &walked[..count], one_way));
        is_allowed.then(|| Self::around_longest(tour.len(), &cuts[..count], &mut walked[..count]))
    }

    /// Cuts the tour behind these ascending seats and reverses the order of the segments, keeping the direction of each.
    ///
    /// ```text
    ///      before:  == A == B == C == D == (A)
    ///      after:   == A == D == C == B == (A)
    /// ```
    pub(super) fn reverse_order<const CUTS: usize>(paths: usize, cuts: [usize; CUTS]) -> Self {
        Self::around_longest(paths, &cuts, &mut std::array::from_fn::<_, CUTS, _>(|i| ((CUTS - i) % CUTS, false)))
    }

    fn around_longest(paths: usize, cuts: &[usize], walked: &mut [(usize, bool)]) -> Self {
        let segment = |index: usize| segment(paths, cuts, index);
        let longest = (0..walked.len()).max_by_key(|&i| segment(walked[i].0).1).unwrap_or(0);
        walked.rotate_left(longest);
        if walked[0].1 {
            // Walk the same ring in the other direction.
            walked[1..].reverse();
            for (_, reversed) in walked.iter_mut() {
                *reversed = !*reversed;
            }
        }
        let mut segments = [Segment::default(); MAX_LINKS];
        let mut to = segment(walked[0].0).0;
        for (slot, &(index, reversed)) in segments.iter_mut().zip(walked.iter()) {
            let (first, len) = segment(index);
            *slot = Segment { first, len, reversed, to };
            to = (to + len) % paths;
        }
        Self { segments, count: walked.len() }
    }
}

/// First seat and number of paths of the segment that ends at this cut.
fn segment(paths: usize, cuts: &[usize], index: usize) -> (usize, usize) {
    let before = cuts[if index == 0 { cuts.len() - 1 } else { index - 1 }];
    let first = if before + 1 == paths { 0 } else { before + 1 };
    (first, (cuts[index] + paths - before - 1) % paths + 1)
}

/// True if all segments with a one-way path keep the same direction.
fn keeps_directions(tour: &Tour, cuts: &[usize], walked: &[(usize, bool)], one_way: &OneWay) -> bool {
    let mut way = None;
    walked.iter().all(|&(index, reversed)| {
        let (first, len) = segment(tour.len(), cuts, index);
        way == Some(reversed) || !one_way.is_within(tour, first, len) || way.replace(reversed).is_none()
    })
}

/// The cut links as the seats before them, ascending, and for each end its side of a segment: `2 s` for the first end of segment
/// `s`, `2 s + 1` for its last, where segment `s` ends at cut `s`.
fn cut(tour: &Tour, ends: &[End]) -> ([usize; MAX_LINKS], [usize; 2 * MAX_LINKS]) {
    let count = ends.len() / 2;
    let mut cuts = [usize::MAX; MAX_LINKS];
    let mut seats = [0; MAX_LINKS];
    for i in 0..count {
        let (a, b) = (tour.position(ends[2 * i]), tour.position(ends[2 * i + 1]));
        // The end at which its path is left lies before the cut.
        seats[i] = (if a & 1 == 1 { a } else { b }) as usize >> 1;
        let mut rank = i;
        while rank > 0 && cuts[rank - 1] > seats[i] {
            cuts[rank] = cuts[rank - 1];
            rank -= 1;
        }
        cuts[rank] = seats[i];
    }
    let mut sides = [0; 2 * MAX_LINKS];
    for i in 0..count {
        let rank = cuts[..count].iter().position(|&cut| cut == seats[i]).unwrap_or(0);
        let (before, behind) = (2 * rank + 1, if rank + 1 == count { 0 } else { 2 * rank + 2 });
        let first_is_before = tour.position(ends[2 * i]) & 1 == 1;
        (sides[2 * i], sides[2 * i + 1]) = if first_is_before { (before, behind) } else { (behind, before) };
    }
    (cuts, sides)
}
