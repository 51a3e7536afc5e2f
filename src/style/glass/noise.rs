//! The noise that strokes grow from (Papari 2009, equation 7.8).

use crate::raster::{Raster, fast_gaussian};
use crate::style::random;
use rand::RngExt;
use rayon::prelude::*;

/// Noise blurred by `sigma` pixels, with one random stream per row. Before the blur each value is a sum of four uniform numbers; summed
/// over the blur's dozen neighbours it is Gaussian.
pub(super) fn noise(width: usize, height: usize, sigma: f32, seed: u64, stage: &str) -> Raster<f32> {
    let mut white = Raster::filled(width, height, 0.0_f32);
    white.pixels_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        let mut random = random::stream(seed, stage, y as u64);
        for value in row {
            let bits: u64 = random.random();
            let sum: u32 = (0..4).map(|i| u32::from((bits >> (16 * i)) as u16)).sum();
            *value = sum as f32 / 65536.0 - 2.0;
        }
    });
    fast_gaussian(&white, sigma)
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
}
