//! Marks as PDF path operators, in millimetres on the grid of 0.001 mm.

use super::ink::{Inks, MULTIPLY, Paint};
use crate::drawing::{Dot, Drawing, Ends, Layer, Mark, Stroke, Width};
use crate::geometry::{BezPath, Point};
use crate::write::{decimal, thousandths};
use kurbo::PathEl;
use std::fmt::Write as _;

/// The paper's resource name.
pub(super) const PAPER: &str = "P";
/// Bytes after which a new piece of content begins, so that pieces can be compressed in parallel.
const PIECE: usize = 1 << 20;
/// A disc of radius 1 around the origin. Repeated for each dot after the matrix that places it: compressed, a repetition costs
/// three bytes (100,000 dots are 1.1 MB, against 5.2 MB as separate curves). A form `XObject` saves a tenth more, but layout
/// programs wrap each use in a clipped group, and readers take half as long again. The handles are 0.551785 of the radius, which
/// gives the disc's exact area.
const DISC: &str = " cm 1 0 m 1 .551785 .551785 1 0 1 c -.551785 1 -1 .551785 -1 0 c -1 -.551785 -.551785 -1 0 -1 c .551785 -1 1 -.551785 1 0 c f Q\n";

/// The resource name of the i-th layer.
pub(super) fn layer_name(i: usize) -> String {
    format!("L{i}")
}

/// The resource name of the i-th layer's group of marks.
pub(super) fn group_name(i: usize) -> String {
    format!("G{i}")
}

/// What is drawn.
pub(super) struct Content {
    /// The page's content, split between marks into consecutive pieces.
    pub pieces: Vec<String>,
    /// The marks of layers that are multiplied with those below, by the layer's number: groups in millimetres, y down.
    pub groups: Vec<(usize, String)>,
}

impl Content {
    pub(super) fn of(drawing: &Drawing, inks: &Inks<'_>, units_per_mm: f64) -> Self {
        let groups = drawing.layers.iter().enumerate().filter(|(_, layer)| inks.is_multiplied(layer));
        let groups = groups.map(|(i, layer)| (i, Writer::default().whole(layer, inks))).collect();
        Self { pieces: pieces(drawing, inks, units_per_mm), groups }
    }
}

fn pieces(drawing: &Drawing, inks: &Inks<'_>, units_per_mm: f64) -> Vec<String> {
    let mut writer = Writer::default();
    // From here on lengths are in millimetres, y down, from the sheet's upper left corner.
    let (page, scale) = (&drawing.page, units_per_mm);
    let _ = writeln!(writer.text, "{scale:.10} 0 0 -{scale:.10} 0 {:.6} cm 1 j", page.height * scale);
    if super::has_paper(drawing) {
        let _ = write!(writer.text, "/OC /{PAPER} BDC\nq ");
        Paint::covering(page.paper).select(&mut writer.text, inks);
        let _ = writeln!(writer.text, "0 0 {} {} re f Q\nEMC", page.width, page.height);
    }
    for (i, layer) in drawing.layers.iter().enumerate() {
        let _ = writeln!(writer.text, "/OC /{} BDC\nq", layer_name(i));
        if inks.is_multiplied(layer) {
            let _ = writeln!(writer.text, "/{MULTIPLY} gs /{} Do", group_name(i));
        } else {
            writer.layer(layer, inks);
        }
        writer.text.push_str("Q\nEMC\n");
    }
    writer.pieces.push(writer.text);
    writer.pieces
}

/// The current graphics state, which need not be set again.
#[derive(Default)]
struct Pen {
    paint: Option<Paint>,
    width: Option<i64>,
    ends: Option<Ends>,
}

#[derive(Default)]
struct Writer {
    pieces: Vec<String>,
    text: String,
    pen: Pen,
}

impl Writer {
    /// A layer's marks in one piece.
    fn whole(mut self, layer: &Layer, inks: &Inks<'_>) -> String {
        self.text.push_str("1 j\n");
        self.layer(layer, inks);
        self.pieces.push(self.text);
        self.pieces.concat()
    }

    fn layer(&mut self, layer: &Layer, inks: &Inks<'_>) {
        self.pen = Pen::default();
        for mark in &layer.marks {
            self.mark(mark, layer, inks);
        }
    }

    fn mark(&mut self, mark: &Mark, layer: &Layer, inks: &Inks<'_>) {
        let paint = Paint::of(layer, mark.colour(), inks);
        if self.pen.paint != Some(paint) {
            paint.select(&mut self.text, inks);
            self.pen.paint = Some(paint);
        }
        match mark {
            Mark::Dot(Dot { outline: Some(outline), .. }) => self.filled(outline),
            Mark::Dot(Dot { centre, radius, .. }) => self.disc(*centre, *radius),
            Mark::Stroke(stroke) => match *stroke.width() {
                Width::Constant(width) => self.line(stroke, thousandths(width)),
                Width::Along(_) => self.filled(&stroke.outline().unwrap_or_default()),
            },
            Mark::Area(area) => self.filled(&area.outline),
        }
        if self.text.len() > PIECE {
            self.pieces.push(std::mem::take(&mut self.text));
        }
    }

    fn disc(&mut self, centre: Point, radius: f64) {
        let text = &mut self.text;
        // One more digit than elsewhere: 0.001 mm of a small dot's radius is a percent of its ink.
        let radius = (radius * 10_000.0).round() as i64;
        text.push_str("q ");
        decimal(text, radius, 4);
        text.push_str(" 0 0 ");
        decimal(text, radius, 4);
        text.push(' ');
        point(text, centre);
        text.push_str(DISC);
    }

    fn line(&mut self, stroke: &Stroke, width: i64) {
        // In PDF, a width of 0 is the device's thinnest line, not an invisible one.
        if width == 0 || stroke.curve().elements().is_empty() {
            return;
        }
        if self.pen.width != Some(width) {
            decimal(&mut self.text, width, 3);
            self.text.push_str(" w ");
            self.pen.width = Some(width);
        }
        if self.pen.ends != Some(stroke.ends) {
            self.text.push_str(if stroke.ends == Ends::Round { "1 J " } else { "0 J " });
            self.pen.ends = Some(stroke.ends);
        }
        path(&mut self.text, stroke.curve());
        self.text.push_str("S\n");
    }

    fn filled(&mut self, outline: &BezPath) {
        if !outline.elements().is_empty() {
            path(&mut self.text, outline);
            self.text.push_str("f\n");
        }
    }
}

fn point(text: &mut String, p: Point) {
    decimal(text, thousandths(p.x), 3);
    text.push(' ');
    decimal(text, thousandths(p.y), 3);
}

/// Appends path construction operators; quadratic curves are written as equal cubics.
fn path(text: &mut String, path: &BezPath) {
    let mut at = Point::ORIGIN;
    for element in path.elements() {
        let (points, operator): (&[Point], &str) = match element {
            PathEl::MoveTo(p) => (&[*p], " m "),
            PathEl::LineTo(p) => (&[*p], " l "),
            PathEl::QuadTo(a, p) => (&[at.lerp(*a, 2.0 / 3.0), p.lerp(*a, 2.0 / 3.0), *p], " c "),
            PathEl::CurveTo(a, b, p) => (&[*a, *b, *p], " c "),
            PathEl::ClosePath => (&[], "h "),
        };
        for (i, p) in points.iter().enumerate() {
            if i > 0 {
                text.push(' ');
            }
            point(text, *p);
            at = *p;
        }
        text.push_str(operator);
    }
}
