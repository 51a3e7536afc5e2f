//! Measured cost of a structure grid.

use super::parameters::{GridParameters, Primitive};
use crate::geometry::Rect;
use crate::style::cost::{Cost, Each, pixels};

/// Of a pixel: 112 bytes at 100 mm (1 megapixel), 99 at 250 mm (6.3), 95 at 25 x 30 mm and a pitch of 0.05 mm (10.8); 1.5 microseconds at
/// 1, 1.6 at 6.3 megapixels.
const PIXEL: Each = Each { bytes: 105.0, microseconds: 1.5 };
/// Bytes of a pixel with tiles as hatched outlines: 204 at 250 mm.
const TILE_LINES_BYTES: f64 = 210.0;
/// Additional bytes with `adaptive`, in proportion to it: 163 in all at 250 mm and 0.6.
const ADAPTIVE_BYTES: f64 = 100.0;
/// For each small step that makes the stripes regular: 3470 of them (a window of 10 mm) took 5 s on 1 megapixel.
const STEP_MICROSECONDS: f64 = 0.0015;

pub(super) fn cost(parameters: &GridParameters, picture: Rect, pixels_per_mm: f64) -> Cost {
    let narrowest = parameters.narrowest(parameters.is_for_detail(pixels_per_mm));
    let (adaptive, closer) = (1.0 - narrowest, 1.0 / narrowest);
    // Nodes stand half a pitch apart, closer where stripes do; each small step widens the window by two fifths of a node's square.
    let window = 2.0 * closer * parameters.window / parameters.pitch;
    let steps = f64::from(parameters.rounds) * (0.625 * window * window).max(1.0);
    // Detail regions are a small part of a picture: 109 bytes per pixel on A3 with a face.
    let bytes = if parameters.primitive == Primitive::TileLines { TILE_LINES_BYTES } else { PIXEL.bytes };
    let bytes = bytes + ADAPTIVE_BYTES * f64::from(parameters.adaptive);
    let microseconds = PIXEL.microseconds * (1.0 + 2.0 * adaptive * closer) + STEP_MICROSECONDS * steps * closer * closer;
    Cost::of(pixels(picture, pixels_per_mm), Each { bytes, microseconds })
}
