//! The colour of a tint of several inks: the Yule-Nielsen modified Neugebauer model.
//!
//! Seen from afar, a tint has the mean of the colours of its overprints, each by its share of the paper (Neugebauer 1937). Light
//! that enters the paper beside a mark and leaves through it makes tints darker than this mean; Yule and Nielsen (1951) describe
//! it by one number: the mean is taken of the n-th roots. n = 1 is no spread (marks much larger than the way of light in the
//! paper), n = 2 is full spread (marks much smaller); inks that do not lie flat push it further.

use super::bands::{BANDS, Bands, xyz_of};
use super::overlap::{Mixed, Overlap};
use super::overprints::overprints;
use super::pens::PenSet;
use crate::elementary::Elementary as _;

/// Mean way of light in drawing paper, in mm.
const SPREAD_MM: f64 = 0.06;

/// What a paper and pens do to light.
#[derive(Clone, Debug)]
pub struct Model {
    pens: usize,
    n: f32,
    overlap: Overlap,
    /// The n-th roots of each overprint's reflectance.
    roots: Vec<Bands>,
}

/// The exponent for marks of a width in mm: 1.7 at 0.1 mm, 1.4 at 0.3 mm, 1.1 at 0.8 mm. Fitted to tints of round marks 2 to 13
/// times as wide as the way of light, looked at through a simulated microscope.
pub fn yule_nielsen(width_mm: f64) -> f64 {
    1.0 + 1.0 / (1.0 + (width_mm.max(0.0) / (3.6 * SPREAD_MM)).power(1.4))
}

impl Model {
    /// The model of a set of pens. `n` is clamped to 1..=10.
    pub fn new(set: &PenSet, n: f64, overlap: Overlap) -> Self {
        let n = if n.is_finite() { n.clamp(1.0, 10.0) as f32 } else { 1.0 };
        let roots = overprints(set).iter().map(|r| r.map(|v| v.power(1.0 / n))).collect();
        Self { pens: set.pens().len(), n, overlap, roots }
    }

    /// Number of pens.
    pub const fn pens(&self) -> usize {
        self.pens
    }

    /// How marks lie to one another.
    pub const fn overlap(&self) -> Overlap {
        self.overlap
    }

    /// Reflectance of a tint, and its slopes along each coverage.
    pub(super) fn tint(&self, coverages: &[f32]) -> Mixed {
        let mut mixed = self.overlap.mix(coverages, &self.roots);
        for band in 0..BANDS {
            let root = mixed.value[band].max(1e-6);
            let power = root.power(self.n - 1.0);
            mixed.value[band] = root * power;
            mixed.slopes[..self.pens].iter_mut().for_each(|slope| slope[band] *= self.n * power);
        }
        mixed
    }

    /// XYZ of a tint under D65, where a perfect white has Y = 1. Coverages are 0 to 1, one for each pen.
    pub fn xyz(&self, coverages: &[f32]) -> [f64; 3] {
        let mut given = [0.0; super::pens::MOST_PENS];
        given.iter_mut().zip(coverages).for_each(|(to, c)| *to = if c.is_finite() { c.clamp(0.0, 1.0) } else { 0.0 });
        xyz_of(&self.tint(&given[..self.pens]).value)
    }
}
