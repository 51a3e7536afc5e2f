//! A line in working pixels.

use crate::geometry::Point;

/// A line in working pixels (`0.5, 0.5` is the centre of the first pixel).
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Vertices; a closed curve does not repeat its first.
    pub points: Vec<Point>,
    /// True if the last vertex is joined to the first.
    pub closed: bool,
}

impl Curve {
    /// Length in pixels, including the closing segment.
    pub fn length(&self) -> f64 {
        let open: f64 = self.points.windows(2).map(|w| w[0].distance(w[1])).sum();
        match (self.points.first(), self.points.last()) {
            (Some(first), Some(last)) if self.closed => open + first.distance(*last),
            _ => open,
        }
    }
}
