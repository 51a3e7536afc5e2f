//! The bilateral filter (Tomasi and Manduchi 1998), which Bruehl 2023, section 1.4.1 smooths with before isophotes are read.

use super::Raster;

/// Smooths within regions and keeps their edges.
///
/// Each pixel becomes the mean of a window of `2 sigma_space` around it, weighted by a Gaussian of the distance
/// (`sigma_space`, pixels) and one of the difference in value (`sigma_value`, in the raster's own unit).
/// Cost grows with `sigma_space` squared.
pub fn bilateral(raster: &Raster<f32>, sigma_space: f32, sigma_value: f32) -> Raster<f32> {
    let radius = (2.0 * sigma_space).ceil() as isize;
    let side = (2 * radius + 1) as usize;
    let space = Raster::from_fn(side, side, |x, y| {
        let (dx, dy) = (x as f32 - radius as f32, y as f32 - radius as f32);
        (-(dx * dx + dy * dy) / (2.0 * sigma_space * sigma_space)).exp()
    });
    let closeness = ValueWeights::new(sigma_value);
    Raster::from_fn(raster.width(), raster.height(), |x, y| {
        let centre = raster.get(x, y);
        let (mut sum, mut weights) = (0.0_f32, 0.0_f32);
        let columns = columns_inside(x, radius, raster.width());
        for dy in -radius..=radius {
            let Some(row) = y.checked_add_signed(dy).filter(|&row| row < raster.height()) else { continue };
            let values = &raster.row(row)[columns.clone()];
            let first = columns.start + radius as usize - x;
            let window = &space.row((dy + radius) as usize)[first..first + values.len()];
            for (&value, &near) in values.iter().zip(window) {
                let weight = near * closeness.of(value - centre);
                sum += weight * value;
                weights += weight;
            }
        }
        sum / weights
    })
}

fn columns_inside(x: usize, radius: isize, width: usize) -> std::ops::Range<usize> {
    x.saturating_sub(radius as usize)..(x + radius as usize + 1).min(width)
}

/// A Gaussian of the difference in value as a table out to 4 sigma, since `exp` would be most of the filter's time.
struct ValueWeights {
    table: Vec<f32>,
    scale: f32,
}

impl ValueWeights {
    const STEPS: usize = 1024;

    fn new(sigma: f32) -> Self {
        let table = (0..=Self::STEPS).map(|i| (-0.5 * (4.0 * i as f32 / Self::STEPS as f32).powi(2)).exp()).collect();
        Self { table, scale: Self::STEPS as f32 / (4.0 * sigma) }
    }

    fn of(&self, difference: f32) -> f32 {
        self.table[((difference.abs() * self.scale) as usize).min(Self::STEPS)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_a_step_and_flattens_noise() {
        let noisy = Raster::from_fn(40, 20, |x, y| {
            let base = if x < 20 { 0.2 } else { 0.8 };
            base + if (x * 31 + y * 17) % 3 == 0 { 0.02 } else { -0.01 }
        });
        let smooth = bilateral(&noisy, 2.0, 0.1);
        assert!((smooth.get(10, 10) - 0.2).abs() < 0.005);
        assert!((smooth.get(18, 10) - 0.2).abs() < 0.01, "the step stays sharp: {}", smooth.get(18, 10));
        assert!((smooth.get(21, 10) - 0.8).abs() < 0.01);
    }
}
