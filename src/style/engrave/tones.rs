//! Ink of each layer (Galarza 2017, sections 3.2, 3.6 and 4.4).

use super::parameters::Look;
use crate::elementary::Elementary as _;
use crate::raster::Raster;

/// Maximum share of the paper that a crossed layer covers: beyond it the holes of the net close in print.
const MOST_COVERED: f32 = 0.999;

/// Exponent of the tone that the lines alone leave in dark tones: at 0.5 both layers are equal and dark cloth is a net without a
/// direction, at 1 nothing crosses and the slits between the lines close.
const LINES_SHARE: f32 = 0.65;

/// Ink of the lines and of the cross lines, 0 to 1 each: `(1 - lines) (1 - cross) = tone`, since layers that cross at an angle overlap
/// like independent events.
pub(super) struct Layers {
    pub lines: Raster<f32>,
    pub cross: Option<Raster<f32>>,
}

/// Ink of the two layers for the target ink, crossed below the tone `threshold`.
pub(super) fn layers(ink: &Raster<f32>, look: Look, threshold: f64) -> Layers {
    let threshold = threshold as f32;
    match look {
        Look::Hatch | Look::Stipple => Layers { lines: ink.clone(), cross: None },
        // Shadows only, with their full ink from a quarter darker on.
        Look::Contour => Layers { lines: ink.map(|v| v * ((v - (1.0 - threshold)) / 0.25).clamp(0.0, 1.0)), cross: None },
        Look::Net => both(ink, |tone| 1.0 - tone.sqrt()),
        // The lines stop growing where the cross lines begin, and continue before both are equal.
        Look::Engraving | Look::Crosshatch => {
            both(ink, |tone| (1.0 - tone.power(LINES_SHARE)).max((1.0 - tone).min(1.0 - threshold)))
        }
    }
}

fn both(ink: &Raster<f32>, lines: impl Fn(f32) -> f32 + Sync) -> Layers {
    let covered = ink.map(|v| lines((1.0 - v).clamp(0.0, 1.0)).clamp(0.0, MOST_COVERED));
    let cross = ink.zip_map(&covered, |v, covered| (1.0 - (1.0 - v.clamp(0.0, 1.0)) / (1.0 - covered)).clamp(0.0, 1.0));
    Layers { lines: covered, cross: Some(cross) }
}
