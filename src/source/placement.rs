//! Which part of a photograph is drawn, and where it lies on the page.

use super::decode::Photograph;
use super::error::SourceError;
use crate::geometry::{Millimetres, Point, Rect};
use std::ops::Range;

/// Largest relative difference between the proportions of a mask and the photograph's: the rounding of a thumbnail of 50 pixels.
const MOST_DISTORTION: f64 = 0.03;

/// The used part of a photograph in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crop {
    /// Left border.
    pub x: f64,
    /// Upper border.
    pub y: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Crop {
    /// The whole of a photograph.
    pub fn all(photograph: &Photograph) -> Self {
        Self { x: 0.0, y: 0.0, width: f64::from(photograph.width()), height: f64::from(photograph.height()) }
    }

    /// The crop clipped to the photograph; an error unless at least one pixel is left in each direction.
    pub fn within(self, photograph: &Photograph) -> Result<Self, SourceError> {
        let (width, height) = (f64::from(photograph.width()), f64::from(photograph.height()));
        let (x0, y0) = (self.x.clamp(0.0, width), self.y.clamp(0.0, height));
        let (x1, y1) = ((self.x + self.width).clamp(0.0, width), (self.y + self.height).clamp(0.0, height));
        if x1 - x0 >= 1.0 && y1 - y0 >= 1.0 {
            Ok(Self { x: x0, y: y0, width: x1 - x0, height: y1 - y0 })
        } else {
            let (x, y, w, h) = (self.x, self.y, self.width, self.height);
            Err(SourceError::EmptyCrop { x, y, w, h, width: photograph.width(), height: photograph.height() })
        }
    }
}

/// Where the working raster lies on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The picture's box on the page, in millimetres.
    pub picture: Rect,
    /// Working columns.
    pub columns: usize,
    /// Working rows.
    pub rows: usize,
}

impl Placement {
    /// A box with `pixels_per_mm` working pixels per millimetre, rounded to whole pixels.
    pub fn new(picture: Rect, pixels_per_mm: f64) -> Self {
        let count = |length: f64| (length * pixels_per_mm).round().max(1.0) as usize;
        Self { picture, columns: count(picture.width()), rows: count(picture.height()) }
    }

    /// The place of some columns and rows.
    #[must_use]
    pub fn part(&self, columns: &Range<usize>, rows: &Range<usize>) -> Self {
        let corner = |x: usize, y: usize| self.to_page(Point::new(x as f64, y as f64));
        let picture = Rect::from_points(corner(columns.start, rows.start), corner(columns.end, rows.end));
        Self { picture, columns: columns.len(), rows: rows.len() }
    }

    /// Millimetres per pixel, the mean of both directions (over the whole box they differ by less than a pixel).
    pub fn mm_per_pixel(&self) -> f64 {
        (self.picture.area() / (self.columns as f64 * self.rows as f64)).sqrt()
    }

    /// A length on the page in working pixels.
    pub fn pixels(&self, length: Millimetres) -> f64 {
        length.0 / self.mm_per_pixel()
    }

    /// A length in working pixels, on the page.
    pub fn mm(&self, pixels: f64) -> Millimetres {
        Millimetres(pixels * self.mm_per_pixel())
    }

    /// Converts a point on the page from millimetres to working pixels.
    pub fn to_grid(&self, p: Point) -> Point {
        Point::new(
            (p.x - self.picture.x0) * self.columns as f64 / self.picture.width(),
            (p.y - self.picture.y0) * self.rows as f64 / self.picture.height(),
        )
    }

    /// Converts a point from working pixels to millimetres on the page.
    pub fn to_page(&self, p: Point) -> Point {
        Point::new(
            self.picture.x0 + p.x * self.picture.width() / self.columns as f64,
            self.picture.y0 + p.y * self.picture.height() / self.rows as f64,
        )
    }
}

/// The photograph's crop on the pixel grid of a mask or depth map, which has the photograph's proportions at any size.
pub(super) fn crop_on_grid(mask: &Photograph, photograph: &Photograph, crop: Crop) -> Result<Crop, SourceError> {
    let [w, h, width, height] = [mask.width(), mask.height(), photograph.width(), photograph.height()].map(f64::from);
    // The difference of the proportions, cross-multiplied: 0 if equal, up to one pixel of either picture after a program rounded
    // its sides.
    let across = (w * height - h * width).abs();
    if across > width.max(height).max(w).max(h) || across > MOST_DISTORTION * w * height {
        return Err(SourceError::OtherSize {
            width: mask.width(),
            height: mask.height(),
            expected_width: photograph.width(),
            expected_height: photograph.height(),
        });
    }
    let (x, y) = (w / width, h / height);
    Ok(Crop { x: crop.x * x, y: crop.y * y, width: crop.width * x, height: crop.height * y })
}

/// Clips a crop to a photograph, however little is left: a mask may have fewer pixels than the photograph.
pub(super) fn inside(crop: Crop, photograph: &Photograph) -> Crop {
    let (width, height) = (f64::from(photograph.width()), f64::from(photograph.height()));
    let (x, y) = (crop.x.clamp(0.0, width), crop.y.clamp(0.0, height));
    Crop { x, y, width: crop.width.min(width - x), height: crop.height.min(height - y) }
}

/// The centred part of a crop that fills a box of these proportions (`--fit cover`).
pub fn fill_box(crop: Crop, box_width: f64, box_height: f64) -> Crop {
    let shape = box_width / box_height;
    let (width, height) =
        if crop.width / crop.height > shape { (crop.height * shape, crop.height) } else { (crop.width, crop.width / shape) };
    Crop { x: crop.x + 0.5 * (crop.width - width), y: crop.y + 0.5 * (crop.height - height), width, height }
}
