//! Conjugate gradients for equations on the pixels of a raster.

use crate::parallel::shares;
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
    /// Pixels that one thread takes at a time.
    const SHARE: usize = 8192;
    let (width, height) = (a.width(), a.height());
    let mut out = Raster::filled(width, height, 0.0);
    let rows = SHARE.div_ceil(width.max(1));
    shares(out.pixels_mut(), rows * width, &|part, share| {
        for (j, out) in share.chunks_mut(width).enumerate() {
            let y = rows * part + j;
            let (here, above, below) = (a.row(y), a.row(y.saturating_sub(1)), a.row((y + 1).min(height - 1)));
            let at = |x: usize, left: usize, right: usize| 4.0 * here[x] - here[left] - here[right] - above[x] - below[x];
            out[0] = at(0, 0, 1.min(width - 1));
            for (x, out) in out.iter_mut().enumerate().take(width.saturating_sub(1)).skip(1) {
                *out = at(x, x - 1, x + 1);
            }
            if width > 1 {
                out[width - 1] = at(width - 1, width - 2, width - 1);
            }
        }
    });
    out
}

fn dot(a: &Raster<f32>, b: &Raster<f32>) -> f64 {
    a.pixels().iter().zip(b.pixels()).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
}
