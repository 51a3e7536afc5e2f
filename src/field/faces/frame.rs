//! Coordinates of a face.

use crate::elementary::unit_at;
use crate::geometry::{Point, Vec2};

/// Where the crown of a head begins: above it a head has only hair or skin. Between the hairlines of a high and a low forehead.
pub const CROWN: f64 = -0.8;

/// A face's place and size in working pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceFrame {
    /// The midpoint between the eyes.
    pub between_eyes: Point,
    /// Distance between the eyes' middles.
    pub eye_distance: f64,
    /// Height of the face relative to the template, about 1.
    pub stretch: f64,
    /// The tilt of the line through the eyes, in radians.
    pub tilt: f64,
    /// How clearly the pattern stands out, 0 (not at all) to about 1.
    pub score: f64,
    /// Window of each feature, in the order of [`super::FacialFeature::ALL`].
    pub windows: [FeatureWindow; 6],
}

impl FaceFrame {
    /// A place of the template on the page's raster: `across` and `down` in eye distances from the midpoint between the eyes.
    pub fn place(&self, across: f64, down: f64) -> Point {
        let along = unit_at(self.tilt);
        let downwards = Vec2::new(-along.y, along.x);
        self.between_eyes + along * (across * self.eye_distance) + downwards * (down * self.eye_distance * self.stretch)
    }

    /// Converts a place of the raster to eye distances from the midpoint between the eyes: across and down.
    pub fn relative(&self, p: Point) -> (f64, f64) {
        let along = unit_at(self.tilt);
        let offset = p - self.between_eyes;
        let downwards = Vec2::new(-along.y, along.x);
        (offset.dot(along) / self.eye_distance, offset.dot(downwards) / (self.eye_distance * self.stretch))
    }
}

/// Window of a feature, in eye distances from the midpoint between the eyes: its middle across and down, half its sizes across and down.
pub type FeatureWindow = [f64; 4];
