//! What an SVG's paint means for a pen: ink, paper, or paint that no pen can draw.

use crate::drawing::Colour;

/// Minimum red, green and blue of paint that counts as paper: no pen's ink is that light.
const WHITE: u8 = 250;

/// A paint's source and opacity.
#[derive(Clone, Copy)]
pub(super) struct Paint {
    pub ink: Source,
    pub opacity: f32,
}

#[derive(Clone, Copy)]
pub(super) enum Source {
    Ink(Colour),
    White,
    Gradient { is_opaque: bool },
    Pattern,
}

impl Paint {
    pub fn of(paint: &usvg::Paint, opacity: f32) -> Self {
        let is_opaque = |stops: &[usvg::Stop]| stops.iter().all(|stop| stop.opacity().get() >= 1.0);
        let ink = match paint {
            usvg::Paint::Color(c) if [c.red, c.green, c.blue].iter().all(|&part| part >= WHITE) => Source::White,
            usvg::Paint::Color(c) => Source::Ink(Colour { r: c.red, g: c.green, b: c.blue }),
            usvg::Paint::LinearGradient(gradient) => Source::Gradient { is_opaque: is_opaque(gradient.stops()) },
            usvg::Paint::RadialGradient(gradient) => Source::Gradient { is_opaque: is_opaque(gradient.stops()) },
            usvg::Paint::Pattern(_) => Source::Pattern,
        };
        Self { ink, opacity }
    }

    /// True if it hides everything below it.
    pub fn hides(self) -> bool {
        self.opacity >= 1.0 && !matches!(self.ink, Source::Pattern | Source::Gradient { is_opaque: false })
    }
}
