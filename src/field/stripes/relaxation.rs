//! Relaxation in rounds, from coarse to fine: each node becomes the prediction of its neighbourhood.

use super::lattice::{MARGIN, StripeLattice, Wave, vector};
use super::steps::{Edges, SHARE, relaxed_phases};
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2};
use crate::raster::Raster;
use std::f64::consts::TAU;

/// Parameters of stripes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripeParameters {
    /// Distance of neighbouring nodes in pixels: half a pitch, at most 0.6 of the narrowest stripe.
    pub step: f64,
    /// Reach of the window in nodes (Son: `r`): two standard deviations of its Gaussian.
    pub window: f64,
    /// Rounds on each level (Son: 3 to 8 iterations).
    pub rounds: u32,
    /// Levels, each with nodes twice as far apart.
    pub levels: u32,
}

/// Initial phase of a node, in cycles, from its number, its place in pixels and its wave.
pub type Start<'a> = &'a (dyn Fn(u64, Point, Wave) -> f32 + Sync);

/// Stripes along `wave` (full size, in pixels), starting on the coarsest level from the given phases. An anchor pulls each node of the
/// finest level to a phase (a complex number whose length is the strength, 0 for none).
pub fn stripes(
    wave: &Raster<Wave>,
    parameters: StripeParameters,
    start: Start<'_>,
    anchor: Option<&Raster<[f32; 2]>>,
) -> StripeLattice {
    let margin = MARGIN * parameters.step;
    let count = |length: usize, step: f64| ((length as f64 + 2.0 * margin) / step).ceil().max(1.0) as usize;
    let (width, height) = (wave.width(), wave.height());
    let nodes = |step: f64| sampled(wave, step, margin, (count(width, step), count(height, step)));
    let finest_waves = sampled(wave, parameters.step, margin, StripeLattice::bare(width, height, parameters.step));
    let finest = StripeLattice {
        step: parameters.step,
        margin,
        wave: finest_waves,
        phase: Raster::filled(0, 0, [0.0; 2]),
        angles: Raster::filled(0, 0, 0.0),
    };
    let relaxed = |coarser: Option<&StripeLattice>, level: u32| {
        let step = parameters.step * f64::from(1_u32 << level);
        let waves = if level == 0 { finest.wave.clone() } else { nodes(step) };
        let phase = match coarser {
            None => Raster::from_fn(waves.width(), waves.height(), |i, j| {
                let place = Point::new((i as f64 + 0.5) * step - margin, (j as f64 + 0.5) * step - margin);
                let angle = std::f32::consts::TAU * start((j * waves.width() + i) as u64, place, waves.get(i, j));
                [angle.cosine(), angle.sine()]
            }),
            Some(coarse) => refined(coarse, &finest, &waves, step),
        };
        let mut lattice = StripeLattice { step, margin, wave: waves, phase, angles: Raster::filled(0, 0, 0.0) };
        let edges = Edges::new((lattice.wave.width(), lattice.wave.height()), |from, to| edge(&lattice, &finest, from, to));
        let anchor = if level == 0 { anchor } else { None };
        lattice.phase = relaxed_phases(&lattice.phase, &edges, small_steps(parameters), parameters.rounds, anchor);
        lattice
    };
    let coarsest = parameters.levels.max(1) - 1;
    (0..coarsest).rev().fold(relaxed(None, coarsest), |coarser, level| relaxed(Some(&coarser), level)).settled()
}

/// The wave at the nodes of a lattice.
fn sampled(wave: &Raster<Wave>, step: f64, margin: f64, (width, height): (usize, usize)) -> Raster<Wave> {
    Raster::from_fn(width, height, |i, j| wave_at(wave, (i as f64 + 0.5) * step - margin, (j as f64 + 0.5) * step - margin))
}

/// The wave between pixels (or nodes, with coordinates in their unit); waves of opposite sign are flipped.
fn wave_at(wave: &Raster<Wave>, x: f64, y: f64) -> Wave {
    let (x, y) = (x - 0.5, y - 0.5);
    let (x0, y0) = (x.floor(), y.floor());
    let (tx, ty) = (x - x0, y - y0);
    let first = wave.clamped(x0 as isize + isize::from(tx > 0.5), y0 as isize + isize::from(ty > 0.5));
    let mut sum = [0.0_f32; 2];
    for (dx, dy, weight) in [(0, 0, (1.0 - tx) * (1.0 - ty)), (1, 0, tx * (1.0 - ty)), (0, 1, (1.0 - tx) * ty), (1, 1, tx * ty)] {
        let [wx, wy] = wave.clamped(x0 as isize + dx, y0 as isize + dy);
        let weight = if wx * first[0] + wy * first[1] < 0.0 { -weight } else { weight } as f32;
        sum = [sum[0] + weight * wx, sum[1] + weight * wy];
    }
    // Averaging different directions shortens the mean; the stripes' frequency must not fall for that reason.
    let (length, wanted) = (sum[0].hypotenuse(sum[1]), first[0].hypotenuse(first[1]));
    if length > 1e-12 { [sum[0] * wanted / length, sum[1] * wanted / length] } else { first }
}

/// Length of a straight path's pieces in the finest nodes' distances: shorter ones change no line that can be seen.
const PIECE: f64 = 2.0;

/// Phase gained along a straight path that begins with the wave `first`; and the wave at its end, with the sign carried there.
fn gain_along(fine: &StripeLattice, from: Point, to: Point, first: Wave) -> (f64, Vec2) {
    let way = to - from;
    let pieces = (way.hypot() / (PIECE * fine.step)).ceil().max(1.0) as usize;
    let (mut sum, mut carried) = (0.0, vector(first));
    for piece in 0..pieces {
        let p = from + way * ((piece as f64 + 0.5) / pieces as f64);
        let here = vector(wave_at(&fine.wave, (p.x + fine.margin) / fine.step, (p.y + fine.margin) / fine.step));
        carried = if here.dot(carried) < 0.0 { -here } else { here };
        sum += carried.dot(way) / pieces as f64;
    }
    (TAU * sum, carried)
}

/// The same along a way of less than a stripe, by the waves at both its ends.
fn short_gain(way: Vec2, first: Wave, last: Wave) -> (f64, Vec2) {
    let (first, last) = (vector(first), vector(last));
    let carried = if first.dot(last) < 0.0 { -last } else { last };
    (0.5 * TAU * (first + carried).dot(way), carried)
}

/// Weight among the four coarser nodes around a node from which one counts: the farthest has a sixteenth.
const LEAST_WEIGHT: f64 = 0.1;

/// The start of a level: the prediction of the nearest coarser nodes around each node.
fn refined(coarse: &StripeLattice, fine: &StripeLattice, waves: &Raster<Wave>, step: f64) -> Raster<[f32; 2]> {
    let is_finest = step == fine.step;
    Raster::from_fn(waves.width(), waves.height(), |i, j| {
        if waves.get(i, j) == [0.0; 2] {
            return [1.0, 0.0];
        }
        let here = Point::new((i as f64 + 0.5) * step - fine.margin, (j as f64 + 0.5) * step - fine.margin);
        let (x, y) = ((here.x + fine.margin) / coarse.step - 0.5, (here.y + fine.margin) / coarse.step - 0.5);
        let mut sum = [0.0_f32; 2];
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (cx, cy) = (x.floor() as isize + dx, y.floor() as isize + dy);
            let weight = (1.0 - (x - cx as f64).abs()) * (1.0 - (y - cy as f64).abs());
            if weight < LEAST_WEIGHT || !coarse.phase.contains(cx, cy) {
                continue;
            }
            let (cx, cy) = (cx as usize, cy as usize);
            let (from, first) = (coarse.position(cx, cy), coarse.wave.get(cx, cy));
            let (gain, carried) =
                if is_finest { short_gain(here - from, first, waves.get(i, j)) } else { gain_along(fine, from, here, first) };
            let [re, im] = rotated(coarse.phase.get(cx, cy), gain as f32);
            let turned = carried.dot(vector(waves.get(i, j))) < 0.0;
            sum = [sum[0] + weight as f32 * re, sum[1] + weight as f32 * if turned { -im } else { im }];
        }
        unit(sum)
    })
}

fn rotated([re, im]: [f32; 2], angle: f32) -> [f32; 2] {
    let (sin, cos) = angle.sine_and_cosine();
    [re * cos - im * sin, re * sin + im * cos]
}

/// Normalises to length 1; a value of zero length, which predicts nothing, becomes 1.
pub(super) fn unit([re, im]: [f32; 2]) -> [f32; 2] {
    let length = re.hypotenuse(im);
    if length > 1e-20 { [re / length, im / length] } else { [1.0, 0.0] }
}

/// The phase gained from a node to its neighbour, and whether the waves are opposite; none where one of both has no stripes.
fn edge(lattice: &StripeLattice, fine: &StripeLattice, from: (usize, usize), to: (usize, usize)) -> Option<(f64, bool)> {
    if !lattice.is_striped(from.0, from.1) || !lattice.is_striped(to.0, to.1) {
        return None;
    }
    if lattice.step == fine.step {
        return Some(lattice.gain(from, to));
    }
    let first = lattice.wave.get(from.0, from.1);
    let (gain, carried) = gain_along(fine, lattice.position(from.0, from.1), lattice.position(to.0, to.1), first);
    Some((gain, carried.dot(vector(lattice.wave.get(to.0, to.1))) < 0.0))
}

/// Small steps of one round: each adds `2 SHARE` to the window's variance.
fn small_steps(parameters: StripeParameters) -> usize {
    ((0.5 * parameters.window).powi(2) / f64::from(2.0 * SHARE)).round().max(1.0) as usize
}
