//! The pyramids of Burt and Adelson (1983): halving and doubling a raster.

use super::Raster;

/// Their five weights for a = 0.375, which are binomial.
const WEIGHTS: [f32; 5] = [1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0];

/// Every second pixel of the smoothed raster; an odd side is rounded up.
pub fn halved(raster: &Raster<f32>) -> Raster<f32> {
    halved_rows(&halved_rows(raster).transposed()).transposed()
}

/// A halved raster interpolated smoothly to its former size.
pub fn doubled(raster: &Raster<f32>, width: usize, height: usize) -> Raster<f32> {
    doubled_rows(&doubled_rows(raster, width).transposed(), height).transposed()
}

fn halved_rows(raster: &Raster<f32>) -> Raster<f32> {
    Raster::from_fn(raster.width().div_ceil(2), raster.height(), |x, y| {
        (0..5).map(|k| WEIGHTS[k] * raster.clamped(2 * x as isize + k as isize - 2, y as isize)).sum()
    })
}

fn doubled_rows(raster: &Raster<f32>, width: usize) -> Raster<f32> {
    Raster::from_fn(width, raster.height(), |x, y| {
        let at = |i: usize| raster.clamped(i as isize, y as isize);
        let i = x / 2;
        if x % 2 == 0 {
            2.0 * (WEIGHTS[0] * (raster.clamped(i as isize - 1, y as isize) + at(i + 1)) + WEIGHTS[2] * at(i))
        } else {
            2.0 * WEIGHTS[1] * (at(i) + at(i + 1))
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_comes_back_but_at_the_border() {
        let slope = Raster::from_fn(41, 30, |x, y| 0.01 * x as f32 + 0.02 * y as f32);
        let back = doubled(&halved(&slope), 41, 30);
        for (x, y) in [(6, 7), (20, 15), (33, 22)] {
            assert!((back.get(x, y) - slope.get(x, y)).abs() < 1e-4);
        }
    }
}
