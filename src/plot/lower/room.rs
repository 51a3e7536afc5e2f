//! Where the nib may go on the way from one line of a filling to the next: a step over a hole would fill the hole.

use crate::geometry::{Insets, Point, Region};

/// The places of the nib's middle from which it spills next to nothing.
pub(super) struct Room {
    inside: Region,
    step: f64,
}

/// How far beyond the border a step may take the nib, and the distance of the places on it that are looked at, in nibs.
const SLACK: f64 = 0.1;
const LOOK: f64 = 0.25;

impl Room {
    pub fn new(outermost: &Insets, nib: f64) -> Self {
        // Polygons: nothing is flattened.
        Self { inside: Region::new(&outermost.grown(SLACK * nib).path(), 1.0), step: LOOK * nib }
    }

    /// Whether the nib stays inside between two places.
    pub fn holds(&self, a: Point, b: Point) -> bool {
        let steps = (a.distance(b) / self.step).ceil();
        (1..steps as usize).all(|k| self.inside.contains(a.lerp(b, k as f64 / steps)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::BezPath;

    #[test]
    fn a_step_over_a_hole_is_not_taken_and_one_beside_it_is() {
        let frame = Insets::new(&BezPath::from_svg("M0,0 H10 V10 H0 Z M4,4 V6 H6 V4 Z").unwrap(), 0.01);
        let room = Room::new(&frame.grown(-0.25), 0.5);
        assert!(room.holds(Point::new(2.0, 2.0), Point::new(8.0, 2.0)));
        assert!(!room.holds(Point::new(2.0, 5.0), Point::new(8.0, 5.0)));
        assert!(room.holds(Point::new(2.0, 2.0), Point::new(2.0, 2.0)));
    }
}
