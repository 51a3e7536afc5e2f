//! The speed of a controller with look-ahead at each corner, and the resulting time.
//!
//! ```text
//!   speed |    ______        corner^2 = a d s / (1 - s), s = sin(t/2), t the angle between the legs, d the junction deviation
//!         |   /      \   __  exit^2  <= entry^2 + 2 a length
//!         |  /        \_/  \ entry^2 <= the same backwards from rest at the end of the known blocks
//!         +--------------------> time
//! ```
//!
//! GRBL 1.1 (planner.c) knows the running block and those behind it in its buffer, which is full while a file is sent. When a
//! block starts, its exit speed is fixed by the blocks after it in the buffer, the last of which must end at rest. The driver of
//! the `AxiDraw` (`motion.py`) plans each pen-down path as a whole, with the same corner rule. For other machines no rule is
//! known; they are assumed to do the latter.
//!
//! GRBL executes its plan in segments of a hundredth of a second (stepper.c), each at one speed, and longer if a segment would
//! contain less than one step. This happens at a start from rest, which loses 1 to 8 ms if the ramp ends in the added time: see
//! [`Rules::slow_start`].

use crate::plot::profile::{Limits, Motion};

/// A position in millimetres: x, y, z.
pub(super) type Place = [f64; 3];

/// Number of blocks kept before those with final speeds are timed.
const KEPT: usize = 1 << 14;
/// Cosines above this in magnitude are a straight line or a reversal, as in GRBL.
const STRAIGHT: f64 = 0.999_999;
/// GRBL's minimum rate, mm/s.
const SLOWEST: f64 = 1.0 / 60.0;
/// Minimum steps in one of GRBL's segments.
const LEAST_STEPS: f64 = 1.25;

/// One straight move.
#[derive(Clone, Copy, Debug)]
struct Block {
    length: f64,
    acceleration: f64,
    /// Square of the programmed speed, limited for its direction.
    nominal: f64,
    /// Square of the maximum speed at its start.
    entry: f64,
    /// The shortest distance that the controller covers at one speed.
    least: f64,
    /// The slot to which its time is added.
    slot: usize,
}

impl Block {
    /// Maximum change of the squared speed over the block.
    fn gain(&self) -> f64 {
        2.0 * self.acceleration * self.length
    }
}

/// A controller: moves go in, seconds come out.
pub(super) struct LookAhead {
    rules: Rules,
    /// Moves since the last rest that are not yet timed.
    blocks: Vec<Block>,
    /// The speed at the start of the first of them.
    speed: f64,
    /// Its square.
    squared: f64,
    at: Place,
    direction: Place,
    seconds: Vec<f64>,
}

struct Rules {
    limits: Limits,
    acceleration: Limit,
    travel_acceleration: Limit,
    speed: Limit,
    deviation: f64,
    /// Number of blocks known after a corner when its speed is fixed.
    known: Option<usize>,
    steps_per_mm: Option<Place>,
    /// Duration of one segment at constant speed, in seconds.
    segment: Option<f64>,
}

impl LookAhead {
    /// A machine at rest at zero, with a number of slots in which times are summed.
    pub fn new(motion: &Motion, slots: usize) -> Self {
        let planner = &motion.planner;
        let acceleration = |all: f64| motion.axis_accelerations(all);
        let rules = Rules {
            limits: planner.limits,
            acceleration: Limit::new(acceleration(motion.acceleration)),
            travel_acceleration: Limit::new(acceleration(motion.travel_acceleration.unwrap_or(motion.acceleration))),
            speed: Limit::new(motion.axis_speeds()),
            deviation: motion.corner_deviation(),
            // One place stays free, and one holds the running block.
            known: planner.block_buffer.map(|places| places - 2),
            steps_per_mm: planner.steps_per_mm,
            segment: planner.segment_seconds,
        };
        Self { rules, blocks: Vec::new(), speed: 0.0, squared: 0.0, at: [0.0; 3], direction: [0.0; 3], seconds: vec![0.0; slots] }
    }

    /// Draws a straight line to a position given in the file, at a rate in mm/s; the time goes to a slot.
    pub fn line(&mut self, to: Place, rate: f64, slot: usize) {
        self.add(self.rules.in_steps(to, as_read), rate, self.rules.acceleration, slot);
    }

    /// Draws a chord of an arc to a position computed by the controller, which lies on no decimal grid.
    pub fn chord(&mut self, to: Place, rate: f64, slot: usize) {
        self.add(self.rules.in_steps(to, |place| place as f32), rate, self.rules.acceleration, slot);
    }

    /// Moves with the pen up.
    pub fn travel(&mut self, to: Place, rate: f64, slot: usize) {
        self.add(self.rules.in_steps(to, as_read), rate, self.rules.travel_acceleration, slot);
    }

    /// Adds a move to a position in whole steps.
    fn add(&mut self, to: Place, rate: f64, acceleration: Limit, slot: usize) {
        let leg = [to[0] - self.at[0], to[1] - self.at[1], to[2] - self.at[2]];
        let length = norm(leg);
        if length < 1e-9 {
            return;
        }
        let direction = leg.map(|v| v / length);
        let along = self.rules.along(acceleration, direction);
        let nominal = self.rules.rate(direction, rate).powi(2);
        let entry = match self.blocks.last() {
            Some(before) => self.rules.corner(self.direction, direction, acceleration).min(nominal).min(before.nominal),
            None => 0.0,
        };
        let least = self.rules.least_way(direction);
        self.blocks.push(Block { length, acceleration: along, nominal, entry, least, slot });
        (self.at, self.direction) = (to, direction);
        if let Some(known) = self.rules.known
            && self.blocks.len() >= KEPT
        {
            self.run(self.blocks.len() - known - 1);
        }
    }

    /// Finishes all moves and brings the machine to rest.
    pub fn rest(&mut self) {
        if self.rules.known.is_none() {
            let mut after = 0.0;
            for block in self.blocks.iter_mut().rev() {
                block.entry = block.entry.min(after + block.gain());
                after = block.entry;
            }
        }
        self.run(self.blocks.len());
    }

    /// Adds time in which nothing moves.
    pub fn wait(&mut self, seconds: f64, slot: usize) {
        self.seconds[slot] += seconds;
    }

    /// Seconds of each slot.
    pub fn seconds(&self) -> &[f64] {
        &self.seconds
    }

    /// Times the first `count` blocks.
    fn run(&mut self, count: usize) {
        for i in 0..count {
            let block = self.blocks[i];
            let behind = &self.blocks[i + 1..];
            let exit = match (behind.first(), self.rules.known) {
                (None, _) => 0.0,
                (Some(next), None) => next.entry,
                (Some(_), Some(known)) => braking(&behind[..known.min(behind.len())]),
            };
            let exit = exit.min(self.squared + block.gain());
            let exit_speed = exit.sqrt();
            self.seconds[block.slot] += trapezoid(&block, [self.squared, exit], [self.speed, exit_speed])
                + self.rules.slow_start(&block, [self.squared, exit], self.speed);
            (self.squared, self.speed) = (exit, exit_speed);
        }
        self.blocks.drain(..count);
    }
}

/// Square of the maximum speed at the start of these blocks from which every later limit, and rest at the end, can be met.
fn braking(blocks: &[Block]) -> f64 {
    let (mut limit, mut gained) = (f64::INFINITY, 0.0);
    for block in blocks {
        limit = limit.min(block.entry + gained);
        if gained >= limit {
            return limit;
        }
        gained += block.gain();
    }
    limit.min(gained)
}

/// Time over a block, given the speeds at both ends and their squares.
fn trapezoid(block: &Block, [entry, exit]: [f64; 2], [from, to]: [f64; 2]) -> f64 {
    let a = block.acceleration;
    let peak = peak(block, [entry, exit]);
    let fastest = peak.sqrt();
    let level = (a * block.length - peak + 0.5 * (entry + exit)).max(0.0);
    (2.0 * fastest - from - to + level / fastest) / a
}

/// Square of the maximum speed on a block.
fn peak(block: &Block, [entry, exit]: [f64; 2]) -> f64 {
    (0.5 * (entry + exit) + block.acceleration * block.length).min(block.nominal).max(entry).max(exit)
}

impl Rules {
    /// The shortest distance that GRBL covers at one speed: `LEAST_STEPS` steps of the leading axis.
    fn least_way(&self, direction: Place) -> f64 {
        let Some(steps) = self.steps_per_mm.filter(|_| self.segment.is_some()) else { return 0.0 };
        LEAST_STEPS / (0..3).map(|axis| direction[axis].abs() * steps[axis]).fold(0.0, f64::max)
    }

    /// Time lost by a start from rest. If the first segment was lengthened because it would not contain a step, and the
    /// acceleration ends in the added time, GRBL computes the duration of this part from the segment's whole distance and the
    /// speed at the part's beginning, so the distance before is counted twice. The loss is 3.3 ms where 250 mm/s^2 end at 5 mm/s,
    /// with two or three starts per path; without it, the time of a plot of short lines is 0.3 to 0.7 % too short.
    fn slow_start(&self, block: &Block, squares: [f64; 2], from: f64) -> f64 {
        let Some(segment) = self.segment else { return 0.0 };
        let (a, fastest) = (block.acceleration, peak(block, squares).sqrt());
        let ramp = (fastest - from) / a;
        // Only at the lowest speeds is the first segment too short.
        if ramp <= segment || segment * (from + 0.5 * a * segment) >= block.least {
            return 0.0;
        }
        let before = ((ramp / segment).ceil() - 1.0) * segment;
        let way = before * (from + 0.5 * a * before);
        if way >= block.least { 0.0 } else { 2.0 * way / (from + a * before + fastest) }
    }

    /// Rounds a position to motor steps as the controller does, from the single precision in which it is held.
    fn in_steps(&self, place: Place, held: fn(f64) -> f32) -> Place {
        let Some(steps) = self.steps_per_mm else { return place };
        let rounded = |axis: usize| whole(f64::from(held(place[axis]) * steps[axis] as f32)) as f64 / steps[axis];
        [rounded(0), rounded(1), rounded(2)]
    }

    /// The limit along a direction.
    fn along(&self, limit: Limit, direction: Place) -> f64 {
        match self.limits {
            Limits::Path => limit.path,
            Limits::Axis => limit.along(direction),
        }
    }

    fn rate(&self, direction: Place, asked: f64) -> f64 {
        match self.limits {
            Limits::Path => asked,
            Limits::Axis => asked.min(self.speed.along(direction)).max(SLOWEST),
        }
    }

    /// Square of the maximum speed at a corner.
    fn corner(&self, before: Place, after: Place, acceleration: Limit) -> f64 {
        let cosine = -(before[0] * after[0] + before[1] * after[1] + before[2] * after[2]);
        if cosine > STRAIGHT {
            return 0.0;
        }
        if cosine < -STRAIGHT {
            return f64::INFINITY;
        }
        let length = (2.0 * (1.0 + cosine)).sqrt();
        let turn = [after[0] - before[0], after[1] - before[1], after[2] - before[2]];
        let inwards = self.along(acceleration, turn.map(|v| v / length));
        let half_sine = (0.5 * (1.0 - cosine)).sqrt();
        inwards * self.deviation * half_sine / (1.0 - half_sine)
    }
}

/// A speed or an acceleration, along the path and of each axis.
#[derive(Clone, Copy)]
struct Limit {
    path: f64,
    reciprocals: Place,
}

impl Limit {
    fn new(axes: Place) -> Self {
        Self { path: axes[0], reciprocals: axes.map(f64::recip) }
    }

    /// The greatest length along a unit vector at which no component exceeds its axis's value.
    fn along(&self, direction: Place) -> f64 {
        let share = |axis: usize| direction[axis].abs() * self.reciprocals[axis];
        1.0 / share(0).max(share(1)).max(share(2))
    }
}

/// A coordinate as GRBL holds it in single precision after reading up to three decimals: the digits as an integer, times 0.01 and
/// 0.1. At 100 steps per millimetre every tenth coordinate lies half way between two steps, and this decides how it is rounded:
/// without it, circles of 0.02 mm chords are timed 1.3 % short.
fn as_read(place: f64) -> f32 {
    let digits = whole(place * 1000.0);
    if digits == 0 {
        0.0
    } else if digits % 10 != 0 {
        digits as f32 * 0.01 * 0.1
    } else if digits % 100 != 0 {
        (digits / 10) as f32 * 0.01
    } else if digits % 1000 != 0 {
        (digits / 100) as f32 * 0.1
    } else {
        (digits / 1000) as f32
    }
}

/// The nearest integer, halves away from zero. `round` would be a library call, and this runs for each point.
pub(super) fn whole(value: f64) -> i64 {
    (value + 0.5_f64.copysign(value)) as i64
}

fn norm(v: Place) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

#[cfg(test)]
mod tests;
