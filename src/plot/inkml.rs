//! `InkML` (W3C Recommendation, 20 September 2011): the strokes of a drawing as a digital pen would record them, for painting
//! programs and other readers of digital ink.
//!
//! ```text
//! ink
//!   definitions
//!     context      inkSource/traceFormat: X and Y in mm, F (force) from 0 to 1000, T in ms from the timestamp
//!     brush        one per layer, and one per other colour or width: width, height, color, tip
//!   traceGroup     one per layer, with its context and brush
//!     trace        one per stroke and round dot, some per area: X Y F T at each vertex; its brush if not the layer's
//! ```
//!
//! Digital ink has lines only, so filled areas become hatch lines.

use super::{InkModel, Nibs, Toolpath, lower};
use crate::drawing::{Area, Colour, Dot, Drawing, Layer, Mark, Stroke, Width};
use crate::geometry::{BezPath, Point, flatten};
use crate::interrupt::Interrupt;
use crate::parallel::collected;
use crate::write::thousandths;
use kurbo::Shape;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io;

/// Maximum distance of a trace from its curve, in millimetres: a tenth of a fine nib.
const TOLERANCE: f64 = 0.02;
/// Default pen speed in mm/s, for strokes without times.
const USUAL_SPEED: f64 = 80.0;
/// The force of full pressure, in device steps.
const FULL_FORCE: f64 = 1000.0;
/// Default pause between two strokes, in seconds.
const USUAL_PAUSE: f64 = 0.2;
/// Width of the brush that fills an area, as a share of the square root of the area, and its maximum width in millimetres. Wider
/// brushes miss the corners and holes of grains, narrower ones need many lines.
const FILLING: f64 = 0.4;
const FILLING_WIDTH: f64 = 0.1;

/// Areas up to this size, in square millimetres, become one touch: their shape is not visible, and a smudged tone has tens of
/// thousands of them.
const LEAST_FILLED: f64 = 0.01;

/// Writes a drawing as `InkML`. Each stroke becomes one trace with its pressure as force (without pressure, its width as a share
/// of the layer's widest). A round dot is one vertex of a brush of its diameter. Other dots and areas are filled with traces.
/// Each trace has its mark's colour. `title` is written as an annotation.
pub fn write_inkml(drawing: &Drawing, title: &str, out: &mut impl io::Write) -> io::Result<()> {
    let layers: Vec<Vec<Drawn>> = drawing.layers.iter().map(drawn).collect();
    let brushes = Brushes::new(drawing, &layers);
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ink xmlns=\"http://www.w3.org/2003/InkML\">\n");
    let _ = writeln!(text, "<annotation type=\"description\">{}</annotation>", escaped(title));
    definitions(&mut text, drawing, &brushes);
    out.write_all(text.as_bytes())?;
    let mut now = 0.0;
    for (i, (layer, drawn)) in drawing.layers.iter().zip(&layers).enumerate() {
        let mut text = format!("<traceGroup xml:id=\"layer{0}\" contextRef=\"#page\" brushRef=\"#brush{0}\">\n", i + 1);
        let _ = writeln!(text, "<annotation type=\"layer\">{} {}</annotation>", layer.pen, escaped(&layer.name));
        let own = Brush::of(layer);
        for mark in drawn {
            for trace in mark.traces(own.width(), now) {
                now = trace.last().map_or(now, |vertex| vertex.time) + USUAL_PAUSE;
                let other = (mark.brush != own).then(|| brushes.numbers[&mark.brush]);
                write_trace(&mut text, &trace, other);
            }
        }
        text.push_str("</traceGroup>\n");
        out.write_all(text.as_bytes())?;
    }
    out.write_all(b"</ink>\n")
}

fn definitions(text: &mut String, drawing: &Drawing, brushes: &Brushes) {
    text.push_str("<definitions>\n<inkSource xml:id=\"hand\">\n<traceFormat xml:id=\"force-and-time\">\n");
    for (name, max) in [("X", drawing.page.width), ("Y", drawing.page.height)] {
        let _ = write!(text, "<channel name=\"{name}\" type=\"decimal\" units=\"mm\" min=\"0\" max=\"");
        plain_decimal(text, thousandths(max));
        text.push_str("\"/>\n");
    }
    let _ = writeln!(text, "<channel name=\"F\" type=\"integer\" units=\"dev\" min=\"0\" max=\"{FULL_FORCE}\"/>");
    text.push_str("<channel name=\"T\" type=\"integer\" units=\"ms\" min=\"0\" respectTo=\"#start\"/>\n");
    text.push_str("</traceFormat>\n</inkSource>\n<timestamp xml:id=\"start\" time=\"0\"/>\n");
    for (i, brush) in brushes.all.iter().enumerate() {
        let mut width = String::new();
        plain_decimal(&mut width, brush.thousandths);
        let _ = writeln!(text, "<brush xml:id=\"brush{}\">", i + 1);
        for name in ["width", "height"] {
            let _ = writeln!(text, "<brushProperty name=\"{name}\" value=\"{width}\" units=\"mm\"/>");
        }
        let [r, g, b] = brush.colour;
        let _ = writeln!(text, "<brushProperty name=\"color\" value=\"{}\"/>", Colour { r, g, b });
        text.push_str("<brushProperty name=\"tip\" value=\"ellipse\"/>\n</brush>\n");
    }
    text.push_str("<context xml:id=\"page\" inkSourceRef=\"#hand\" traceFormatRef=\"#force-and-time\" timestampRef=\"#start\"/>\n</definitions>\n");
}

/// The brush of a trace at full force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Brush {
    colour: [u8; 3],
    /// Width in thousandths of a millimetre.
    thousandths: i64,
}

impl Brush {
    fn new(colour: Colour, width: f64) -> Self {
        Self { colour: [colour.r, colour.g, colour.b], thousandths: thousandths(width).max(1) }
    }

    /// A layer's brush: its colour, and the width of its widest stroke.
    fn of(layer: &Layer) -> Self {
        let width = |mark: &Mark| if let Mark::Stroke(stroke) = mark { stroke.widest() } else { 0.0 };
        let widest = layer.marks.iter().map(width).fold(0.0, f64::max);
        Self::new(layer.ink.colour(), if widest > 0.0 { widest } else { FILLING_WIDTH })
    }

    fn width(self) -> f64 {
        self.thousandths as f64 / 1000.0
    }
}

/// All brushes of a file, those of the layers first.
struct Brushes {
    all: Vec<Brush>,
    /// The number of each brush, from 1.
    numbers: BTreeMap<Brush, usize>,
}

impl Brushes {
    fn new(drawing: &Drawing, layers: &[Vec<Drawn>]) -> Self {
        let all: Vec<Brush> = drawing.layers.iter().map(Brush::of).collect();
        let mut numbers = BTreeMap::new();
        all.iter().enumerate().for_each(|(i, brush)| {
            numbers.entry(*brush).or_insert(i + 1);
        });
        let mut brushes = Self { all, numbers };
        for drawn in layers.iter().flatten() {
            let next = brushes.all.len() + 1;
            if *brushes.numbers.entry(drawn.brush).or_insert(next) == next {
                brushes.all.push(drawn.brush);
            }
        }
        brushes
    }
}

/// A mark as brush lines.
struct Drawn<'a> {
    brush: Brush,
    way: Way<'a>,
}

enum Way<'a> {
    /// Along a stroke, with its width as force.
    Stroke(&'a Stroke),
    /// Along lines and touches at full force.
    Lines(Vec<Toolpath>),
}

fn drawn(layer: &Layer) -> Vec<Drawn<'_>> {
    let own = Brush::of(layer);
    let of_mark = |mark: usize| {
        let mark = &layer.marks[mark];
        let colour = mark.colour().unwrap_or(layer.ink.colour());
        match mark {
            Mark::Stroke(stroke) => Drawn { brush: Brush::new(colour, own.width()), way: Way::Stroke(stroke) },
            Mark::Dot(Dot { centre, radius, outline: None, .. }) => touch(*centre, *radius, colour),
            Mark::Dot(Dot { outline: Some(outline), .. }) => filled(outline, colour),
            Mark::Area(Area { outline, .. }) => filled(outline, colour),
        }
    };
    collected(layer.marks.len(), &of_mark)
}

fn touch(centre: Point, radius: f64, colour: Colour) -> Drawn<'static> {
    Drawn { brush: Brush::new(colour, 2.0 * radius), way: Way::Lines(vec![Toolpath::touch(centre)]) }
}

/// The lines that fill an outline with a fine pen, or a touch if it is too small for lines.
fn filled(outline: &BezPath, colour: Colour) -> Drawn<'static> {
    let area = outline.area().abs();
    let one_touch = || touch(outline.bounding_box().center(), (area / std::f64::consts::PI).sqrt(), colour);
    if area <= LEAST_FILLED {
        return one_touch();
    }
    let brush = Brush::new(colour, (FILLING * area.sqrt()).min(FILLING_WIDTH));
    let mut layer = Layer::new("", 1);
    layer.marks.push(Mark::Area(Area { outline: outline.clone(), colour: None }));
    let page = crate::drawing::Page::new(1.0, 1.0);
    let drawing = Drawing { page, layers: vec![layer] };
    let plot = lower(&drawing, InkModel::Ink, &Nibs::all(brush.width()), TOLERANCE, &Interrupt::never());
    let pens = plot.map(|plot| plot.pens).unwrap_or_default();
    let lines: Vec<Toolpath> = pens.into_iter().flat_map(|pen| pen.paths).collect();
    if lines.is_empty() { one_touch() } else { Drawn { brush, way: Way::Lines(lines) } }
}

impl Drawn<'_> {
    /// The traces, starting at time `now` in seconds.
    fn traces(&self, widest: f64, now: f64) -> Vec<Vec<Vertex>> {
        match &self.way {
            Way::Stroke(stroke) => vec![stroke_trace(stroke, widest, now)],
            Way::Lines(lines) => {
                let mut now = now;
                let timed = |line: &Toolpath| {
                    let trace = timed(line, now);
                    now = trace.last().map_or(now, |vertex| vertex.time) + USUAL_PAUSE;
                    trace
                };
                lines.iter().map(timed).collect()
            }
        }
    }
}

/// A vertex of a trace: position in millimetres, force 0 to 1, time in seconds.
#[derive(Clone, Copy)]
struct Vertex {
    at: Point,
    force: f64,
    time: f64,
}

/// Vertices at full force and the default speed.
fn timed(line: &Toolpath, now: f64) -> Vec<Vertex> {
    let (mut time, mut before) = (now, line.first());
    let vertex = |&at: &Point| {
        time += before.distance(at) / USUAL_SPEED;
        before = at;
        Vertex { at, force: 1.0, time }
    };
    line.points().iter().map(vertex).collect()
}

/// A stroke's nodes with their force and time, and the points between them that flatten its curves.
fn stroke_trace(stroke: &Stroke, widest: f64, now: f64) -> Vec<Vertex> {
    let force = |node: usize| match (stroke.pressure(), stroke.width()) {
        (Some(pressure), _) => pressure[node],
        (None, Width::Along(widths)) => widths[node] / widest,
        (None, Width::Constant(width)) => width / widest,
    };
    let mut trace: Vec<Vertex> = Vec::new();
    for (i, segment) in stroke.curve().segments().enumerate() {
        let mut path = kurbo::BezPath::new();
        path.move_to(kurbo::ParamCurve::start(&segment));
        path.push(segment.as_path_el());
        let points = flatten(&path, TOLERANCE).swap_remove(0).0;
        let length: f64 = crate::geometry::polyline_length(&points);
        let from = trace.last().map_or(now, |v| v.time);
        let (from, to) = match stroke.times() {
            Some(times) => (times[i], times[i + 1]),
            None => (from, from + length / USUAL_SPEED),
        };
        let mut travelled = 0.0;
        for (k, &at) in points.iter().enumerate() {
            travelled += if k > 0 { points[k - 1].distance(at) } else { 0.0 };
            let t = if length > 0.0 { travelled / length } else { 1.0 };
            // Skip the start of a segment: it is the end of the one before.
            if k > 0 || i == 0 {
                trace.push(Vertex { at, force: force(i) * (1.0 - t) + force(i + 1) * t, time: from + (to - from) * t });
            }
        }
    }
    trace
}

/// Writes `X Y F T, X Y F T, ...`: millimetres to 0.001, force in steps, whole milliseconds. `brush` is the number of a brush
/// other than the layer's.
fn write_trace(text: &mut String, trace: &[Vertex], brush: Option<usize>) {
    if trace.is_empty() {
        return;
    }
    match brush {
        Some(number) => {
            let _ = write!(text, "<trace brushRef=\"#brush{number}\">");
        }
        None => text.push_str("<trace>"),
    }
    for (i, vertex) in trace.iter().enumerate() {
        if i > 0 {
            text.push_str(", ");
        }
        plain_decimal(text, thousandths(vertex.at.x));
        text.push(' ');
        plain_decimal(text, thousandths(vertex.at.y));
        let (force, time) = (vertex.force.clamp(0.0, 1.0) * FULL_FORCE, vertex.time * 1000.0);
        let _ = write!(text, " {} {}", force.round() as i64, time.round() as i64);
    }
    text.push_str("</trace>\n");
}

/// Appends thousandths as a decimal with a digit before the point, which `InkML`'s grammar requires.
fn plain_decimal(text: &mut String, value: i64) {
    let (sign, size) = (if value < 0 { "-" } else { "" }, value.unsigned_abs());
    let _ = write!(text, "{sign}{}", size / 1000);
    if size % 1000 > 0 {
        let part = format!("{:03}", size % 1000);
        let _ = write!(text, ".{}", part.trim_end_matches('0'));
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
