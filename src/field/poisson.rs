//! Multigrid solver for Poisson's equation on a raster with some given pixels.

use crate::raster::Raster;

/// One grid: unknown heights, the right-hand side times the grid's squared pixel, and a mask of the given pixels.
struct Level {
    z: Raster<f32>,
    source: Raster<f32>,
    is_given: Raster<u8>,
    /// Screening term: subtracted from the Laplacian per unit of height, times the grid's squared pixel.
    screening: f32,
}

/// Solves `laplacian(z) = source` (per squared pixel) with `z = given` at given pixels and slope 0 at the raster's border. Runs `cycles`
/// V-cycles; each removes about nine tenths of the error, so 8 are enough.
pub fn poisson(source: &Raster<f32>, given: &Raster<Option<f32>>, cycles: usize) -> Raster<f32> {
    let mut level = Level::new(source, given, 0.0);
    if level.is_given.pixels().iter().all(|&g| g == 0) {
        // Without a given height the solution is defined up to a constant: the source's mean is removed, and the first pixel is set to
        // 0.
        let mean = source.pixels().iter().map(|&v| f64::from(v)).sum::<f64>() / source.len().max(1) as f64;
        level.source = source.map(|v| v - mean as f32);
    }
    for _ in 0..cycles {
        level.cycle();
    }
    level.z
}

/// Solves `laplacian(z) - z / reach^2 = source`; otherwise like [`poisson`]. Given heights have influence over about `reach` pixels
/// (above 0); farther away the heights tend to `-source * reach^2`.
pub fn screened_poisson(source: &Raster<f32>, given: &Raster<Option<f32>>, reach: f32, cycles: usize) -> Raster<f32> {
    let mut level = Level::new(source, given, 1.0 / (reach * reach));
    for _ in 0..cycles {
        level.cycle();
    }
    level.z
}

impl Level {
    fn new(source: &Raster<f32>, given: &Raster<Option<f32>>, screening: f32) -> Self {
        let is_given = given.map(|v| u8::from(v.is_some()));
        Self { z: given.map(|v| v.unwrap_or(0.0)), source: source.clone(), is_given, screening }
    }

    fn cycle(&mut self) {
        /// Sweeps before and after the coarser grid.
        const SWEEPS: usize = 2;
        /// Sweeps on the coarsest grid.
        const COARSEST_SWEEPS: usize = 60;
        /// Coarsest side in pixels.
        const COARSEST: usize = 6;
        let (width, height) = (self.z.width(), self.z.height());
        if width.min(height) <= COARSEST {
            (0..COARSEST_SWEEPS).for_each(|_| self.sweep());
            return;
        }
        (0..SWEEPS).for_each(|_| self.sweep());
        let mut coarse = self.restricted();
        coarse.cycle();
        self.correct(&coarse.z);
        (0..SWEEPS).for_each(|_| self.sweep());
    }

    /// Sum and number of a pixel's neighbours.
    fn neighbours(z: &Raster<f32>, x: usize, y: usize) -> (f32, f32) {
        let (mut sum, mut count) = (0.0, 0.0);
        let mut add = |v: f32| {
            sum += v;
            count += 1.0;
        };
        if x > 0 {
            add(z.get(x - 1, y));
        }
        if x + 1 < z.width() {
            add(z.get(x + 1, y));
        }
        if y > 0 {
            add(z.get(x, y - 1));
        }
        if y + 1 < z.height() {
            add(z.get(x, y + 1));
        }
        (sum, count)
    }

    /// One round of red-black Gauss-Seidel; each colour reads only the other, so rows can run in parallel.
    fn sweep(&mut self) {
        let width = self.z.width();
        for colour in 0..2 {
            let old = &self.z;
            self.z = Raster::from_fn(width, old.height(), |x, y| {
                if (x + y) % 2 != colour || self.is_given.get(x, y) != 0 {
                    return old.get(x, y);
                }
                let (sum, count) = Self::neighbours(old, x, y);
                (sum - self.source.get(x, y)) / (count + self.screening).max(1.0)
            });
        }
    }

    fn residual(&self, x: usize, y: usize) -> f32 {
        if self.is_given.get(x, y) != 0 {
            return 0.0;
        }
        let (sum, count) = Self::neighbours(&self.z, x, y);
        self.source.get(x, y) - (sum - (count + self.screening) * self.z.get(x, y))
    }

    /// The equation for the error on a grid of half the size. A coarse pixel is given if any of its four children is, so that thin walls
    /// between regions persist.
    fn restricted(&self) -> Self {
        let (width, height) = (self.z.width().div_ceil(2), self.z.height().div_ceil(2));
        let children = |x: usize, y: usize| {
            [(2 * x, 2 * y), (2 * x + 1, 2 * y), (2 * x, 2 * y + 1), (2 * x + 1, 2 * y + 1)]
                .into_iter()
                .filter(|(x, y)| *x < self.z.width() && *y < self.z.height())
        };
        let is_given = Raster::from_fn(width, height, |x, y| u8::from(children(x, y).any(|(x, y)| self.is_given.get(x, y) != 0)));
        // The sum over the children: their mean times the four fine pixels in a coarse one.
        let source = Raster::from_fn(width, height, |x, y| children(x, y).map(|(x, y)| self.residual(x, y)).sum());
        Self { z: Raster::filled(width, height, 0.0), source, is_given, screening: 4.0 * self.screening }
    }

    /// Adds the coarse grid's error, interpolated bilinearly.
    fn correct(&mut self, error: &Raster<f32>) {
        let is_given = &self.is_given;
        let corrected = Raster::from_fn(self.z.width(), self.z.height(), |x, y| {
            let add = if is_given.get(x, y) != 0 { 0.0 } else { error.sample(0.5 * (x as f64 + 0.5), 0.5 * (y as f64 + 0.5)) };
            self.z.get(x, y) + add
        });
        self.z = corrected;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    #[test]
    fn a_disc_bulges_to_a_paraboloid() {
        let radius = |x: usize, y: usize| (x as f32 - 99.5).hypotenuse(y as f32 - 79.5);
        let given = Raster::from_fn(200, 160, |x, y| (radius(x, y) >= 70.0).then_some(0.0_f32));
        let z = poisson(&Raster::filled(200, 160, -4.0), &given, 10);
        for (x, y) in [(99, 79), (130, 79), (60, 100), (99, 20)] {
            let expected = 70.0_f32.powi(2) - radius(x, y).powi(2);
            assert!((z.get(x, y) - expected).abs() < 0.03 * 4900.0, "({x}, {y}): {} for {expected}", z.get(x, y));
        }
    }

    #[test]
    fn screened_heights_fall_off_with_the_distance() {
        let given = Raster::from_fn(200, 20, |x, _| (x == 0).then_some(0.0_f32));
        let z = screened_poisson(&Raster::filled(200, 20, -0.25), &given, 20.0, 10);
        for x in [1, 10, 40, 150] {
            let expected = 100.0 * (1.0 - (-(x as f32) / 20.0).exponential());
            assert!((z.get(x, 10) - expected).abs() < 1.0, "{x}: {} for {expected}", z.get(x, 10));
        }
    }

    #[test]
    fn multigrid_agrees_with_plain_sweeps() {
        let given = Raster::from_fn(40, 30, |x, y| (x == 0 || (x == 20 && y > 8)).then_some(x as f32 * 0.1));
        let source = Raster::from_fn(40, 30, |x, y| ((x * 7 + y * 13) % 11) as f32 * 0.01 - 0.05);
        let mut plain = Level::new(&source, &given, 0.0);
        (0..6000).for_each(|_| plain.sweep());
        let fast = poisson(&source, &given, 12);
        let worst = fast.pixels().iter().zip(plain.z.pixels()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 2e-3, "{worst}");
    }
}
