//! Tool paths: what a pen draws between two lifts.

use crate::geometry::{Point, Vec2, polyline_length};
use crate::order::PathEnds;

/// One pen-down path: at least one point; a single one is a touch.
///
/// ```
/// use drypoint::geometry::Point;
/// use drypoint::plot::Toolpath;
///
/// let (from, to) = (Point::new(10.0, 10.0), Point::new(40.0, 10.0));
/// let line = Toolpath::through(from, [to]);
/// assert_eq!((line.first(), line.last(), line.length()), (from, to, 30.0));
/// assert!(Toolpath::new(Vec::new()).is_none(), "it has no point");
/// assert!(line.with_heights(vec![0.0]).is_none(), "it has two points");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Toolpath {
    /// Never empty.
    points: Vec<Point>,
    /// As many as points.
    heights: Option<Vec<f64>>,
    /// How long a touch rests on the paper after the pen has come down, in seconds.
    pub dwell_seconds: f64,
    /// The group. Its paths are drawn consecutively, in their given order and direction.
    pub group: Option<u32>,
}

impl Toolpath {
    /// A line of constant height, or a touch, without a group, through these points in millimetres on the page. None without a
    /// point.
    #[must_use]
    pub fn new(points: Vec<Point>) -> Option<Self> {
        (!points.is_empty()).then_some(Self::level(points))
    }

    /// A touch.
    pub fn touch(at: Point) -> Self {
        Self::level(vec![at])
    }

    /// A line of constant height from a point through others; a touch if there are none.
    pub fn through(first: Point, others: impl IntoIterator<Item = Point>) -> Self {
        Self::level(std::iter::once(first).chain(others).collect())
    }

    /// A path of constant height through at least one point.
    const fn level(points: Vec<Point>) -> Self {
        Self { points, heights: None, dwell_seconds: 0.0, group: None }
    }

    /// The path with the pen's height at each vertex, in millimetres. None unless there are as many heights as points.
    #[must_use]
    pub fn with_heights(mut self, heights: Vec<f64>) -> Option<Self> {
        let is_one_each = heights.len() == self.points.len();
        self.heights = Some(heights);
        is_one_each.then_some(self)
    }

    /// Vertices in millimetres on the page, at least one; a closed path repeats its first.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The pen's height at each vertex in millimetres, if the line's width follows from the height.
    pub fn heights(&self) -> Option<&[f64]> {
        self.heights.as_deref()
    }

    /// Its first point.
    pub fn first(&self) -> Point {
        self.points[0]
    }

    /// Its last point; of a touch, the only one.
    pub fn last(&self) -> Point {
        self.points[self.points.len() - 1]
    }

    /// Its two ends.
    pub fn ends(&self) -> PathEnds {
        PathEnds { start: self.first(), end: self.last() }
    }

    /// True if the path is a single point.
    pub const fn is_touch(&self) -> bool {
        self.points.len() == 1
    }

    /// True if the path is a loop: more than two points, the last equal to the first.
    pub fn is_closed(&self) -> bool {
        self.points.len() > 2 && self.first() == self.last()
    }

    /// Length of the line in millimetres.
    pub fn length(&self) -> f64 {
        polyline_length(&self.points)
    }

    /// The path in the opposite direction.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        self.points.reverse();
        if let Some(heights) = &mut self.heights {
            heights.reverse();
        }
        self
    }

    /// The path elsewhere on the page.
    #[must_use]
    pub fn moved(mut self, by: Vec2) -> Self {
        self.points.iter_mut().for_each(|p| *p += by);
        self
    }

    /// Goes on through more points, at the height of the last.
    pub fn extend(&mut self, points: impl IntoIterator<Item = Point>) {
        self.points.extend(points);
        if let Some(heights) = &mut self.heights {
            heights.resize(self.points.len(), heights.last().copied().unwrap_or_default());
        }
    }

    /// Goes on along another path; where the two meet, their common point is not repeated. It keeps its heights if both have some,
    /// and its own rest and group.
    pub fn append(&mut self, next: Self) {
        let skipped = usize::from(self.last() == next.first());
        self.points.extend(&next.points[skipped..]);
        self.heights = self.heights.take().zip(next.heights).map(|(mut heights, next)| {
            heights.extend(&next[skipped..]);
            heights
        });
    }

    /// Draws another path first, as [`append`](Self::append) draws one afterwards.
    pub fn prepend(&mut self, before: Self) {
        let before = Self { dwell_seconds: self.dwell_seconds, group: self.group, ..before };
        let after = std::mem::replace(self, before);
        self.append(after);
    }

    /// Goes back to its first point, unless it ends there.
    pub fn close(&mut self) {
        if self.first() != self.last() {
            self.points.push(self.first());
            if let Some(heights) = &mut self.heights {
                heights.push(heights[0]);
            }
        }
    }

    /// True for a loop that may be entered anywhere: closed, of finite extent, with equal heights at both ends.
    pub(super) fn is_free(&self) -> bool {
        let is_level = self.heights().is_none_or(|heights| heights.first() == heights.last());
        self.is_closed() && is_level && self.points.iter().any(|p| *p != self.first()) && self.length().is_finite()
    }

    /// The same loop drawn from a point on one of its edges, given by its first vertex. The point becomes a vertex if it is not
    /// one.
    pub(super) fn rotated(&self, edge: usize, at: Point) -> Self {
        let around = self.points.len() - 1;
        let (from, to) = (self.points[edge], self.points[edge + 1]);
        // Both ends of the edge may equal the point.
        let first = if at == from { edge } else { edge + 1 };
        let is_vertex = at == from || at == to;
        let turn = || (0..around).map(|i| (first + i) % around);
        let mut points = Vec::with_capacity(self.points.len() + 2);
        points.extend((!is_vertex).then_some(at));
        points.extend(turn().map(|i| self.points[i]));
        points.push(at);
        let heights = self.heights.as_ref().map(|old| {
            let along = if from == to { 0.0 } else { from.distance(at) / from.distance(to) };
            let height = if is_vertex { old[first] } else { old[edge] + (old[edge + 1] - old[edge]) * along };
            let mut heights = Vec::with_capacity(old.len() + 2);
            heights.extend((!is_vertex).then_some(height));
            heights.extend(turn().map(|i| old[i]));
            heights.push(height);
            heights
        });
        Self { points, heights, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> Point {
        Point::new(x, y)
    }

    fn swelling(points: &[(f64, f64)], heights: &[f64]) -> Toolpath {
        let points = points.iter().map(|&p| p.into()).collect();
        Toolpath::new(points).and_then(|path| path.with_heights(heights.to_vec())).unwrap()
    }

    #[test]
    fn heights_go_with_their_points() {
        let mut path = swelling(&[(0.0, 0.0), (1.0, 0.0)], &[-0.25, -0.5]);
        path.append(swelling(&[(1.0, 0.0), (1.0, 1.0)], &[-0.5, -0.75]));
        path.extend([at(0.0, 1.0)]);
        path.close();
        assert_eq!(path.heights().unwrap(), [-0.25, -0.5, -0.75, -0.75, -0.25]);
        assert!(path.is_free());
        let turned = path.rotated(1, at(1.0, 0.5)).reversed();
        assert_eq!((turned.first(), turned.last(), turned.points().len()), (at(1.0, 0.5), at(1.0, 0.5), 6));
        assert_eq!(turned.heights().unwrap(), [-0.625, -0.5, -0.25, -0.75, -0.75, -0.625]);
    }

    #[test]
    fn a_path_before_another_keeps_the_other_s_rest_and_group() {
        let mut path = Toolpath { group: Some(3), dwell_seconds: 0.5, ..Toolpath::touch(at(2.0, 0.0)) };
        path.prepend(Toolpath::through(at(0.0, 0.0), [at(2.0, 0.0)]));
        assert_eq!(path.points(), [at(0.0, 0.0), at(2.0, 0.0)]);
        assert_eq!((path.group, path.dwell_seconds), (Some(3), 0.5));
        path.append(swelling(&[(5.0, 0.0)], &[-0.1]));
        assert_eq!(path.heights(), None);
        assert_eq!(path.moved(Vec2::new(1.0, 1.0)).points(), [at(1.0, 1.0), at(3.0, 1.0), at(6.0, 1.0)]);
    }
}
