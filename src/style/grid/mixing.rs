//! The transition from dots to lines, and line widths (Son et al. 2011, sections 6.2 and 6.3; errata).
//!
//! ```text
//!   tone   1 ........ border + blend ........ border - blend ........ 0
//!   ink      dots     dots and thin lines     lines only;
//!                     through them            dots are inside them
//! ```

use super::Drawer;
use super::parameters::Hatching;
use crate::elementary::Elementary as _;
use crate::geometry::{Point, disc_area_in};

/// Share of a tone between dots and lines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mixing {
    /// Tone at which a dot reaches its maximum size.
    border: f64,
    blend: f64,
    hatching: Hatching,
}

impl Mixing {
    pub(super) fn new(drawer: &Drawer<'_>) -> Self {
        let parameters = &drawer.parameters;
        let border = border(parameters.size_max / parameters.pitch);
        Self { border, blend: parameters.blend, hatching: parameters.hatching }
    }

    /// Share of its full width that a line has at a tone: 0 if there are only dots, 1 if there are only lines.
    pub(super) fn line_share(&self, tone: f64) -> f64 {
        if self.border >= 1.0 {
            return 1.0;
        }
        if self.border <= 0.0 {
            return 0.0;
        }
        let t = ((self.border + self.blend - tone) / (2.0 * self.blend)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }

    /// True if marks of this tone leave only meshes: dots, or lines in both directions.
    pub(super) fn closes_up(&self, tone: f64) -> bool {
        self.hatching == Hatching::Both || self.line_share(tone) == 0.0
    }

    /// True if the lines of a family (0 along, 1 across) are drawn.
    pub(super) fn hatches(&self, family: usize) -> bool {
        match self.hatching {
            Hatching::Both => true,
            Hatching::Along => family == 0,
            Hatching::Across => family == 1,
        }
    }

    /// Width at which lines alone make the ink `1 - tone`, for families of `density` lines per pixel: the remaining white is
    /// `(1 - h f0) (1 - h f1)`, or `1 - h f` with one family (for equal spacing d: `h = d (1 - sqrt(b))` and `d (1 - b)`).
    pub(super) fn full_width(&self, tone: f64, density: [f64; 2]) -> f64 {
        let ink = (1.0 - tone).clamp(0.0, 1.0);
        match self.hatching {
            Hatching::Along => ink / density[0],
            Hatching::Across => ink / density[1],
            Hatching::Both => {
                let (sum, product) = (density[0] + density[1], density[0] * density[1]);
                (sum - (sum * sum - 4.0 * product * ink).max(0.0).sqrt()) / (2.0 * product)
            }
        }
    }
}

/// Exact tone of a square cell of side 1 with a dot of this radius; overlaps count once.
fn border(radius: f64) -> f64 {
    let cell = [Point::new(-0.5, -0.5), Point::new(0.5, -0.5), Point::new(0.5, 0.5), Point::new(-0.5, 0.5)];
    if radius <= 0.0 {
        return 1.0;
    }
    let tone = 1.0 - disc_area_in(&cell, Point::ORIGIN, radius);
    if tone < 1e-9 { 0.0 } else { tone }
}

/// The paper's dot radius for a tone on a square cell of side `pitch` (section 6.1; appendix B, corrected: `s = sqrt(k^2 + (d/2)^2)`).
pub(super) fn paper_radius(tone: f64, pitch: f64) -> f64 {
    use std::f64::consts::PI;
    let ink = 1.0 - tone;
    let apart = pitch * (ink / PI).sqrt();
    if apart <= 0.5 * pitch {
        return apart;
    }
    let k = 0.5 * pitch - pitch * (tone.max(0.0) / (4.0 - PI)).sqrt();
    k.hypotenuse(0.5 * pitch)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mixing(size_max: f64, hatching: Hatching) -> Mixing {
        Mixing { border: border(size_max), blend: 0.1, hatching }
    }

    #[test]
    fn the_ends_of_the_range_are_pure() {
        for tone in [0.0, 0.2, 0.5, 1.0] {
            assert_eq!(mixing(0.0, Hatching::Both).line_share(tone), 1.0);
            assert_eq!(mixing(0.75, Hatching::Both).line_share(tone), 0.0);
        }
        let half = mixing(0.5, Hatching::Both);
        assert!((half.border - (1.0 - std::f64::consts::FRAC_PI_4)).abs() < 1e-12);
        assert!(half.line_share(0.4) == 0.0 && half.line_share(0.1) == 1.0);
    }

    #[test]
    fn widths_leave_the_tone_white() {
        for tone in [0.05, 0.3, 0.7, 0.95] {
            let density = [0.17, 0.15];
            let h = mixing(0.0, Hatching::Both).full_width(tone, density);
            assert!(((1.0 - h * density[0]) * (1.0 - h * density[1]) - tone).abs() < 1e-9);
            let equal = mixing(0.0, Hatching::Both).full_width(tone, [1.0 / 6.0; 2]);
            assert!((equal - 6.0 * (1.0 - tone.sqrt())).abs() < 1e-9, "the errata's width");
            let one = mixing(0.0, Hatching::Along).full_width(tone, density);
            assert!((1.0 - one * density[0] - tone).abs() < 1e-9);
        }
    }

    /// Continuous where dots begin to touch, and the farthest corner at full ink.
    #[test]
    fn the_paper_s_radius_as_corrected() {
        let touching = 1.0 - std::f64::consts::FRAC_PI_4;
        assert!((paper_radius(touching + 1e-9, 6.0) - 3.0).abs() < 1e-3);
        assert!((paper_radius(touching - 1e-9, 6.0) - 3.0).abs() < 1e-3);
        assert!((paper_radius(0.0, 6.0) - 6.0 / 2.0_f64.sqrt()).abs() < 1e-9);
    }
}
