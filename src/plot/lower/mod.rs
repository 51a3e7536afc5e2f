//! Lowering: from ink to the centre lines that a nib draws.
//!
//! A dot no larger than the nib becomes a touch, a larger one a spiral. Dots smaller than the nib are thinned out so that tone is
//! kept. A line as wide as the nib becomes its centre line, a wider one several passes side by side, a thinner one dashes. Areas
//! are filled with rings that follow their outline, or hatched. A pen whose line swells with its height draws a swelling stroke
//! in one pass.

mod area;
mod dash;
mod dot;
mod ground;
mod hatch;
mod needle;
mod net;
mod room;
mod stroke;
mod swell;
mod thin;
mod unite;

use super::profile::Swell;
use super::{PenPaths, Plot, Toolpath};
use crate::drawing::{Area, Drawing, Layer, Mark, Stroke};
use crate::geometry::{BezPath, OffsetOutline, flatten, simplify_until};
use crate::interrupt::{Interrupt, Interrupted};
use crate::parallel::{collected, mapped};
use area::fill;
use dot::fill_dot;
use std::collections::BTreeMap;
use stroke::lower_stroke;
pub(super) use stroke::turns_sharply;
use swell::swelling_pass;

/// Which parts of a drawing are plotted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InkModel {
    /// Widths and fills are laid down with the nib.
    Ink,
    /// Only strokes' centre lines; dots and areas are left out.
    Lines,
}

/// The nib of each pen, in millimetres.
#[derive(Clone, Debug, PartialEq)]
pub struct Nibs {
    /// Default for pens without their own.
    pub usual: f64,
    /// Nib by pen number.
    pub by_pen: BTreeMap<u32, f64>,
    /// Line width by pen height, for a machine whose line swells with the pen's height.
    pub swell: Option<Swell>,
}

impl Nibs {
    /// One width for all pens.
    pub const fn all(usual: f64) -> Self {
        Self { usual, by_pen: BTreeMap::new(), swell: None }
    }

    /// The nib of a pen.
    pub fn of(&self, pen: u32) -> f64 {
        self.by_pen.get(&pen).copied().unwrap_or(self.usual)
    }
}

/// Lowers a drawing to tool paths. Layers of one pen are merged, and curves are flattened to `tolerance` millimetres.
pub fn lower(
    drawing: &Drawing,
    model: InkModel,
    nibs: &Nibs,
    tolerance: f64,
    interrupt: &Interrupt,
) -> Result<Plot, Interrupted> {
    let mut pens: Vec<PenPaths> = Vec::new();
    for layer in &drawing.layers {
        let nib = nibs.of(layer.pen);
        let lowering = Lowering { model, nib, swell: nibs.swell.as_ref(), tolerance, interrupt };
        let paths = lowering.layer(layer);
        interrupt.check()?;
        // A layer with its own handling is kept separate.
        let is_alike = |pen: &&mut PenPaths| pen.number == layer.pen && pen.handling == layer.handling && !layer.handling.pauses;
        match pens.iter_mut().find(is_alike) {
            Some(pen) => {
                pen.name = format!("{}, {}", pen.name, layer.name);
                pen.paths.extend(paths);
            }
            None => pens.push(pen_of(layer, nib, paths)),
        }
    }
    pens.sort_by_key(|pen| pen.number);
    Ok(Plot { page: drawing.page, pens })
}

fn pen_of(layer: &Layer, nib: f64, paths: Vec<Toolpath>) -> PenPaths {
    PenPaths { number: layer.pen, name: layer.name.clone(), colour: layer.ink.colour(), nib, handling: layer.handling, paths }
}

/// How the marks of one layer are lowered.
struct Lowering<'a> {
    model: InkModel,
    nib: f64,
    swell: Option<&'a Swell>,
    tolerance: f64,
    /// If raised, the result is incomplete.
    interrupt: &'a Interrupt,
}

impl Lowering<'_> {
    fn layer(&self, layer: &Layer) -> Vec<Toolpath> {
        let kept = match self.model {
            InkModel::Ink => thin::thin_small_dots(&layer.marks, self.nib, self.interrupt),
            InkModel::Lines => vec![true; layer.marks.len()],
        };
        if self.interrupt.is_raised() {
            return Vec::new();
        }
        let united = match self.model {
            InkModel::Ink => unite::united(&layer.marks, 0.5 * self.tolerance, self.interrupt),
            InkModel::Lines => unite::United { is_part: vec![false; layer.marks.len()], shapes: Vec::new() },
        };
        let stays = |i: usize| kept[i] && !united.is_part[i];
        let chosen: Vec<(usize, &Mark)> = layer.marks.iter().enumerate().filter(|(i, _)| stays(*i)).collect();
        let mut lowered = collected(united.shapes.len(), &|i| self.shape(&united.shapes[i], phase(i)));
        lowered.append(&mut mapped(&chosen, &|(i, mark)| self.mark(*i, mark)));
        lowered.concat()
    }

    fn mark(&self, index: usize, mark: &Mark) -> Vec<Toolpath> {
        if self.interrupt.is_raised() {
            return Vec::new();
        }
        let phase = phase(index);
        match (mark, self.model) {
            (Mark::Stroke(stroke), InkModel::Lines) => grouped(polylines(stroke.curve(), self.tolerance), stroke),
            (_, InkModel::Lines) => Vec::new(),
            (Mark::Dot(dot), InkModel::Ink) => vec![fill_dot(dot, self.nib, self.tolerance, self.interrupt)],
            (Mark::Stroke(stroke), InkModel::Ink) => grouped(self.stroke(stroke, phase), stroke),
            (Mark::Area(area), InkModel::Ink) => self.area(area, phase),
        }
    }

    fn stroke(&self, stroke: &Stroke, phase: f64) -> Vec<Toolpath> {
        if let Some(pass) = self.swell.and_then(|swell| swelling_pass(stroke, swell, self.tolerance)) {
            return pass;
        }
        if turns_sharply(stroke, self.nib) {
            let area = Area { outline: stroke.ink_outline(0.5 * self.tolerance), colour: None };
            return self.area(&area, phase);
        }
        self.simplified(&lower_stroke(stroke, self.nib, phase, self.interrupt))
    }

    fn area(&self, area: &Area, phase: f64) -> Vec<Toolpath> {
        self.shape(&OffsetOutline::new(&area.outline, 0.5 * self.tolerance), phase)
    }

    fn shape(&self, shape: &OffsetOutline, phase: f64) -> Vec<Toolpath> {
        if self.interrupt.is_raised() {
            return Vec::new();
        }
        self.simplified(&fill(shape, self.nib, phase, self.interrupt))
    }

    /// Level paths without the vertices that straight stretches do not need.
    fn simplified(&self, paths: &[Toolpath]) -> Vec<Toolpath> {
        let points = |path: &Toolpath| simplify_until(path.points(), 0.5 * self.tolerance, self.interrupt);
        paths.iter().filter_map(|path| Toolpath::new(points(path))).collect()
    }
}

/// The dash phase at which a mark's line begins, from 0 to 1. The golden ratio spreads the phases of neighbouring dashed lines.
fn phase(index: usize) -> f64 {
    (index as f64 * 0.618_033_988_75).fract()
}

fn grouped(mut paths: Vec<Toolpath>, stroke: &Stroke) -> Vec<Toolpath> {
    paths.iter_mut().for_each(|path| path.group = stroke.group);
    paths
}

/// A curve's subpaths as tool paths. A subpath without length becomes a touch.
fn polylines(curve: &BezPath, tolerance: f64) -> Vec<Toolpath> {
    flatten(curve, tolerance)
        .into_iter()
        .filter(|(points, _)| points.iter().all(|p| p.is_finite()))
        .filter_map(|(mut points, closed)| {
            if closed && points.len() > 1 {
                points.push(points[0]);
            }
            points.dedup();
            Toolpath::new(points)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Dot, Page};
    use crate::geometry::Point;

    fn touch(x: f64, y: f64) -> Toolpath {
        Toolpath::touch(Point::new(x, y))
    }

    #[test]
    fn small_dots_are_touches_and_large_ones_spirals_inside_their_border() {
        let mut layer = Layer::new("dots", 1);
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(5.0, 5.0), 0.15)));
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(8.0, 5.0), 1.0)));
        let drawing = Drawing { page: Page::new(10.0, 10.0), layers: vec![layer] };
        let plot = lower(&drawing, InkModel::Ink, &Nibs::all(0.3), 0.01, &Interrupt::never()).unwrap();
        assert_eq!(plot.pens[0].paths[0], touch(5.0, 5.0));
        let spiral = plot.pens[0].paths[1].points();
        assert_eq!(spiral[0], Point::new(8.0, 5.0));
        assert!(spiral.iter().all(|p| p.distance(Point::new(8.0, 5.0)) < 0.86));
        assert!(lower(&drawing, InkModel::Lines, &Nibs::all(0.3), 0.01, &Interrupt::never()).unwrap().pens[0].paths.is_empty());
    }

    #[test]
    fn layers_of_one_pen_are_drawn_together() {
        let stroke = Mark::Stroke(Stroke::even(BezPath::from_svg("M0,0 L1,1").unwrap(), 0.3));
        let layers = [("a", 2), ("b", 1), ("c", 2)]
            .into_iter()
            .map(|(name, pen)| Layer { marks: vec![stroke.clone()], ..Layer::new(name, pen) })
            .collect();
        let drawing = Drawing { page: Page::new(10.0, 10.0), layers };
        let plot = lower(&drawing, InkModel::Ink, &Nibs::all(0.3), 0.01, &Interrupt::never()).unwrap();
        let pens: Vec<(u32, &str, usize)> = plot.pens.iter().map(|p| (p.number, p.name.as_str(), p.paths.len())).collect();
        assert_eq!(pens, [(1, "b", 1), (2, "a, c", 2)]);
    }
}
