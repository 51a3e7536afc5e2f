//! Copies of patches gathered into pens, pairs and all.

use super::doubts;
use super::measuring::Sampled;
use super::{Known, Measured, PairReading, PenReading, Quality, RampStep, SheetReading};
use crate::colour::sheet::grid::Patch;
use crate::colour::sheet::lab::lab;
use crate::colour::sheet::layout::nominal;

/// The patches of a sheet on their way to a reading.
pub(super) struct Gathered<'a> {
    pub known: &'a Known<'a>,
    pub patches: &'a [(Patch, Sampled)],
    pub quality: Quality,
    /// Side of a cell in millimetres.
    pub cell: f64,
    pub paper: [f64; 3],
}

impl Gathered<'_> {
    pub(super) fn reading(&self) -> SheetReading {
        let pens: Vec<PenReading> = (0..self.known.nibs.len()).map(|pen| self.pen(pen)).collect();
        let pairs = (0..pens.len()).flat_map(|a| (a + 1..pens.len()).map(move |b| [a, b]));
        let pairs = pairs.map(|[a, b]| PairReading { pens: [a, b], colour: self.together(Patch::Pair(a, b)) }).collect();
        let all = (pens.len() > 2).then(|| self.together(Patch::All));
        let warnings = doubts::warnings(&self.quality, &pens, self.paper, self.cell);
        SheetReading { pens, pairs, all, paper: self.paper, quality: self.quality, warnings }
    }

    fn pen(&self, pen: usize) -> PenReading {
        let solid = self.together(Patch::Solid(pen));
        let nominal = nominal(self.known.nibs[pen], self.cell);
        let step = |(step, nominal): (usize, f64)| {
            let colour = self.together(Patch::Ramp(pen, step));
            RampStep { nominal, effective: coverage(colour.relative, solid.relative), colour }
        };
        let solids = self.copies(Patch::Solid(pen));
        let filled = solids.iter().map(|copy| coverage(copy.mean, copy.colour)).sum::<f64>() / solids.len().max(1) as f64;
        PenReading { solid, filled, ramp: nominal.into_iter().enumerate().map(step).collect() }
    }

    /// One colour from a patch's copies: the median of three in each channel, else the mean.
    fn together(&self, patch: Patch) -> Measured {
        let copies: Vec<[f64; 3]> = self.copies(patch).iter().map(|read| read.on(self.paper)).collect();
        let relative = std::array::from_fn(|c| {
            let mut values: Vec<f64> = copies.iter().map(|copy| copy[c]).collect();
            values.sort_unstable_by(f64::total_cmp);
            let kept = if values.len() > 2 { &values[1..values.len() - 1] } else { &values[..] };
            kept.iter().sum::<f64>() / kept.len().max(1) as f64
        });
        let on_paper = |v: [f64; 3]| lab(std::array::from_fn(|c| v[c] * self.paper[c]));
        let lab = on_paper(relative);
        let spread = copies.into_iter().map(|copy| doubts::distance(on_paper(copy), lab)).fold(0.0, f64::max);
        Measured { relative, lab, spread }
    }

    fn copies(&self, patch: Patch) -> Vec<&Sampled> {
        self.patches.iter().filter(|(known, _)| *known == patch).map(|(_, read)| read).collect()
    }
}

/// The share of ink in a mixture of ink and paper, by least squares over the channels.
fn coverage(mixture: [f64; 3], ink: [f64; 3]) -> f64 {
    let (product, square) = (0..3).fold((0.0, 0.0), |(product, square), c| {
        (product + (1.0 - mixture[c]) * (1.0 - ink[c]), square + (1.0 - ink[c]) * (1.0 - ink[c]))
    });
    (product / square.max(1e-6)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coverage_is_that_of_the_mixture() {
        let ink = [0.1, 0.5, 0.9];
        assert!((coverage(ink.map(|v| 0.7 + 0.3 * v), ink) - 0.3).abs() < 1e-9);
        assert_eq!((coverage(ink, ink), coverage([1.0; 3], ink), coverage([0.5; 3], [1.0; 3])), (1.0, 0.0, 0.0));
    }
}
