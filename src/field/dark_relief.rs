//! Dark places that are thin from top to bottom, as a face's features are and a fringe, a cap or a shaded cheek is not.

use crate::raster::{Raster, gaussian_blur};

/// Blur, and the height of the tallest feature, in distances of the eyes: taller than an eye or a parted mouth, less tall than hair.
const BLUR: f64 = 0.03;
const TALLEST: f64 = 0.34;
/// Added to the lightness before it is divided by, so that black is not all noise.
const NOISE: f32 = 0.02;

/// A lightness with its thin dark places filled, and what share of that light they leave.
pub(super) struct DarkRelief {
    /// The lightness closed downwards: features are gone, hair and shadows stay.
    pub filled: Raster<f32>,
    /// The lightness divided by the filled one: 1 where nothing was thin and dark.
    pub relief: Raster<f32>,
}

/// The relief of features of a face whose eyes are so many pixels apart.
pub(super) fn dark_relief(lightness: &Raster<f32>, eye_distance: f64) -> DarkRelief {
    let fine = gaussian_blur(lightness, (BLUR * eye_distance) as f32);
    let height = ((TALLEST * eye_distance) as isize).max(1);
    let raised = extreme_of_columns(&fine, height, f32::max);
    // Looked for the other way, so that the two windows meet where they began.
    let filled = extreme_of_columns(&raised, -height, f32::min);
    let relief = fine.zip_map(&filled, |fine, filled| (fine + NOISE) / (filled + NOISE));
    DarkRelief { filled, relief }
}

/// The extreme of `|reach|` pixels from each one on, downwards or, when negative, upwards: windows double until they are long enough.
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
