//! Dark places that are thin from top to bottom, such as a face's features, but not a fringe, a cap or a shaded cheek.

use crate::raster::{Raster, gaussian_blur};

/// Blur, and the height of the tallest feature, in eye distances: taller than an eye or a parted mouth, but less than hair.
const BLUR: f64 = 0.03;
const TALLEST: f64 = 0.34;
/// Added to the lightness before dividing by it, so that black does not turn into noise.
const NOISE: f32 = 0.02;

/// A lightness with its thin dark places filled, and the ratio of the original to it.
pub(super) struct DarkRelief {
    /// The lightness after a vertical closing: features are gone, hair and shadows stay.
    pub filled: Raster<f32>,
    /// The lightness divided by the filled one: 1 where nothing was thin and dark.
    pub relief: Raster<f32>,
}

/// The relief of a face's features; `eye_distance` in pixels.
pub(super) fn dark_relief(lightness: &Raster<f32>, eye_distance: f64) -> DarkRelief {
    let fine = gaussian_blur(lightness, (BLUR * eye_distance) as f32);
    let height = ((TALLEST * eye_distance) as isize).max(1);
    let raised = extreme_of_columns(&fine, height, f32::max);
    // In the opposite direction, so that the two windows end where they began.
    let filled = extreme_of_columns(&raised, -height, f32::min);
    let relief = fine.zip_map(&filled, |fine, filled| (fine + NOISE) / (filled + NOISE));
    DarkRelief { filled, relief }
}

/// The extreme over `|reach|` pixels starting at each pixel, downwards or, if negative, upwards; windows double until they are long
/// enough.
fn extreme_of_columns(raster: &Raster<f32>, reach: isize, pick: fn(f32, f32) -> f32) -> Raster<f32> {
    let step = reach.signum();
    let with = |raster: &Raster<f32>, by: isize| {
        Raster::from_fn(raster.width(), raster.height(), |x, y| {
            pick(raster.get(x, y), raster.clamped(x as isize, y as isize + step * by))
        })
    };
    let mut length = 1;
    let mut found = raster.clone();
    while 2 * length <= reach.abs() {
        found = with(&found, length);
        length *= 2;
    }
    if length < reach.abs() { with(&found, reach.abs() - length) } else { found }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brow_stands_out_and_a_fringe_does_not() {
        let page = Raster::from_fn(100, 200, |_, y| if y < 80 || (120..128).contains(&y) { 0.2 } else { 0.8 });
        let found = dark_relief(&page, 60.0);
        assert!(found.relief.get(50, 124) < 0.5, "{}", found.relief.get(50, 124));
        assert!(found.relief.get(50, 60) > 0.98 && found.relief.get(50, 160) > 0.98);
        assert!(found.filled.get(50, 40) < 0.3 && found.filled.get(50, 124) > 0.7);
    }
}
