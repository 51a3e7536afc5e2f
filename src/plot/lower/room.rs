//! Where the nib may go between two lines of a filling: a step across a hole would fill the hole.

use crate::geometry::{OffsetOutline, Point, Region};

/// The positions of the nib's centre at which it spills next to nothing.
pub(super) struct Room {
    inside: Region,
    step: f64,
}

impl Room {
    pub fn new(outermost: &OffsetOutline, nib: f64) -> Self {
        /// Distance that a step may take the nib beyond the border, and spacing of the sample points on a step, both in nibs.
        const SLACK: f64 = 0.1;
        const LOOK: f64 = 0.25;
        // The outlines are polygons, so the flattening tolerance has no effect.
        Self { inside: Region::new(&outermost.grown(SLACK * nib).path(), 1.0), step: LOOK * nib }
    }

    /// True if the nib stays inside between two points.
    pub fn allows_step(&self, a: Point, b: Point) -> bool {
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
        let frame = OffsetOutline::new(&BezPath::from_svg("M0,0 H10 V10 H0 Z M4,4 V6 H6 V4 Z").unwrap(), 0.01);
        let room = Room::new(&frame.grown(-0.25), 0.5);
        assert!(room.allows_step(Point::new(2.0, 2.0), Point::new(8.0, 2.0)));
        assert!(!room.allows_step(Point::new(2.0, 5.0), Point::new(8.0, 5.0)));
        assert!(room.allows_step(Point::new(2.0, 2.0), Point::new(2.0, 2.0)));
    }
}
