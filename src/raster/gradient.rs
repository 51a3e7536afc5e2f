//! Sobel's gradient.

use super::Raster;

/// The gradient by Sobel's operator, in raster units per pixel.
pub fn sobel(raster: &Raster<f32>) -> Raster<[f32; 2]> {
    Raster::from_fn(raster.width(), raster.height(), |x, y| {
        let at = |dx: isize, dy: isize| raster.clamped(x as isize + dx, y as isize + dy);
        let gx = at(1, -1) + 2.0 * at(1, 0) + at(1, 1) - at(-1, -1) - 2.0 * at(-1, 0) - at(-1, 1);
        let gy = at(-1, 1) + 2.0 * at(0, 1) + at(1, 1) - at(-1, -1) - 2.0 * at(0, -1) - at(1, -1);
        [gx / 8.0, gy / 8.0]
    })
}
