//! Measured ink of lines, and the spacing that gives each tone its ink.

use crate::elementary::Elementary as _;
use crate::geometry::{Point, distance_to_segment};
use crate::raster::{Raster, fast_gaussian};

/// Number of tones for which the spacing is found separately.
const TONES: usize = 20;

/// Sub-pixels per line width: finer changes the measured ink by less than 0.002.
const FINE: f64 = 6.0;

/// Share of each pixel that lines of this width (in pixels) with round ends cover.
pub(super) fn coverage(lines: &[Vec<Point>], width: f64, like: &Raster<f32>) -> Raster<f32> {
    let scale = (FINE / width).ceil().max(1.0);
    let side = scale as usize;
    let mut fine = Raster::filled(like.width() * side, like.height() * side, false);
    let radius = 0.5 * width * scale;
    for pair in lines.iter().flat_map(|line| line.windows(2)) {
        let [a, b] = [pair[0], pair[1]].map(|p| Point::new(p.x * scale, p.y * scale));
        let range = |low: f64, high: f64, most: usize| {
            (low - radius).floor().max(0.0) as usize..((high + radius).ceil().max(0.0) as usize).min(most)
        };
        for y in range(a.y.min(b.y), a.y.max(b.y), fine.height()) {
            for x in range(a.x.min(b.x), a.x.max(b.x), fine.width()) {
                if distance_to_segment(Point::new(x as f64 + 0.5, y as f64 + 0.5), a, b) <= radius {
                    fine.set(x, y, true);
                }
            }
        }
    }
    let share = 1.0 / (side * side) as f32;
    Raster::from_fn(like.width(), like.height(), |x, y| {
        let row = |dy: usize| &fine.row(y * side + dy)[x * side..(x + 1) * side];
        (0..side).map(|dy| row(dy).iter().filter(|v| **v).count()).sum::<usize>() as f32 * share
    })
}

/// Correction of the line spacing: a factor on `width / ink`, by ink.
pub(super) struct Calibration {
    factors: [f32; TONES + 1],
    /// For each tone, the logarithms of the tried factors and of the resulting ink.
    tried: [Vec<(f64, f64)>; TONES + 1],
}

impl Default for Calibration {
    fn default() -> Self {
        Self { factors: [0.9; TONES + 1], tried: [const { Vec::new() }; TONES + 1] }
    }
}

impl Calibration {
    /// Distance of neighbouring lines in pixels; infinite where hardly any ink is needed.
    pub(super) fn spacing(&self, ink: &Raster<f32>, width: f32) -> Raster<f32> {
        ink.map(|ink| if ink < 0.01 { f32::INFINITY } else { self.factor(ink) * width / ink })
    }

    fn factor(&self, ink: f32) -> f32 {
        let at = ink.clamp(0.0, 1.0) * TONES as f32;
        let i = (at as usize).min(TONES - 1);
        self.factors[i] + (self.factors[i + 1] - self.factors[i]) * (at - i as f32)
    }

    /// Corrects the factors by the ink drawn for each tone.
    pub(super) fn learn(&mut self, ink: &Raster<f32>, laid: &Raster<f32>) {
        /// Minimum number of a tone's pixels for it to be corrected.
        const LEAST_PIXELS: f64 = 200.0;
        /// Maximum change of a factor's logarithm per round.
        const MOST_STEP: f64 = 0.4;
        /// Blur of the ink before it is sorted by tone, in pixels: the tones at the foot of an edge differ from those of the
        /// lines there.
        const BLUR: f32 = 2.0;
        let (ink, laid) = (fast_gaussian(ink, BLUR), fast_gaussian(laid, BLUR));
        let mut sums = [[0.0_f64; 3]; TONES + 1];
        for (&wanted, &laid) in ink.pixels().iter().zip(laid.pixels()) {
            let at = wanted.clamp(0.0, 1.0) * TONES as f32;
            let i = (at as usize).min(TONES - 1);
            let t = f64::from(at - i as f32);
            for (slot, share) in [(i, 1.0 - t), (i + 1, t)] {
                sums[slot][0] += share;
                sums[slot][1] += share * f64::from(wanted);
                sums[slot][2] += share * f64::from(laid);
            }
        }
        for ((factor, tried), [count, wanted, laid]) in self.factors.iter_mut().zip(&mut self.tried).zip(sums) {
            if count < LEAST_PIXELS || wanted <= 0.0 {
                continue;
            }
            // Close lines cover like 1 - exp(-1 / spacing), so the uncovered part is compared.
            let depth = |ink: f64| (-(1.0 - (ink / count).clamp(0.002, 0.99)).logarithm()).logarithm();
            tried.push((f64::from(*factor).logarithm(), depth(laid)));
            let (middle, slope) = trend(tried);
            let wanted = middle.0 + (depth(wanted) - middle.1) / slope;
            *factor = wanted
                .clamp(f64::from(factor.logarithm()) - MOST_STEP, f64::from(factor.logarithm()) + MOST_STEP)
                .exponential()
                .clamp(0.3, 2.5) as f32;
        }
    }
}

/// Weight of each try relative to the next one: the first tries are far from the tone.
const FORGETTING: f64 = 0.6;
/// Minimum variance of the tried factors' logarithms for a slope to be fitted.
const LEAST_SPREAD: f64 = 1e-3;

/// Weighted mean of all tries and the slope through them; ink falls about in proportion as the factor grows. At the same factor the ink
/// of two drawings differs by up to 0.03, so the last try alone is a poor guide.
fn trend(tried: &[(f64, f64)]) -> ((f64, f64), f64) {
    let weight = |i: usize| FORGETTING.powi((tried.len() - 1 - i) as i32);
    let mean = |value: &dyn Fn(&(f64, f64)) -> f64| {
        let sums = tried.iter().enumerate().fold((0.0, 0.0), |sum, (i, t)| (sum.0 + weight(i) * value(t), sum.1 + weight(i)));
        sums.0 / sums.1
    };
    let middle = (mean(&|t| t.0), mean(&|t| t.1));
    let spread = mean(&|t| (t.0 - middle.0).powi(2));
    let slope = mean(&|t| (t.0 - middle.0) * (t.1 - middle.1)) / spread;
    (middle, if spread > LEAST_SPREAD { slope.clamp(-3.0, -0.7) } else { -1.0 })
}
