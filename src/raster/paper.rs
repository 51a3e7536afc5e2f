//! Paper: seeded irregular textures for charcoal and pastel.

use super::{Raster, gaussian_blur};
use crate::parallel::collected;

/// Bins of the histogram that equalises the texture; one bin is less than a mark's edge can show.
const LEVELS: usize = 8192;

/// An irregular texture with values distributed evenly over 0 to 1 and hills about `grain` pixels apart.
///
/// White noise (a hash of position and `seed`), band-passed so that no tenth of the sheet is much darker than another, then
/// equalised by rank. It does not repeat. `grain` is at least 2.
pub fn paper_texture(width: usize, height: usize, grain: f32, seed: u64) -> Raster<f32> {
    let white = Raster::from_fn(width, height, |x, y| hash(seed, x as u64, y as u64));
    // The band between the two blurs peaks at a wavelength of 2 pi * 1.26 sigma.
    let sigma = grain / 5.0;
    let (fine, coarse) = (gaussian_blur(&white, sigma), gaussian_blur(&white, 2.0 * sigma));
    // Twice, since equalising changes the interpolated surface between the pixels.
    equalised(&equalised(&fine.zip_map(&coarse, |a, b| a - b)))
}

/// A hash of the position, evenly distributed in -1 to 1 (`SplitMix64`'s finaliser).
fn hash(seed: u64, x: u64, y: u64) -> f32 {
    let mut z = seed.wrapping_add(x.wrapping_mul(0x9e37_79b9_7f4a_7c15)).wrapping_add(y.wrapping_mul(0xd1b5_4a32_d192_ed03));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 40) as f32 / 8_388_608.0 - 1.0
}

/// Pixels that are counted at least if there are more, in rows that are at most this far apart: hills are about five pixels apart.
const ENOUGH: usize = 1 << 20;
const MOST_APART: usize = 4;
/// Bands of rows that are counted in parallel; each has a table of all levels.
const BANDS: usize = 16;

/// Each value replaced by its rank, 0 to 1, among the values of the bilinear surface between pixel centres, on which outlines are
/// drawn. The pixels alone have a wider range.
fn equalised(raster: &Raster<f32>) -> Raster<f32> {
    let bounds = |a: (f32, f32), b: (f32, f32)| (a.0.min(b.0), a.1.max(b.1));
    let (low, high) = raster.pixels().iter().map(|&v| (v, v)).fold((f32::INFINITY, f32::NEG_INFINITY), bounds);
    let scale = if high > low { (LEVELS - 1) as f32 / (high - low) } else { 0.0 };
    let rows = raster.height().div_ceil(BANDS);
    let apart = (raster.len() / ENOUGH).clamp(1, MOST_APART);
    let counted = |band: usize| {
        let mut below = vec![0_u32; LEVELS + 1];
        let mut count = |value: f32| below[((value - low) * scale).clamp(0.0, (LEVELS - 1) as f32) as usize + 1] += 1;
        for y in (band * rows..((band + 1) * rows).min(raster.height())).step_by(apart) {
            let (row, next) = (raster.row(y), raster.row((y + 1).min(raster.height() - 1)));
            for x in 0..raster.width() {
                let right = (x + 1).min(raster.width() - 1);
                // A quarter and three quarters of the way to the neighbours.
                let top = between(row[x], row[right]);
                let bottom = between(next[x], next[right]);
                for (top, bottom) in top.into_iter().zip(bottom) {
                    between(top, bottom).into_iter().for_each(&mut count);
                }
            }
        }
        below
    };
    let mut below = vec![0_u32; LEVELS + 1];
    for band in collected(BANDS, &counted) {
        below.iter_mut().zip(band).for_each(|(all, part)| *all += part);
    }
    for level in 0..LEVELS {
        below[level + 1] += below[level];
    }
    let total = below[LEVELS];
    raster.map(|value| {
        let at = (value - low) * scale;
        let level = (at as usize).min(LEVELS - 1);
        let (from, to) = (below[level] as f32, below[level + 1] as f32);
        ((from + (to - from) * at.fract()) / total.max(1) as f32).clamp(0.0, 1.0)
    })
}

/// The values at a quarter and at three quarters of the way.
fn between(from: f32, to: f32) -> [f32; 2] {
    [from * 0.75 + to * 0.25, from * 0.25 + to * 0.75]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_even_and_seeds_differ() {
        let paper = paper_texture(200, 150, 5.0, 7);
        let between = Raster::from_fn(400, 300, |x, y| paper.sample(0.5 * x as f64 + 0.25, 0.5 * y as f64 + 0.25));
        for limit in [0.1, 0.25, 0.5, 0.9] {
            let share = between.pixels().iter().filter(|v| **v < limit).count() as f32 / between.len() as f32;
            assert!((share - limit).abs() < 0.02, "{share} below {limit}");
        }
        assert_ne!(paper, paper_texture(200, 150, 5.0, 8));
    }
}
