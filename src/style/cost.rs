//! Cost of a drawing, estimated from its size and parameters before any work is done.
//!
//! Each style has its own figures, measured with `time -v` on the sample astronaut: peak memory, and user seconds on two cores of about
//! 3 GHz. They should be right to about a third, and rather high than low.

use crate::geometry::Rect;
use std::ops::{Add, Mul};

/// Memory and time of one drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Working pixels.
    pub pixels: f64,
    /// Bytes at the peak, without the photograph and its masks.
    pub bytes: f64,
    /// Seconds of work on one core at about 3 GHz; all cores share it.
    pub seconds: f64,
}

/// What one working pixel, or one item of another kind, takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Each {
    pub bytes: f64,
    pub microseconds: f64,
}

impl Add for Each {
    type Output = Self;

    fn add(self, more: Self) -> Self {
        Self { bytes: self.bytes + more.bytes, microseconds: self.microseconds + more.microseconds }
    }
}

impl Mul<f64> for Each {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self { bytes: self.bytes * factor, microseconds: self.microseconds * factor }
    }
}

impl Cost {
    /// The cost of `pixels` working pixels.
    pub(super) fn of(pixels: f64, each: Each) -> Self {
        Self { pixels, bytes: pixels * each.bytes, seconds: 1e-6 * pixels * each.microseconds }
    }

    /// Adds `count` items other than pixels.
    #[must_use]
    pub(super) fn and(self, count: f64, each: Each) -> Self {
        Self { bytes: self.bytes + count * each.bytes, seconds: self.seconds + 1e-6 * count * each.microseconds, ..self }
    }
}

/// The working pixels of a picture.
pub(super) fn pixels(picture: Rect, pixels_per_mm: f64) -> f64 {
    picture.width() * picture.height() * pixels_per_mm * pixels_per_mm
}
