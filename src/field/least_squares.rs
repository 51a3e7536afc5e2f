//! Conjugate gradients for equations on the pixels of a raster.

use crate::raster::Raster;

/// Remainder, squared and scaled, at which the solution is good enough.
const ENOUGH: f64 = 1e-14;

/// Values `a` with `image(a) = right`, for a symmetric positive `image`, from a start, in at most so many rounds; `scale` is about the
/// inverse of the image's diagonal.
pub(crate) fn solved(
    image: impl Fn(&Raster<f32>) -> Raster<f32>,
    right: &Raster<f32>,
    scale: &Raster<f32>,
    start: Raster<f32>,
    rounds: usize,
) -> Raster<f32> {
    let mut a = start;
    let mut rest = right.zip_map(&image(&a), |b, ax| b - ax);
    let mut scaled = rest.zip_map(scale, |r, s| r * s);
    let mut way = scaled.clone();
    let mut size = dot(&rest, &scaled);
    for _ in 0..rounds {
        if size <= ENOUGH {
            break;
        }
        let moved = image(&way);
        let step = (size / dot(&way, &moved).max(1e-30)) as f32;
        a = a.zip_map(&way, |a, d| a + step * d);
        rest = rest.zip_map(&moved, |r, q| r - step * q);
        scaled = rest.zip_map(scale, |r, s| r * s);
        let next = dot(&rest, &scaled);
        let turn = (next / size) as f32;
        way = scaled.zip_map(&way, |z, d| z + turn * d);
        size = next;
    }
    a
}

/// Four times the difference from the neighbours' mean; at the border the missing neighbours are equal.
pub(crate) fn negative_laplacian(a: &Raster<f32>) -> Raster<f32> {
    Raster::from_fn(a.width(), a.height(), |x, y| {
        let (i, j) = (x as isize, y as isize);
        4.0 * a.get(x, y) - a.clamped(i - 1, j) - a.clamped(i + 1, j) - a.clamped(i, j - 1) - a.clamped(i, j + 1)
    })
}

fn dot(a: &Raster<f32>, b: &Raster<f32>) -> f64 {
    a.pixels().iter().zip(b.pixels()).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
}
