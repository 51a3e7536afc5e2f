//! Spectacles, as the lines of their frame.

use crate::geometry::Point;

/// The frame of a face's spectacles, in the unit of its landmarks.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectacles {
    /// The rims around the person's right and left eye; each is closed, its first point is not repeated.
    pub rims: [Vec<Point>; 2],
    /// The bridge over the nose, from the right rim to the left; open.
    pub bridge: Vec<Point>,
    /// The temples, from each rim towards the ear; open, empty where they are not seen.
    pub temples: [Vec<Point>; 2],
    /// Width of the frame.
    pub width: f64,
}

impl Spectacles {
    /// All lines, the closed ones with their first point repeated.
    pub fn lines(&self) -> Vec<Vec<Point>> {
        let closed = |rim: &Vec<Point>| rim.iter().chain(rim.first()).copied().collect();
        let open = std::iter::once(&self.bridge).chain(&self.temples).filter(|line| line.len() > 1).cloned();
        self.rims.iter().map(closed).chain(open).collect()
    }

    /// The same spectacles with each point moved by `place` and lengths scaled by `scale`.
    #[must_use]
    pub fn placed(&self, place: impl Fn(Point) -> Point, scale: f64) -> Self {
        let moved = |line: &Vec<Point>| line.iter().map(|p| place(*p)).collect::<Vec<_>>();
        let both = |lines: &[Vec<Point>; 2]| [moved(&lines[0]), moved(&lines[1])];
        Self { rims: both(&self.rims), bridge: moved(&self.bridge), temples: both(&self.temples), width: self.width * scale }
    }
}
