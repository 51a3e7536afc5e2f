//! A kernel across the flow as pixel weights, precomputed for each direction.

use super::padded::Padded;
use crate::elementary::Elementary as _;
use std::collections::BTreeMap;

/// Number of distinct slopes in each half of the directions; at the stencil's end neighbouring slopes are a twentieth of a pixel apart.
const SLOPES: usize = 64;

/// The kernel across the flow for each direction, its bilinear samples gathered into weights of whole pixels.
pub(super) struct Stencils {
    /// One for each direction, in the order of [`Stencils::class`].
    taps: Vec<Vec<Tap>>,
    /// Weight of the middle pixel.
    centre: f32,
    /// Reach to each side in pixels.
    pub reach: usize,
}

/// A weight for the two pixels at an offset before and behind the middle one.
#[derive(Clone, Copy)]
struct Tap {
    offset: isize,
    weight: f32,
}

impl Stencils {
    /// For a raster of this width, padded by the reach.
    pub(super) fn new(kernel: &[f32], width: usize) -> Self {
        let reach = kernel.len() + 1;
        let stride = (width + 2 * reach) as isize;
        let slope = |k: usize| 2.0 * k as f32 / SLOPES as f32 - 1.0;
        let flat = (0..=SLOPES).map(|k| [1.0, slope(k)]);
        let steep = (0..=SLOPES).map(|k| [slope(k), 1.0]);
        let taps = flat.chain(steep).map(|tangent| taps_across(tangent, kernel, stride)).collect();
        Self { taps, centre: kernel[0], reach }
    }

    /// The kernel's sum across this tangent, at a pixel of a raster padded by the reach.
    pub(super) fn sum(&self, padded: &Padded<f32>, tangent: [f32; 2], x: usize, y: usize) -> f32 {
        let here = (y + padded.margin) * padded.stride + x + padded.margin;
        let at = |offset: isize| padded.data[here.wrapping_add_signed(offset)];
        let taps = self.taps[Self::class(tangent)].iter();
        taps.fold(self.centre * at(0), |sum, tap| sum + tap.weight * (at(tap.offset) + at(-tap.offset)))
    }

    /// Which stencil lies across this tangent.
    fn class([x, y]: [f32; 2]) -> usize {
        let (first, slope) = if x.abs() >= y.abs() { (0, y / x) } else { (SLOPES + 1, x / y) };
        first + ((slope + 1.0) * (0.5 * SLOPES as f32) + 0.5) as usize
    }
}

fn taps_across([x, y]: [f32; 2], kernel: &[f32], stride: isize) -> Vec<Tap> {
    let length = x.hypotenuse(y);
    let mut sums: BTreeMap<isize, f32> = BTreeMap::new();
    for (i, weight) in kernel.iter().enumerate().skip(1) {
        let (px, py) = (-y / length * i as f32, x / length * i as f32);
        let (tx, ty) = (px - px.floor(), py - py.floor());
        let first = py.floor() as isize * stride + px.floor() as isize;
        for (offset, share) in
            [(0, (1.0 - tx) * (1.0 - ty)), (1, tx * (1.0 - ty)), (stride, (1.0 - tx) * ty), (stride + 1, tx * ty)]
        {
            *sums.entry(first + offset).or_default() += weight * share;
        }
    }
    sums.into_iter().filter(|(_, weight)| *weight != 0.0).map(|(offset, weight)| Tap { offset, weight }).collect()
}
