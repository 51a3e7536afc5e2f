//! The exact place of a round mark that is nearly known.

use super::picture::Probe;
use super::view::View;
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2};

/// Distance of samples around a mark, in cells.
const STEP: f64 = 0.02;
/// Least contrast of a mark: difference of paper and ink over paper.
pub(super) const LEAST_CONTRAST: f64 = 0.2;

/// What a grey value is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grey {
    /// The darkest channel instead of luminance.
    pub darkest: bool,
}

impl Grey {
    pub(super) fn of(self, [r, g, b]: [f32; 3]) -> f64 {
        f64::from(if self.darkest { r.min(g).min(b) } else { 0.2126 * r + 0.7152 * g + 0.0722 * b })
    }
}

/// Width of the bare ring around a mark, and the gap that blur may fill, in cells.
const BARE: f64 = 0.045;
const SOFT: f64 = 0.03;

/// A round mark: where it is inked.
#[derive(Clone, Debug)]
pub(super) struct Stamp {
    radius: f64,
    /// Samples of ink and of bare paper, in steps from the centre.
    ink: Vec<[i32; 2]>,
    bare: Vec<[i32; 2]>,
}

impl Stamp {
    /// A mark inked from `inner` (0 for a disc) to `radius`, in cells.
    pub(super) fn new(inner: f64, radius: f64) -> Self {
        let soft = if inner > 0.0 { SOFT } else { 0.0 };
        let ink = between(inner + soft, radius - SOFT);
        Self { radius, ink, bare: between(radius + SOFT, radius + SOFT + BARE) }
    }

    /// The centre of the mark nearest to a point of the sheet; it may lie off by `reach` cells. `None` if there is nothing dark in bare paper.
    pub(super) fn seek(&self, view: &View, probe: &Probe<'_>, grey: Grey, at: Point, reach: f64) -> Option<Point> {
        /// Rounds towards the centre of the ink.
        const ROUNDS: usize = 4;
        /// Part of the contrast below which darkness does not count as ink: noise and light.
        const FAINT: f64 = 0.15;
        let shifts = (reach / STEP).round() as i32;
        let half = shifts + ((self.radius + SOFT + BARE) / STEP).ceil() as i32;
        let place = |i: i32, j: i32| at + STEP * Vec2::new(f64::from(i), f64::from(j));
        let side = 2 * half + 1;
        let values: Vec<f64> =
            (0..side * side).map(|k| grey.of(probe.at(view.at(place(k % side - half, k / side - half))))).collect();
        let value = |i: i32, j: i32| values[((j + half) * side + i + half) as usize];
        let mut best = (LEAST_CONTRAST, None);
        for dy in -shifts..=shifts {
            for dx in -shifts..=shifts {
                // A few samples may be noise or dust.
                let darkest_ink = ranked(self.ink.iter().map(|[i, j]| value(i + dx, j + dy)), 0.8);
                let bare = ranked(self.bare.iter().map(|[i, j]| value(i + dx, j + dy)), 0.2);
                let contrast = (bare - darkest_ink) / bare.max(1e-6);
                if contrast > best.0 {
                    best = (contrast, Some((Vec2::new(f64::from(dx), f64::from(dy)), bare)));
                }
            }
        }
        let (start, bare) = best.1?;
        let mut centre = start;
        for _ in 0..ROUNDS {
            let darkness = |i, j| ((bare - value(i, j)) / (best.0 * bare) - FAINT).clamp(0.0, 1.0 - FAINT);
            centre += drift(centre, (self.radius + SOFT) / STEP, half, darkness);
        }
        ((centre - start).hypot() < 5.0).then(|| at + STEP * centre)
    }
}

/// Steps from a centre to the samples between two radii in cells.
fn between(from: f64, to: f64) -> Vec<[i32; 2]> {
    let most = (to / STEP).ceil() as i32;
    let all = (-most..=most).flat_map(|j| (-most..=most).map(move |i| [i, j]));
    all.filter(|[i, j]| (from - 1e-9..=to + 1e-9).contains(&(STEP * f64::from(*i).hypotenuse(f64::from(*j))))).collect()
}

/// The value below which a share of the values lies.
fn ranked(values: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let rank = (share * values.len().saturating_sub(1) as f64).round() as usize;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(rank, f64::total_cmp).1 }
}

/// From a point to the centre of the darkness around it, in steps.
fn drift(around: Vec2, radius: f64, half: i32, darkness: impl Fn(i32, i32) -> f64) -> Vec2 {
    let (mut sum, mut moment) = (0.0, Vec2::ZERO);
    for j in -half..=half {
        for i in -half..=half {
            let d = Vec2::new(f64::from(i), f64::from(j)) - around;
            if d.hypot() <= radius {
                let weight = darkness(i, j);
                sum += weight;
                moment += weight * d;
            }
        }
    }
    if sum > 0.0 { moment / sum } else { Vec2::ZERO }
}
