//! The block buffer: the entry speed of each block, recomputed for every block that is added.

use super::stepper::Stepper;
use super::{Real, Settings};
use std::collections::VecDeque;

/// Corners with cosines closer to 1 than this are a straight line or a reversal.
const STRAIGHT: Real = 0.999_999;
/// The slowest rate, mm/min.
const MINIMUM_FEED_RATE: Real = 1.0;

/// A straight move, mm and minutes.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Steps of the axis with most of them.
    pub steps: u64,
    /// The remaining length.
    pub length: Real,
    pub acceleration: Real,
    pub nominal: Real,
    greatest_entry_squared: Real,
    /// Squared entry speed; for the running block its speed when last planned.
    pub entry_squared: Real,
    /// Its end, in mm.
    pub end: [f64; 3],
    pub direction: [Real; 3],
}

impl Block {
    /// The place at a distance before its end.
    pub fn place(&self, left: Real) -> [f64; 3] {
        std::array::from_fn(|axis| self.end[axis] - f64::from(self.direction[axis] * left))
    }
}

pub struct Planner {
    settings: Settings,
    /// The first is the running or next block.
    blocks: VecDeque<Block>,
    position: [i64; 3],
    direction: [Real; 3],
    nominal: Real,
}

impl Planner {
    pub fn new(settings: &Settings) -> Self {
        Self { settings: *settings, blocks: VecDeque::new(), position: [0; 3], direction: [0.0; 3], nominal: 0.0 }
    }

    pub fn is_full(&self) -> bool {
        self.blocks.len() == self.settings.blocks
    }

    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Free places.
    pub fn free(&self) -> usize {
        self.settings.blocks - self.blocks.len()
    }

    /// Forgets all blocks; the motors stand at a place in mm.
    pub fn reset(&mut self, at: [f64; 3]) {
        self.blocks.clear();
        self.position = std::array::from_fn(|axis| (at[axis] * self.settings.steps_per_mm[axis]).round() as i64);
        (self.direction, self.nominal) = ([0.0; 3], 0.0);
    }

    /// Plans again from rest, after a hold.
    pub fn plan_again(&mut self) {
        if let Some(block) = self.blocks.front_mut() {
            block.entry_squared = 0.0;
        }
        self.replan();
    }

    pub fn first(&mut self) -> Option<&mut Block> {
        self.blocks.front_mut()
    }

    pub fn discard_first(&mut self) {
        self.blocks.pop_front();
    }

    /// The squared speed at which the first block ends.
    pub fn exit_squared(&self) -> Real {
        self.blocks.get(1).map_or(0.0, |next| next.entry_squared)
    }

    /// Adds a move to the buffer and replans; a move of no step is ignored.
    pub fn add(&mut self, target: [f32; 3], rate: Option<f64>, stepper: &mut Stepper) {
        let mut delta = [0.0; 3];
        let mut steps = 0;
        let mut position = self.position;
        for axis in 0..3 {
            let per_mm = self.settings.steps_per_mm[axis] as Real;
            position[axis] = (target[axis] * self.settings.steps_per_mm[axis] as f32).round() as i64;
            let moved = position[axis] - self.position[axis];
            steps = steps.max(moved.unsigned_abs());
            delta[axis] = moved as Real / per_mm;
        }
        if steps == 0 {
            return;
        }
        let length = length_of(delta);
        let direction = delta.map(|d| d / length);
        let acceleration = limited(self.accelerations(), direction);
        let fastest = limited(self.settings.greatest_rate.map(|rate| rate as Real), direction);
        let nominal = rate.map_or(fastest, |rate| rate as Real).min(fastest).max(MINIMUM_FEED_RATE);
        let corner = if self.blocks.is_empty() { 0.0 } else { self.corner_squared(direction) };
        let greatest_entry_squared = corner.min(nominal * nominal).min(self.nominal * self.nominal);
        let end = std::array::from_fn(|axis| position[axis] as f64 / self.settings.steps_per_mm[axis]);
        let entry_squared = 0.0;
        self.blocks.push_back(Block {
            steps,
            length,
            acceleration,
            nominal,
            greatest_entry_squared,
            entry_squared,
            end,
            direction,
        });
        (self.position, self.direction, self.nominal) = (position, direction, nominal);
        stepper.prepare_replan(self);
        self.replan();
    }

    /// In mm/min^2.
    fn accelerations(&self) -> [Real; 3] {
        self.settings.acceleration.map(|acceleration| (3600.0 * acceleration) as Real)
    }

    /// Squared corner speed: on a circle that touches both legs and passes the corner at the junction deviation, with the
    /// centripetal acceleration that the axes can give in the direction of the change.
    fn corner_squared(&self, direction: [Real; 3]) -> Real {
        let before = self.direction;
        let cosine = -(0..3).map(|i| before[i] * direction[i]).sum::<Real>();
        if cosine > STRAIGHT {
            return 0.0;
        }
        if cosine < -STRAIGHT {
            return 1e38;
        }
        let change = [direction[0] - before[0], direction[1] - before[1], direction[2] - before[2]];
        let size = length_of(change);
        let acceleration = limited(self.accelerations(), change.map(|c| c / size));
        let half_sine = (0.5 * (1.0 - cosine)).sqrt();
        acceleration * self.settings.junction_deviation as Real * half_sine / (1.0 - half_sine)
    }

    /// Backwards from rest at the end of the last block, then forwards from the running one, the only one left unchanged.
    fn replan(&mut self) {
        let mut exit_squared = 0.0;
        for block in self.blocks.iter_mut().skip(1).rev() {
            exit_squared = block.greatest_entry_squared.min(exit_squared + 2.0 * block.acceleration * block.length);
            block.entry_squared = exit_squared;
        }
        for i in 1..self.blocks.len() {
            let before = self.blocks[i - 1];
            let reached = before.entry_squared + 2.0 * before.acceleration * before.length;
            self.blocks[i].entry_squared = self.blocks[i].entry_squared.min(reached);
        }
    }
}

/// The greatest value along a direction at which no axis exceeds its own limit.
fn limited(values: [Real; 3], direction: [Real; 3]) -> Real {
    (0..3).filter(|&i| direction[i] != 0.0).map(|i| (values[i] / direction[i]).abs()).fold(Real::INFINITY, Real::min)
}

fn length_of(v: [Real; 3]) -> Real {
    v.iter().map(|c| c * c).sum::<Real>().sqrt()
}
