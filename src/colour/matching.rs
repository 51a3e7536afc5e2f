//! The coverages that match a colour best, and the prices that they pay.

use super::bands::xyz_of;
use super::eye::{Aim, Eye, Oklab};
use super::neugebauer::Model;
use super::overprints::overprints;
use super::pens::{MOST_PENS, PenSet};
use super::rendering::Rendering;
use super::settings::Settings;
use super::solver::{Coverages, Problem, Solution, Solver};
use super::table::Problems;

/// Out of gamut, differences in chroma count less and those in hue more, so that colours go towards the grey of their lightness.
const CHROMA: f32 = 0.8;
const HUE: f32 = 3.0;
/// Weight of squared coverages, and of squared distances from what neighbouring colours use.
const RIDGE: f32 = 1.0;
const HOLD: f32 = 20.0;

/// What the eye sees of the paper and of each ink alone.
#[derive(Clone, Debug)]
struct Inks {
    eye: Eye,
    white: [f64; 3],
    paper: Oklab,
    looks: Vec<Oklab>,
}

impl Inks {
    fn new(set: &PenSet) -> Self {
        let colours = overprints(set);
        let alone = (0..set.pens().len()).map(|i| &colours[1 << i]);
        let white = alone.clone().fold(&colours[0], |white, ink| if xyz_of(ink)[1] > xyz_of(white)[1] { ink } else { white });
        let eye = Eye::adapted_to(white);
        Self { white: xyz_of(white), paper: eye.look(&colours[0]), looks: alone.map(|ink| eye.look(ink)).collect(), eye }
    }
}

/// The darkest look that ink reaches.
fn darkest(solver: &Solver<'_>) -> Oklab {
    let aim = Aim::new([0.0; 3], 1.0, 1.0);
    let found = best_of_starts(solver, &aim, &[0.0; MOST_PENS]);
    solver.eye.look(&solver.model.tint(&found.coverages[..solver.model.pens()]).value)
}

/// The best from several starts: nearly bare paper, each pen alone, and some of all.
fn best_of_starts(solver: &Solver<'_>, aim: &Aim, prices: &Coverages) -> Solution {
    let pens = solver.model.pens();
    let start = |alone: usize| -> Coverages {
        std::array::from_fn(|i| match i {
            _ if alone == pens => 0.05,
            _ if alone > pens => 0.4,
            _ if i == alone => 0.6,
            _ => 0.05,
        })
    };
    let solve = |start: &Coverages| solver.solve(Problem { aim, prices, start, hold: 0.0 });
    let mut best = solve(&start(pens));
    for other in (0..pens).chain([pens + 1]) {
        let found = solve(&start(other));
        if found.cost < best.cost {
            best = found;
        }
    }
    best
}

/// For a simplified drawing, the price of using a pen at all, and the coverage at which half of it is paid.
const SIMPLE: f32 = 30.0;
const FEW: f32 = 0.1;

/// Coverages for a colour: those whose look is nearest to what the colour becomes on paper, by little ink in few pens.
#[derive(Clone, Debug)]
pub(super) struct Matching {
    model: Model,
    inks: Inks,
    most: Coverages,
    limit: f32,
    rendering: Rendering,
    simple: f32,
}

impl Matching {
    pub fn new(set: &PenSet, settings: &Settings) -> Self {
        let (model, inks, most, limit) = (settings.model(set), Inks::new(set), settings.most(set), settings.ink_limit);
        let darkest = darkest(&Solver { model: &model, eye: &inks.eye, most, limit, ridge: RIDGE });
        let rendering = Rendering::new(darkest, inks.paper);
        Self { model, inks, most, limit, rendering, simple: SIMPLE * settings.simplify.clamp(0.0, 1.0) }
    }

    /// The model of these pens on this paper.
    pub const fn model(&self) -> &Model {
        &self.model
    }

    /// XYZ of what is taken for white: the paper, or a covering ink lighter than the paper.
    pub const fn white(&self) -> [f64; 3] {
        self.inks.white
    }

    /// The coverages nearest to a look.
    pub fn nearest(&self, look: Oklab) -> Solution {
        let aim = Aim::new(look, CHROMA, HUE);
        best_of_starts(&self.solver_for(look), &aim, &self.prices(look, &[1.0; MOST_PENS]))
    }

    /// A white pen heightens: no tone that is darker than toned paper has ink lighter than that, whose dots would glare in the dark.
    fn solver_for(&self, look: Oklab) -> Solver<'_> {
        /// How much lighter than toned paper, in Oklab, a tone is that a light ink may cover wholly.
        const HEIGHTENED: f32 = 0.05;
        let lightness = self.inks.paper[0];
        let share = ((look[0] - lightness) / HEIGHTENED).clamp(0.0, 1.0);
        let mut most = self.most;
        for (most, _) in most.iter_mut().zip(&self.inks.looks).filter(|(_, ink)| ink[0] > lightness) {
            *most = most.min(share);
        }
        Solver { model: &self.model, eye: &self.inks.eye, most, limit: self.limit, ridge: RIDGE }
    }

    /// The price of using a pen is a concave function of its coverage; its slope is taken where the coverages are now (reweighting
    /// of Candes, Wakin and Boyd 2008), so that pens in use become cheap and others stay dear.
    fn prices(&self, look: Oklab, now: &Coverages) -> Coverages {
        /// Price of full coverage, in halves of squared visible differences: of any ink, and more by the square of the difference
        /// in lightness between ink and colour (dark dots in light tones are seen as grain).
        const INK: f32 = 1.0;
        const GRAIN: f32 = 8.0;
        /// The same for the difference in hue and chroma: pale greys of cyan, magenta and yellow dots are seen as confetti. Tuned
        /// on four samples in four and eight pens: at 0 they are, at 60 skin has black freckles.
        const CONFETTI: f32 = 20.0;
        let mut prices = [0.0; MOST_PENS];
        for ((price, ink), c) in prices.iter_mut().zip(&self.inks.looks).zip(now) {
            let contrast = ink[0] - look[0];
            let [a, b] = [ink[1] - look[1], ink[2] - look[2]];
            *price = INK + GRAIN * contrast * contrast + CONFETTI * (a * a + b * b) + self.simple * FEW / ((c + FEW) * (c + FEW));
        }
        prices
    }
}

impl Problems for Matching {
    fn first(&self, light: [f32; 3]) -> Coverages {
        /// Rounds in which prices at the coarsest level follow the coverages.
        const ROUNDS: usize = 3;
        let look = self.rendering.look(light);
        let aim = Aim::new(look, CHROMA, HUE);
        let solver = self.solver_for(look);
        let mut found = self.nearest(look).coverages;
        for _ in 0..if self.simple > 0.0 { ROUNDS } else { 0 } {
            found = solver.solve(Problem { aim: &aim, prices: &self.prices(look, &found), start: &found, hold: 0.0 }).coverages;
        }
        found
    }

    fn near(&self, light: [f32; 3], suggested: &Coverages) -> Coverages {
        let look = self.rendering.look(light);
        let (aim, prices) = (Aim::new(look, CHROMA, HUE), self.prices(look, suggested));
        self.solver_for(look).solve(Problem { aim: &aim, prices: &prices, start: suggested, hold: HOLD }).coverages
    }
}
