//! Measured cost of a hedcut.

use super::parameters::{HedcutParameters, Lines};
use crate::geometry::Rect;
use crate::style::cost::{Cost, Each, pixels};

/// Of a pixel: 78 bytes at 100 mm (1 megapixel), 73 at 250 mm (6.3), 80 at 25 x 30 mm and a pitch of 0.05 mm (10.8); with 40 rounds 1.6
/// microseconds at 1, 1.7 at 6.3, 1.7 at 10.8 megapixels.
const PIXEL: Each = Each { bytes: 80.0, microseconds: 1.1 };
/// Additional if every dot has an outline of its own: 90 bytes in all at 250 mm.
const BLOB: Each = Each { bytes: 18.0, microseconds: 0.0 };
/// For each round of relaxation: 1000 rounds took 1.1 s on 0.075 megapixels.
const ROUND: Each = Each { bytes: 0.0, microseconds: 0.015 };
/// For line detection, per pixel of line width above the default of 1.2.
const WIDTH: Each = Each { bytes: 0.0, microseconds: 0.5 };

pub(super) fn cost(parameters: &HedcutParameters, picture: Rect, pixels_per_mm: f64) -> Cost {
    let rounds = f64::from(parameters.plain_rounds + parameters.flow_rounds);
    let wider = if parameters.lines == Lines::Coherent { (parameters.line_width.0 * pixels_per_mm - 1.2).max(0.0) } else { 0.0 };
    let plain = if parameters.blob > 0.0 { PIXEL + BLOB } else { PIXEL };
    Cost::of(pixels(picture, pixels_per_mm), plain + ROUND * rounds + WIDTH * wider)
}
