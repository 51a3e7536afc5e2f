//! The correction of widths until the ink drawn is the ink wanted.

use super::super::Drawer;
use super::{Pieces, marks};
use crate::raster::{Raster, gaussian_blur};
use crate::style::coverage::covered;

/// Rounds of the tone's correction, its reach in pitches, and the greatest change of a width in one round.
pub(super) const TONE_ROUNDS: usize = 2;
const TONE_REACH: f64 = 1.6;
const TONE_STEP: [f32; 2] = [0.6, 1.6];
/// Ink that is as good as none.
const LEAST_INK: f32 = 0.01;

impl Drawer<'_> {
    /// Makes lines wider or thinner by the ratio of the ink wanted around each node to the ink drawn there.
    pub(super) fn correct(&self, pieces: &mut Pieces, ink: &Raster<f32>) {
        let placement = &self.portrait.placement;
        let reach = (TONE_REACH * self.pitch()) as f32;
        let drawn = gaussian_blur(&covered(&marks(pieces.iter().flatten(), placement), placement), reach);
        let wanted = gaussian_blur(ink, reach);
        let ratio = wanted
            .zip_map(&drawn, |wanted, drawn| ((wanted + LEAST_INK) / (drawn + LEAST_INK)).clamp(TONE_STEP[0], TONE_STEP[1]));
        // Beside the picture's border neither is whole.
        let inner = |at: f64, side: usize| at.clamp(f64::from(reach), (side as f64 - f64::from(reach)).max(f64::from(reach)));
        for piece in pieces.iter_mut().flatten() {
            for ((width, ceiling), node) in piece.widths.iter_mut().zip(&piece.ceilings).zip(&piece.nodes) {
                *width =
                    (*width * f64::from(ratio.sample(inner(node.x, ratio.width()), inner(node.y, ratio.height())))).min(*ceiling);
            }
        }
    }
}
