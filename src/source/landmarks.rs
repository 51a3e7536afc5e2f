//! The landmarks of a face, numbered as in the networks' mesh.

use super::Spectacles;
use crate::geometry::Point;
use kurbo::Circle;

/// Number of points in the mesh.
pub const POINTS: usize = 468;

/// The landmarks of one face: x, y, z in the same unit. Smaller z is nearer; z is about 0 at the centre of the head's front.
#[derive(Clone, Debug, PartialEq)]
pub struct Landmarks {
    /// The [`POINTS`] points of the mesh.
    pub points: Vec<[f64; 3]>,
    /// The irises: first the person's right, then the left.
    pub irises: [Iris; 2],
    /// The spectacles before the eyes, if any were found.
    pub spectacles: Option<Spectacles>,
    /// The pearls of earrings and necklaces that were found.
    pub pearls: Vec<Circle>,
}

/// One iris.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iris {
    /// Its centre.
    pub centre: Point,
    /// Its radius.
    pub radius: f64,
}

/// A face seen from the side is narrower than its head: [`Landmarks::width`] is at least this fraction of the face's height.
pub const LEAST_FACE_WIDTH: f64 = 0.6;

impl Landmarks {
    /// A point of the mesh in the image plane (x, y).
    pub fn point(&self, index: usize) -> Point {
        Point::new(self.points[index][0], self.points[index][1])
    }

    /// Several points of the mesh, as a polyline.
    pub fn line(&self, indices: &[usize]) -> Vec<Point> {
        indices.iter().map(|&index| self.point(index)).collect()
    }

    /// The distance between the irises, by which landmark errors are normalised.
    pub fn eye_distance(&self) -> f64 {
        (self.irises[1].centre - self.irises[0].centre).hypot()
    }

    /// The width of the face from ear to ear, at least [`LEAST_FACE_WIDTH`] of its height: about the frontal width of a face seen
    /// from the side.
    pub fn width(&self) -> f64 {
        let across = (self.point(454) - self.point(234)).hypot();
        across.max(LEAST_FACE_WIDTH * (self.point(10) - self.point(152)).hypot())
    }

    /// The same face with each point moved by `place` and lengths scaled by `scale`.
    #[must_use]
    pub fn placed(&self, place: impl Fn(Point) -> Point, scale: f64) -> Self {
        let points = self.points.iter().map(|&[x, y, z]| {
            let p = place(Point::new(x, y));
            [p.x, p.y, z * scale]
        });
        let irises = self.irises.map(|iris| Iris { centre: place(iris.centre), radius: iris.radius * scale });
        let spectacles = self.spectacles.as_ref().map(|spectacles| spectacles.placed(&place, scale));
        let pearls = self.pearls.iter().map(|pearl| Circle::new(place(pearl.center), pearl.radius * scale));
        Self { points: points.collect(), irises, spectacles, pearls: pearls.collect() }
    }
}

/// Contours of the mesh, as indices of its points (`MediaPipe`'s canonical face); left and right are the person's.
pub mod outlines {
    /// The outline of the face, from the middle of the forehead, closed.
    pub const OVAL: [usize; 36] = [
        10, 338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288, 397, 365, 379, 378, 400, 377, 152, 148, 176, 149, 150, 136,
        172, 58, 132, 93, 234, 127, 162, 21, 54, 103, 67, 109,
    ];
    /// The lines of a face's front, which stand out beside its outline where it is turned.
    pub const FRONT: [&[usize]; 5] = [&LIPS, &NOSE, &NOSE_WINGS, &LEFT_EYE, &RIGHT_EYE];
    /// The lids of the left eye, closed.
    pub const LEFT_EYE: [usize; 16] = [263, 249, 390, 373, 374, 380, 381, 382, 362, 398, 384, 385, 386, 387, 388, 466];
    /// The lids of the right eye, closed.
    pub const RIGHT_EYE: [usize; 16] = [33, 7, 163, 144, 145, 153, 154, 155, 133, 173, 157, 158, 159, 160, 161, 246];
    /// The left brow: its lower line, then its upper; open.
    pub const LEFT_BROW: [usize; 10] = [276, 283, 282, 295, 285, 336, 296, 334, 293, 300];
    /// The right brow: its lower line, then its upper; open.
    pub const RIGHT_BROW: [usize; 10] = [46, 53, 52, 65, 55, 107, 66, 105, 63, 70];
    /// The lips' outer border, closed.
    pub const LIPS: [usize; 20] = [61, 146, 91, 181, 84, 17, 314, 405, 321, 375, 291, 409, 270, 269, 267, 0, 37, 39, 40, 185];
    /// The border between the lips, closed.
    pub const MOUTH: [usize; 20] = [78, 95, 88, 178, 87, 14, 317, 402, 318, 324, 308, 415, 310, 311, 312, 13, 82, 81, 80, 191];
    /// Around the person's left nostril.
    pub const LEFT_NOSTRIL: [usize; 10] = [438, 457, 274, 461, 462, 326, 305, 460, 455, 439];
    /// Around the person's right nostril.
    pub const RIGHT_NOSTRIL: [usize; 10] = [218, 237, 44, 241, 242, 97, 75, 240, 235, 219];
    /// The ridge of the nose, from between the eyes to below its tip.
    pub const NOSE: [usize; 10] = [168, 6, 197, 195, 5, 4, 1, 19, 94, 2];
    /// The wings of the nose, across its ridge.
    pub const NOSE_WINGS: [usize; 11] = [129, 49, 131, 134, 51, 5, 281, 363, 360, 279, 358];
}
