//! The density at which lines along a field of directions need not end: where lines part, they stand farther from one another.

use super::least_squares::{negative_laplacian, solved};
use crate::elementary::Elementary as _;
use crate::raster::Raster;

/// How soon the density goes back to the one wanted, in pixels, and the weight of its smoothness.
const REACH: f32 = 70.0;
const SMOOTH: f32 = 0.1;
const ROUNDS: usize = 50;

/// The factor of the density at each pixel for lines along `angles` (radians, signed, smooth), 1 on the whole, between two limits
/// on either side of 1.
///
/// A family of lines along unit vectors `t` needs no ends if its density `f` satisfies `t grad(ln f) = -div t`.
pub(crate) fn evening(angles: &Raster<f32>, limits: [f32; 2]) -> Raster<f32> {
    let along = angles.map(|a| [a.cosine(), a.sine()]);
    let parting = Raster::from_fn(angles.width(), angles.height(), |x, y| {
        let (i, j) = (x as isize, y as isize);
        0.5 * (along.clamped(i + 1, j)[0] - along.clamped(i - 1, j)[0] + along.clamped(i, j + 1)[1] - along.clamped(i, j - 1)[1])
    });
    let right = transposed_slope(&along, &parting.map(|p| -p));
    let keep = 1.0 / (REACH * REACH);
    let image = |g: &Raster<f32>| {
        let bent = transposed_slope(&along, &slope(&along, g));
        bent.zip_map(&negative_laplacian(g), |bent, rough| bent + SMOOTH * keep * 100.0 * rough).zip_map(g, |v, g| v + keep * g)
    };
    let scale = angles.map(|_| 1.0 / (0.5 + 40.0 * SMOOTH * keep * 10.0 + keep));
    let g = solved(image, &right, &scale, angles.map(|_| 0.0), ROUNDS);
    let [least, most] = limits.map(|limit| limit.logarithm().abs());
    // Softly, so that the density has no corners.
    let bounded =
        |g: f32| if g < 0.0 { least * (g / least).hyperbolic_tangent() } else { most * (g / most).hyperbolic_tangent() };
    g.map(|g| bounded(g).exponential())
}

/// The growth of values along the directions, per pixel.
fn slope(along: &Raster<[f32; 2]>, g: &Raster<f32>) -> Raster<f32> {
    Raster::from_fn(g.width(), g.height(), |x, y| {
        let (i, j) = (x as isize, y as isize);
        let [cos, sin] = along.get(x, y);
        0.5 * (cos * (g.clamped(i + 1, j) - g.clamped(i - 1, j)) + sin * (g.clamped(i, j + 1) - g.clamped(i, j - 1)))
    })
}

/// The transpose of [`slope`].
fn transposed_slope(along: &Raster<[f32; 2]>, v: &Raster<f32>) -> Raster<f32> {
    let (width, height) = (v.width(), v.height());
    // What a neighbour's slope takes from this pixel; at the border a pixel stands for its missing neighbour too.
    let part = |axis: usize, x: usize, y: usize, at: usize, end: usize, of: &dyn Fn(usize) -> (usize, usize)| {
        let weight = |k: usize| {
            let (x, y) = of(k);
            0.5 * along.get(x, y)[axis] * v.get(x, y)
        };
        let mut sum = 0.0;
        if at > 0 {
            sum += weight(at - 1);
        }
        if at + 1 < end {
            sum -= weight(at + 1);
        }
        if at == 0 {
            sum -= 0.5 * along.get(x, y)[axis] * v.get(x, y);
        }
        if at + 1 == end {
            sum += 0.5 * along.get(x, y)[axis] * v.get(x, y);
        }
        sum
    };
    Raster::from_fn(width, height, |x, y| part(0, x, y, x, width, &|k| (k, y)) + part(1, x, y, y, height, &|k| (x, k)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transpose_is_one() {
        let along = Raster::from_fn(17, 13, |x, y| {
            let a = 0.3 * x as f32 - 0.2 * y as f32;
            [a.cosine(), a.sine()]
        });
        let noise = |seed: usize| Raster::from_fn(17, 13, move |x, y| ((x * 31 + y * 17 + seed * 7) % 23) as f32 / 23.0);
        let (g, v) = (noise(1), noise(5));
        let dot = |a: &Raster<f32>, b: &Raster<f32>| a.pixels().iter().zip(b.pixels()).map(|(a, b)| a * b).sum::<f32>();
        assert!((dot(&slope(&along, &g), &v) - dot(&g, &transposed_slope(&along, &v))).abs() < 1e-3);
    }

    /// Rays from a point: their density falls with the distance.
    #[test]
    fn parting_lines_stand_farther_apart() {
        let angles = Raster::from_fn(60, 40, |x, y| (y as f32 - 20.0).angle_over(x as f32 + 40.0));
        let factor = evening(&angles, [0.33, 3.0]);
        let (near, far) = (factor.get(5, 20), factor.get(55, 20));
        assert!((near / far / (95.0 / 45.0) - 1.0).abs() < 0.2, "{near} {far}");
    }
}
