//! A field of orientations: directions without a sign, as doubled-angle vectors (Jaehne; Wong 1999, section 4.3).

use crate::elementary::Elementary as _;
use crate::geometry::Vec2;
use crate::raster::{Raster, gaussian_blur};

/// For each pixel `strength * (cos 2a, sin 2a)` of the direction `a`; y runs down, as on the page.
#[derive(Clone, Debug, PartialEq)]
pub struct OrientationField {
    doubled: Raster<[f32; 2]>,
}

impl OrientationField {
    /// Wraps doubled-angle vectors.
    pub const fn new(doubled: Raster<[f32; 2]>) -> Self {
        Self { doubled }
    }

    /// The doubled-angle vectors.
    pub const fn doubled(&self) -> &Raster<[f32; 2]> {
        &self.doubled
    }

    /// Each vector with its length squared, so that strong responses outweigh weak ones (Wong 1999, section 4.4).
    #[must_use]
    pub fn squared(&self) -> Self {
        Self::new(self.doubled.map(|[x, y]| {
            let length = x.hypotenuse(y);
            [x * length, y * length]
        }))
    }

    /// Averaged by a Gaussian of `sigma` pixels; undefined places take their neighbours' orientation.
    #[must_use]
    pub fn smoothed(&self, sigma: f32) -> Self {
        let x = gaussian_blur(&self.doubled.map(|v| v[0]), sigma);
        let y = gaussian_blur(&self.doubled.map(|v| v[1]), sigma);
        Self::new(x.zip_map(&y, |x, y| [x, y]))
    }

    /// The direction in radians, -pi/2 to pi/2, at a place in pixel units; none where the field is 0.
    pub fn angle(&self, x: f64, y: f64) -> Option<f64> {
        let at = |x: isize, y: isize| {
            let [a, b] = self.doubled.clamped(x, y);
            Vec2::new(f64::from(a), f64::from(b))
        };
        let (fx, fy) = (x - 0.5, y - 0.5);
        let (ix, iy) = (fx.floor() as isize, fy.floor() as isize);
        let (tx, ty) = (fx - fx.floor(), fy - fy.floor());
        let upper = at(ix, iy).lerp(at(ix + 1, iy), tx);
        let lower = at(ix, iy + 1).lerp(at(ix + 1, iy + 1), tx);
        let mean = upper.lerp(lower, ty);
        (mean.hypot2() > 0.0).then(|| 0.5 * mean.y.angle_over(mean.x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opposite_directions_are_one_orientation() {
        let field = OrientationField::new(Raster::from_fn(20, 20, |x, _| {
            let angle = if x < 10 { 1.5_f32 } else { 1.5 - std::f32::consts::PI };
            [(2.0 * angle).cosine(), (2.0 * angle).sine()]
        }));
        for x in 0..20 {
            assert!((field.smoothed(4.0).angle(f64::from(x) + 0.5, 9.5).unwrap() - 1.5).abs() < 1e-3);
        }
        assert_eq!(OrientationField::new(Raster::filled(3, 3, [0.0; 2])).angle(1.0, 1.0), None);
    }
}
