//! Reducing and enlarging rasters of smooth fields.

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

/// Enlarges a raster that was reduced by `factor` to `width` by `height` pixels, bilinear.
pub fn enlarge(raster: &Raster<f32>, factor: usize, width: usize, height: usize) -> Raster<f32> {
    let scale = 1.0 / factor.max(1) as f64;
    Raster::from_fn(width, height, |x, y| raster.sample((x as f64 + 0.5) * scale, (y as f64 + 0.5) * scale))
}

/// Like [`enlarge`], with the pixels as control points of a uniform cubic B-spline: smooth to the second derivative, and blurred
/// by the spline (variance a third of a pixel squared).
pub fn enlarge_smoothly(raster: &Raster<f32>, factor: usize, width: usize, height: usize) -> Raster<f32> {
    let scale = 1.0 / factor.max(1) as f64;
    // For each position: the first of its four pixels (one before its left neighbour), and their weights.
    let taps = |count: usize| -> Vec<(isize, [f32; 4])> {
        let place = |i: usize| (i as f64 + 0.5) * scale - 0.5;
        (0..count).map(|i| (place(i).floor() as isize - 1, cubic_basis((place(i) - place(i).floor()) as f32))).collect()
    };
    let (columns, rows) = (taps(width), taps(height));
    let wide = Raster::from_fn(width, raster.height(), |x, y| {
        let (first, weights) = columns[x];
        (0..4).map(|k| weights[k] * raster.clamped(first + k as isize, y as isize)).sum::<f32>()
    });
    Raster::from_fn(width, height, |x, y| {
        let (first, weights) = rows[y];
        (0..4).map(|k| weights[k] * wide.clamped(x as isize, first + k as isize)).sum::<f32>()
    })
}

/// The four non-zero cubic B-splines at `t`, 0 to 1 from the second to the third control point.
fn cubic_basis(t: f32) -> [f32; 4] {
    let (s, t2, t3) = (1.0 - t, t * t, t * t * t);
    [s * s * s / 6.0, (3.0 * t3 - 6.0 * t2 + 4.0) / 6.0, (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0) / 6.0, t3 / 6.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_comes_back() {
        let slope = Raster::from_fn(50, 37, |x, y| x as f32 + 2.0 * y as f32);
        for enlarged in [enlarge, enlarge_smoothly] {
            let back = enlarged(&reduce(&slope, 4), 4, 50, 37);
            for (x, y) in [(7, 7), (25, 18), (41, 29)] {
                assert!((back.get(x, y) - slope.get(x, y)).abs() < 1e-3);
            }
        }
    }
}
