//! Nodes with waves and phases, and how a phase is carried from one to another.

use crate::geometry::{Point, Vec2};
use crate::raster::Raster;
use std::f64::consts::{PI, TAU};

/// The wave that the stripes should be: direction across them, cycles a pixel; of either sign.
pub type Wave = [f32; 2];

/// A lattice of nodes over a raster; node `(i, j)` lies at `((i + 0.5) step, (j + 0.5) step)` in pixels.
#[derive(Clone, Debug)]
pub struct StripeLattice {
    /// Distance of neighbouring nodes in pixels.
    pub step: f64,
    /// The wanted wave at each node.
    pub wave: Raster<Wave>,
    /// The stripes' phase at each node as a complex number; it grows along the node's wave.
    pub phase: Raster<[f32; 2]>,
}

impl StripeLattice {
    /// Where a node lies, in pixels.
    pub fn position(&self, i: usize, j: usize) -> Point {
        Point::new((i as f64 + 0.5) * self.step, (j as f64 + 0.5) * self.step)
    }

    /// Phase gained from one node to another in radians, and whether their waves point opposite ways; by the mean of both waves.
    pub fn gain(&self, from: (usize, usize), to: (usize, usize)) -> (f64, bool) {
        let (a, b) = (vector(self.wave.get(from.0, from.1)), vector(self.wave.get(to.0, to.1)));
        let turned = a.dot(b) < 0.0;
        let way = self.position(to.0, to.1) - self.position(from.0, from.1);
        let mean = if turned { a - b } else { a + b };
        (PI * mean.dot(way), turned)
    }

    /// The node's phase in radians.
    pub fn angle(&self, i: usize, j: usize) -> f64 {
        let [re, im] = self.phase.get(i, j);
        f64::from(im).atan2(f64::from(re))
    }

    /// How much the phase really grows from one node to its neighbour, seen with the first one's wave: the wanted gain and the
    /// remainder that brings it to the neighbour's phase, at most half a cycle.
    pub fn step_between(&self, from: (usize, usize), to: (usize, usize)) -> (f64, f64) {
        let (gain, turned) = self.gain(from, to);
        let there = self.angle(to.0, to.1);
        let there = if turned { -there } else { there };
        let remainder = wrapped(there - self.angle(from.0, from.1) - gain);
        (gain, remainder)
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
