//! The regions as places on the page: how far inside its region a point lies, and what a raster says there.

use crate::geometry::{Point, Rect, Vec2};
use crate::raster::Raster;
use crate::source::Placement;

/// Lines end this far within the picture, in millimetres: less than is written, but never outside the page, where they would be
/// cut again.
const RIM: f64 = 1e-5;

/// Working rasters read at places on the page, in millimetres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    picture: Rect,
    scale: (f64, f64),
}

impl Grid {
    pub(super) fn new(placement: &Placement) -> Self {
        let picture = placement.picture;
        Self { picture, scale: (placement.columns as f64 / picture.width(), placement.rows as f64 / picture.height()) }
    }

    /// The place in working pixels.
    pub(super) fn pixel(&self, p: Point) -> Point {
        Point::new((p.x - self.picture.x0) * self.scale.0, (p.y - self.picture.y0) * self.scale.1)
    }

    pub(super) fn read(&self, raster: &Raster<f32>, p: Point) -> f32 {
        let p = self.pixel(p);
        raster.sample(p.x, p.y)
    }

    pub(super) fn pixel_mm(&self) -> f64 {
        1.0 / self.scale.0.min(self.scale.1)
    }

    /// How far inside the picture a place is; below 0 outside.
    fn inside_picture(&self, p: Point) -> f64 {
        let r = self.picture;
        (p.x - r.x0).min(r.x1 - p.x).min((p.y - r.y0).min(r.y1 - p.y)) - RIM
    }
}

/// One region.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    pub label: i32,
    /// Direction of its lines in degrees, anticlockwise from the right.
    pub angle: f64,
    /// Around it, on the page.
    pub bounds: Rect,
}

/// All regions.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    pub grid: Grid,
    /// The region of each pixel; 0 is left bare.
    pub labels: Raster<i32>,
    /// Distance to the nearest border of a region, in millimetres.
    pub border: Raster<f32>,
    pub regions: Vec<Region>,
    /// How far lines run on into another region, in millimetres.
    pub overlap: f64,
}

impl Ground {
    /// How far inside a region a place lies, in millimetres; below 0 outside.
    pub(super) fn inside(&self, label: i32, p: Point) -> f64 {
        let pixel = self.grid.pixel(p);
        let (fx, fy) = (pixel.x - 0.5, pixel.y - 0.5);
        let (x, y) = (fx.floor(), fy.floor());
        let (tx, ty) = (fx - x, fy - y);
        let (x, y) = (x as isize, y as isize);
        let signed = |x: isize, y: isize| {
            let distance = f64::from(self.border.clamped(x, y));
            if self.labels.clamped(x, y) == label { distance } else { -distance }
        };
        let top = signed(x, y) * (1.0 - tx) + signed(x + 1, y) * tx;
        let bottom = signed(x, y + 1) * (1.0 - tx) + signed(x + 1, y + 1) * tx;
        (top * (1.0 - ty) + bottom * ty).min(self.grid.inside_picture(p))
    }

    /// The same with the overlap: a place in another region counts as inside as far as lines run on.
    pub(super) fn inside_or_over(&self, label: i32, p: Point) -> f64 {
        let inside = self.inside(label, p);
        if self.overlap <= 0.0 || inside > 0.0 || self.grid.inside_picture(p) <= 0.0 {
            return inside;
        }
        let pixel = self.grid.pixel(p);
        if self.labels.clamped(pixel.x as isize, pixel.y as isize) > 0 { inside + self.overlap } else { inside }
    }

    /// Towards the inside of a region.
    pub(super) fn inwards(&self, label: i32, p: Point) -> Vec2 {
        let h = 0.5 * self.grid.pixel_mm();
        let along = |step: Vec2| self.inside(label, p + step) - self.inside(label, p - step);
        let gradient = Vec2::new(along(Vec2::new(h, 0.0)), along(Vec2::new(0.0, h)));
        gradient / gradient.hypot().max(1e-9)
    }

    pub(super) fn has_neighbours(&self) -> bool {
        self.regions.len() > 1
    }
}
