//! What is put in order, and how.

use kurbo::Point;

/// The two ends of a path drawn in one go, in millimetres. For a closed path they are the same point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathEnds {
    /// Start of the path as given.
    pub start: Point,
    /// End of the path as given.
    pub end: Point,
}

/// One step of an order: a path and its direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Visit {
    /// Index of the path in the input.
    pub path: usize,
    /// True if it is drawn from its end to its start.
    pub reversed: bool,
}

/// How much work to spend on the order. Budgets count work, not seconds, so the result is the same on any machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Effort {
    /// The order as given.
    None,
    /// About 2 % longer than the best known order for dots, 4 % for segments and 8 % for hatches; about 15 microseconds per path.
    #[default]
    Fast,
    /// About 1 % longer than the best known order; about 50 microseconds per path, and a second for the first thousand.
    Full,
}

/// The directions in which paths may be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Direction {
    /// In either direction, whichever is nearer.
    #[default]
    Either,
    /// Always from start to end.
    AsDrawn,
}

/// A path, or several drawn consecutively, as the search sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop<'a> {
    /// Where the pen is lowered and where it is lifted.
    pub ends: PathEnds,
    /// True if it may be drawn from its end to its start.
    pub may_turn: bool,
    /// The vertices of a loop that may be entered anywhere, the last equal to the first; `ends` both lie on it.
    pub ring: Option<&'a [Point]>,
    /// The edge of the ring on which `ends` lie, by its first vertex.
    pub edge: usize,
}

/// Maximum distance in millimetres between the ends of a path that is as near from one end as from the other, so that the search
/// may ignore its direction. A hundredth of a millimetre is less than the step of most plotters.
const TOUCH: f64 = 0.01;

impl Stop<'_> {
    /// A path with two fixed ends.
    pub fn new(ends: PathEnds, direction: Direction) -> Self {
        Self { ends, may_turn: direction == Direction::Either, ring: None, edge: 0 }
    }

    /// True if its direction matters to the search.
    pub(super) fn is_one_way(&self) -> bool {
        !self.may_turn && self.ends.start.distance(self.ends.end) > TOUCH
    }
}
