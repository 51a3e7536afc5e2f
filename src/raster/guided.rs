//! The guided filter (He, Sun and Tang 2010): a mask takes on the edges of a colour picture. Also its fast form (He and Sun
//! 2015), for a mask coarser than the picture.

use super::{Raster, box_blur};

/// `raster` smoothed along the edges of `guide` (same size, values 0 to 1): in each window of `radius` pixels it is fitted as a
/// linear function of the guide's three channels, by least squares, and each pixel takes the mean of the functions of its
/// windows. Edges of a contrast well below the root of `eps` are ignored. The time does not depend on `radius`.
///
/// # Panics
/// If the sizes differ.
pub fn guided_filter(guide: &Raster<[f32; 3]>, raster: &Raster<f32>, radius: usize, eps: f64) -> Raster<f32> {
    fitted(guide, raster, radius, eps).zip_map(guide, applied)
}

/// The guided filter with the raster as its own guide: smooths, but keeps edges of a contrast above the root of `eps`.
pub fn self_guided(raster: &Raster<f32>, radius: usize, eps: f32) -> Raster<f32> {
    let mean = |raster: &Raster<f32>| box_blur(&box_blur(raster, radius), (radius / 2).max(1));
    let means = mean(raster);
    let spread = mean(&raster.map(|v| v * v)).zip_map(&means, |square, m| (square - m * m).max(0.0));
    let slope = spread.map(|v| v / (v + eps));
    let offset = mean(&slope.zip_map(&means, |a, m| m - a * m));
    mean(&slope).zip_map(raster, |a, v| a * v).zip_map(&offset, |av, b| av + b)
}

/// A coarse raster, values 0 to 1, enlarged to the grid of a picture of bytes, along the picture's edges. The guided filter's
/// functions are fitted on `coarse_guide` (the same picture at the coarse raster's size, values 0 to 1) in windows of `radius`
/// coarse pixels; each fine pixel takes their bilinear interpolation.
///
/// # Panics
/// If the coarse sizes differ.
pub fn guided_enlargement(
    guide: &Raster<[u8; 3]>,
    coarse_guide: &Raster<[f32; 3]>,
    coarse: &Raster<f32>,
    radius: usize,
    eps: f64,
) -> Raster<f32> {
    let functions = fitted(coarse_guide, coarse, radius, eps);
    let columns = neighbours(guide.width(), functions.width());
    let rows = neighbours(guide.height(), functions.height());
    Raster::from_fn(guide.width(), guide.height(), |x, y| {
        let ((left, right, tx), (above, below, ty)) = (columns[x], rows[y]);
        let corners =
            [functions.get(left, above), functions.get(right, above), functions.get(left, below), functions.get(right, below)];
        applied(mean_of_corners(corners, tx, ty), shares_of_bytes(guide.get(x, y)))
    })
}

/// The mean of four functions by a place between their pixels, 0 to 1 across and down; left and right above, left and right below.
#[inline]
pub(crate) fn mean_of_corners(corners: [[f32; 4]; 4], across: f32, down: f32) -> [f32; 4] {
    let weights = [(1.0 - across) * (1.0 - down), across * (1.0 - down), (1.0 - across) * down, across * down];
    let mut mean = [0.0; 4];
    for (k, sum) in mean.iter_mut().enumerate() {
        (0..4).for_each(|corner| *sum += weights[corner] * corners[corner][k]);
    }
    mean
}

/// Bytes as shares of the largest, 0 to 1.
#[inline]
pub(crate) fn shares_of_bytes(bytes: [u8; 3]) -> [f32; 3] {
    bytes.map(|v| f32::from(v) / 255.0)
}

/// For each of `fine` pixels in a row: the two of `coarse` between whose centres it lies, and its position between them, 0 to 1.
fn neighbours(fine: usize, coarse: usize) -> Vec<(usize, usize, f32)> {
    let last = coarse.saturating_sub(1);
    let place = |i: usize| ((i as f64 + 0.5) * coarse as f64 / fine as f64 - 0.5).clamp(0.0, last as f64);
    (0..fine).map(place).map(|p| (p as usize, (p as usize + 1).min(last), p.fract() as f32)).collect()
}

/// The value, 0 to 1, of a function at a colour: slopes for the three channels, then the offset.
fn applied(function: [f32; 4], colour: [f32; 3]) -> f32 {
    let sum = (0..3).map(|k| function[k] * colour[k]).sum::<f32>();
    (sum + function[3]).clamp(0.0, 1.0)
}

/// For each pixel, the mean of the linear functions of its windows: slopes for the guide's three channels, then the offset.
fn fitted(guide: &Raster<[f32; 3]>, raster: &Raster<f32>, radius: usize, eps: f64) -> Raster<[f32; 4]> {
    let mean = |plane: &Raster<f32>| box_blur(plane, radius);
    let channels = [0, 1, 2].map(|k| guide.map(|colour| colour[k]));
    let means = channels.each_ref().map(mean);
    let mean_value = mean(raster);
    let covariance = |a: &Raster<f32>, b: &Raster<f32>, mean_a: &Raster<f32>, mean_b: &Raster<f32>| {
        mean(&a.zip_map(b, |a, b| a * b)).zip_map(&mean_a.zip_map(mean_b, |a, b| a * b), |ab, product| ab - product)
    };
    let with_value = [0, 1, 2].map(|k| covariance(&channels[k], raster, &means[k], &mean_value));
    // Upper triangle of the guide's covariance, row by row.
    let spread = PAIRS.map(|(i, j)| covariance(&channels[i], &channels[j], &means[i], &means[j]));
    let slopes = Raster::from_fn(guide.width(), guide.height(), |x, y| {
        let at = |plane: &Raster<f32>| f64::from(plane.get(x, y));
        solved(spread.each_ref().map(at), with_value.each_ref().map(at), eps)
    });
    drop((spread, with_value));
    let offset = Raster::from_fn(guide.width(), guide.height(), |x, y| {
        let slope = slopes.get(x, y);
        mean_value.get(x, y) - (0..3).map(|k| slope[k] * means[k].get(x, y)).sum::<f32>()
    });
    drop((means, mean_value));
    let slope = [0, 1, 2].map(|k| mean(&slopes.map(|slope| slope[k])));
    let offset = mean(&offset);
    Raster::from_fn(guide.width(), guide.height(), |x, y| {
        [slope[0].get(x, y), slope[1].get(x, y), slope[2].get(x, y), offset.get(x, y)]
    })
}

/// Rows and columns of a symmetric matrix's upper triangle.
const PAIRS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// The solution of `(S + eps) x = v`, `S` symmetric and given by its upper triangle, by Cramer's rule.
fn solved([rr, rg, rb, gg, gb, bb]: [f64; 6], [r, g, b]: [f64; 3], eps: f64) -> [f32; 3] {
    let (rr, gg, bb) = (rr + eps, gg + eps, bb + eps);
    let cofactors = [gg * bb - gb * gb, gb * rb - rg * bb, rg * gb - gg * rb];
    let determinant = rr * cofactors[0] + rg * cofactors[1] + rb * cofactors[2];
    if determinant.abs() < f64::MIN_POSITIVE {
        return [0.0; 3];
    }
    let (second, third, last) = (rr * bb - rb * rb, rg * rb - rr * gb, rr * gg - rg * rg);
    [
        (cofactors[0] * r + cofactors[1] * g + cofactors[2] * b) / determinant,
        (cofactors[1] * r + second * g + third * b) / determinant,
        (cofactors[2] * r + third * g + last * b) / determinant,
    ]
    .map(|v| v as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coarse_mask_takes_the_edge_of_the_picture() {
        let guide = Raster::from_fn(60, 40, |x, _| if x < 30 { [0.2, 0.5, 0.1] } else { [0.6, 0.3, 0.7] });
        let coarse = Raster::from_fn(60, 40, |x, _| ((x as f32 - 22.0) / 16.0).clamp(0.0, 1.0));
        let fine = guided_filter(&guide, &coarse, 8, 1e-4);
        assert!(fine.get(28, 20) < 0.3 && fine.get(31, 20) > 0.7, "{} {}", fine.get(28, 20), fine.get(31, 20));
    }

    #[test]
    fn a_coarser_mask_takes_the_edge_of_the_fine_picture() {
        let fine = Raster::from_fn(120, 80, |x, _| if x < 61 { [50, 130, 25] } else { [150, 80, 180] });
        let small = Raster::from_fn(30, 20, |x, _| if x < 15 { [0.2, 0.5, 0.1] } else { [0.6, 0.3, 0.7] });
        let coarse = Raster::from_fn(30, 20, |x, _| ((x as f32 - 11.0) / 8.0).clamp(0.0, 1.0));
        let mask = guided_enlargement(&fine, &small, &coarse, 4, 1e-4);
        assert!(mask.get(60, 40) < 0.35 && mask.get(61, 40) > 0.65, "{} {}", mask.get(60, 40), mask.get(61, 40));
    }

    #[test]
    fn a_flat_guide_leaves_a_double_box_blur() {
        let mask = Raster::from_fn(40, 30, |x, y| f32::from(u8::from(x > 17 && y > 9)));
        let blurred = box_blur(&box_blur(&mask, 3), 3);
        let filtered = guided_filter(&Raster::filled(40, 30, [0.3; 3]), &mask, 3, 1e-4);
        assert!(filtered.pixels().iter().zip(blurred.pixels()).all(|(a, b)| (a - b).abs() < 1e-3));
    }

    #[test]
    fn the_solution_solves() {
        let (s, v) = ([2.0, 0.3, -0.4, 1.5, 0.2, 1.1], [0.7, -0.2, 0.5]);
        let x = solved(s, v, 0.1).map(f64::from);
        let row = |a: f64, b: f64, c: f64| a * x[0] + b * x[1] + c * x[2];
        let back = [row(2.1, 0.3, -0.4), row(0.3, 1.6, 0.2), row(-0.4, 0.2, 1.2)];
        assert!(back.iter().zip(v).all(|(a, b)| (a - b).abs() < 1e-6), "{back:?}");
    }
}
