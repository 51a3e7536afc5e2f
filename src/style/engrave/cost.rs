//! Measured cost of an engraving.

use super::parameters::{Division, EngraveParameters};
use crate::geometry::Rect;
use crate::style::cost::{Cost, pixels};

/// Bytes per pixel: 109 at 100 mm (1 megapixel), 95 at 250 mm (6.3), 90 at 25 x 30 mm and a pitch of 0.05 mm (10.8); no look needs more.
const BYTES: f64 = 100.0;
/// Additional bytes with outlines: 138 in all at 250 mm.
const OUTLINE_BYTES: f64 = 43.0;
/// Microseconds per pixel: 0.43 at 1 and at 6.3 megapixels.
const MICROSECONDS: f64 = 0.45;
/// Additional with superpixels: 1.04 in all at 250 mm.
const SUPERPIXEL_MICROSECONDS: f64 = 0.6;
/// Additional with outlines: 0.65 in all at 250 mm.
const OUTLINE_MICROSECONDS: f64 = 0.25;

/// Additional bytes and microseconds where lines follow the form of a face: 120 bytes in all at 200 mm (4 megapixels), 2.1 microseconds
/// at 90 mm. Whether there is a face is not known here.
const FORM_BYTES: f64 = 20.0;
const FORM_MICROSECONDS: f64 = 1.6;

pub(super) fn cost(parameters: &EngraveParameters, picture: Rect, pixels_per_mm: f64) -> Cost {
    let (mut bytes, mut microseconds) = (BYTES, MICROSECONDS);
    if parameters.has_outline {
        (bytes, microseconds) = (bytes + OUTLINE_BYTES, microseconds + OUTLINE_MICROSECONDS);
    }
    if parameters.may_follow_form() {
        (bytes, microseconds) = (bytes + FORM_BYTES, microseconds + FORM_MICROSECONDS);
    }
    if parameters.regions == Division::Superpixels {
        microseconds += SUPERPIXEL_MICROSECONDS;
    }
    Cost::each(pixels(picture, pixels_per_mm), bytes, microseconds)
}
