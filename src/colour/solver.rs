//! The coverages that come nearest to a look.

use super::eye::{Aim, Eye};
use super::neugebauer::Model;
use super::pens::MOST_PENS;

/// Coverages of all pens; those of missing pens are 0.
pub(super) type Coverages = [f32; MOST_PENS];

/// Finds coverages within their bounds. Minimised are half the square of the visible difference, ink at its price, and a little of
/// the coverages' squares, which makes the best coverages a continuous function of the look.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solver<'a> {
    pub model: &'a Model,
    pub eye: &'a Eye,
    /// Most coverage of each pen: 0 for a pen that is not used.
    pub most: Coverages,
    /// Most coverage of all pens together.
    pub limit: f32,
    /// Weight of the coverages' squares.
    pub ridge: f32,
}

/// One problem.
#[derive(Clone, Copy, Debug)]
pub(super) struct Problem<'a> {
    pub aim: &'a Aim,
    /// Price of each pen's full coverage, in halves of squared differences.
    pub prices: &'a Coverages,
    pub start: &'a Coverages,
    /// Weight of squared distances from the start.
    pub hold: f32,
}

/// Coverages and how they do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solution {
    pub coverages: Coverages,
    /// What was minimised.
    pub cost: f32,
}

struct State {
    cost: f32,
    gradient: Coverages,
    curvature: [Coverages; MOST_PENS],
}

/// Most Newton steps, most sweeps over one step's quadratic problem, and the change below which coverages stand.
const MOST_STEPS: usize = 24;
const MOST_SWEEPS: usize = 40;
const STANDS: f32 = 3e-4;

impl Solver<'_> {
    /// Downhill from the start, by Gauss-Newton steps within the bounds.
    pub fn solve(&self, problem: Problem<'_>) -> Solution {
        /// Levenberg's damping at the start; a step that helps lowers it, one that does not raises it, up to a bound.
        const DAMPING: f32 = 0.5;
        const LOWERED: f32 = 0.2;
        const RAISED: f32 = 10.0;
        const MOST_DAMPING: f32 = 1e6;
        let pens = self.model.pens();
        let mut at: Coverages = std::array::from_fn(|i| problem.start[i].clamp(0.0, self.most[i]));
        let mut state = self.state(problem, &at);
        let mut damping = DAMPING;
        for _ in 0..MOST_STEPS {
            let next = self.step(&state, &at, damping);
            let moved = (0..pens).map(|i| (next[i] - at[i]).abs()).fold(0.0, f32::max);
            if moved < STANDS {
                break;
            }
            let tried = self.state(problem, &next);
            if tried.cost < state.cost {
                (at, state) = (next, tried);
                damping *= LOWERED;
            } else {
                damping *= RAISED;
                if damping > MOST_DAMPING {
                    break;
                }
            }
        }
        let sum: f32 = at[..pens].iter().sum();
        if sum > self.limit {
            at.iter_mut().for_each(|c| *c *= self.limit / sum);
        }
        Solution { coverages: at, cost: state.cost }
    }

    fn state(&self, problem: Problem<'_>, at: &Coverages) -> State {
        /// Weight of the square of ink above the limit.
        const EXCESS: f32 = 4000.0;
        let pens = self.model.pens();
        let tint = self.model.tint(&at[..pens]);
        let (look, slopes) = self.eye.look_and_slopes(&tint, pens);
        let off = problem.aim.miss(look);
        let square = dot(off, off);
        let excess = (at[..pens].iter().sum::<f32>() - self.limit).max(0.0);
        let mut state = State {
            cost: 0.5 * (square + EXCESS * excess * excess),
            gradient: [0.0; MOST_PENS],
            curvature: [[0.0; MOST_PENS]; MOST_PENS],
        };
        let rises = slopes.map(|slope| problem.aim.weighted(slope));
        let over = if excess > 0.0 { EXCESS } else { 0.0 };
        for i in 0..pens {
            let held = at[i] - problem.start[i];
            state.cost += problem.prices[i] * at[i] + 0.5 * (self.ridge * at[i] * at[i] + problem.hold * held * held);
            state.gradient[i] = dot(rises[i], off) + problem.prices[i] + self.ridge * at[i] + problem.hold * held + over * excess;
            for j in 0..=i {
                state.curvature[i][j] = dot(rises[i], rises[j]) + over;
                state.curvature[j][i] = state.curvature[i][j];
            }
            state.curvature[i][i] += self.ridge + problem.hold;
        }
        state
    }

    /// The least of the quadratic model within the bounds, one coverage after another.
    fn step(&self, state: &State, at: &Coverages, damping: f32) -> Coverages {
        let pens = self.model.pens();
        let mut next = *at;
        let mut gradient = state.gradient;
        for _ in 0..MOST_SWEEPS {
            let mut most = 0.0f32;
            for i in 0..pens {
                let to = (next[i] - gradient[i] / (state.curvature[i][i] + damping)).clamp(0.0, self.most[i]);
                let by = to - next[i];
                if by != 0.0 {
                    next[i] = to;
                    (0..MOST_PENS).for_each(|j| gradient[j] += by * state.curvature[i][j]);
                    gradient[i] += by * damping;
                    most = most.max(by.abs());
                }
            }
            if most < 0.3 * STANDS {
                break;
            }
        }
        next
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
