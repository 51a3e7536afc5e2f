//! Teeth as one light shape: the gaps between them, which marks would make strings of beads of, are rubbed out, by half if no lines take their
//! place.

use super::solids::inside_outlines;
use crate::raster::{Raster, fast_gaussian, fast_gaussian_within};
use crate::source::{Landmarks, Portrait, outlines};

/// Reach of a tooth's tone and blur of the teeth's border, in widths of the face.
const REACH: f64 = 0.016;
const BORDER: f64 = 0.004;
/// Mean ink of teeth, and that above which a place is none: with more the dark of open mouths is grey.
const TOOTH: [f32; 2] = [0.3, 0.45];
/// The share of a gap that stays where it has no line: without it teeth are a blank strip (portraits 01 and 06), with all of it beads.
const KEPT: f32 = 0.5;

/// What becomes of the gaps between teeth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Gaps {
    /// They are fainter: in charcoal; and in grids, whose face finder's light, brown and dark faces are else unequally alike.
    Faint,
    /// They go: lines take their place.
    Drawn,
}

/// Ink with fainter gaps between teeth, or none.
pub(super) fn with_whole_teeth(portrait: &Portrait, ink: Raster<f32>, gaps: Gaps) -> Raster<f32> {
    let Some(widest) = portrait.faces.iter().map(Landmarks::width).reduce(f64::max) else { return ink };
    let mouths = inside_outlines(&portrait.faces, [&outlines::MOUTH, &outlines::MOUTH], (ink.width(), ink.height()));
    if mouths.pixels().iter().all(|inside| *inside == 0.0) {
        return ink;
    }
    let around = fast_gaussian_within(&ink, &mouths.map(|inside| inside + 1e-6), (REACH * widest) as f32);
    let teeth = mouths.zip_map(&around, |inside, around| inside * ((TOOTH[1] - around) / (TOOTH[1] - TOOTH[0])).clamp(0.0, 1.0));
    let soft = fast_gaussian(&teeth, (BORDER * widest) as f32);
    let less = if gaps == Gaps::Faint { 1.0 - KEPT } else { 1.0 };
    let darker = ink.zip_map(&around, |ink, around| (ink - around).max(0.0));
    ink.zip_map(&darker.zip_map(&soft, |darker, tooth| darker * tooth * less), |ink, less| ink - less)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::form::mean_portrait;

    #[test]
    fn gaps_between_teeth_fade_and_an_open_mouth_stays_dark() {
        let portrait = mean_portrait(6.0, 0.0, |_| 140);
        let face = &portrait.faces[0];
        let middle = face.point(outlines::MOUTH[0]).midpoint(face.point(outlines::MOUTH[10]));
        let (width, height) = (portrait.lightness.width(), portrait.lightness.height());
        let at = |ink: &Raster<f32>| {
            let near = inside_outlines(&portrait.faces, [&outlines::MOUTH, &outlines::MOUTH], (width, height));
            ink.pixels()
                .iter()
                .zip(near.pixels())
                .filter(|(_, inside)| **inside > 0.0)
                .map(|(ink, _)| *ink)
                .fold(0.0_f32, f32::max)
        };
        let gaps = Raster::from_fn(width, height, |x, _| if x.abs_diff(middle.x as usize) % 8 == 0 { 0.9 } else { 0.05 });
        let dark = Raster::filled(width, height, 0.9);
        let (whole, open) =
            (with_whole_teeth(&portrait, gaps.clone(), Gaps::Faint), with_whole_teeth(&portrait, dark.clone(), Gaps::Drawn));
        assert!(at(&gaps) == 0.0 || at(&whole) < 0.8 * at(&gaps), "{} of {}", at(&whole), at(&gaps));
        assert_eq!(open, dark);
    }
}
