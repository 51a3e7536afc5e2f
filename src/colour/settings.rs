//! How a photograph is separated into pens.

use super::neugebauer::{Model, yule_nielsen};
use super::overlap::Overlap;
use super::pens::PenSet;
use super::solver::Coverages;

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
