//! Pixels that may be skin, by colour.

use crate::elementary::Elementary as _;
use crate::raster::Raster;

/// Ranges of differences of encoded red, green and blue (0 to 1) for dark to light skin in white light: redder than green, not bluer
/// than green, and less saturated than dyed cloth. Tuned on the busts, whose skins run from light to very dark, and the portraits; lower
/// upper limits lose cheeks in warm light; an orange suit passes these, so only places in a head are tested.
const RED_OVER_GREEN: (f32, f32) = (0.012, 0.28);
const GREEN_OVER_BLUE: (f32, f32) = (-0.02, 0.22);
/// Mean spread of the colours below which a photograph is black and white.
const COLOURLESS: f32 = 0.01;

/// 1 where a colour may be skin, 0 elsewhere; 1 everywhere in a black and white photograph.
pub(super) fn may_be_skin(light: &Raster<[f32; 3]>) -> Raster<f32> {
    let encoded = light.map(|rgb| rgb.map(f32::cube_root));
    let spread: f64 = encoded.pixels().iter().map(|[r, g, b]| f64::from((r - g).abs() + (g - b).abs())).sum();
    if spread < f64::from(COLOURLESS) * encoded.len() as f64 {
        return light.map(|_| 1.0);
    }
    let within = |v: f32, (low, high): (f32, f32)| v > low && v < high;
    encoded.map(|[r, g, b]| {
        let is_skin = within(r - g, RED_OVER_GREEN) && within(g - b, GREEN_OVER_BLUE) && r > 0.25;
        f32::from(u8::from(is_skin))
    })
}
