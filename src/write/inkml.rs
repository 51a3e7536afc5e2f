//! `InkML` (W3C Recommendation, 20 September 2011): the strokes of a drawing as a pen would have recorded them, for painting
//! programs and everything else that knows digital ink.
//!
//! ```text
//! ink
//!   definitions
//!     context      inkSource/traceFormat: X and Y in mm, F (force) from 0 to 1000, T in ms from the timestamp
//!     brush        one for each layer: width, height, color, tip
//!   traceGroup     one for each layer, with its context and brush
//!     trace        one for each stroke: X Y F T at each vertex
//! ```

use super::number::thousandths;
use crate::drawing::{Area, Dot, Drawing, Layer, Mark, Stroke, Width};
use crate::geometry::{Point, flatten};
use std::fmt::Write as _;
use std::io;

/// How far a trace may lie from its curve, in millimetres: a tenth of a fine nib.
const TOLERANCE: f64 = 0.02;
/// Millimetres a second that are assumed where a style says nothing.
const USUAL_SPEED: f64 = 80.0;
/// The force of full pressure, in the device's steps.
const FULL_FORCE: f64 = 1000.0;
/// Seconds between two strokes where a style says nothing.
const USUAL_PAUSE: f64 = 0.2;

/// Writes a drawing as `InkML`. Strokes become one trace each with their pressure as force (their width's share of the layer's
/// widest where they have none); the outlines of dots and areas become traces at full force. `title` is
/// kept as an annotation.
pub fn write_inkml(drawing: &Drawing, title: &str, out: &mut impl io::Write) -> io::Result<()> {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ink xmlns=\"http://www.w3.org/2003/InkML\">\n");
    let _ = writeln!(text, "<annotation type=\"description\">{}</annotation>", escaped(title));
    definitions(&mut text, drawing);
    out.write_all(text.as_bytes())?;
    let mut now = 0.0;
    for (i, layer) in drawing.layers.iter().enumerate() {
        let mut text = format!("<traceGroup xml:id=\"layer{0}\" contextRef=\"#page\" brushRef=\"#brush{0}\">\n", i + 1);
        let _ = writeln!(text, "<annotation type=\"layer\">{} {}</annotation>", layer.pen, escaped(&layer.name));
        let widest = widest(layer);
        for mark in &layer.marks {
            for trace in traces(mark, widest, now) {
                now = trace.last().map_or(now, |vertex| vertex.time) + USUAL_PAUSE;
                write_trace(&mut text, &trace);
            }
        }
        text.push_str("</traceGroup>\n");
        out.write_all(text.as_bytes())?;
    }
    out.write_all(b"</ink>\n")
}

fn definitions(text: &mut String, drawing: &Drawing) {
    text.push_str("<definitions>\n<inkSource xml:id=\"hand\">\n<traceFormat xml:id=\"force-and-time\">\n");
    for (name, max) in [("X", drawing.page.width), ("Y", drawing.page.height)] {
        let _ = write!(text, "<channel name=\"{name}\" type=\"decimal\" units=\"mm\" min=\"0\" max=\"");
        plain_decimal(text, thousandths(max));
        text.push_str("\"/>\n");
    }
    let _ = writeln!(text, "<channel name=\"F\" type=\"integer\" units=\"dev\" min=\"0\" max=\"{FULL_FORCE}\"/>");
    text.push_str("<channel name=\"T\" type=\"integer\" units=\"ms\" min=\"0\" respectTo=\"#start\"/>\n");
    text.push_str("</traceFormat>\n</inkSource>\n<timestamp xml:id=\"start\" time=\"0\"/>\n");
    for (i, layer) in drawing.layers.iter().enumerate() {
        let mut width = String::new();
        plain_decimal(&mut width, thousandths(widest(layer)));
        let _ = writeln!(text, "<brush xml:id=\"brush{}\">", i + 1);
        for name in ["width", "height"] {
            let _ = writeln!(text, "<brushProperty name=\"{name}\" value=\"{width}\" units=\"mm\"/>");
        }
        let _ = writeln!(text, "<brushProperty name=\"color\" value=\"{}\"/>", layer.ink.colour());
        text.push_str("<brushProperty name=\"tip\" value=\"ellipse\"/>\n</brush>\n");
    }
    text.push_str("<context xml:id=\"page\" inkSourceRef=\"#hand\" traceFormatRef=\"#force-and-time\" timestampRef=\"#start\"/>\n</definitions>\n");
}

/// Width of a layer's brush: that of its widest stroke.
fn widest(layer: &Layer) -> f64 {
    let widths = layer.marks.iter().filter_map(|mark| if let Mark::Stroke(stroke) = mark { Some(stroke.widest()) } else { None });
    let widest = widths.fold(0.0, f64::max);
    if widest > 0.0 { widest } else { 0.1 }
}

/// A place of a trace: millimetres, force 0 to 1, seconds.
#[derive(Clone, Copy)]
struct Vertex {
    at: Point,
    force: f64,
    time: f64,
}

fn traces(mark: &Mark, widest: f64, now: f64) -> Vec<Vec<Vertex>> {
    let outline = |path: &kurbo::BezPath| -> Vec<Vec<Vertex>> {
        let mut now = now;
        flatten(path, TOLERANCE)
            .into_iter()
            .map(|(mut points, _)| {
                points.extend(points.first().copied());
                let trace = timed(&points, now);
                now = trace.last().map_or(now, |v| v.time) + USUAL_PAUSE;
                trace
            })
            .collect()
    };
    match mark {
        Mark::Stroke(stroke) => vec![stroke_trace(stroke, widest, now)],
        Mark::Area(Area { outline: path, .. }) => outline(path),
        Mark::Dot(Dot { centre, outline: None, .. }) => vec![timed(&[*centre], now)],
        Mark::Dot(Dot { outline: Some(path), .. }) => outline(path),
    }
}

/// Vertices at full force and the usual speed.
fn timed(points: &[Point], now: f64) -> Vec<Vertex> {
    let mut time = now;
    let mut before = points.first().copied();
    let vertex = |&at: &Point| {
        time += before.map_or(0.0, |b| b.distance(at)) / USUAL_SPEED;
        before = Some(at);
        Vertex { at, force: 1.0, time }
    };
    points.iter().map(vertex).collect()
}

/// A stroke's nodes with their force and time, and between them what its curves need.
fn stroke_trace(stroke: &Stroke, widest: f64, now: f64) -> Vec<Vertex> {
    let force = |node: usize| match (&stroke.pressure, &stroke.width) {
        (Some(pressure), _) => pressure[node],
        (None, Width::Along(widths)) => widths[node] / widest,
        (None, Width::Constant(width)) => width / widest,
    };
    let mut trace: Vec<Vertex> = Vec::new();
    for (i, segment) in stroke.curve.segments().enumerate() {
        let mut path = kurbo::BezPath::new();
        path.move_to(kurbo::ParamCurve::start(&segment));
        path.push(segment.as_path_el());
        let points = flatten(&path, TOLERANCE).swap_remove(0).0;
        let length: f64 = crate::geometry::polyline_length(&points);
        let from = trace.last().map_or(now, |v| v.time);
        let (from, to) = match &stroke.times {
            Some(times) => (times[i], times[i + 1]),
            None => (from, from + length / USUAL_SPEED),
        };
        let mut travelled = 0.0;
        for (k, &at) in points.iter().enumerate() {
            travelled += if k > 0 { points[k - 1].distance(at) } else { 0.0 };
            let t = if length > 0.0 { travelled / length } else { 1.0 };
            // The start of a segment is the end of the one before.
            if k > 0 || i == 0 {
                trace.push(Vertex { at, force: force(i) * (1.0 - t) + force(i + 1) * t, time: from + (to - from) * t });
            }
        }
    }
    trace
}

/// `X Y F T, X Y F T, ...`: millimetres to 0.001, force in steps, whole milliseconds.
fn write_trace(text: &mut String, trace: &[Vertex]) {
    if trace.is_empty() {
        return;
    }
    text.push_str("<trace>");
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

/// Thousandths as a decimal with a digit before its point, which `InkML`'s grammar asks for.
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
