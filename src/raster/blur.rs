//! Box and Gaussian blur, both separable and independent of thread count.

use super::Raster;
use crate::elementary::Elementary as _;
use crate::parallel::{rows_with, shares};

/// Mean over a `(2r+1) x (2r+1)` window, borders clamped; time does not depend on `radius`.
pub fn box_blur(raster: &Raster<f32>, radius: usize) -> Raster<f32> {
    if radius == 0 || raster.is_empty() {
        return raster.clone();
    }
    let rows = box_blur_rows(raster, radius).transposed();
    box_blur_rows(&rows, radius).transposed()
}

/// Rows whose sums run side by side: each waits for its own last sum alone.
const TOGETHER: usize = 4;

fn box_blur_rows(raster: &Raster<f32>, radius: usize) -> Raster<f32> {
    let width = raster.width();
    let mut out = Raster::filled(width, raster.height(), 0.0_f32);
    shares(out.pixels_mut(), TOGETHER * width, &|part, out| {
        let first = part * TOGETHER;
        if out.len() == TOGETHER * width {
            running_means::<TOGETHER>(std::array::from_fn(|j| raster.row(first + j)), radius, out);
        } else {
            out.chunks_mut(width).enumerate().for_each(|(j, out)| running_means([raster.row(first + j)], radius, out));
        }
    });
    out
}

/// The mean of the window around each pixel of some rows, which follow each other in `out`.
fn running_means<const N: usize>(rows: [&[f32]; N], radius: usize, out: &mut [f32]) {
    let width = rows[0].len();
    let scale = 1.0 / (2 * radius + 1) as f64;
    let at = |row: &[f32], x: isize| f64::from(row[x.clamp(0, width as isize - 1) as usize]);
    let mut sums = rows.map(|row| (-(radius as isize)..=radius as isize).map(|x| at(row, x)).sum::<f64>());
    for x in 0..width {
        let (ahead, behind) = ((x + radius + 1).min(width - 1), x.saturating_sub(radius));
        for (j, (sum, row)) in sums.iter_mut().zip(&rows).enumerate() {
            out[j * width + x] = (*sum * scale) as f32;
            *sum += f64::from(row[ahead]) - f64::from(row[behind]);
        }
    }
}

/// [`box_blur`] of each of some values: they share their way through the picture.
#[cfg(feature = "see")]
pub(crate) fn box_blur_each<const N: usize>(raster: &Raster<[f32; N]>, radius: usize) -> Raster<[f32; N]>
where
    [f32; N]: Default,
{
    if radius == 0 || raster.is_empty() {
        return raster.clone();
    }
    let rows = box_blur_rows_of_each(raster, radius).transposed();
    box_blur_rows_of_each(&rows, radius).transposed()
}

#[cfg(feature = "see")]
fn box_blur_rows_of_each<const N: usize>(raster: &Raster<[f32; N]>, radius: usize) -> Raster<[f32; N]>
where
    [f32; N]: Default,
{
    let width = raster.width();
    let mut out = raster.clone();
    let scale = 1.0 / (2 * radius + 1) as f64;
    shares(out.pixels_mut(), width, &|y, out| {
        let row = raster.row(y);
        let at = |x: isize| row[x.clamp(0, width as isize - 1) as usize];
        let mut sums = [0.0_f64; N];
        for x in -(radius as isize)..=radius as isize {
            sums.iter_mut().zip(at(x)).for_each(|(sum, v)| *sum += f64::from(v));
        }
        for (x, out) in out.iter_mut().enumerate() {
            let (ahead, behind) = (row[(x + radius + 1).min(width - 1)], row[x.saturating_sub(radius)]);
            for k in 0..N {
                out[k] = (sums[k] * scale) as f32;
                sums[k] += f64::from(ahead[k]) - f64::from(behind[k]);
            }
        }
    });
    out
}

/// Gaussian blur of standard deviation `sigma` in pixels by its sampled kernel, cut at 3.5 sigma.
pub fn gaussian_blur(raster: &Raster<f32>, sigma: f32) -> Raster<f32> {
    if sigma <= 0.05 || raster.is_empty() {
        return raster.clone();
    }
    let kernel = gaussian_kernel(sigma);
    convolve_columns(&convolve_rows(raster, &kernel), &kernel)
}

/// The right half of a normalised Gaussian kernel, centre first.
pub(super) fn gaussian_kernel(sigma: f32) -> Vec<f32> {
    let radius = (3.5 * sigma).ceil() as i32;
    let mut half: Vec<f32> = (0..=radius).map(|i| (-0.5 * (i as f32 / sigma).powi(2)).exponential()).collect();
    let sum = half[0] + 2.0 * half[1..].iter().sum::<f32>();
    for weight in &mut half {
        *weight /= sum;
    }
    half
}

fn convolve_rows(raster: &Raster<f32>, half: &[f32]) -> Raster<f32> {
    let width = raster.width();
    let radius = half.len() - 1;
    let mut out = Raster::filled(width, raster.height(), 0.0_f32);
    rows_with(out.pixels_mut(), width, &|| vec![0.0_f32; width + 2 * radius], &|padded, y, out| {
        let row = raster.row(y);
        padded[..radius].fill(row[0]);
        padded[radius..radius + width].copy_from_slice(row);
        padded[radius + width..].fill(row[width - 1]);
        for (o, &v) in out.iter_mut().zip(row) {
            *o = v * half[0];
        }
        for (i, &weight) in half.iter().enumerate().skip(1) {
            let (left, right) = (&padded[radius - i..], &padded[radius + i..]);
            for ((o, a), b) in out.iter_mut().zip(left).zip(right) {
                *o += weight * (a + b);
            }
        }
    });
    out
}

fn convolve_columns(raster: &Raster<f32>, half: &[f32]) -> Raster<f32> {
    let width = raster.width();
    let last = raster.height() as isize - 1;
    let row = |y: isize| raster.row(y.clamp(0, last) as usize);
    let mut out = Raster::filled(width, raster.height(), 0.0_f32);
    shares(out.pixels_mut(), width, &|y, out| {
        let y = y as isize;
        for (o, &v) in out.iter_mut().zip(row(y)) {
            *o = v * half[0];
        }
        for (i, &weight) in half.iter().enumerate().skip(1) {
            for ((o, a), b) in out.iter_mut().zip(row(y - i as isize)).zip(row(y + i as isize)) {
                *o += weight * (a + b);
            }
        }
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bumpy(width: usize, height: usize) -> Raster<f32> {
        Raster::from_fn(width, height, |x, y| ((x * 7 + y * 13) % 11) as f32 / 11.0)
    }

    #[test]
    fn box_blur_matches_the_plain_sum() {
        let raster = bumpy(17, 9);
        let fast = box_blur(&raster, 3);
        for (x, y) in [(0, 0), (8, 4), (16, 8), (2, 7)] {
            let mut sum = 0.0;
            for dy in -3..=3 {
                for dx in -3..=3 {
                    sum += raster.clamped(x + dx, y + dy);
                }
            }
            assert!((fast.get(x as usize, y as usize) - sum / 49.0).abs() < 1e-5);
        }
    }

    #[test]
    fn gaussian_blur_spreads_an_impulse_by_sigma() {
        let mut raster = Raster::filled(61, 61, 0.0);
        raster.set(30, 30, 1.0);
        let blurred = gaussian_blur(&raster, 4.0);
        let (mut mass, mut variance) = (0.0, 0.0);
        for y in 0..61 {
            for x in 0..61 {
                let v = f64::from(blurred.get(x, y));
                mass += v;
                variance += v * (x as f64 - 30.0).powi(2);
            }
        }
        assert!((mass - 1.0).abs() < 1e-4, "mass {mass}");
        assert!((variance.sqrt() - 4.0).abs() < 0.05, "sigma {}", variance.sqrt());
    }

    #[test]
    fn a_kernel_wider_than_the_raster_is_fine() {
        let blurred = gaussian_blur(&Raster::filled(2, 3, 0.25), 9.0);
        assert!(blurred.pixels().iter().all(|v| (v - 0.25).abs() < 1e-5));
    }
}
