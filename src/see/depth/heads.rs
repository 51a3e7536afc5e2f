//! How far bodies are behind their faces, and people behind each other.

use super::centre;
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, fast_gaussian, filled_polygon};
use crate::source::Landmarks;
use crate::source::outlines::OVAL;

/// One head, in pixels.
struct Head {
    chin: Point,
    centre: Point,
    /// Unit vector towards the forehead.
    up: Vec2,
    /// Height of the ears above the chin.
    ears: f64,
    width: f64,
    /// 1 on the face, 0 off it, smooth between.
    face: Raster<f32>,
}

/// All heads of a picture.
pub(super) struct Heads {
    heads: Vec<Head>,
    largest: f64,
}

impl Head {
    fn new(face: &Landmarks, [columns, rows]: [usize; 2]) -> Self {
        /// Where the body falls back: around the face's outline scaled by `OUTLINE`, as a Gaussian step of sigma `FALL` widths of
        /// the face. A fall that begins farther out leaves a rim around the face, whose own slopes end before.
        const OUTLINE: f64 = 1.05;
        const FALL: f64 = 0.12;
        let (chin, forehead) = (face.point(152), face.point(10));
        let along = forehead - chin;
        let up = if along.hypot() > 0.0 { along.normalize() } else { Vec2::new(0.0, -1.0) };
        let width = face.width().max(1.0);
        let ears = (face.point(234).midpoint(face.point(454)) - chin).dot(up).max(0.1 * width);
        let centre = chin.midpoint(forehead);
        let larger = |p: &Point| centre + (*p - centre) * OUTLINE;
        let outline: Vec<[f64; 2]> = face.line(&OVAL).iter().map(|p| [larger(p).x, larger(p).y]).collect();
        let inside = filled_polygon(columns, rows, &outline).map(f32::from);
        Self { chin, centre, up, ears, width, face: fast_gaussian(&inside, (FALL * width) as f32) }
    }

    /// 0 on the head, 1 on the body, smooth between: below the ears and off the face.
    fn body(&self, x: usize, y: usize) -> f64 {
        let height = (centre(x, y) - self.chin).dot(self.up);
        smooth_step((self.ears - height) / self.ears) * (1.0 - f64::from(self.face.get(x, y)))
    }

    /// Weight at a point among several heads: the inverse fourth power of the distance in widths of the head's face.
    fn weight(&self, p: Point) -> f64 {
        ((p - self.centre).hypot2() / (self.width * self.width) + 0.01).powi(-2)
    }
}

impl Heads {
    /// `None` without a face; `size` is the raster's.
    pub(super) fn new(faces: &[Landmarks], size: [usize; 2]) -> Option<Self> {
        let heads: Vec<Head> = faces.iter().map(|face| Head::new(face, size)).collect();
        let largest = heads.iter().map(|head| head.width).reduce(f64::max)?;
        Some(Self { heads, largest })
    }

    /// The width of the largest face.
    pub(super) const fn largest(&self) -> f64 {
        self.largest
    }

    /// Distance behind the largest head, 0 or more: of bodies, and of smaller heads, which are farther away.
    pub(super) fn set_back(&self, columns: usize, rows: usize) -> Raster<f32> {
        /// Distance of the body behind the head, in widths of the face: the neck behind the chin.
        const BEHIND: f64 = 0.3;
        /// Extra distance of a face of half the largest one's width, in widths of the largest.
        const FARTHER: f64 = 0.6;
        Raster::from_fn(columns, rows, |x, y| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for head in &self.heads {
                let farther = FARTHER * self.largest * (self.largest / head.width).binary_logarithm();
                let weight = head.weight(centre(x, y));
                sum += weight * (BEHIND * head.width * head.body(x, y) + farther);
                weights += weight;
            }
            (sum / weights) as f32
        })
    }
}

/// From 0 to 1, with continuous slope and curvature.
fn smooth_step(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}
