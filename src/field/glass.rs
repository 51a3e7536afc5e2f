//! Continuous Glass patterns and line integral convolution as rasters (Papari 2009, section 7.2.2; Cabral and Leedom 1993).

use super::Flow;
use crate::raster::Raster;

/// Euler step in pixels. At 1 the finest noise (sigma 0.7) loses peaks between two samples; below 0.5 nothing changes.
const STEP: f32 = 0.5;

/// Fractional bits of fixed-point positions along an arc: whole part and remainder then need no rounding calls, which took a third of
/// the time.
const BITS: u32 = 16;
const UNIT: f32 = (1 << BITS) as f32;

/// `G(r) = max z(Phi(r, t))` over an arc of `length` pixels downstream (equation 7.7), by Euler steps; the arc ends where the flow or
/// the raster does. Noise and flow have one size.
pub fn glass_pattern(noise: &Raster<f32>, flow: &Flow, length: f32) -> Raster<f32> {
    let arcs = Arcs::new(noise, flow, length);
    Raster::from_fn(noise.width(), noise.height(), |x, y| {
        let mut highest = noise.get(x, y);
        arcs.walk((x, y), 1, |value| highest = highest.max(value));
        highest
    })
}

/// The mean of the noise over an arc of `length` pixels, half of it to either side (figure 7.15).
pub fn line_integral_convolution(noise: &Raster<f32>, flow: &Flow, length: f32) -> Raster<f32> {
    let arcs = Arcs::new(noise, flow, 0.5 * length);
    Raster::from_fn(noise.width(), noise.height(), |x, y| {
        let (mut sum, mut count) = (noise.get(x, y), 1.0);
        for sign in [1, -1] {
            arcs.walk((x, y), sign, |value| {
                sum += value;
                count += 1.0;
            });
        }
        sum / count
    })
}

/// Precomputed data for walking along arcs.
struct Arcs {
    /// The noise within a frame of one pixel, so that every place on the raster lies between four samples.
    framed: Raster<f32>,
    /// The step at each pixel, in `UNIT`s of a pixel.
    strides: Raster<[i32; 2]>,
    count: usize,
}

impl Arcs {
    fn new(noise: &Raster<f32>, flow: &Flow, length: f32) -> Self {
        let count = (length / STEP).ceil().max(1.0);
        let stride = length / count * UNIT;
        let strides = flow.directions().map(|d| d.map(|v| (v * stride).round() as i32));
        Self { framed: noise.framed(1), strides, count: count as usize }
    }

    /// Visits the noise along an arc from a pixel's centre, without that pixel.
    #[inline]
    fn walk(&self, (x, y): (usize, usize), sign: i64, mut visit: impl FnMut(f32)) {
        let centre = |at: usize| ((at as i64) << BITS) + (1 << (BITS - 1));
        let (mut px, mut py) = (centre(x), centre(y));
        let [mut dx, mut dy] = self.strides.get(x, y);
        for _ in 0..self.count {
            px += sign * i64::from(dx);
            py += sign * i64::from(dy);
            // As an unsigned number, a position left of or above the raster is far beyond its other end.
            let (column, row) = ((px >> BITS) as usize, (py >> BITS) as usize);
            if column >= self.strides.width() || row >= self.strides.height() || (dx, dy) == (0, 0) {
                return;
            }
            visit(self.between(px, py));
            [dx, dy] = self.strides.get(column, row);
        }
    }

    /// The noise at a place on the raster, bilinear between the pixels' centres.
    #[inline]
    fn between(&self, px: i64, py: i64) -> f32 {
        let (fx, fy) = (px + (1 << (BITS - 1)), py + (1 << (BITS - 1)));
        let share = |at: i64| (at as i32 & ((1 << BITS) - 1)) as f32 * (1.0 / UNIT);
        let (tx, ty) = (share(fx), share(fy));
        let width = self.framed.width();
        let from = (fy >> BITS) as usize * width + (fx >> BITS) as usize;
        let window = &self.framed.pixels()[from..from + width + 2];
        let upper = window[0] + (window[1] - window[0]) * tx;
        let lower = window[width] + (window[width + 1] - window[width]) * tx;
        upper + (lower - upper) * ty
    }
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
