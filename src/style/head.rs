//! The frame of a head: across from ear to ear, down to the chin.

use crate::elementary::angle_of;
use crate::geometry::{Point, Vec2};
use crate::source::Landmarks;

/// Points of the mesh: beside the ears, the forehead's middle, between the brows, the chin.
const EARS: (usize, usize) = (234, 454);
const FOREHEAD: usize = 10;
const BETWEEN_BROWS: usize = 168;
const CHIN: usize = 152;

/// The frame of a head, in working pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Head {
    pub across: Vec2,
    pub down: Vec2,
    /// Width of the face, and the height from chin to forehead.
    pub width: f64,
    pub height: f64,
    middle: Point,
    chin: Point,
}

impl Head {
    pub(super) fn new(face: &Landmarks) -> Self {
        let way = face.point(EARS.1) - face.point(EARS.0);
        let across = if way.hypot2() > 0.0 { way.normalize() } else { Vec2::new(1.0, 0.0) };
        let [forehead, brows, chin] = [FOREHEAD, BETWEEN_BROWS, CHIN].map(|i| face.point(i));
        let middle = ((forehead.to_vec2() + brows.to_vec2() + chin.to_vec2()) / 3.0).to_point();
        let height = (chin - forehead).hypot().max(1.0);
        Self { across, down: Vec2::new(-across.y, across.x), width: face.width().max(1.0), height, middle, chin }
    }

    /// A place in widths of the face across from its middle, and in its heights down from the chin.
    pub(super) fn relative(&self, p: Point) -> (f64, f64) {
        ((p - self.middle).dot(self.across) / self.width, (p - self.chin).dot(self.down) / self.height)
    }

    /// The angle of its line between the ears on the page, in radians.
    pub(super) fn roll(&self) -> f64 {
        angle_of(self.across)
    }

    /// How many widths of its face a place lies from the middle of the face.
    pub(super) fn away(&self, p: Point) -> f64 {
        (p - self.middle).hypot() / self.width
    }
}
