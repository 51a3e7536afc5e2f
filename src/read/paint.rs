//! What an SVG's paint means for a pen: ink, paper, or what no pen can do.

use crate::drawing::Colour;

/// The least red, green and blue of paint that is taken for paper: no pen's ink is as light.
const WHITE: u8 = 250;

/// What paint is, and how much of it.
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

    /// Whether nothing below it is seen.
    pub fn hides(self) -> bool {
        self.opacity >= 1.0 && !matches!(self.ink, Source::Pattern | Source::Gradient { is_opaque: false })
    }
}
