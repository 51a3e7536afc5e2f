//! Edge tangent flow (Kang, Lee and Chui 2007): directions along the edges, smoothed so that strong edges dominate.
//!
//! Uses the separable form: the window is summed along the rows, then along the columns.

use crate::elementary::Elementary as _;
use crate::raster::{Raster, sobel};
use rayon::prelude::*;

/// Gradients below this (grey 0 to 1, per pixel) have no direction: a tenth of the rounding of 8-bit grey.
const NO_GRADIENT: f32 = 4e-4;

/// The direction of the nearby edges at each pixel.
#[derive(Clone, Debug)]
pub struct EdgeTangentFlow {
    /// Unit vectors along the edges, of either sign; (0, 0) where the grey is flat.
    pub tangent: Raster<[f32; 2]>,
    /// Gradient magnitude, 0 to 1, 1 the strongest of the raster.
    pub strength: Raster<f32>,
}

/// The edge tangent flow of a grey raster, 0 to 1.
///
/// Each round replaces the direction at `x` by the sum over the window (`radius` pixels, mu = 5) of `sign(t(x).t(y)) t(y) w_m w_d`,
/// `w_d = |t(x).t(y)|`, `w_m = (1 + tanh(g(y) - g(x))) / 2`. Kang's value: 2 to 3 rounds.
///
/// ```
/// use drypoint::{field::edge_tangent_flow, raster::Raster};
///
/// // Light rises to the right: edges run up and down.
/// let grey = Raster::from_fn(40, 40, |x, _| if x < 20 { 0.2 } else { 0.8 });
/// let [x, y] = edge_tangent_flow(&grey, 5, 2).tangent.get(20, 20);
/// assert!(x.abs() < 0.01 && y.abs() > 0.99);
/// ```
pub fn edge_tangent_flow(grey: &Raster<f32>, radius: usize, rounds: u32) -> EdgeTangentFlow {
    let gradient = sobel(grey);
    let magnitude = gradient.map(|[x, y]| x.hypotenuse(y));
    let greatest = magnitude.pixels().iter().copied().fold(0.0, f32::max).max(NO_GRADIENT);
    let strength = magnitude.map(|m| m / greatest);
    let mut flow = Planes {
        x: gradient.map(|g| unit(g)[1]),
        y: gradient.map(|g| -unit(g)[0]),
        // (1 + tanh(b - a)) / 2 = e^2b / (e^2a + e^2b).
        power: strength.map(|s| (2.0 * s).exponential()),
    };
    for _ in 0..rounds {
        flow = flow.smoothed_along_rows(radius);
        flow = flow.smoothed_along_columns(radius);
    }
    EdgeTangentFlow { tangent: flow.x.zip_map(&flow.y, |x, y| [x, y]), strength }
}

fn unit([x, y]: [f32; 2]) -> [f32; 2] {
    let length = x.hypotenuse(y);
    if length < NO_GRADIENT { [0.0, 0.0] } else { [x / length, y / length] }
}

/// The flow's components as separate planes, which the compiler can vectorise.
struct Planes {
    x: Raster<f32>,
    y: Raster<f32>,
    power: Raster<f32>,
}

/// A stretch of one row of the flow.
#[derive(Clone, Copy)]
struct Stretch<'a> {
    x: &'a [f32],
    y: &'a [f32],
    power: &'a [f32],
}

impl<'a> Stretch<'a> {
    fn part(self, from: usize, to: usize) -> Stretch<'a> {
        Stretch { x: &self.x[from..to], y: &self.y[from..to], power: &self.power[from..to] }
    }
}

impl Planes {
    fn row(&self, y: usize) -> Stretch<'_> {
        Stretch { x: self.x.row(y), y: self.y.row(y), power: self.power.row(y) }
    }

    fn smoothed_along_rows(self, radius: usize) -> Self {
        let width = self.x.width();
        self.smoothed(|flow, y, x_out, y_out| {
            let row = flow.row(y);
            for shift in 0..=radius.min(width - 1) {
                let (left, right) = (row.part(0, width - shift), row.part(shift, width));
                add_weighted(left, right, &mut x_out[..width - shift], &mut y_out[..width - shift]);
                if shift > 0 {
                    add_weighted(right, left, &mut x_out[shift..], &mut y_out[shift..]);
                }
            }
        })
    }

    fn smoothed_along_columns(self, radius: usize) -> Self {
        let last = self.x.height() - 1;
        self.smoothed(|flow, y, x_out, y_out| {
            for other in y.saturating_sub(radius)..=(y + radius).min(last) {
                add_weighted(flow.row(y), flow.row(other), x_out, y_out);
            }
        })
    }

    /// Sums by row with `add`, then unit length.
    fn smoothed(self, add: impl Fn(&Self, usize, &mut [f32], &mut [f32]) + Sync) -> Self {
        let (width, height) = (self.x.width(), self.x.height());
        if width == 0 || height == 0 {
            return self;
        }
        let mut x = Raster::filled(width, height, 0.0_f32);
        let mut y = x.clone();
        let rows = x.pixels_mut().par_chunks_mut(width).zip(y.pixels_mut().par_chunks_mut(width)).enumerate();
        rows.for_each(|(row, (x_out, y_out))| {
            add(&self, row, x_out, y_out);
            for (x, y) in x_out.iter_mut().zip(y_out) {
                let scale = 1.0 / (*x * *x + *y * *y).sqrt().max(1e-12);
                *x *= scale;
                *y *= scale;
            }
        });
        Self { x, y, power: self.power }
    }
}

/// Adds to each pixel of `here` its neighbour in `there`; `sign(a.b) |a.b|` is just `a.b`.
fn add_weighted(here: Stretch<'_>, there: Stretch<'_>, x_out: &mut [f32], y_out: &mut [f32]) {
    let count = x_out.len();
    let (here, there, y_out) = (here.part(0, count), there.part(0, count), &mut y_out[..count]);
    for i in 0..count {
        let dot = here.x[i] * there.x[i] + here.y[i] * there.y[i];
        let weight = dot * there.power[i] / (there.power[i] + here.power[i]);
        x_out[i] += weight * there.x[i];
        y_out[i] += weight * there.y[i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::distances_from;

    #[test]
    fn the_flow_runs_around_a_noisy_disc() {
        let disc = distances_from(59.5, 120).map(|r| 0.8 / (1.0 + (35.0 - r).exponential()));
        let grey = Raster::from_fn(120, 120, |x, y| disc.get(x, y) + 0.04 * ((x * 31 + y * 57) % 7) as f32 / 7.0);
        let flow = edge_tangent_flow(&grey, 5, 3);
        for degrees in 0..360 {
            let angle = (degrees as f32).to_radians();
            let (x, y) = ((60.0 + 35.0 * angle.cosine()) as usize, (60.0 + 35.0 * angle.sine()) as usize);
            let [tx, ty] = flow.tangent.get(x, y);
            assert!((tx.hypotenuse(ty) - 1.0).abs() < 1e-3);
            let across = tx * angle.cosine() + ty * angle.sine();
            assert!(across.abs() < 0.1, "at {degrees} degrees {across}");
        }
    }

    #[test]
    fn flat_grey_has_no_direction() {
        let flow = edge_tangent_flow(&Raster::filled(20, 10, 0.5), 5, 2);
        assert!(flow.tangent.pixels().iter().all(|t| *t == [0.0, 0.0]));
        assert!(edge_tangent_flow(&Raster::filled(0, 0, 0.5), 5, 2).tangent.is_empty());
    }

    /// The sums by stretches against the formula as it is printed, pixel by pixel along a row.
    #[test]
    fn one_row_is_the_formula() {
        let grey = Raster::from_fn(40, 1, |x, _| ((x * 7) % 11) as f32 / 11.0);
        let before = edge_tangent_flow(&grey, 3, 0);
        let after = edge_tangent_flow(&grey, 3, 1);
        for x in 0..40_usize {
            let here = before.tangent.get(x, 0);
            let mut sum = [0.0_f32; 2];
            for other in x.saturating_sub(3)..=(x + 3).min(39) {
                let there = before.tangent.get(other, 0);
                let dot = here[0] * there[0] + here[1] * there[1];
                let weight = 0.5 * (1.0 + (before.strength.get(other, 0) - before.strength.get(x, 0)).hyperbolic_tangent());
                let sign = if dot < 0.0 { -1.0 } else { 1.0 };
                sum[0] += sign * there[0] * weight * dot.abs();
                sum[1] += sign * there[1] * weight * dot.abs();
            }
            let length = sum[0].hypotenuse(sum[1]).max(1e-12);
            // The column pass over a single row changes nothing but the length, which is 1 again.
            let found = after.tangent.get(x, 0);
            assert!((found[0] - sum[0] / length).abs() < 1e-4 && (found[1] - sum[1] / length).abs() < 1e-4);
        }
    }
}
