//! Strokes along an orientation field that cover a region evenly and make its tone (Wong 1999, sections 6.3.3 and 8).
//!
//! The thesis starts its strokes at random places and relies on their number. Here each stroke starts where ink is still missing, and
//! its ink is subtracted from the target around it: the cover is even, and denser where darker.

use super::orientation::OrientationField;
use crate::elementary::{Elementary as _, unit_at};
use crate::geometry::{Point, Vec2};
use crate::raster::Raster;
use rand::{Rng, RngExt};

/// Parameters of a covering; lengths in working pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covering {
    /// Width of a stroke.
    pub width: f64,
    /// Mean length of a stroke, along its centre line.
    pub length: f64,
    /// Variation of the lengths, as a fraction.
    pub length_spread: f64,
    /// Maximum angle between a stroke and the field, in radians; each stroke has its own angle (thesis: pi/12).
    pub turn: f64,
    /// Radius over which ink is averaged: about the distance between neighbouring strokes.
    pub reach: f64,
}

/// Length of a step along the field in pixels.
const STEP: f64 = 1.5;

/// Missing ink that a stroke's start requires, in passes of a stroke. A stroke continues while half a pass is missing, so that its ink
/// is as often too much as too little; starting at half a pass, too, made everything a quarter too dark.
const START: f32 = 0.7;
/// Strokes shorter than this many widths are specks and are left out.
const LEAST_WIDTHS: f64 = 4.0;

/// Strokes inside the region (at least 0.5) whose ink adds up to `ink` (0 to 1), in drawing order.
///
/// `looseness` is the share of the covering's turn at a stroke's start.
///
/// Starting places are tried in random order, one per square of a stroke's width. Time grows with the region's area and with the total
/// length of strokes times `reach` squared.
pub fn cover(
    field: &OrientationField,
    region: &Raster<f32>,
    ink: &Raster<f32>,
    covering: Covering,
    looseness: impl Fn(Point) -> f64,
    random: &mut impl Rng,
) -> Vec<Vec<Point>> {
    let mut bed = MissingInk { wanted: ink.clone(), splat: splat(covering), reach: splat_reach(covering) };
    let mut strokes = Vec::new();
    for start in starts(region, covering.width.max(1.5), random) {
        let turn = if covering.turn > 0.0 { random.random_range(-covering.turn..covering.turn) * looseness(start) } else { 0.0 };
        let spread = covering.length_spread.clamp(0.0, 0.99);
        let length = covering.length * if spread > 0.0 { random.random_range(1.0 - spread..1.0 + spread) } else { 1.0 };
        if bed.left(start) < START * bed.of_one_pass() {
            continue;
        }
        let run = Run { field, region, turn, length: 0.5 * length };
        let mut stroke = run.follow(&bed, start, -1.0);
        stroke.reverse();
        stroke.push(start);
        stroke.extend(run.follow(&bed, start, 1.0));
        if (stroke.len() - 1) as f64 * STEP >= LEAST_WIDTHS * covering.width {
            for p in &stroke {
                bed.lay(*p);
            }
            strokes.push(stroke);
        }
    }
    strokes
}

/// A place in each square of the region, in random order.
fn starts(region: &Raster<f32>, square: f64, random: &mut impl Rng) -> Vec<Point> {
    let mut starts = Vec::new();
    let (columns, rows) = ((region.width() as f64 / square) as usize + 1, (region.height() as f64 / square) as usize + 1);
    for (column, row) in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
        let mut within = |i: usize| (i as f64 + random.random_range(0.0..1.0)) * square;
        let p = Point::new(within(column), within(row));
        let inside = p.x < region.width() as f64 && p.y < region.height() as f64;
        if inside && region.sample(p.x, p.y) >= 0.5 {
            starts.push(p);
        }
    }
    for i in (1..starts.len()).rev() {
        let j = random.random_range(0..=i);
        starts.swap(i, j);
    }
    starts
}

/// The ink that is still missing.
struct MissingInk {
    wanted: Raster<f32>,
    /// Ink that a step of a stroke removes from each pixel of the square around it.
    splat: Vec<f32>,
    reach: isize,
}

fn splat_reach(covering: Covering) -> isize {
    (2.5 * covering.reach).ceil().clamp(1.0, 60.0) as isize
}

/// A Gaussian with the ink of one step.
fn splat(covering: Covering) -> Vec<f32> {
    let reach = splat_reach(covering);
    let weight = |dx: isize, dy: isize| (-0.5 * ((dx * dx + dy * dy) as f64) / covering.reach.max(0.3).powi(2)).exponential();
    let weights: Vec<f64> = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| weight(dx, dy))).collect();
    let total: f64 = weights.iter().sum();
    weights.into_iter().map(|w| (w / total * covering.width * STEP) as f32).collect()
}

impl MissingInk {
    fn left(&self, p: Point) -> f32 {
        self.wanted.sample(p.x, p.y)
    }

    /// Ink that one straight stroke removes along its own line.
    fn of_one_pass(&self) -> f32 {
        let side = 2 * self.reach as usize + 1;
        let middle: f32 = self.splat[side * self.reach as usize..side * (self.reach as usize + 1)].iter().sum();
        middle / STEP as f32
    }

    fn lay(&mut self, p: Point) {
        let (width, height) = (self.wanted.width() as isize, self.wanted.height() as isize);
        let (left, upper) = (p.x.floor() as isize - self.reach, p.y.floor() as isize - self.reach);
        let side = 2 * self.reach + 1;
        // The columns of the square that lie on the raster.
        let (from, to) = ((-left).max(0), (width - left).min(side));
        if from >= to {
            return;
        }
        for row in (-upper).max(0)..(height - upper).min(side) {
            let start = ((upper + row) * width + left + from) as usize;
            let wanted = &mut self.wanted.pixels_mut()[start..start + (to - from) as usize];
            let taken = &self.splat[(row * side + from) as usize..(row * side + to) as usize];
            for (wanted, taken) in wanted.iter_mut().zip(taken) {
                *wanted -= taken;
            }
        }
    }
}

/// Tracing of one stroke.
struct Run<'a> {
    field: &'a OrientationField,
    region: &'a Raster<f32>,
    turn: f64,
    length: f64,
}

impl Run<'_> {
    /// Points from a start (not included) in one direction until the length is used up, the region ends, the field ends or turns back,
    /// or no ink is missing.
    fn follow(&self, bed: &MissingInk, start: Point, sign: f64) -> Vec<Point> {
        /// Share of half its length that a stroke may continue over places that already have their ink; a hand does not stop at
        /// each crossing.
        const OVERDRAWN: f64 = 0.15;
        let mut points = Vec::new();
        let Some(first) = self.direction(start) else { return points };
        let (mut here, mut heading) = (start, first * sign);
        let mut overdrawn = 0.0;
        for _ in 0..(self.length / STEP) as usize {
            let ahead = here + heading * (0.5 * STEP);
            let Some(axis) = self.direction(ahead) else { break };
            let next_heading = if axis.dot(heading) < 0.0 { -axis } else { axis };
            let next = here + next_heading * STEP;
            let is_inside = next.x >= 0.0
                && next.y >= 0.0
                && next.x < self.region.width() as f64
                && next.y < self.region.height() as f64
                && self.region.sample(next.x, next.y) >= 0.5;
            overdrawn = if bed.left(next) < 0.5 * bed.of_one_pass() { overdrawn + STEP } else { 0.0 };
            if !is_inside || next_heading.dot(heading) < 0.5 || overdrawn > OVERDRAWN * self.length {
                overdrawn = if overdrawn > 0.0 { overdrawn - STEP } else { 0.0 };
                break;
            }
            points.push(next);
            (here, heading) = (next, next_heading);
        }
        // Removes the overdrawn end.
        points.truncate(points.len() - (overdrawn / STEP) as usize);
        points
    }

    fn direction(&self, p: Point) -> Option<Vec2> {
        self.field.angle(p.x, p.y).map(|angle| unit_at(angle + self.turn))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand::rngs::ChaCha8Rng;

    #[test]
    fn ink_follows_the_tone_and_stays_in_the_region() {
        let field = OrientationField::new(Raster::filled(300, 200, [1.0, 0.0]));
        let region = Raster::from_fn(300, 200, |_, y| f32::from(u8::from((20..180).contains(&y))));
        let ink = Raster::from_fn(300, 200, |x, _| if x < 150 { 0.3 } else { 0.6 });
        let covering = Covering { width: 2.0, length: 40.0, length_spread: 0.5, turn: 0.2, reach: 4.0 };
        let strokes = cover(&field, &region, &ink, covering, |_| 1.0, &mut ChaCha8Rng::seed_from_u64(1));
        let mut laid = [0.0, 0.0];
        for p in strokes.iter().flatten() {
            assert!((20.0..=180.0).contains(&p.y), "{p:?}");
            laid[usize::from(p.x >= 150.0)] += 2.0 * STEP / (150.0 * 160.0);
        }
        assert!((laid[0] / 0.3 - 1.0).abs() < 0.15 && (laid[1] / 0.6 - 1.0).abs() < 0.15, "{laid:?}");
    }
}
