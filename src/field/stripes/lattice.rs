//! Nodes with waves and phases, and the transport of phase between nodes.

use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2};
use crate::raster::Raster;
use std::f64::consts::{PI, TAU};

/// Nodes beyond the raster's border on each side, so that lines reach it.
pub(super) const MARGIN: f64 = 2.0;

/// The target wave of the stripes: direction across them, cycles per pixel; of either sign. Where it is 0 there are no stripes.
pub type Wave = [f32; 2];

/// A lattice of nodes over a raster and a little beyond; node `(i, j)` lies at `((i + 0.5) step - margin, (j + 0.5) step - margin)`
/// in pixels.
#[derive(Clone, Debug)]
pub struct StripeLattice {
    /// Distance of neighbouring nodes in pixels.
    pub step: f64,
    /// Margin beyond the raster on each side, in pixels.
    pub margin: f64,
    /// The target wave at each node.
    pub wave: Raster<Wave>,
    /// The stripes' phase at each node as a complex number; it grows along the node's wave.
    pub phase: Raster<[f32; 2]>,
    /// The same in radians, once the phases are final.
    pub(super) angles: Raster<f64>,
}

impl StripeLattice {
    /// Where a node lies, in pixels.
    pub fn position(&self, i: usize, j: usize) -> Point {
        Point::new((i as f64 + 0.5) * self.step - self.margin, (j as f64 + 0.5) * self.step - self.margin)
    }

    /// Phase gained from one node to another in radians, by the mean of both waves; and whether the waves point in opposite directions.
    pub fn gain(&self, from: (usize, usize), to: (usize, usize)) -> (f64, bool) {
        let (a, b) = (vector(self.wave.get(from.0, from.1)), vector(self.wave.get(to.0, to.1)));
        let turned = a.dot(b) < 0.0;
        let way = self.position(to.0, to.1) - self.position(from.0, from.1);
        let mean = if turned { a - b } else { a + b };
        (PI * mean.dot(way), turned)
    }

    /// True if a node has stripes.
    pub(super) fn is_striped(&self, i: usize, j: usize) -> bool {
        let [x, y] = self.wave.get(i, j);
        x != 0.0 || y != 0.0
    }

    /// The node's phase in radians.
    pub fn angle(&self, i: usize, j: usize) -> f64 {
        self.angles.get(i, j)
    }

    /// The lattice with its phases made final.
    pub(super) fn settled(self) -> Self {
        Self { angles: self.phase.map(|[re, im]| f64::from(im).angle_over(f64::from(re))), ..self }
    }

    /// The stripes midway between these.
    #[must_use]
    pub fn between(&self) -> Self {
        Self { phase: self.phase.map(|[re, im]| [-re, -im]), ..self.clone() }.settled()
    }

    /// Actual growth of the phase from one node to its neighbour, seen with the first node's wave: the target gain, and the remainder to
    /// the neighbour's phase, at most half a cycle.
    pub fn step_between(&self, from: (usize, usize), to: (usize, usize)) -> (f64, f64) {
        let (gain, turned) = self.gain(from, to);
        let there = self.angle(to.0, to.1);
        let there = if turned { -there } else { there };
        let remainder = wrapped(there - self.angle(from.0, from.1) - gain);
        (gain, remainder)
    }

    /// Columns and rows of the lattice of this step over a raster of this size.
    pub fn bare(width: usize, height: usize, step: f64) -> (usize, usize) {
        let count = |length: usize| (length as f64 / step + 2.0 * MARGIN).ceil().max(1.0) as usize;
        (count(width), count(height))
    }

    /// Where a node of such a lattice lies, in pixels.
    pub fn bare_position(i: usize, j: usize, step: f64) -> Point {
        Point::new((i as f64 + 0.5 - MARGIN) * step, (j as f64 + 0.5 - MARGIN) * step)
    }

    /// Actual density of the stripes at each node, in cycles per pixel.
    pub fn frequency(&self) -> Raster<f32> {
        let (width, height) = (self.phase.width(), self.phase.height());
        Raster::from_fn(width, height, |i, j| {
            if !self.is_striped(i, j) {
                return 0.0;
            }
            let growth = |ni: usize, nj: usize| {
                let (gain, remainder) = self.step_between((i, j), (ni, nj));
                gain + remainder
            };
            let slope = |before: f64, after: f64, sides: usize| (after - before) / (sides.max(1) as f64 * self.step * TAU);
            let x = slope(
                if i > 0 { growth(i - 1, j) } else { 0.0 },
                if i + 1 < width { growth(i + 1, j) } else { 0.0 },
                usize::from(i > 0) + usize::from(i + 1 < width),
            );
            let y = slope(
                if j > 0 { growth(i, j - 1) } else { 0.0 },
                if j + 1 < height { growth(i, j + 1) } else { 0.0 },
                usize::from(j > 0) + usize::from(j + 1 < height),
            );
            x.hypotenuse(y) as f32
        })
    }

    /// Reads a raster with one value per node at a place in pixels.
    pub fn read(&self, nodes: &Raster<f32>, p: Point) -> f32 {
        nodes.sample((p.x + self.margin) / self.step, (p.y + self.margin) / self.step)
    }
}

/// A wave as a vector.
pub(super) fn vector(wave: Wave) -> Vec2 {
    Vec2::new(f64::from(wave[0]), f64::from(wave[1]))
}

/// An angle within half a turn of 0.
pub(super) fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}
