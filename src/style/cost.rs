//! What a drawing will take, foretold from its size and its parameters before any work is done.
//!
//! Each style has its own figures, measured with `time -v` on the astronaut of the samples: the peak of memory, and the user's seconds
//! on two cores of about 3 GHz. They are meant to be right to a third or so, and high rather than low.

use crate::geometry::Rect;

/// The memory and the work of one drawing.
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
    /// So many bytes and microseconds for each working pixel.
    pub(super) fn each(pixels: f64, bytes: f64, microseconds: f64) -> Self {
        Self { pixels, bytes: pixels * bytes, seconds: 1e-6 * pixels * microseconds }
    }

    /// With so many things more that are no pixels.
    #[must_use]
    pub(super) fn and(self, count: f64, bytes: f64, microseconds: f64) -> Self {
        Self { bytes: self.bytes + count * bytes, seconds: self.seconds + 1e-6 * count * microseconds, ..self }
    }
}

/// The working pixels of a picture.
pub(super) fn pixels(picture: Rect, pixels_per_mm: f64) -> f64 {
    picture.width() * picture.height() * pixels_per_mm * pixels_per_mm
}
