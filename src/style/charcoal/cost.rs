//! Measured cost of a charcoal.

use super::parameters::CharcoalParameters;
use crate::geometry::Rect;
use crate::style::cost::{Cost, Each, pixels};

/// Of a pixel: 50 MB and 0.22 s at 10 mm, where 0.36 megapixels hold hardly a mark.
const PIXEL: Each = Each { bytes: 90.0, microseconds: 0.6 };
/// Of each place of a grain of the smudged tone: 1.2 kB and 6.7 microseconds at 250 mm (1.4 million of them), 1.2 kB and 6.3 at 100 mm with
/// grain=0.1 (1 million).
const GRAIN: Each = Each { bytes: 1600.0, microseconds: 8.0 };

pub(super) fn cost(parameters: &CharcoalParameters, picture: Rect, pixels_per_mm: f64) -> Cost {
    let grains = picture.area() / parameters.grain.0.powi(2);
    Cost::of(pixels(picture, pixels_per_mm), PIXEL).and(grains, GRAIN)
}
