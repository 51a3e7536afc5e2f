//! Measured cost of a painting; pixels include the frame in which strokes start.

use super::parameters::{GlassParameters, Gradient, Manner};
use crate::geometry::Rect;
use crate::style::cost::{Cost, Each, pixels};

/// Of a pixel, plus that for each pixel of the strokes' length: 480 bytes at 250 mm and 430 at 400 mm with a length of 18 px, 820 at 100
/// mm with one of 357 px; 4.1 microseconds at 400 mm, 17 at 100 mm with a length of 357 px.
const PIXEL: Each = Each { bytes: 470.0, microseconds: 1.7 };
const LENGTH: Each = Each { bytes: 1.0, microseconds: 0.04 };
/// For each step of lightness, bytes only beyond three: 1500 bytes and 11.3 microseconds in all at 250 mm and sixteen steps.
const RIBBON_BYTES: f64 = 80.0;
const RIBBON_MICROSECONDS: f64 = 0.55;
/// Without colours: 220 bytes with one pen, 290 with points, at 250 mm.
const PLAIN: Each = Each { bytes: 290.0, microseconds: PIXEL.microseconds + 4.0 };
/// Additional with brush hairs: 570 bytes in all at 250 mm.
const HAIRS: Each = Each { bytes: 90.0, microseconds: 0.0 };
/// Additional with diffusion: 12 microseconds in all at 250 mm.
const DIFFUSION: Each = Each { bytes: 0.0, microseconds: 8.0 };

pub(super) fn cost(parameters: &GlassParameters, picture: Rect, pixels_per_mm: f64) -> Cost {
    let length = parameters.length.0 * pixels_per_mm;
    let framed = picture.inflate(parameters.length.0, parameters.length.0);
    let ribbons = f64::from(parameters.ribbons);
    let ribboned = Each { bytes: RIBBON_BYTES * (ribbons - 3.0).max(0.0), microseconds: RIBBON_MICROSECONDS * ribbons };
    let mut each = match parameters.manner() {
        Manner::Painting => PIXEL + LENGTH * length + ribboned,
        Manner::OnePen | Manner::Discrete => PLAIN,
    };
    if parameters.hairs > 0.0 {
        each = each + HAIRS;
    }
    if parameters.gradient == Gradient::Diffusion {
        each = each + DIFFUSION;
    }
    Cost::of(pixels(framed, pixels_per_mm), each)
}
