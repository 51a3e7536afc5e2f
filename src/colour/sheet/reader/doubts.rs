//! What is doubtful about a reading.

use super::{PenReading, Quality, ReadWarning};
use crate::colour::sheet::lab::lab;

/// Blur in cells from which ramps may be read too even.
const SOFT: f64 = 0.035;
/// Share of clipped paper.
const CLIPPED: f64 = 0.005;
/// Robust deviation of paper from smooth light.
const UNEVEN: f64 = 0.02;
/// Noise of a pixel on paper.
const NOISY: f64 = 0.08;
/// Level of paper.
const DARK: f64 = 110.0;
/// Error of the marks' places in cells.
const UNFLAT: f64 = 0.015;
/// Cast of the light.
const CAST: f64 = 1.6;
/// Differences in Lab: of copies that agree; of a pen from paper; of two pens.
const AGREE: f64 = 5.0;
const PALE: f64 = 4.0;
const ALIKE: f64 = 5.0;
/// Relative light below which a channel may have been cut off.
const NO_LIGHT: f64 = 0.002;
/// Least share of a patch that its pen should cover.
const FILLED: f64 = 0.85;

/// The warnings about a picture and the pens in it; `cell` in millimetres.
pub(super) fn warnings(quality: &Quality, pens: &[PenReading], paper: [f64; 3], cell: f64) -> Vec<ReadWarning> {
    let mut warnings = Vec::new();
    let mut warn = |is_so: bool, warning: ReadWarning| warnings.extend(is_so.then_some(warning));
    warn(quality.clipped > CLIPPED, ReadWarning::Clipped { share: quality.clipped });
    warn(quality.residual > UNEVEN, ReadWarning::Uneven { residual: quality.residual });
    warn(quality.noise > NOISY, ReadWarning::Noisy { noise: quality.noise });
    warn(quality.blur_mm > SOFT * cell, ReadWarning::Soft { blur_mm: quality.blur_mm });
    warn(quality.paper_level < DARK, ReadWarning::Dark { level: quality.paper_level });
    warn(quality.registration_mm > UNFLAT * cell, ReadWarning::Unflat { error_mm: quality.registration_mm });
    warn(quality.cast > CAST, ReadWarning::Cast { cast: quality.cast });
    for (pen, reading) in pens.iter().enumerate() {
        let solid = &reading.solid;
        let is_pale = distance(solid.lab, lab(paper)) < PALE;
        warn(is_pale, ReadWarning::Pale { pen });
        warn(solid.spread > AGREE, ReadWarning::Differs { pen, spread: solid.spread });
        warn(solid.relative.into_iter().any(|v| v < NO_LIGHT), ReadWarning::BeyondGamut { pen });
        warn(!is_pale && !rises(reading), ReadWarning::Ramp { pen });
        warn(!is_pale && reading.filled < FILLED, ReadWarning::Bare { pen, bare: 1.0 - reading.filled });
        let twins = (0..pen).filter(|other| distance(pens[*other].solid.lab, solid.lab) < ALIKE);
        twins.for_each(|other| warn(true, ReadWarning::Alike { pens: [other, pen] }));
    }
    warnings
}

fn rises(pen: &PenReading) -> bool {
    let steps = pen.ramp.iter().map(|step| step.effective).chain([1.0]);
    steps.clone().zip(steps.skip(1)).all(|(a, b)| a < b)
}

/// Distance of two colours in Lab.
pub(super) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}
