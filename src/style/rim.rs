//! The edge of light hair: as engravers do, it is a little shade inside the silhouette, whose strokes run as the hair does. A line
//! around white or blond hair is a wire.

use crate::raster::{Raster, fast_gaussian};

/// The least ink along the border of the subject, inside it: `most` at the silhouette, less inwards, `reach` pixels a blur.
pub(in crate::style) fn rim(subject: &Raster<f32>, reach: f64, most: f32) -> Raster<f32> {
    let near = fast_gaussian(subject, reach as f32).map(|v| (2.0 * (1.0 - v)).clamp(0.0, 1.0));
    near.zip_map(subject, |near, subject| most * near * subject)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shade_is_inside_the_silhouette_alone() {
        let subject = Raster::from_fn(100, 40, |x, _| f32::from(u8::from(x < 50)));
        let rim = rim(&subject, 9.0, 0.6);
        let ink = |x: usize| rim.get(x, 20);
        assert!((ink(49) - 0.6).abs() < 0.05 && ink(44) < ink(49) && ink(20) < 0.01, "{} {}", ink(49), ink(44));
        assert!((50..100).all(|x| ink(x) == 0.0), "outside is paper");
        assert!(ink(0) < 0.01, "the picture's border is no silhouette");
    }
}
