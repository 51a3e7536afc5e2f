//! The edge of light hair: as engravers do, it is a little shade inside the silhouette, whose strokes run as the hair does. A line
//! around white or blond hair is a wire.

use crate::raster::{Raster, fast_gaussian};

/// Ink at the silhouette. Looked at on portraits 07, 12, 13 and 15: with 0.45 the edge of white hair is faint, and more would be a second
/// outline.
const RIM: f32 = 0.6;
/// How far the shade reaches inside, as a blur of the subject in pitches.
const REACH: f64 = 1.5;

/// A tone with a shade along the border of the subject where it is light; `pitch` in pixels.
pub(super) fn with_rim(tone: &Raster<f32>, subject: &Raster<f32>, pitch: f64) -> Raster<f32> {
    let near = fast_gaussian(subject, (REACH * pitch) as f32).map(|v| (2.0 * (1.0 - v)).clamp(0.0, 1.0));
    tone.zip_map(&near, |tone, near| tone.min(1.0 - RIM * near))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_hair_is_shaded_at_the_silhouette_alone_and_dark_hair_stays() {
        let subject = Raster::from_fn(100, 40, |x, _| f32::from(u8::from(x < 50)));
        let [light, dark] = [0.95, 0.1].map(|tone| with_rim(&Raster::filled(100, 40, tone), &subject, 6.0));
        let ink = |x: usize| 1.0 - light.get(x, 20);
        assert!((ink(49) - RIM).abs() < 0.05 && ink(44) < ink(49) && ink(20) < 0.06, "{} {}", ink(49), ink(44));
        assert!(dark.pixels().iter().take(50).all(|v| (*v - 0.1).abs() < 1e-6), "it is dark enough");
        assert!(ink(0) < 0.06, "the picture's border is no silhouette");
    }
}
