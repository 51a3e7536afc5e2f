//! Measured cost of a painting; pixels include the frame in which strokes start.

use super::parameters::{GlassParameters, Gradient, Manner};
use crate::geometry::Rect;
use crate::style::cost::{Cost, pixels};

/// Bytes per pixel, plus those for each pixel of the strokes' length: 480 at 250 mm and 430 at 400 mm with a length of 18 px, 820 at 100
/// mm with one of 357 px.
const BYTES: f64 = 470.0;
const LENGTH_BYTES: f64 = 1.0;
/// Additional bytes for each step of lightness beyond three: 1500 in all at 250 mm and sixteen steps.
const RIBBON_BYTES: f64 = 80.0;
/// Additional bytes with brush hairs: 570 in all at 250 mm.
const HAIR_BYTES: f64 = 90.0;
/// Bytes without colours: 220 with one pen, 290 with points, at 250 mm.
const PLAIN_BYTES: f64 = 290.0;
/// Microseconds per pixel, plus those for each pixel of the strokes' length and for each step of lightness: 4.1 at 400 mm, 11.3 with
/// sixteen steps at 250 mm, 17 at 100 mm with a length of 357 px.
const MICROSECONDS: f64 = 1.7;
const LENGTH_MICROSECONDS: f64 = 0.04;
const RIBBON_MICROSECONDS: f64 = 0.55;
/// Additional with diffusion: 12 in all at 250 mm.
const DIFFUSION_MICROSECONDS: f64 = 8.0;

pub(super) fn cost(parameters: &GlassParameters, picture: Rect, pixels_per_mm: f64) -> Cost {
    let length = parameters.length.0 * pixels_per_mm;
    let framed = picture.inflate(parameters.length.0, parameters.length.0);
    let ribbons = f64::from(parameters.ribbons);
    let (mut bytes, mut microseconds) = match parameters.manner() {
        Manner::Painting => (
            BYTES + LENGTH_BYTES * length + RIBBON_BYTES * (ribbons - 3.0).max(0.0),
            MICROSECONDS + LENGTH_MICROSECONDS * length + RIBBON_MICROSECONDS * ribbons,
        ),
        Manner::OnePen | Manner::Discrete => (PLAIN_BYTES, MICROSECONDS + 4.0),
    };
    if parameters.hairs > 0.0 {
        bytes += HAIR_BYTES;
    }
    if parameters.gradient == Gradient::Diffusion {
        microseconds += DIFFUSION_MICROSECONDS;
    }
    Cost::each(pixels(framed, pixels_per_mm), bytes, microseconds)
}
