//! Cost of a drawing, estimated from its size and parameters before any work is done.
//!
//! Each style has its own figures, measured with `time -v` on the sample astronaut: peak memory, and user seconds on two cores of about
//! 3 GHz. They should be right to about a third, and rather high than low.

use crate::geometry::Rect;

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

impl Cost {
    /// `bytes` and `microseconds` for each of `pixels` working pixels.
    pub(super) fn each(pixels: f64, bytes: f64, microseconds: f64) -> Self {
        Self { pixels, bytes: pixels * bytes, seconds: 1e-6 * pixels * microseconds }
    }

    /// Adds `count` items, other than pixels, of `bytes` and `microseconds` each.
    #[must_use]
    pub(super) fn and(self, count: f64, bytes: f64, microseconds: f64) -> Self {
        Self { bytes: self.bytes + count * bytes, seconds: self.seconds + 1e-6 * count * microseconds, ..self }
    }
}

/// The working pixels of a picture.
pub(super) fn pixels(picture: Rect, pixels_per_mm: f64) -> f64 {
    picture.width() * picture.height() * pixels_per_mm * pixels_per_mm
}
