//! Smaller and larger rasters, for fields that are smooth.

use super::Raster;

/// Means of `factor x factor` blocks; the last row and column of blocks may be smaller.
pub fn reduce(raster: &Raster<f32>, factor: usize) -> Raster<f32> {
    let factor = factor.max(1);
    Raster::from_fn(raster.width().div_ceil(factor), raster.height().div_ceil(factor), |x, y| {
        let (right, bottom) = (((x + 1) * factor).min(raster.width()), ((y + 1) * factor).min(raster.height()));
        let rows = y * factor..bottom;
        let count = (rows.len() * (right - x * factor)) as f32;
        rows.map(|y| raster.row(y)[x * factor..right].iter().sum::<f32>()).sum::<f32>() / count
    })
}

/// The raster that was reduced by `factor`, `width` by `height` pixels large again, bilinear.
pub fn enlarge(raster: &Raster<f32>, factor: usize, width: usize, height: usize) -> Raster<f32> {
    let scale = 1.0 / factor.max(1) as f64;
    Raster::from_fn(width, height, |x, y| raster.sample((x as f64 + 0.5) * scale, (y as f64 + 0.5) * scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_comes_back() {
        let slope = Raster::from_fn(50, 37, |x, y| x as f32 + 2.0 * y as f32);
        let back = enlarge(&reduce(&slope, 4), 4, 50, 37);
        for (x, y) in [(5, 5), (25, 18), (44, 30)] {
            assert!((back.get(x, y) - slope.get(x, y)).abs() < 1e-3);
        }
    }
}
