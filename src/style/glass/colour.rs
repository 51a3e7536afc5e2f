//! The photograph in the encoding used for mixing strokes.

use crate::drawing::Colour;
use crate::elementary::Elementary as _;
use crate::raster::Raster;

/// Red, green and blue in sRGB encoding, 0 to 1: equal steps look about equal, and the paper's values apply.
pub(super) fn planes(light: &Raster<[f32; 3]>) -> Vec<Raster<f32>> {
    (0..3).map(|channel| light.map(|rgb| encoded(rgb[channel]))).collect()
}

/// sRGB's encoding of linear light, both 0 to 1 (IEC 61966-2-1).
fn encoded(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.power(1.0 / 2.4) - 0.055 }
}

/// A colour, each channel shifted by `shift` (equation 7.13) and kept in gamut.
pub(super) fn shifted(rgb: [f32; 3], shift: f32) -> Colour {
    let [r, g, b] = rgb.map(|v| ((v + shift).clamp(0.0, 1.0) * 255.0).round() as u8);
    Colour { r, g, b }
}
