//! A k-d tree of points in the plane, for nearest neighbours in any distribution of points.

use std::cmp::Ordering;

use kurbo::Point;

/// Points with a label each. Labels must differ. They break every tie, which makes results reproducible and keeps searches among
/// thousands of coincident points short.
pub(crate) struct KdTree {
    /// In tree order: the middle element of a range is its root, with one subtree on either side.
    points: Vec<(Point, u32)>,
    /// True if the range with this middle element is split by y.
    by_y: Vec<bool>,
}

/// Ranges up to this length are searched linearly. Twice or half as many make no measurable difference.
const LEAF: usize = 8;

impl KdTree {
    /// Builds the tree in O(n log n) on all threads.
    pub(crate) fn new(mut points: Vec<(Point, u32)>) -> Self {
        let mut by_y = vec![false; points.len()];
        build(&mut points, &mut by_y);
        Self { points, by_y }
    }

    /// The labels in tree order, which tends to keep neighbours in the plane close.
    pub(crate) fn into_labels(self) -> impl Iterator<Item = u32> {
        self.points.into_iter().map(|(_, label)| label)
    }

    /// Collects in `nearest` the `count` points nearest to `query` whose label is `wanted`, the nearest first, as
    /// (squared distance, label). About O(count + log n).
    pub(crate) fn nearest(&self, query: (Point, u32), count: usize, wanted: impl Fn(u32) -> bool, nearest: &mut Vec<(f64, u32)>) {
        nearest.clear();
        if count > 0 {
            let mut search = NearestSearch { query, count, wanted, nearest };
            search.visit(&self.points, &self.by_y);
        }
    }
}

struct NearestSearch<'a, W> {
    query: (Point, u32),
    count: usize,
    wanted: W,
    nearest: &'a mut Vec<(f64, u32)>,
}

impl<W: Fn(u32) -> bool> NearestSearch<'_, W> {
    fn visit(&mut self, points: &[(Point, u32)], by_y: &[bool]) {
        if points.len() <= LEAF {
            for &point in points {
                self.offer(point);
            }
            return;
        }
        let middle = points.len() / 2;
        let root = points[middle];
        let below = (&points[..middle], &by_y[..middle]);
        let above = (&points[middle + 1..], &by_y[middle + 1..]);
        // Comparing labels too sends each of many coincident points to its own leaf.
        let is_below = compare(by_y[middle], &self.query, &root) == Ordering::Less;
        let (near, far) = if is_below { (below, above) } else { (above, below) };
        self.visit(near.0, near.1);
        self.offer(root);
        let offset = self.query.0 - root.0;
        let gap = if by_y[middle] { offset.y } else { offset.x };
        if !self.is_full() || gap * gap < self.reach() {
            self.visit(far.0, far.1);
        }
    }

    fn is_full(&self) -> bool {
        self.nearest.len() == self.count
    }

    /// Squared distance of the farthest point found so far.
    fn reach(&self) -> f64 {
        self.nearest.last().map_or(f64::INFINITY, |&(distance, _)| distance)
    }

    fn offer(&mut self, (point, label): (Point, u32)) {
        let distance = (point - self.query.0).hypot2();
        if self.is_full() && distance >= self.reach() || !(self.wanted)(label) {
            return;
        }
        if self.is_full() {
            self.nearest.pop();
        }
        let rank = self.nearest.iter().rposition(|&(other, _)| other <= distance).map_or(0, |before| before + 1);
        self.nearest.insert(rank, (distance, label));
    }
}

fn build(points: &mut [(Point, u32)], by_y: &mut [bool]) {
    if points.len() <= LEAF {
        return;
    }
    let middle = points.len() / 2;
    by_y[middle] = split(points, middle);
    let (below, above) = points.split_at_mut(middle);
    let (by_y_below, by_y_above) = by_y.split_at_mut(middle);
    rayon::join(|| build(below, by_y_below), || build(&mut above[1..], &mut by_y_above[1..]));
}

/// Partitions the points at index `middle` along the longer side of their bounds. Returns true if they are split by y.
pub(crate) fn split(points: &mut [(Point, u32)], middle: usize) -> bool {
    let by_y = is_taller(points);
    points.select_nth_unstable_by(middle, |a, b| compare(by_y, a, b));
    by_y
}

/// True if the points extend farther in y than in x.
fn is_taller(points: &[(Point, u32)]) -> bool {
    let spread = |axis: fn(&Point) -> f64| {
        let (low, high) =
            points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (p, _)| (low.min(axis(p)), high.max(axis(p))));
        high - low
    };
    spread(|p| p.y) > spread(|p| p.x)
}

fn compare(by_y: bool, a: &(Point, u32), b: &(Point, u32)) -> Ordering {
    let coordinate = |p: &Point| if by_y { p.y } else { p.x };
    coordinate(&a.0).total_cmp(&coordinate(&b.0)).then(a.1.cmp(&b.1))
}
