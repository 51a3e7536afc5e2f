//! Relaxation in rounds, from coarse to fine: each node becomes the prediction of its neighbourhood.

use super::lattice::{MARGIN, StripeLattice, Wave, vector};
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2};
use crate::parallel::shares;
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

/// Share of each of the four neighbours in one small step; above 0.25 steps overshoot.
const SHARE: f32 = 0.2;

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
        let edges = Edges::new(&lattice, &finest);
        relax(&mut lattice, &edges, parameters, if level == 0 { anchor } else { None });
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

/// Phase gained along a straight path that begins with the wave `first`; and the wave at its end, with the sign carried there.
fn gain_along(fine: &StripeLattice, from: Point, to: Point, first: Wave) -> (f64, Vec2) {
    let way = to - from;
    let pieces = (way.hypot() / fine.step).ceil().max(1.0) as usize;
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

/// The start of a level: the prediction of the four coarser nodes around each node.
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
            if !coarse.phase.contains(cx, cy) {
                continue;
            }
            let weight = (1.0 - (x - cx as f64).abs()) * (1.0 - (y - cy as f64).abs());
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
fn unit([re, im]: [f32; 2]) -> [f32; 2] {
    let length = re.hypotenuse(im);
    if length > 1e-20 { [re / length, im / length] } else { [1.0, 0.0] }
}

/// From a node to its right or lower neighbour: the turn of the phase, and -1 where the waves are opposite; 0 where one of both has no
/// stripes.
#[derive(Clone, Copy, Default)]
struct Edge {
    cos: f32,
    sin: f32,
    sign: f32,
}

impl Edge {
    /// The far node's prediction for the near one.
    fn back(self, [re, im]: [f32; 2]) -> [f32; 2] {
        let im = self.sign * im;
        [re * self.cos + im * self.sin, im * self.cos - re * self.sin]
    }

    /// The near node's prediction for the far one.
    fn ahead(self, [re, im]: [f32; 2]) -> [f32; 2] {
        [re * self.cos - im * self.sin, self.sign * (re * self.sin + im * self.cos)]
    }
}

/// All edges of a lattice.
struct Edges {
    right: Raster<Edge>,
    down: Raster<Edge>,
}

impl Edges {
    fn new(lattice: &StripeLattice, fine: &StripeLattice) -> Self {
        let (width, height) = (lattice.wave.width(), lattice.wave.height());
        let is_finest = lattice.step == fine.step;
        let edge = |i: usize, j: usize, di: usize, dj: usize| {
            let (ni, nj) = (i + di, j + dj);
            if ni >= width || nj >= height || !lattice.is_striped(i, j) || !lattice.is_striped(ni, nj) {
                return Edge::default();
            }
            let (gain, turned) = if is_finest {
                lattice.gain((i, j), (ni, nj))
            } else {
                let (from, to) = (lattice.position(i, j), lattice.position(ni, nj));
                let (gain, carried) = gain_along(fine, from, to, lattice.wave.get(i, j));
                (gain, carried.dot(vector(lattice.wave.get(ni, nj))) < 0.0)
            };
            let (sin, cos) = (gain as f32).sine_and_cosine();
            Edge { cos, sin, sign: if turned { -1.0 } else { 1.0 } }
        };
        Self {
            right: Raster::from_fn(width, height, |i, j| edge(i, j, 1, 0)),
            down: Raster::from_fn(width, height, |i, j| edge(i, j, 0, 1)),
        }
    }
}

/// Rounds of small steps; each round ends by normalising every phase to length 1, so that no patch of stripes fades away.
fn relax(lattice: &mut StripeLattice, edges: &Edges, parameters: StripeParameters, anchor: Option<&Raster<[f32; 2]>>) {
    /// Least nodes of a share: a row of a small lattice takes less time than handing it to a thread.
    const LEAST_NODES: usize = 2048;
    // Each step adds 2 SHARE to the window's variance.
    let steps = ((0.5 * parameters.window).powi(2) / f64::from(2.0 * SHARE)).round().max(1.0) as usize;
    let width = lattice.phase.width().max(1);
    let rows = (LEAST_NODES / width).max(1);
    let mut next = lattice.phase.clone();
    for _ in 0..parameters.rounds {
        for step in 0..steps {
            let small = SmallStep { lattice, edges, anchor, is_last: step + 1 == steps };
            shares(next.pixels_mut(), rows * width, &|part, out| {
                out.chunks_mut(width).enumerate().for_each(|(j, out)| small.row(rows * part + j, out));
            });
            std::mem::swap(&mut lattice.phase, &mut next);
        }
    }
}

/// One small step towards the four neighbours' predictions.
struct SmallStep<'a> {
    lattice: &'a StripeLattice,
    edges: &'a Edges,
    anchor: Option<&'a Raster<[f32; 2]>>,
    /// Whether it ends a round.
    is_last: bool,
}

impl SmallStep<'_> {
    fn row(&self, j: usize, out: &mut [[f32; 2]]) {
        let (phase, edges) = (&self.lattice.phase, self.edges);
        let (row, right, down) = (phase.row(j), edges.right.row(j), edges.down.row(j));
        let above = (j > 0).then(|| (phase.row(j - 1), edges.down.row(j - 1)));
        let below = (j + 1 < phase.height()).then(|| phase.row(j + 1));
        for (i, out) in out.iter_mut().enumerate().filter(|(i, _)| self.lattice.is_striped(*i, j)) {
            let (mut sum, mut count) = ([0.0_f32; 2], 0.0_f32);
            let mut add = |edge: Edge, [re, im]: [f32; 2]| {
                sum = [sum[0] + re, sum[1] + im];
                count += edge.sign.abs();
            };
            if i > 0 {
                add(right[i - 1], right[i - 1].ahead(row[i - 1]));
            }
            if i + 1 < row.len() {
                add(right[i], right[i].back(row[i + 1]));
            }
            if let Some((above, edges)) = above {
                add(edges[i], edges[i].ahead(above[i]));
            }
            if let Some(below) = below {
                add(down[i], down[i].back(below[i]));
            }
            let own = 1.0 - SHARE * count;
            let [re, im] = row[i];
            let mut value = [own * re + SHARE * sum[0], own * im + SHARE * sum[1]];
            if let Some(anchor) = self.anchor {
                let [re, im] = anchor.get(i, j);
                value = [value[0] + re, value[1] + im];
            }
            *out = if self.is_last { unit(value) } else { value };
        }
    }
}
