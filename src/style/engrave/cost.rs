//! Measured cost of an engraving.

use super::parameters::{Division, EngraveParameters};
use crate::geometry::Rect;
use crate::style::cost::{Cost, Each, pixels};

/// Of a pixel: 109 bytes at 100 mm (1 megapixel), 95 at 250 mm (6.3), 90 at 25 x 30 mm and a pitch of 0.05 mm (10.8), and no look needs
/// more; 0.43 microseconds at 1 and at 6.3 megapixels.
const PIXEL: Each = Each { bytes: 100.0, microseconds: 0.45 };
/// Additional with outlines: 138 bytes and 0.65 microseconds in all at 250 mm.
const OUTLINE: Each = Each { bytes: 43.0, microseconds: 0.25 };
/// Additional where lines follow the form of a face: 164 bytes and 2.6 microseconds in all at 200 mm (9 megapixels), told a fifth lower,
/// since whether there is a face is not known here and straight lines take 100.
const FORM: Each = Each { bytes: 30.0, microseconds: 1.9 };
/// Additional with superpixels: 1.04 microseconds in all at 250 mm.
const SUPERPIXELS: Each = Each { bytes: 0.0, microseconds: 0.6 };

pub(super) fn cost(parameters: &EngraveParameters, picture: Rect, pixels_per_mm: f64) -> Cost {
    let mut each = PIXEL;
    if parameters.has_outline {
        each = each + OUTLINE;
    }
    if parameters.may_follow_form() {
        each = each + FORM;
    }
    if parameters.regions == Division::Superpixels {
        each = each + SUPERPIXELS;
    }
    Cost::of(pixels(picture, pixels_per_mm), each)
}
