//! Separation of a photograph into pens.

use super::bands::xyz_of;
use super::eye::{Aim, Eye, Oklab};
use super::neugebauer::{Model, yule_nielsen};
use super::overlap::Overlap;
use super::overprints::overprints;
use super::pens::{MOST_PENS, PenSet};
use super::rendering::Rendering;
use super::solver::{Coverages, Problem, Solution, Solver};
use super::space::Lab;
use super::table::{Place, Problems, Table, of_nodes};
use crate::parallel;
use crate::raster::Raster;
use thiserror::Error;

/// Out of gamut, differences in chroma count less and those in hue more, so that colours go towards the grey of their lightness.
const CHROMA: f32 = 0.8;
const HUE: f32 = 3.0;
/// Weight of squared coverages, and of squared distances from what neighbouring colours use.
pub(super) const RIDGE: f32 = 1.0;
const HOLD: f32 = 20.0;

/// What the black pen does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Black {
    /// It draws tones where it serves.
    #[default]
    Tones,
    /// It is kept for lines: no tones.
    Lines,
    /// It is not used at all.
    None,
}

/// How a photograph is separated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How marks of different pens will lie to one another.
    pub overlap: Overlap,
    /// Yule-Nielsen exponent, 1 to 10; `None` for that of marks of the pens' mean width.
    pub n: Option<f64>,
    /// Most coverage of all pens together, from 0.5: 2.4 for drawing paper, less for paper that buckles or pills.
    pub ink_limit: f32,
    /// What the black pen does.
    pub black: Black,
    /// 0 to 1: 0 for the nearest colours, 1 for few pens and little ink at some visible difference.
    pub simplify: f32,
}

impl Default for Settings {
    fn default() -> Self {
        Self { overlap: Overlap::round_dots(0.3, 0.18), n: None, ink_limit: 2.4, black: Black::Tones, simplify: 0.0 }
    }
}

impl Settings {
    pub(super) fn model(&self, set: &PenSet) -> Model {
        let width = set.pens().iter().map(|pen| pen.width_mm).sum::<f64>() / set.pens().len() as f64;
        Model::new(set, self.n.unwrap_or_else(|| yule_nielsen(width)), self.overlap)
    }

    /// Most coverage of each pen.
    pub(super) fn most(&self, set: &PenSet) -> Coverages {
        let mut most: Coverages = std::array::from_fn(|i| f32::from(u8::from(i < set.pens().len())));
        if let (Some(black), Black::Lines | Black::None) = (set.black(), self.black) {
            most[black] = 0.0;
        }
        most
    }
}

/// Why nothing can be separated.
#[derive(Debug, Error, PartialEq)]
pub enum SeparationError {
    /// The black pen alone, and no tones from it.
    #[error("without the black pen no pen is left for tones; add one, or let black draw tones")]
    NoPen,
    /// A limit that allows no drawing.
    #[error("an ink limit of {0} is out of range; it is the most that all pens together cover, 0.5 to 8, such as 2.4")]
    InkLimit(f32),
}

/// Separates any number of photographs into the same pens.
#[derive(Clone, Debug)]
pub struct Separator {
    model: Model,
    table: Table,
    /// CIEDE2000 between the photograph and what the model predicts, at the table's nodes.
    errors: Vec<[f32; 1]>,
    white: [f64; 3],
    pens: usize,
}

/// A separated photograph.
#[derive(Clone, Debug, PartialEq)]
pub struct Separation {
    /// For each pen, in the set's order, the share of the paper that it covers, 0 to 1.
    pub coverages: Vec<Raster<f32>>,
    /// How far the predicted colours are from the photograph's.
    pub error: GamutError,
}

/// Differences (CIEDE2000) between a photograph's pixels and their predicted colours on paper, each beside its own white.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GamutError {
    /// Mean.
    pub mean: f64,
    /// 95 % of the pixels differ less.
    pub most: f64,
    /// Share of the pixels, 0 to 1, that differ by more than 2.
    pub outside: f64,
}

impl Separator {
    /// Solves the table of all colours: 0.3 s for four pens on two processors.
    pub fn new(set: &PenSet, settings: &Settings) -> Result<Self, SeparationError> {
        let pens = set.pens().len();
        let most = settings.most(set);
        if most.iter().all(|c| *c == 0.0) {
            return Err(SeparationError::NoPen);
        }
        if !(0.5..=8.0).contains(&settings.ink_limit) {
            return Err(SeparationError::InkLimit(settings.ink_limit));
        }
        let model = settings.model(set);
        let inks = Inks::new(set);
        let solver = Solver { model: &model, eye: &inks.eye, most, limit: settings.ink_limit, ridge: RIDGE };
        let colours = Colours::new(solver, &inks, settings);
        let table = Table::solved(&colours);
        let white = inks.white;
        let errors = of_nodes(|node, light| [difference(&model, &table.nodes()[node][..pens], white, light)]);
        Ok(Self { model, table, errors, white, pens })
    }

    /// The model of these pens on this paper.
    pub const fn model(&self) -> &Model {
        &self.model
    }

    /// XYZ of what is taken for white: the paper, or a covering ink lighter than the paper.
    pub const fn white(&self) -> [f64; 3] {
        self.white
    }

    /// Coverages for one colour, linear sRGB light.
    pub fn coverages_of(&self, light: [f32; 3]) -> Vec<f32> {
        Place::of(light).mix(self.table.nodes())[..self.pens].to_vec()
    }

    /// Predicted difference (CIEDE2000) of one colour, linear sRGB light.
    pub fn error_of(&self, light: [f32; 3]) -> f32 {
        Place::of(light).mix(&self.errors)[0]
    }

    /// Separates a photograph: linear sRGB light, 0 to 1 per channel; values outside are clamped.
    pub fn separate(&self, photograph: &Raster<[f32; 3]>) -> Separation {
        let coverages = if self.pens <= 4 { self.looked_up::<4>(photograph) } else { self.looked_up::<MOST_PENS>(photograph) };
        Separation { coverages, error: self.error(photograph) }
    }

    fn looked_up<const LANES: usize>(&self, photograph: &Raster<[f32; 3]>) -> Vec<Raster<f32>> {
        const SHARE: usize = 1 << 14;
        let nodes = self.table.lanes::<LANES>();
        let mut planes: Vec<Vec<f32>> = (0..self.pens).map(|_| vec![0.0; photograph.len()]).collect();
        let mut shares: Vec<Vec<&mut [f32]>> = photograph.pixels().chunks(SHARE).map(|_| Vec::new()).collect();
        for plane in &mut planes {
            shares.iter_mut().zip(plane.chunks_mut(SHARE)).for_each(|(share, part)| share.push(part));
        }
        parallel::shares(&mut shares, 1, &|k, share| {
            let parts = &mut share[0];
            for (i, light) in photograph.pixels()[k * SHARE..].iter().take(SHARE).enumerate() {
                let mixed = Place::of(*light).mix(&nodes);
                parts.iter_mut().zip(mixed).for_each(|(part, c)| part[i] = c);
            }
        });
        planes.into_iter().map(|plane| Raster::from_vec(photograph.width(), photograph.height(), plane)).collect()
    }

    fn error(&self, photograph: &Raster<[f32; 3]>) -> GamutError {
        /// A visible difference above which a colour counts as out of gamut.
        const OUTSIDE: f32 = 2.0;
        /// Most pixels at which the error is measured.
        const SAMPLES: usize = 100_000;
        let step = photograph.len().div_ceil(SAMPLES).max(1);
        let mut errors: Vec<f32> = photograph.pixels().iter().step_by(step).map(|light| self.error_of(*light)).collect();
        if errors.is_empty() {
            return GamutError::default();
        }
        errors.sort_unstable_by(f32::total_cmp);
        let count = errors.len() as f64;
        let outside = errors.len() - errors.partition_point(|e| *e <= OUTSIDE);
        GamutError {
            mean: errors.iter().map(|e| f64::from(*e)).sum::<f64>() / count,
            most: f64::from(errors[(0.95 * (count - 1.0)) as usize]),
            outside: outside as f64 / count,
        }
    }
}

/// What the eye sees of the paper and of each ink alone.
pub(super) struct Inks {
    pub eye: Eye,
    white: [f64; 3],
    paper: Oklab,
    looks: Vec<Oklab>,
}

impl Inks {
    pub fn new(set: &PenSet) -> Self {
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

/// The problems of the table.
pub(super) struct Colours<'a> {
    solver: Solver<'a>,
    rendering: Rendering,
    paper: Oklab,
    looks: &'a [Oklab],
    simple: f32,
}

impl<'a> Colours<'a> {
    pub fn new(solver: Solver<'a>, inks: &'a Inks, settings: &Settings) -> Self {
        let simple = SIMPLE * settings.simplify.clamp(0.0, 1.0);
        let rendering = Rendering::new(darkest(&solver), inks.paper);
        Self { solver, rendering, paper: inks.paper, looks: &inks.looks, simple }
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
        let mut solver = self.solver;
        let share = ((look[0] - self.paper[0]) / HEIGHTENED).clamp(0.0, 1.0);
        for (most, _) in solver.most.iter_mut().zip(self.looks).filter(|(_, ink)| ink[0] > self.paper[0]) {
            *most = most.min(share);
        }
        solver
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
        for ((price, ink), c) in prices.iter_mut().zip(self.looks).zip(now) {
            let contrast = ink[0] - look[0];
            let [a, b] = [ink[1] - look[1], ink[2] - look[2]];
            *price = INK + GRAIN * contrast * contrast + CONFETTI * (a * a + b * b) + self.simple * FEW / ((c + FEW) * (c + FEW));
        }
        prices
    }
}

impl Problems for Colours<'_> {
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

fn difference(model: &Model, coverages: &[f32], white: [f64; 3], light: [f32; 3]) -> f32 {
    let seen = Lab::from_xyz(model.xyz(coverages), white);
    Lab::from_rgb(light.map(f64::from)).difference(seen) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::{ColourPen, Paper};
    use crate::drawing::Colour;

    #[test]
    fn white_ink_is_for_what_is_lighter_than_the_paper() {
        let pen = |name: &str, colour: &str| ColourPen::new(name, 0.3, colour.parse::<Colour>().unwrap());
        let paper = Paper::new("#c9b28f".parse().unwrap());
        let set = PenSet::new(vec![pen("black", "#2a2826"), pen("white", "#f7f5ee").opaque()], paper, Vec::new()).unwrap();
        let separator = Separator::new(&set, &Settings::default()).unwrap();
        let white_in = |grey: f32| separator.coverages_of([grey; 3])[1];
        assert!(white_in(0.02) < 1e-3 && white_in(0.2) < 1e-3, "{} {}", white_in(0.02), white_in(0.2));
        assert!(white_in(0.95) > 0.5, "{}", white_in(0.95));
    }
}
