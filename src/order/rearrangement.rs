//! The segments of a tour in a new order.

/// Maximum links in one exchange: a kick's.
pub(super) const MAX_LINKS: usize = 4;

/// A piece of the tour between two cut links, and its new position.
#[derive(Clone, Copy, Default)]
pub(super) struct Segment {
    /// Its current first seat.
    pub(super) first: usize,
    /// Number of paths in it.
    pub(super) len: usize,
    /// True if it is reversed.
    pub(super) reversed: bool,
    /// Its new first seat, which may wrap around past the last seat.
    pub(super) to: usize,
}

/// The segments of a tour in their new order.
///
/// ```text
///      before:  == A == t1--t2 == B == t4--t3 == (A)      cut t1-t2 and t3-t4, join t2-t3 and t4-t1
///      after:   == A == t1--t4 == B == t2--t3 == (A)      B reversed; A, the longest, stays where it is
/// ```
pub(super) struct Rearrangement {
    pub(super) segments: [Segment; MAX_LINKS],
    pub(super) count: usize,
}

impl Rearrangement {
    /// The segments that change seats or direction. The longest never does.
    pub(super) fn moved(&self) -> impl Iterator<Item = &Segment> {
        self.segments[1..self.count].iter().filter(|segment| segment.reversed || segment.first != segment.to)
    }
}
