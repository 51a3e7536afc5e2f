//! Continuous Glass patterns and line integral convolution as rasters (Papari 2009, section 7.2.2; Cabral and Leedom 1993).

use super::Flow;
use crate::raster::Raster;

/// Euler step in pixels. At 1 the finest noise (sigma 0.7) loses peaks between two samples; below 0.5 nothing changes.
const STEP: f32 = 0.5;

/// `G(r) = max z(Phi(r, t))` over an arc of `length` pixels downstream (equation 7.7), by Euler steps; the arc ends where the flow or
/// the raster does. Noise and flow have one size.
pub fn glass_pattern(noise: &Raster<f32>, flow: &Flow, length: f32) -> Raster<f32> {
    Raster::from_fn(noise.width(), noise.height(), |x, y| {
        let mut highest = noise.get(x, y);
        walk(noise, flow, (x, y), length, |value| highest = highest.max(value));
        highest
    })
}

/// The mean of the noise over an arc of `length` pixels, half of it to either side (figure 7.15).
pub fn line_integral_convolution(noise: &Raster<f32>, flow: &Flow, length: f32) -> Raster<f32> {
    Raster::from_fn(noise.width(), noise.height(), |x, y| {
        let (mut sum, mut count) = (noise.get(x, y), 1.0);
        for half in [0.5 * length, -0.5 * length] {
            walk(noise, flow, (x, y), half, |value| {
                sum += value;
                count += 1.0;
            });
        }
        sum / count
    })
}

/// Visits the noise along an arc from a pixel's centre, that pixel left out.
#[inline]
fn walk(noise: &Raster<f32>, flow: &Flow, (x, y): (usize, usize), length: f32, mut visit: impl FnMut(f32)) {
    let (width, height) = (noise.width() as f32, noise.height() as f32);
    let count = (length.abs() / STEP).ceil().max(1.0);
    let stride = length / count;
    let (mut px, mut py) = (x as f32 + 0.5, y as f32 + 0.5);
    let directions = flow.directions();
    for _ in 0..count as usize {
        let [dx, dy] = directions.get(px as usize, py as usize);
        px += stride * dx;
        py += stride * dy;
        let is_inside = px >= 0.0 && py >= 0.0 && px < width && py < height;
        if !is_inside || (dx == 0.0 && dy == 0.0) {
            return;
        }
        visit(bilinear(noise, px, py));
    }
}

/// The noise at a place on the raster in pixels; `Raster::sample` in single precision and without its calls, since this is the inner
/// loop.
#[inline]
fn bilinear(noise: &Raster<f32>, x: f32, y: f32) -> f32 {
    let (width, height) = (noise.width(), noise.height());
    let (fx, fy) = ((x - 0.5).max(0.0), (y - 0.5).max(0.0));
    let (x0, y0) = (fx as usize, fy as usize);
    let (tx, ty) = (fx - x0 as f32, fy - y0 as f32);
    let (x1, y1) = ((x0 + 1).min(width - 1), (y0 + 1).min(height - 1));
    let (top, bottom) = (noise.row(y0.min(height - 1)), noise.row(y1));
    let upper = top[x0] + (top[x1] - top[x0]) * tx;
    let lower = bottom[x0] + (bottom[x1] - bottom[x0]) * tx;
    upper + (lower - upper) * ty
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec2;

    #[test]
    fn one_grain_shows_along_its_backward_arc() {
        let flow = Flow::from_fn(60, 20, |_| Vec2::new(1.0, 0.0));
        let mut noise = Raster::filled(60, 20, 0.0);
        noise.set(40, 10, 1.0);
        let pattern = glass_pattern(&noise, &flow, 12.0);
        assert!((28..=40).all(|x| pattern.get(x, 10) == 1.0));
        assert_eq!((pattern.get(41, 10), pattern.get(26, 10), pattern.get(35, 12)), (0.0, 0.0, 0.0));
        let lic = line_integral_convolution(&noise, &flow, 12.0);
        assert!(lic.get(40, 10) > 0.05 && lic.get(48, 10) == 0.0 && lic.get(35, 10) > 0.0);
    }

    #[test]
    fn without_flow_it_is_the_noise() {
        let noise = Raster::from_fn(9, 9, |x, y| ((x * 5 + y * 3) % 7) as f32);
        assert_eq!(glass_pattern(&noise, &Flow::from_fn(9, 9, |_| Vec2::ZERO), 5.0), noise);
    }
}
