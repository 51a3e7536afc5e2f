//! Rasters and the filters on them.
//!
//! In: a [`Raster`]; out: a [`Raster`] of the same size. Nothing here knows of pages, millimetres or photographs.
//! Every filter clamps at the border (the edge pixel is repeated), runs parallel by rows, and gives the same bits
//! on any number of threads.

mod best_way;
mod bilateral;
mod binary;
mod blur;
mod canny;
mod diffusion;
mod edge_preserving;
mod flood;
mod frame;
mod gradient;
mod guided;
mod lattice_gaussian;
mod local_laplacian;
mod opening;
mod paper;
mod polygon;
mod pyramid;
mod rank;
mod ridges;
mod scale;
mod soft_maximum;
mod structure_tensor;
mod thin;

pub(crate) use best_way::best_way;
#[doc(hidden)]
pub use bilateral::bilateral;
#[doc(hidden)]
pub use binary::{close, components, dilate, erode, majority, open, open_round, remove_components};
#[cfg(feature = "see")]
pub(crate) use blur::box_blur_each;
#[doc(hidden)]
pub use blur::{box_blur, gaussian_blur};
#[doc(hidden)]
pub use canny::{Thresholds, canny};
#[doc(hidden)]
pub use diffusion::anisotropic_diffusion;
#[doc(hidden)]
pub use edge_preserving::edge_preserving;
#[doc(hidden)]
pub use flood::{flood_from_border, without_holes};
#[doc(hidden)]
pub use gradient::sobel;
#[cfg(feature = "see")]
pub(crate) use guided::mean_of_corners;
pub(crate) use guided::shares_of_bytes;
#[doc(hidden)]
pub use guided::{guided_enlargement, guided_filter, self_guided};
#[doc(hidden)]
pub use lattice_gaussian::fast_gaussian;
pub(crate) use lattice_gaussian::fast_gaussian_within;
#[doc(hidden)]
pub use local_laplacian::{Remapping, local_laplacian};
pub(crate) use opening::opening;
#[doc(hidden)]
pub use paper::paper_texture;
#[doc(hidden)]
pub use polygon::{each_pixel_inside, filled_polygon};
#[doc(hidden)]
pub use pyramid::{doubled, halved};
pub(crate) use rank::median;
#[doc(hidden)]
pub use rank::{equalised, sorted};
#[doc(hidden)]
pub use ridges::ridges;
#[doc(hidden)]
pub use scale::{enlarge, enlarge_smoothly, reduce};
pub(crate) use soft_maximum::soft_rise;
#[doc(hidden)]
pub use structure_tensor::{gaussian_gradient, gradient, structure_tensor};
#[doc(hidden)]
pub use thin::thin;

use crate::parallel::shares;
use blur::gaussian_kernel;

/// A rectangle of pixels in row order; pixel `(x, y)` has its centre at `(x + 0.5, y + 0.5)`.
///
/// ```
/// use drypoint::raster::Raster;
///
/// let ramp = Raster::from_fn(4, 2, |x, y| (x + 10 * y) as f32);
/// assert_eq!(ramp.row(1), [10.0, 11.0, 12.0, 13.0]);
/// assert_eq!(ramp.map(|v| v * 2.0).get(3, 0), 6.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Raster<T> {
    width: usize,
    height: usize,
    data: Vec<T>,
}

impl<T> Raster<T> {
    /// Wraps pixels that are already in row order.
    ///
    /// # Panics
    /// If `data` does not hold `width * height` pixels.
    pub fn from_vec(width: usize, height: usize, data: Vec<T>) -> Self {
        assert_eq!(data.len(), width * height, "a raster's pixels must fill it");
        Self { width, height, data }
    }

    /// Number of columns.
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    pub const fn height(&self) -> usize {
        self.height
    }

    /// Number of pixels.
    pub fn len(&self) -> usize {
        self.data.len()
    }

    /// Whether there are no pixels.
    pub fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    /// All pixels in row order.
    pub fn pixels(&self) -> &[T] {
        &self.data
    }

    /// All pixels in row order, mutable.
    pub fn pixels_mut(&mut self) -> &mut [T] {
        &mut self.data
    }

    /// The pixels, without the shape.
    pub fn into_vec(self) -> Vec<T> {
        self.data
    }

    /// One row.
    pub fn row(&self, y: usize) -> &[T] {
        &self.data[y * self.width..(y + 1) * self.width]
    }

    /// Whether `(x, y)` is a pixel of this raster.
    pub const fn contains(&self, x: isize, y: isize) -> bool {
        x >= 0 && y >= 0 && (x as usize) < self.width && (y as usize) < self.height
    }
}

impl<T: Copy + Send + Sync> Raster<T> {
    /// A raster of one value.
    pub fn filled(width: usize, height: usize, value: T) -> Self {
        Self { width, height, data: vec![value; width * height] }
    }

    /// A raster whose pixel `(x, y)` is `pixel(x, y)`, made parallel by rows.
    #[inline]
    pub fn from_fn(width: usize, height: usize, pixel: impl Fn(usize, usize) -> T + Sync) -> Self
    where
        T: Default,
    {
        let mut data = vec![T::default(); width * height];
        let rows = SHARE.div_ceil(width.max(1));
        shares(&mut data, rows * width, &|i, share| {
            for (j, row) in share.chunks_mut(width).enumerate() {
                row.iter_mut().enumerate().for_each(|(x, out)| *out = pixel(x, i * rows + j));
            }
        });
        Self { width, height, data }
    }

    /// A raster of the same size, pixel by pixel.
    #[inline]
    pub fn map<U: Copy + Default + Send + Sync>(&self, pixel: impl Fn(T) -> U + Sync) -> Raster<U> {
        let mut data = vec![U::default(); self.len()];
        shares(&mut data, SHARE, &|i, share| {
            share.iter_mut().zip(&self.data[i * SHARE..]).for_each(|(out, &v)| *out = pixel(v));
        });
        Raster { width: self.width, height: self.height, data }
    }

    /// A raster of the same size from two, pixel by pixel.
    ///
    /// # Panics
    /// If the sizes differ.
    #[inline]
    pub fn zip_map<U: Copy + Send + Sync, V: Copy + Default + Send + Sync>(
        &self,
        other: &Raster<U>,
        pixel: impl Fn(T, U) -> V + Sync,
    ) -> Raster<V> {
        assert_eq!((self.width, self.height), (other.width, other.height), "rasters must have one size");
        let mut data = vec![V::default(); self.len()];
        shares(&mut data, SHARE, &|i, share| {
            let start = i * SHARE;
            let both = self.data[start..].iter().zip(&other.data[start..]);
            share.iter_mut().zip(both).for_each(|(out, (&a, &b))| *out = pixel(a, b));
        });
        Raster { width: self.width, height: self.height, data }
    }

    /// The pixel at `(x, y)`, which must be inside.
    #[inline]
    pub fn get(&self, x: usize, y: usize) -> T {
        self.data[y * self.width + x]
    }

    /// Sets the pixel at `(x, y)`, which must be inside.
    pub fn set(&mut self, x: usize, y: usize, value: T) {
        self.data[y * self.width + x] = value;
    }

    /// The pixel at `(x, y)`, or the border pixel nearest to it.
    #[inline]
    pub fn clamped(&self, x: isize, y: isize) -> T {
        let x = x.clamp(0, self.width as isize - 1) as usize;
        let y = y.clamp(0, self.height as isize - 1) as usize;
        self.get(x, y)
    }

    /// Rows and columns exchanged.
    #[must_use]
    pub fn transposed(&self) -> Self
    where
        T: Default,
    {
        let (width, height) = (self.height, self.width);
        let mut data = vec![T::default(); self.len()];
        shares(&mut data, BAND * width.max(1), &|band, out| {
            let from = band * BAND;
            for x in 0..width {
                let pixels = &self.row(x)[from..(from + BAND).min(height)];
                pixels.iter().enumerate().for_each(|(y, v)| out[y * width + x] = *v);
            }
        });
        Self { width, height, data }
    }
}

/// Rows that are transposed together: their pixels share the lines of the processor's cache.
const BAND: usize = 16;

/// Pixels per parallel task: enough to outweigh the call, few enough to divide a small raster among threads.
const SHARE: usize = 4096;

impl Raster<f32> {
    /// The value at a point in pixel units (`0.5, 0.5` is the centre of the first pixel), bilinear between centres.
    #[inline]
    pub fn sample(&self, x: f64, y: f64) -> f32 {
        let (fx, fy) = (x - 0.5, y - 0.5);
        // Inside the raster, which is the usual case, nothing needs holding to its border, and to cut off is to round down.
        let (x0, y0) = (fx as usize, fy as usize);
        if fx >= 0.0 && fy >= 0.0 && x0 + 1 < self.width && y0 + 1 < self.height {
            let (upper, lower) = (&self.row(y0)[x0..x0 + 2], &self.row(y0 + 1)[x0..x0 + 2]);
            return mixed([upper[0], upper[1], lower[0], lower[1]], (fx - x0 as f64) as f32, (fy - y0 as f64) as f32);
        }
        let (x0, y0) = (fx.floor(), fy.floor());
        let (tx, ty) = ((fx - x0) as f32, (fy - y0) as f32);
        let at = |dx: isize, dy: isize| self.clamped(x0 as isize + dx, y0 as isize + dy);
        mixed([at(0, 0), at(1, 0), at(0, 1), at(1, 1)], tx, ty)
    }
}

/// Bilinear between four values, row by row.
fn mixed([a, b, c, d]: [f32; 4], tx: f32, ty: f32) -> f32 {
    let (top, bottom) = (a * (1.0 - tx) + b * tx, c * (1.0 - tx) + d * tx);
    top * (1.0 - ty) + bottom * ty
}

/// Distances of a square picture's pixels from a place on its diagonal, for tests with discs and rings.
#[cfg(test)]
pub(crate) fn distances_from(place: f32, side: usize) -> Raster<f32> {
    use crate::elementary::Elementary as _;
    Raster::from_fn(side, side, |x, y| (x as f32 - place).hypotenuse(y as f32 - place))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sample_is_exact_on_a_plane() {
        let plane = Raster::from_fn(9, 7, |x, y| (x as f32 + 0.5) * 2.0 - (y as f32 + 0.5));
        for (x, y) in [(1.5, 2.5), (3.25, 4.75), (7.9, 1.1)] {
            assert!((f64::from(plane.sample(x, y)) - (2.0 * x - y)).abs() < 1e-5);
        }
    }

    #[test]
    fn transposing_twice_is_nothing() {
        let raster = Raster::from_fn(5, 3, |x, y| x * 10 + y);
        assert_eq!(raster.transposed().transposed(), raster);
        assert_eq!(raster.transposed().get(2, 4), raster.get(4, 2));
    }
}
