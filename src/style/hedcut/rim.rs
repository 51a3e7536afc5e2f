//! The edge of light hair: as engravers do, it is a little shade inside the silhouette, whose strokes run as the hair does. A line
//! around white or blond hair is a wire.

use crate::raster::{Raster, fast_gaussian};

/// Ink at the silhouette. Looked at on portraits 07, 12, 13 and 15: with 0.45 the edge of white hair is faint, and more would be a second
/// outline.
const RIM: f32 = 0.6;
/// How far the shade reaches inside, as a blur of the subject in pitches.
const REACH: f64 = 1.5;

/// The least ink along the border of the subject, inside it; `pitch` in pixels.
pub(super) fn rim(subject: &Raster<f32>, pitch: f64) -> Raster<f32> {
    let near = fast_gaussian(subject, (REACH * pitch) as f32).map(|v| (2.0 * (1.0 - v)).clamp(0.0, 1.0));
    near.zip_map(subject, |near, subject| RIM * near * subject)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shade_is_inside_the_silhouette_alone() {
        let subject = Raster::from_fn(100, 40, |x, _| f32::from(u8::from(x < 50)));
        let rim = rim(&subject, 6.0);
        let ink = |x: usize| rim.get(x, 20);
        assert!((ink(49) - RIM).abs() < 0.05 && ink(44) < ink(49) && ink(20) < 0.01, "{} {}", ink(49), ink(44));
        assert!((50..100).all(|x| ink(x) == 0.0), "outside is paper");
        assert!(ink(0) < 0.01, "the picture's border is no silhouette");
    }
}
