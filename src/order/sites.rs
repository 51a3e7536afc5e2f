//! The problem as the search sees it: numbered path ends and the distances between them.

use kurbo::Point;

use super::ends::End;
use super::one_way::OneWay;
use super::stops::Stop;
use crate::geometry::kd_tree::KdTree;
use crate::interrupt::Interrupt;

/// Coordinates are clamped to this, so that squares and sums of distances stay finite.
const FARTHEST: f64 = 1e150;

/// Path ends with their positions, including a path for the pen's home.
///
/// The home path closes the open tour, which avoids special cases in the search:
///
/// ```text
///      free end ==== home end ---- first path ---- ... ---- last path ---- (back to the free end)
///                at home                                                0 mm from everywhere
/// ```
///
/// The free end is even like every start, and the home end odd like every end. So "links only join an odd end with an even one"
/// means "every path is drawn forwards", home included. If some path may not be reversed, neither may the home path, as it
/// defines the direction of the tour.
pub(super) struct Sites {
    at: Vec<Point>,
    free: End,
    tolerance: f64,
    one_way: OneWay,
    interrupt: Interrupt,
}

/// How a link may use an end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Role {
    /// The path is entered here.
    Entry,
    /// The path is left here.
    Exit,
    /// Either.
    Either,
}

impl Role {
    /// True if ends with these roles may be linked.
    pub(super) fn may_link(self, other: Self) -> bool {
        self == Self::Either || other == Self::Either || self != other
    }
}

/// Numbers the paths along a k-d tree of their midpoints, so that neighbours on paper are close in memory. Returns the caller's
/// number of each. The home path comes last and is not included.
pub(super) fn numbering(stops: &[Stop]) -> Vec<usize> {
    let middles = stops.iter().map(|stop| clamped(stop.ends.start).midpoint(clamped(stop.ends.end)));
    KdTree::new(middles.zip(0..).collect()).into_labels().map(|path| path as usize).collect()
}

impl Sites {
    /// The ends of all paths in this numbering, and of the home path. Once the interrupt is raised, the search among them stops
    /// with its current result.
    pub(super) fn new(stops: &[Stop], numbering: &[usize], home: Point, interrupt: &Interrupt) -> Self {
        let ends = numbering.iter().flat_map(|&path| [stops[path].ends.start, stops[path].ends.end]);
        let at: Vec<Point> = ends.chain([home, home]).map(clamped).collect();
        let corner = |pick: fn(f64, f64) -> f64| {
            at.iter().copied().reduce(|p, q| Point::new(pick(p.x, q.x), pick(p.y, q.y))).unwrap_or(home)
        };
        // A sum of a dozen distances has an error of about 1e-15 of the extent at most. Gains above this tolerance are real, so
        // the search never cycles.
        let tolerance = 1e-12 * corner(f64::min).distance(corner(f64::max));
        let mut one_way: Vec<bool> = numbering.iter().map(|&path| stops[path].is_one_way()).collect();
        one_way.push(one_way.contains(&true));
        Self { at, free: 2 * numbering.len() as End, tolerance, one_way: OneWay::new(one_way), interrupt: interrupt.clone() }
    }

    /// Some of these ends, renumbered; each consecutive pair belongs to one path.
    pub(super) fn part(&self, ends: &[End], one_way: OneWay) -> Self {
        let at = ends.iter().map(|&end| self.place(end)).collect();
        let free = ends.iter().position(|&end| end == self.free).map_or(End::MAX, |end| end as End);
        Self { at, free, tolerance: self.tolerance, one_way, interrupt: self.interrupt.clone() }
    }

    /// The request to stop the search among these ends.
    pub(super) fn interrupt(&self) -> &Interrupt {
        &self.interrupt
    }

    /// Number of paths, including the home path.
    pub(super) fn path_count(&self) -> usize {
        self.at.len() / 2
    }

    /// Number of ends, including the home path's.
    pub(super) fn end_count(&self) -> usize {
        self.at.len()
    }

    /// The end of the home path that is 0 mm from everything; `End::MAX` if it is not among these ends.
    pub(super) fn free_end(&self) -> End {
        self.free
    }

    /// Position of an end. Meaningless for the free end.
    pub(super) fn place(&self, end: End) -> Point {
        self.at[end as usize]
    }

    /// The paths that may not be reversed.
    pub(super) fn one_way(&self) -> &OneWay {
        &self.one_way
    }

    /// How a link may use this end.
    pub(super) fn role(&self, end: End) -> Role {
        match (self.one_way.contains(end as usize >> 1), end & 1) {
            (false, _) => Role::Either,
            (true, 0) => Role::Entry,
            (true, _) => Role::Exit,
        }
    }

    /// Gains up to this, in millimetres, are rounding errors.
    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Pen-up distance between two ends in millimetres.
    #[inline]
    pub(super) fn distance(&self, a: End, b: End) -> f64 {
        if a == self.free || b == self.free {
            return 0.0;
        }
        // Not `hypot`, which guards against an overflow that the clamping rules out: this is the innermost loop.
        (self.at[a as usize] - self.at[b as usize]).hypot2().sqrt()
    }
}

fn clamped(p: Point) -> Point {
    Point::new(p.x.clamp(-FARTHEST, FARTHEST), p.y.clamp(-FARTHEST, FARTHEST))
}
