//! Means along the streamlines of the flow.

use super::super::tangent_flow::EdgeTangentFlow;
use super::half_gaussian;
use super::padded::Padded;

/// Length of a step along a streamline in pixels: half the standard deviation of the shortest Gaussian in use.
const STEP: f32 = 1.5;
/// Fractional bits of a position on a streamline: fixed point is faster than rounding floats.
const BITS: i32 = 14;
const PIXEL: i32 = 1 << BITS;

/// The flow, prepared for tracing.
pub(super) struct Streamlines {
    /// One step at each pixel.
    steps: Padded<[i16; 2]>,
    /// Weights of the middle and of each step to either side.
    weights: Vec<f32>,
}

/// A position on a streamline relative to its start, and the next step.
struct Walker {
    place: [i32; 2],
    step: [i32; 2],
}

impl Streamlines {
    pub(super) fn new(flow: &EdgeTangentFlow, sigma: f32) -> Self {
        let weights = half_gaussian(sigma / STEP);
        let margin = (weights.len() as f32 * STEP) as usize + 2;
        let steps = flow.tangent.map(|t| t.map(|t| (t * STEP * PIXEL as f32) as i16));
        Self { steps: Padded::new(&steps, margin), weights }
    }

    /// How far streamlines are followed, plus a small margin.
    pub(super) const fn margin(&self) -> usize {
        self.steps.margin
    }

    /// Weighted mean of the responses along the streamline through a pixel.
    #[inline]
    pub(super) fn mean(&self, responses: &Padded<f32>, x: usize, y: usize) -> f32 {
        let here = (y + self.margin()) * responses.stride + x + self.margin();
        let [dx, dy] = self.step(here);
        let mut walkers = [Walker { place: [0, 0], step: [dx, dy] }, Walker { place: [0, 0], step: [-dx, -dy] }];
        let mut sum = self.weights[0] * responses.data[here];
        for &weight in &self.weights[1..] {
            let [ahead, behind] = &mut walkers;
            sum += weight * (self.advance(ahead, responses, here) + self.advance(behind, responses, here));
        }
        sum
    }

    #[inline]
    fn step(&self, pixel: usize) -> [i32; 2] {
        let [dx, dy] = self.steps.data[pixel];
        [i32::from(dx), i32::from(dy)]
    }

    /// Takes one step and returns the bilinear response there.
    #[inline]
    fn advance(&self, walker: &mut Walker, responses: &Padded<f32>, here: usize) -> f32 {
        let Walker { place: [x, y], step: [dx, dy] } = walker;
        (*x, *y) = (*x + *dx, *y + *dy);
        let at =
            |x: i32, y: i32| here.wrapping_add_signed((y >> BITS) as isize * responses.stride as isize + (x >> BITS) as isize);
        let [tx, ty] = self.step(at(*x + PIXEL / 2, *y + PIXEL / 2));
        let dot = tx * *dx + ty * *dy;
        if dot != 0 {
            let sign = dot.signum();
            (*dx, *dy) = (sign * tx, sign * ty);
        }
        let part = |v: i32| (v & (PIXEL - 1)) as f32 * (1.0 / PIXEL as f32);
        let (u, v, first) = (part(*x), part(*y), at(*x, *y));
        let (top, bottom) = (&responses.data[first..first + 2], &responses.data[first + responses.stride..][..2]);
        let upper = top[0] + (top[1] - top[0]) * u;
        let lower = bottom[0] + (bottom[1] - bottom[0]) * u;
        upper + (lower - upper) * v
    }
}
