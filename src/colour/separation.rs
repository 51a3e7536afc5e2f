//! Separation of a photograph into pens.

use super::matching::Matching;
use super::neugebauer::Model;
use super::pens::{MOST_PENS, PenSet};
use super::settings::Settings;
use super::space::Lab;
use super::table::{Nodes, Place, Table, of_nodes};
use crate::parallel;
use crate::raster::Raster;
use std::sync::OnceLock;
use thiserror::Error;

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
    matching: Matching,
    pens: usize,
    /// Of all colours, solved when first asked for.
    whole: OnceLock<Solved>,
}

/// The table at some nodes.
#[derive(Clone, Debug)]
struct Solved {
    table: Table,
    /// CIEDE2000 between the photograph and what the model predicts, at the table's nodes.
    errors: Vec<[f32; 1]>,
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
    /// Checks that these pens can be separated into.
    ///
    /// # Errors
    /// If no pen is left for tones, or the limit of ink is out of range.
    pub fn new(set: &PenSet, settings: &Settings) -> Result<Self, SeparationError> {
        if settings.most(set).iter().all(|c| *c == 0.0) {
            return Err(SeparationError::NoPen);
        }
        if !(0.5..=8.0).contains(&settings.ink_limit) {
            return Err(SeparationError::InkLimit(settings.ink_limit));
        }
        Ok(Self { matching: Matching::new(set, settings), pens: set.pens().len(), whole: OnceLock::new() })
    }

    /// The model of these pens on this paper.
    pub const fn model(&self) -> &Model {
        self.matching.model()
    }

    /// XYZ of what is taken for white: the paper, or a covering ink lighter than the paper.
    pub const fn white(&self) -> [f64; 3] {
        self.matching.white()
    }

    /// Coverages for one colour, linear sRGB light.
    pub fn coverages_of(&self, light: [f32; 3]) -> Vec<f32> {
        Place::of(light).mix(self.whole().table.nodes())[..self.pens].to_vec()
    }

    /// Predicted difference (CIEDE2000) of one colour, linear sRGB light.
    pub fn error_of(&self, light: [f32; 3]) -> f32 {
        self.whole().error_of(light)
    }

    /// The table of all colours.
    fn whole(&self) -> &Solved {
        self.whole.get_or_init(|| self.solved(&Nodes::all()))
    }

    fn solved(&self, nodes: &Nodes) -> Solved {
        let table = Table::solved(&self.matching, nodes);
        let (model, white) = (self.model(), self.white());
        let errors = of_nodes(nodes, |node, light| [difference(model, &table.nodes()[node][..self.pens], white, light)]);
        Solved { table, errors }
    }

    /// Separates a photograph: linear sRGB light, 0 to 1 per channel; values outside are clamped. Only the colours that it has are solved.
    pub fn separate(&self, photograph: &Raster<[f32; 3]>) -> Separation {
        let solved = self.solved(&Nodes::used_by(photograph.pixels()));
        let coverages = if self.pens <= 4 {
            self.looked_up::<4>(&solved.table, photograph)
        } else {
            self.looked_up::<MOST_PENS>(&solved.table, photograph)
        };
        Separation { coverages, error: solved.error(photograph) }
    }

    fn looked_up<const LANES: usize>(&self, table: &Table, photograph: &Raster<[f32; 3]>) -> Vec<Raster<f32>> {
        const SHARE: usize = 1 << 14;
        let nodes = table.lanes::<LANES>();
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
}

impl Solved {
    fn error_of(&self, light: [f32; 3]) -> f32 {
        Place::of(light).mix(&self.errors)[0]
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
