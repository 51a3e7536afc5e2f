//! Measured cost of a hedcut.

use super::parameters::{HedcutParameters, Lines};
use crate::geometry::Rect;
use crate::style::cost::{Cost, pixels};

/// Bytes per pixel: 78 at 100 mm (1 megapixel), 73 at 250 mm (6.3), 80 at 25 x 30 mm and a pitch of 0.05 mm (10.8).
const BYTES: f64 = 80.0;
/// Additional bytes if every dot has an outline of its own: 90 in all at 250 mm.
const BLOB_BYTES: f64 = 18.0;
/// Microseconds per pixel: 1.6 at 1, 1.7 at 6.3, 1.7 at 10.8 megapixels, with 40 rounds.
const MICROSECONDS: f64 = 1.1;
/// For each round of relaxation: 1000 rounds took 1.1 s on 0.075 megapixels.
const ROUND_MICROSECONDS: f64 = 0.015;
/// For line detection, per pixel of line width above the default of 1.2.
const WIDTH_MICROSECONDS: f64 = 0.5;

pub(super) fn cost(parameters: &HedcutParameters, picture: Rect, pixels_per_mm: f64) -> Cost {
    let rounds = f64::from(parameters.plain_rounds + parameters.flow_rounds);
    let wider = if parameters.lines == Lines::Coherent { (parameters.line_width.0 * pixels_per_mm - 1.2).max(0.0) } else { 0.0 };
    let bytes = if parameters.blob > 0.0 { BYTES + BLOB_BYTES } else { BYTES };
    let microseconds = MICROSECONDS + ROUND_MICROSECONDS * rounds + WIDTH_MICROSECONDS * wider;
    Cost::each(pixels(picture, pixels_per_mm), bytes, microseconds)
}
