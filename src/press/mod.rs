//! The press: compensates in the drawing for what a press does to ink.
//!
//! Ink spreads on its way to the paper, and light that enters the paper beside it is lost under it: each mark's border seems to
//! move outwards by the same distance, whatever the mark's size. In this border-zone model, dot gain grows with the
//! length of the borders; Viggiano (The GRL Dot Gain Model, TAGA 1983) derives his `sqrt(a (1 - a))` law from it. It holds for
//! stipples and lines of any pitch, whereas a tone curve (Murray-Davies, Yule-Nielsen) holds only for the screen on which it was
//! measured and would make coarse marks far too thin. So the usual figure for a press, the gain of a 50 % screen tint, is
//! converted to that distance ([`Press::new`]), and all marks are made smaller by it ([`Press::compensated`]).
//!
//! Marks too small for print are thinned out: dots, and thin lines cut into dashes, stand for their neighbours in blue-noise
//! order at the smallest printable size, so that the mean ink is kept.

mod area;
mod job;
mod line;
mod plan;
mod spread;
mod thin;

pub use job::{PrintFormat, PrintJob};

use crate::drawing::{Area, Dot, Drawing, Layer, Mark, Stroke};
use crate::geometry::Affine;
use crate::interrupt::{Interrupt, Interrupted};
use crate::parallel::mapped;
use kurbo::Shape;
use plan::{Plan, Speck};

/// The effect of a press on marks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// Distance by which a mark's border moves outwards, in millimetres.
    spread: f64,
    /// Diameter of the smallest dot and width of the thinnest line on the plate, in millimetres.
    least: f64,
}

impl Press {
    /// A press that prints a 50 % tint of `lines_a_cm` lines per centimetre as 50 % + `dot_gain` (0 to 0.5), with no mark smaller
    /// than `least_mark` millimetres across. With dot gain, no mark is reduced to less than half its size: it is thinned out
    /// instead.
    pub fn new(dot_gain: f64, lines_a_cm: f64, least_mark: f64) -> Self {
        let spread = spread::of_gain(dot_gain, 10.0 / lines_a_cm);
        Self { spread, least: least_mark.max(2.0 * spread) }
    }

    /// Distance by which a mark's border moves outwards in print, in millimetres.
    pub const fn spread(&self) -> f64 {
        self.spread
    }

    /// The drawing for the plate, such that the print shows `drawing`.
    ///
    /// Marks in the paper's colour, into which ink spreads, are made larger. Strokes that are cut into dashes lose pressure and
    /// times.
    #[must_use]
    pub fn compensated(&self, drawing: &Drawing) -> Drawing {
        if self.least == 0.0 {
            return drawing.clone();
        }
        let layers = drawing.layers.iter().map(|layer| self.layer(layer, drawing, &Interrupt::never())).collect();
        Drawing { page: drawing.page, layers }
    }

    /// As [`Press::compensated`], but can be interrupted.
    pub fn compensated_until(&self, drawing: &Drawing, interrupt: &Interrupt) -> Result<Drawing, Interrupted> {
        if self.least == 0.0 {
            return Ok(drawing.clone());
        }
        let layer = |layer| {
            let layer = self.layer(layer, drawing, interrupt);
            interrupt.check().map(|()| layer)
        };
        Ok(Drawing { page: drawing.page, layers: drawing.layers.iter().map(layer).collect::<Result<_, _>>()? })
    }

    fn layer(&self, layer: &Layer, drawing: &Drawing, interrupt: &Interrupt) -> Layer {
        let plan = |mark: &Mark| (!interrupt.is_raised()).then(|| self.plan(mark, drawing));
        let plans = mapped(&layer.marks, &plan);
        Layer { marks: thin::settled(plans.into_iter().flatten().collect(), self, interrupt), ..layer.clone() }
    }

    fn plan(&self, mark: &Mark, drawing: &Drawing) -> Plan {
        let is_knocked_out = mark.colour() == Some(drawing.page.paper);
        match mark {
            _ if is_knocked_out => Plan::Whole(knocked_out(mark, self.spread)),
            Mark::Dot(dot) => self.dot(dot),
            Mark::Stroke(stroke) => line::plan(stroke, self),
            Mark::Area(area) => area::plan(area, self),
        }
    }

    /// Half the printed width of the smallest mark.
    fn least_printed_radius(&self) -> f64 {
        0.5 * self.least + self.spread
    }

    fn dot(&self, dot: &Dot) -> Plan {
        let least = self.least_printed_radius();
        // Written sizes are rounded: a size exactly at the limit counts as large enough.
        if dot.radius >= least - 1e-6 {
            return Plan::Whole(Mark::Dot(spread_dot(dot, -self.spread)));
        }
        let mark = Mark::Dot(scaled_dot(dot, 0.5 * self.least / dot.radius));
        Plan::Specks(None, vec![Speck { at: dot.centre, share: (dot.radius / least).powi(2), mark }])
    }
}

/// A hole in the ink, enlarged by what the press will fill.
fn knocked_out(mark: &Mark, spread: f64) -> Mark {
    match mark {
        Mark::Dot(dot) => Mark::Dot(spread_dot(dot, spread)),
        Mark::Stroke(stroke) => Mark::Stroke(widened(stroke, 2.0 * spread)),
        Mark::Area(area) => Mark::Area(Area { outline: area::grown(&area.outline, spread), colour: area.colour }),
    }
}

/// A dot whose border has moved outwards. A blob keeps its shape and gets the area that moving its border would give (Steiner's
/// formula, exact for convex outlines: `A + P d + pi d^2`).
fn spread_dot(dot: &Dot, distance: f64) -> Dot {
    let Some(outline) = &dot.outline else {
        return Dot { radius: dot.radius + distance, ..dot.clone() };
    };
    let (area, border) = (outline.area().abs(), outline.perimeter(1e-3));
    if area <= 0.0 {
        return dot.clone();
    }
    // Growing `scale` times the blob by -distance gives the blob: s^2 A - s P d + pi d^2 = A.
    let half = 0.5 * border * distance / area;
    let scale = half + (half * half + 1.0 - std::f64::consts::PI * distance * distance / area).max(0.0).sqrt();
    scaled_dot(dot, scale)
}

fn scaled_dot(dot: &Dot, scale: f64) -> Dot {
    let place = Affine::translate(dot.centre.to_vec2()) * Affine::scale(scale) * Affine::translate(-dot.centre.to_vec2());
    Dot {
        radius: dot.radius * scale,
        outline: dot.outline.as_ref().map(|outline| Box::new(place * (**outline).clone())),
        ..dot.clone()
    }
}

/// A stroke wider by `more` millimetres everywhere.
fn widened(stroke: &Stroke, more: f64) -> Stroke {
    stroke.clone().map_widths(|width| width + more)
}

#[cfg(test)]
mod tests;
