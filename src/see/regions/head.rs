//! A head's own coordinates: across in widths of the face, up in heights of the face.

use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2};
use crate::source::{LEAST_FACE_WIDTH, Landmarks};

/// A head in a picture. `u` increases to the picture's right: 0 at the middle of the skull, about 0.5 at the ears. `v` increases
/// upwards: 0 at the chin, 1 at the forehead's upper border.
#[derive(Clone, Copy, Debug)]
pub(super) struct Head {
    middle: Point,
    chin: Point,
    up: Vec2,
    across: Vec2,
    /// From ear to ear in pixels, in three dimensions, so that a turned head is as wide as a frontal one.
    pub width: f64,
    /// From chin to forehead in pixels of the picture.
    pub height: f64,
}

impl Head {
    /// The head of a face in the picture's pixels; `None` if the landmarks are degenerate.
    pub(super) fn new(face: &Landmarks) -> Option<Self> {
        /// The middle of the forehead's upper border, the chin, and the ends of the face's width before the ears.
        const FOREHEAD: usize = 10;
        const CHIN: usize = 152;
        const EARS: [usize; 2] = [234, 454];
        /// Distance of the skull's middle behind the face's width line, in widths: on a turned head it shows beside the face.
        const BACK: f64 = 0.3;
        /// Least width and height in pixels, to avoid division by zero.
        const LEAST: f64 = 1.0;
        let [forehead, chin, right, left] = [FOREHEAD, CHIN, EARS[0], EARS[1]].map(|i| face.point(i));
        let rise = forehead - chin;
        let deep = |a: usize, b: usize| face.points[a][2] - face.points[b][2];
        let width = (left - right).hypot().hypotenuse(deep(EARS[0], EARS[1]));
        // The line from ear to ear leans into the picture by the turn of the head.
        let turn = deep(EARS[0], EARS[1]) / width.max(LEAST);
        let up = rise / rise.hypot().max(f64::MIN_POSITIVE);
        let across = Vec2::new(-up.y, up.x);
        let head = Self {
            middle: right.midpoint(left) + across * (BACK * turn * width),
            chin,
            up,
            across,
            width: width.max(LEAST_FACE_WIDTH * rise.hypot()).max(LEAST),
            height: rise.hypot().max(LEAST),
        };
        (rise.hypot() > 0.0 && head.middle.is_finite() && head.width.is_finite() && head.height.is_finite()).then_some(head)
    }

    /// `u` and `v` of a point.
    pub(super) fn coordinates(&self, p: Point) -> [f32; 2] {
        let u = (p - self.middle).dot(self.across) / self.width;
        let v = (p - self.chin).dot(self.up) / self.height;
        [u as f32, v as f32]
    }

    /// The point at `u` and `v`.
    pub(super) fn place(&self, u: f64, v: f64) -> Point {
        let sideways = (self.chin - self.middle).dot(self.across);
        self.chin + self.up * (v * self.height) + self.across * (u * self.width - sideways)
    }

    /// Distance of a point from the middle of the face, in widths of the face.
    pub(super) fn distance(&self, p: Point) -> f64 {
        (p - self.place(0.0, 0.5)).hypot() / self.width
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::face;
    use super::*;

    #[test]
    fn places_and_coordinates_are_each_others_way_back() {
        let head = Head::new(&face(Point::new(100.0, 80.0), 60.0, 0.4)).unwrap();
        for (u, v) in [(0.0, 0.0), (0.4, 1.2), (-1.0, -0.7)] {
            let [back_u, back_v] = head.coordinates(head.place(u, v));
            assert!((f64::from(back_u) - u).abs() < 1e-5 && (f64::from(back_v) - v).abs() < 1e-5);
        }
    }
}
