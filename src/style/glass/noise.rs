//! The noise that strokes grow from (Papari 2009, equation 7.8).

use crate::parallel::shares;
use crate::raster::{Raster, fast_gaussian};
use crate::style::random;
use rand::RngExt;

/// Noise blurred by `sigma` pixels, with one random stream per row. Before the blur each value is a sum of four uniform numbers; summed
/// over the blur's dozen neighbours it is Gaussian.
pub(super) fn noise(width: usize, height: usize, sigma: f32, seed: u64, stage: &str) -> Raster<f32> {
    let mut white = Raster::filled(width, height, 0.0_f32);
    shares(white.pixels_mut(), width, &|y, row| {
        let mut random = random::stream(seed, stage, y as u64);
        for value in row {
            let bits: u64 = random.random();
            let sum: u32 = (0..4).map(|i| u32::from((bits >> (16 * i)) as u16)).sum();
            *value = sum as f32 / 65536.0 - 2.0;
        }
    });
    fast_gaussian(&white, sigma)
}

/// Smooth noise of variance 1 with a reach in pixels.
pub(super) fn wandering(width: usize, height: usize, reach: f32, seed: u64) -> Raster<f32> {
    // The sum of four uniform numbers has a variance of a third, the blur divides it by its area.
    let whole = (12.0 * std::f32::consts::PI).sqrt() * reach;
    noise(width, height, reach, seed, "wandering").map(|v| whole * v)
}

/// Noise whose grain grows by a factor with a weight of 0 to 1; its variance is that of the fine noise everywhere.
pub(super) fn mixed(fine: &Raster<f32>, broad: &Raster<f32>, factor: f32, weight: &Raster<f32>) -> Raster<f32> {
    let fine = fine.zip_map(weight, |noise, weight| noise * (1.0 - weight).max(0.0).sqrt());
    let broad = broad.zip_map(weight, |noise, weight| factor * noise * weight.max(0.0).sqrt());
    fine.zip_map(&broad, |fine, broad| fine + broad)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_has_no_mean_and_repeats() {
        let field = noise(200, 100, 1.0, 3, "noise");
        let mean = field.pixels().iter().sum::<f32>() / field.len() as f32;
        assert!(mean.abs() < 0.01, "{mean}");
        assert_eq!(field, noise(200, 100, 1.0, 3, "noise"));
        assert_ne!(field, noise(200, 100, 1.0, 4, "noise"));
    }

    #[test]
    fn wandering_noise_has_a_variance_of_one() {
        let field = wandering(700, 700, 6.0, 3);
        // Near the border the blur has fewer values to average.
        let inner = field.part(&(30..670), &(30..670));
        let variance = inner.pixels().iter().map(|v| v * v).sum::<f32>() / inner.len() as f32;
        assert!((variance - 1.0).abs() < 0.2, "{variance}");
    }
}
