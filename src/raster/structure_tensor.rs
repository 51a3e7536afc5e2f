//! Gradients of a raster, and the structure tensor of a colour picture (Papari 2009, equations 7.9 and 7.14).

use super::{Raster, fast_gaussian};

/// The gradient of a Gaussian-blurred plane per pixel (x, then y), by central differences.
pub fn gaussian_gradient(plane: &Raster<f32>, sigma: f32) -> Raster<[f32; 2]> {
    gradient(&fast_gaussian(plane, sigma))
}

/// Central differences (x, then y) per pixel; at the border one-sided, so half as large.
pub fn gradient(plane: &Raster<f32>) -> Raster<[f32; 2]> {
    Raster::from_fn(plane.width(), plane.height(), |x, y| {
        let (x, y) = (x as isize, y as isize);
        let across = plane.clamped(x + 1, y) - plane.clamped(x - 1, y);
        let down = plane.clamped(x, y + 1) - plane.clamped(x, y - 1);
        [0.5 * across, 0.5 * down]
    })
}

/// The sum of the outer products of the planes' gradients: `[xx, xy, yy]` per pixel. `None` without planes.
pub fn structure_tensor(gradients: &[Raster<[f32; 2]>]) -> Option<Raster<[f32; 3]>> {
    let outer = |g: &Raster<[f32; 2]>| g.map(|[x, y]| [x * x, x * y, y * y]);
    let add = |a: Raster<[f32; 3]>, b: Raster<[f32; 3]>| a.zip_map(&b, |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
    gradients.iter().map(outer).reduce(add)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_has_its_slope() {
        let ramp = Raster::from_fn(60, 60, |x, y| 0.01 * x as f32 - 0.004 * y as f32);
        let [x, y] = gaussian_gradient(&ramp, 4.0).get(30, 30);
        assert!((x - 0.01).abs() < 1e-4 && (y + 0.004).abs() < 1e-4, "{x} {y}");
        let tensor = structure_tensor(&[gradient(&ramp), gradient(&ramp)]).unwrap().get(30, 30);
        assert!((tensor[0] - 2e-4).abs() < 1e-6 && (tensor[1] + 0.8e-4).abs() < 1e-6, "{tensor:?}");
    }
}
