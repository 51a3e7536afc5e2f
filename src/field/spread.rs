//! Values known at some places, spread smoothly over the others.
//!
//! Minimises `sum |grad a|^2 + bending (laplace a)^2 + weight (a - known)^2` by conjugate gradients, each level starting from the
//! coarser one's result.

use super::least_squares::{negative_laplacian, solved};
use crate::parallel::mapped;
use crate::raster::{Raster, enlarge_smoothly};

/// Shorter side of the coarsest level in pixels, and the rounds there and on each finer level.
const COARSEST: usize = 12;
const COARSE_ROUNDS: usize = 120;
const ROUNDS: usize = 40;
/// Weight that keeps the equations solvable where nothing is known.
const LEAST_WEIGHT: f32 = 1e-6;

/// The smooth values of several planes known at the same places with the same weights, 0 where nothing is known.
pub(crate) fn spread(known: &[Raster<f32>], weight: &Raster<f32>, bending: f32) -> Vec<Raster<f32>> {
    mapped(known, &|plane| spread_plane(plane, weight, bending))
}

fn spread_plane(known: &Raster<f32>, weight: &Raster<f32>, bending: f32) -> Raster<f32> {
    let (width, height) = (weight.width(), weight.height());
    let is_coarsest = width.min(height) <= COARSEST;
    let start = if is_coarsest {
        let total: f64 = weight.pixels().iter().map(|w| f64::from(*w)).sum();
        let sum: f64 = known.pixels().iter().zip(weight.pixels()).map(|(k, w)| f64::from(*k) * f64::from(*w)).sum();
        Raster::filled(width, height, (sum / total.max(1e-12)) as f32)
    } else {
        // A coarse pixel stands for four: its weight is theirs together, and bending falls with the square of the step.
        let weights = sums_of_four(weight);
        let known = sums_of_four(&weight.zip_map(known, |w, k| w * k)).zip_map(&weights, |sum, w| sum / w.max(1e-12));
        enlarge_smoothly(&spread_plane(&known, &weights, 0.25 * bending), 2, width, height)
    };
    let equations = Equations { weight, bending };
    equations.solved(known, start, if is_coarsest { COARSE_ROUNDS } else { ROUNDS })
}

/// The sums of two by two pixels.
fn sums_of_four(raster: &Raster<f32>) -> Raster<f32> {
    let (width, height) = (raster.width(), raster.height());
    Raster::from_fn(width.div_ceil(2), height.div_ceil(2), |x, y| {
        let places = (2 * y..(2 * y + 2).min(height)).flat_map(|y| (2 * x..(2 * x + 2).min(width)).map(move |x| (x, y)));
        places.map(|(x, y)| raster.get(x, y)).sum()
    })
}

struct Equations<'a> {
    weight: &'a Raster<f32>,
    bending: f32,
}

impl Equations<'_> {
    /// The left side for values `a`.
    fn of(&self, a: &Raster<f32>) -> Raster<f32> {
        let once = negative_laplacian(a);
        let twice = negative_laplacian(&once);
        Raster::from_fn(a.width(), a.height(), |x, y| {
            once.get(x, y) + self.bending * twice.get(x, y) + (self.weight.get(x, y) + LEAST_WEIGHT) * a.get(x, y)
        })
    }

    fn solved(&self, known: &Raster<f32>, start: Raster<f32>, rounds: usize) -> Raster<f32> {
        let scale = self.weight.map(|w| 1.0 / (4.0 + 20.0 * self.bending + w + LEAST_WEIGHT));
        solved(|a| self.of(a), &known.zip_map(self.weight, |k, w| k * w), &scale, start, rounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_known_at_a_few_places_is_a_plane() {
        let plane = |x: usize, y: usize| 0.02 * x as f32 - 0.01 * y as f32;
        let weight = Raster::from_fn(90, 70, |x, y| f32::from(u8::from(x % 17 == 3 && y % 13 == 4)));
        let known = Raster::from_fn(90, 70, plane);
        let spread = &spread(&[known], &weight, 6.0)[0];
        for (x, y) in [(20, 20), (45, 33), (60, 50)] {
            assert!((spread.get(x, y) - plane(x, y)).abs() < 0.04, "{} {}", spread.get(x, y), plane(x, y));
        }
    }
}
