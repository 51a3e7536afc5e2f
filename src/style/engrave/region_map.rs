//! The regions on the page: how far inside its region a point lies, and raster values there.

use super::lines::{FIT_ROOM, Frame};
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect, Vec2};
use crate::raster::Raster;
use crate::source::Placement;

/// Lines end this far inside the picture: the tolerance of their curves, so that no curve bulges over the rim, is cut there and comes
/// too close to itself; and two micrometres for the outlines that programs make of strokes.
const RIM: f64 = FIT_ROOM + 0.002;
/// Distance used if there is no border, in millimetres.
const NO_BORDER: f64 = 1e6;
/// Error of distances to curved borders interpolated between pixels, in pixels.
const BORDER_ERROR: f64 = 0.25;

/// Reads working rasters at places on the page, in millimetres.
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
    pub(super) fn inside_picture(&self, p: Point) -> f64 {
        let r = self.picture;
        (p.x - r.x0).min(r.x1 - p.x).min((p.y - r.y0).min(r.y1 - p.y)) - RIM
    }

    /// The same, separately for the vertical and the horizontal sides.
    pub(super) fn inside_sides(&self, p: Point) -> [f64; 2] {
        let r = self.picture;
        [(p.x - r.x0).min(r.x1 - p.x) - RIM, (p.y - r.y0).min(r.y1 - p.y) - RIM]
    }
}

/// One region.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    pub label: i32,
    /// Direction of its lines in degrees, anticlockwise from the right.
    pub angle: f64,
    /// Bounding box on the page.
    pub bounds: Rect,
}

/// All regions.
#[derive(Clone, Debug)]
pub(super) struct RegionMap {
    pub grid: Grid,
    /// The region of each pixel; 0 stays bare.
    pub labels: Raster<i32>,
    /// Distance to the nearest border of a region, in millimetres; none if one region fills the picture.
    pub border: Option<Raster<f32>>,
    pub regions: Vec<Region>,
    /// Direction of the lines for each label from 1, in degrees.
    pub angles: Vec<f64>,
    /// How far lines are displaced, in millimetres.
    pub displacement: Raster<f32>,
    /// How far lines extend into another region, in millimetres.
    pub overlap: f64,
    /// Minimum distance of lines, in millimetres.
    pub gap: f64,
    /// Distance to a border below which the region beyond it matters, in millimetres.
    pub near: f64,
}

/// Minimum angle between two regions' lines where they meet, in degrees, for them to overlap; at smaller angles they would run side by
/// side. With the angle before displacement, a photograph's superpixels had pairs side by side for two and a half pitches.
const LEAST_ANGLE: f64 = 30.0;
/// Fixed-point rounds that find the origin of a displaced line; on most slopes the origin hardly moves in the last round.
const BACK_ROUNDS: usize = 3;

/// Angle between two lines, in degrees, 0 to 90.
pub(super) fn angle_between(a: f64, b: f64) -> f64 {
    let apart = (a - b).rem_euclid(180.0);
    apart.min(180.0 - apart)
}

impl RegionMap {
    /// How far inside a region a place lies, in millimetres; below 0 outside. The picture's rim is not a border.
    pub(super) fn inside_region(&self, label: i32, p: Point) -> f64 {
        let Some(border) = &self.border else { return NO_BORDER };
        let pixel = self.grid.pixel(p);
        let (fx, fy) = (pixel.x - 0.5, pixel.y - 0.5);
        let (x, y) = (fx.floor(), fy.floor());
        let (tx, ty) = (fx - x, fy - y);
        let (x, y) = (x as isize, y as isize);
        let signed = |x: isize, y: isize| {
            let distance = f64::from(border.clamped(x, y));
            if self.labels.clamped(x, y) == label { distance } else { -distance }
        };
        let top = signed(x, y) * (1.0 - tx) + signed(x + 1, y) * tx;
        let bottom = signed(x, y + 1) * (1.0 - tx) + signed(x + 1, y + 1) * tx;
        top * (1.0 - ty) + bottom * ty
    }

    /// How far a region's lines may extend beyond the border nearest to a place; `turn` is the angle of cross lines in degrees. They
    /// overlap a region with another line direction, and end just before the border of a region with nearly the same direction, whose
    /// lines would meet them.
    fn leave(&self, label: i32, turn: f64, p: Point, inside: f64) -> f64 {
        if !self.has_neighbours() || inside > self.near || inside < -self.overlap - self.gap {
            return 0.0;
        }
        let across = |way: f64| {
            let pixel = self.grid.pixel(p + self.inwards(label, p) * way);
            self.labels.clamped(pixel.x.floor() as isize, pixel.y.floor() as isize)
        };
        let pixel = self.grid.pixel_mm();
        let (here, other) = if inside > 0.0 { (label, across(-inside - pixel)) } else { (across(pixel - inside), across(0.0)) };
        // Outside, the nearest border may lie between two other regions.
        if other <= 0 || other == label || here != label {
            0.0
        } else if self.overlap > 0.0 && self.angle_of_lines([label, other], turn, p) >= LEAST_ANGLE {
            self.overlap
        } else {
            -0.5 * self.gap - BORDER_ERROR * pixel
        }
    }

    /// How far inside the reach of a region's lines, and inside the picture, a place lies; below 0 outside. The second value is the part
    /// of that beyond the region's border, negative if the lines end before it.
    pub(super) fn reach(&self, label: i32, turn: f64, p: Point) -> (f64, f64) {
        let inside = self.inside_region(label, p);
        let leave = self.leave(label, turn, p, inside);
        ((inside + leave).min(self.grid.inside_picture(p)), leave)
    }

    /// How far inside the area that a region's ink may cover a place lies; the picture's rim is not a border.
    pub(super) fn cover(&self, label: i32, turn: f64, p: Point) -> f64 {
        let inside = self.inside_region(label, p);
        inside + self.leave(label, turn, p, inside).max(0.0)
    }

    /// Angle between two regions' lines at a place, in degrees: before or after displacement, whichever is smaller.
    fn angle_of_lines(&self, labels: [i32; 2], turn: f64, p: Point) -> f64 {
        let laid = labels.map(|label| self.angles[label as usize - 1] + turn);
        let [a, b] = laid.map(|angle| angle + self.bend(angle, p));
        angle_between(a, b).min(angle_between(laid[0], laid[1]))
    }

    /// Angle by which displacement turns lines of a direction at a place, in degrees anticlockwise.
    fn bend(&self, degrees: f64, p: Point) -> f64 {
        let frame = Frame::new(degrees);
        let displacement = |p: Point| f64::from(self.grid.read(&self.displacement, p));
        let (u, v) = frame.place(p);
        // A line is displaced by the value at its undisplaced place.
        let origin = (0..BACK_ROUNDS).fold(v, |origin, _| v - displacement(frame.to_page(u, origin)));
        let step = self.grid.pixel_mm();
        let rise = displacement(frame.to_page(u + step, origin)) - displacement(frame.to_page(u - step, origin));
        (0.5 * rise / step).arc_tangent().to_degrees()
    }

    /// Direction towards the inside of a region.
    pub(super) fn inwards(&self, label: i32, p: Point) -> Vec2 {
        let h = 0.5 * self.grid.pixel_mm();
        let along = |step: Vec2| self.inside_region(label, p + step) - self.inside_region(label, p - step);
        let gradient = Vec2::new(along(Vec2::new(h, 0.0)), along(Vec2::new(0.0, h)));
        gradient / gradient.hypot().max(1e-9)
    }

    pub(super) fn has_neighbours(&self) -> bool {
        self.regions.len() > 1
    }
}
