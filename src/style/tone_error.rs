//! Where a drawing is darker or lighter than its portrait.

use super::coverage::darkened;
use crate::drawing::Drawing;
use crate::raster::{Raster, gaussian_blur};
use crate::source::Portrait;

/// Ink drawn less ink wanted of each working pixel, -1 (bare where black is wanted) to 1, as an eye sees them that does not resolve
/// `reach` millimetres. The drawing lies as it was drawn, not turned. A layer's ink counts as black, a mark's own colour by its
/// lightness.
pub fn tone_error(drawing: &Drawing, portrait: &Portrait, reach: f64) -> Raster<f32> {
    let placement = &portrait.placement;
    let sigma = (reach / placement.mm_per_pixel()) as f32;
    let marks = drawing.marks().map(|mark| (mark, mark.colour().map_or(1.0, |colour| 1.0 - colour.lightness() as f32)));
    let drawn = gaussian_blur(&darkened(marks, placement), sigma);
    gaussian_blur(&portrait.ink(), sigma).zip_map(&drawn, |wanted, drawn| drawn - wanted)
}
