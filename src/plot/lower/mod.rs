//! Lowering: from ink to the centre lines that a nib draws.
//!
//! A dot no larger than the nib is a touch, a larger one is filled with a spiral; dots smaller than the nib are thinned out, so that
//! tone stays. A line no wider than the nib is its centre line, a wider one passes side by side; areas are filled with rings that follow
//! their outline.

mod area;
mod dot;
mod stroke;
mod thin;

use super::{PenPaths, Plot, Toolpath};
use crate::drawing::{Drawing, Layer, Mark, Stroke};
use crate::geometry::{BezPath, flatten, simplify};
use area::fill_area;
use dot::fill_dot;
use std::collections::BTreeMap;
use stroke::fill_stroke;

/// What of a drawing a plotter draws.
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
    /// For pens that have none of their own.
    pub usual: f64,
    /// By pen number.
    pub by_pen: BTreeMap<u32, f64>,
}

impl Nibs {
    /// One width for all pens.
    pub const fn all(usual: f64) -> Self {
        Self { usual, by_pen: BTreeMap::new() }
    }

    /// The nib of a pen.
    pub fn of(&self, pen: u32) -> f64 {
        self.by_pen.get(&pen).copied().unwrap_or(self.usual)
    }
}

/// The tool paths of a drawing, layers of one pen together, curves flattened to `tolerance` millimetres.
pub fn lower(drawing: &Drawing, model: InkModel, nibs: &Nibs, tolerance: f64) -> Plot {
    let mut pens: Vec<PenPaths> = Vec::new();
    for layer in &drawing.layers {
        let nib = nibs.of(layer.pen);
        let kept = thin::keeps_tone(&layer.marks, nib);
        let marks = layer.marks.iter().zip(kept).filter(|(_, kept)| *kept).map(|(mark, _)| mark);
        let paths = marks.flat_map(|mark| lower_mark(mark, model, nib, tolerance));
        // A layer that asks for something of its own is drawn by itself.
        let is_alike = |pen: &&mut PenPaths| pen.number == layer.pen && pen.handling == layer.handling && !layer.handling.pauses;
        match pens.iter_mut().find(is_alike) {
            Some(pen) => {
                pen.name = format!("{}, {}", pen.name, layer.name);
                pen.paths.extend(paths);
            }
            None => pens.push(pen_of(layer, nib, paths.collect())),
        }
    }
    pens.sort_by_key(|pen| pen.number);
    Plot { page: drawing.page, pens }
}

fn pen_of(layer: &Layer, nib: f64, paths: Vec<Toolpath>) -> PenPaths {
    PenPaths { number: layer.pen, name: layer.name.clone(), colour: layer.ink.colour(), nib, handling: layer.handling, paths }
}

fn lower_mark(mark: &Mark, model: InkModel, nib: f64, tolerance: f64) -> Vec<Toolpath> {
    match (mark, model) {
        (Mark::Stroke(stroke), InkModel::Lines) => polylines(&stroke.curve, tolerance),
        (_, InkModel::Lines) => Vec::new(),
        (Mark::Dot(dot), InkModel::Ink) => vec![fill_dot(dot, nib, tolerance)],
        (Mark::Stroke(stroke), InkModel::Ink) => lower_stroke(stroke, nib, tolerance),
        (Mark::Area(area), InkModel::Ink) => fill_area(area, nib, tolerance),
    }
}

fn lower_stroke(stroke: &Stroke, nib: f64, tolerance: f64) -> Vec<Toolpath> {
    // A line hardly wider than the nib gains nothing from a second pass.
    if stroke.widest() <= 1.1 * nib {
        polylines(&stroke.curve, tolerance)
    } else {
        simplified(fill_stroke(stroke, nib), tolerance)
    }
}

/// Paths without the vertices that straight stretches do not need.
fn simplified(paths: Vec<Toolpath>, tolerance: f64) -> Vec<Toolpath> {
    paths.into_iter().map(|path| Toolpath::new(simplify(&path.points, 0.5 * tolerance))).collect()
}

/// A curve's subpaths as tool paths; one without length becomes a touch.
fn polylines(curve: &BezPath, tolerance: f64) -> Vec<Toolpath> {
    flatten(curve, tolerance)
        .into_iter()
        .filter(|(points, _)| points.iter().all(|p| p.is_finite()))
        .map(|(mut points, closed)| {
            if closed && points.len() > 1 {
                points.push(points[0]);
            }
            points.dedup();
            Toolpath::new(points)
        })
        .filter(|path| !path.points.is_empty())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Dot, Page, Width};
    use crate::geometry::Point;

    fn touch(x: f64, y: f64) -> Toolpath {
        Toolpath::new(vec![Point::new(x, y)])
    }

    #[test]
    fn small_dots_are_touches_and_large_ones_spirals_inside_their_border() {
        let mut layer = Layer::new("dots", 1);
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(5.0, 5.0), 0.15)));
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(8.0, 5.0), 1.0)));
        let drawing = Drawing { page: Page::new(10.0, 10.0), layers: vec![layer] };
        let plot = lower(&drawing, InkModel::Ink, &Nibs::all(0.3), 0.01);
        assert_eq!(plot.pens[0].paths[0], touch(5.0, 5.0));
        let spiral = &plot.pens[0].paths[1].points;
        assert_eq!(spiral[0], Point::new(8.0, 5.0));
        assert!(spiral.iter().all(|p| p.distance(Point::new(8.0, 5.0)) < 0.86));
        assert!(lower(&drawing, InkModel::Lines, &Nibs::all(0.3), 0.01).pens[0].paths.is_empty());
    }

    #[test]
    fn layers_of_one_pen_are_drawn_together() {
        let stroke = Mark::Stroke(Stroke::new(BezPath::from_svg("M0,0 L1,1").unwrap(), Width::Constant(0.3)));
        let layers = [("a", 2), ("b", 1), ("c", 2)]
            .into_iter()
            .map(|(name, pen)| Layer { marks: vec![stroke.clone()], ..Layer::new(name, pen) })
            .collect();
        let plot = lower(&Drawing { page: Page::new(10.0, 10.0), layers }, InkModel::Ink, &Nibs::all(0.3), 0.01);
        let pens: Vec<(u32, &str, usize)> = plot.pens.iter().map(|p| (p.number, p.name.as_str(), p.paths.len())).collect();
        assert_eq!(pens, [(1, "b", 1), (2, "a, c", 2)]);
    }
}
