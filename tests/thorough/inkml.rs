//! Digital ink, read back: colours, widths of dots and filled areas match the drawing.

use crate::any_style;
use crate::common;
use crate::rasterised;

use any_style::Order;
use common::sample;
use drypoint::drawing::{Area, Colour, Dot, Drawing, Ink, Layer, Mark, Page, Stroke};
use drypoint::geometry::{BezPath, Point};
use drypoint::plot::write_inkml;
use rasterised::{Pixels, rasterised};
use std::collections::BTreeMap;

const INKML: &str = "http://www.w3.org/2003/InkML";
const RED: Colour = Colour { r: 200, g: 20, b: 30 };
const BLUE: Colour = Colour { r: 10, g: 60, b: 220 };

/// A trace as a reader draws it: discs of the brush's width times force, and the areas between consecutive discs.
struct Trace {
    colour: Colour,
    width: f64,
    /// Position, and force from 0 to 1.
    vertices: Vec<(Point, f64)>,
}

fn read(text: &str) -> Vec<Trace> {
    let document = roxmltree::Document::parse(text).unwrap();
    let brushes: BTreeMap<String, (Colour, f64)> = document
        .descendants()
        .filter(|n| n.has_tag_name((INKML, "brush")))
        .map(|brush| {
            let property = |name| brush.children().find(|n| n.attribute("name") == Some(name)).unwrap();
            assert_eq!(property("width").attribute("units"), Some("mm"));
            assert_eq!(property("width").attribute("value"), property("height").attribute("value"));
            let id = brush.attributes().find(|a| a.name() == "id").unwrap().value();
            let colour = property("color").attribute("value").unwrap().parse().unwrap();
            (format!("#{id}"), (colour, property("width").attribute("value").unwrap().parse().unwrap()))
        })
        .collect();
    let traces = document.descendants().filter(|n| n.has_tag_name((INKML, "trace")));
    traces
        .map(|trace| {
            let (colour, width) = brushes[trace.ancestors().find_map(|n| n.attribute("brushRef")).unwrap()];
            let vertex = |text: &str| {
                let v: Vec<f64> = text.split_whitespace().map(|v| v.parse().unwrap()).collect();
                (Point::new(v[0], v[1]), v[2] / 1000.0)
            };
            Trace { colour, width, vertices: trace.text().unwrap().split(',').map(vertex).collect() }
        })
        .collect()
}

fn written(drawing: &Drawing) -> String {
    let mut bytes = Vec::new();
    write_inkml(drawing, "test", &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// The traces as marks.
fn drawn(traces: &[Trace], page: Page) -> Drawing {
    let mut layer = Layer::new("ink", 1);
    layer.marks = traces
        .iter()
        .map(|trace| {
            let widths: Vec<f64> = trace.vertices.iter().map(|(_, force)| trace.width * force).collect();
            if let [(at, _)] = trace.vertices[..] {
                return Mark::Dot(Dot { colour: Some(trace.colour), ..Dot::circle(at, 0.5 * widths[0]) });
            }
            let mut curve = BezPath::new();
            curve.move_to(trace.vertices[0].0);
            trace.vertices[1..].iter().for_each(|(p, _)| curve.line_to(*p));
            let is_even = widths.iter().all(|w| (w - widths[0]).abs() < 1e-9);
            let stroke = if is_even { Stroke::even(curve, widths[0]) } else { Stroke::swelling(curve, widths).unwrap() };
            Mark::Stroke(stroke.with_colour(Some(trace.colour)))
        })
        .collect();
    Drawing { page, layers: vec![layer] }
}

fn differs(a: &Pixels, b: &Pixels) -> f64 {
    let off = a.rgb.iter().zip(&b.rgb).map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / 3.0);
    off.sum::<f64>() / a.rgb.len() as f64
}

#[test]
fn colours_widths_and_fills_are_read_back() {
    let mut layer = Layer { ink: Ink::Colour(BLUE), ..Layer::new("marks", 1) };
    let line = BezPath::from_svg("M2,2 L18,2").unwrap();
    layer.marks.push(Mark::Stroke(Stroke::even(line.clone(), 0.5)));
    layer.marks.push(Mark::Stroke(Stroke::even(line, 0.25).with_colour(Some(RED))));
    layer.marks.push(Mark::Dot(Dot::circle(Point::new(5.0, 8.0), 0.7)));
    layer.marks.push(Mark::Dot(Dot { colour: Some(RED), ..Dot::circle(Point::new(9.0, 8.0), 0.15) }));
    let outline = BezPath::from_svg("M12,6 h5 v5 h-5 Z M14,8 v1 h1 v-1 Z").unwrap();
    layer.marks.push(Mark::Area(Area { outline, colour: Some(RED) }));
    let drawing = Drawing { page: Page::new(20.0, 14.0), layers: vec![layer] };
    let traces = read(&written(&drawing));
    let told: Vec<(Colour, f64)> = traces.iter().take(4).map(|t| (t.colour, t.width * t.vertices[0].1)).collect();
    assert_eq!(told, [(BLUE, 0.5), (RED, 0.25), (BLUE, 1.4), (RED, 0.3)]);
    assert!(traces.len() > 4 && traces[4..].iter().all(|t| t.colour == RED), "the area is filled with lines");
    let (own, back) = (rasterised(&drawing, 20.0), rasterised(&drawn(&traces, drawing.page), 20.0));
    let off = differs(&own, &back);
    assert!(off < 0.004, "{off}");
    let inside = |x: f64, y: f64| back.rgb[(y * 20.0) as usize * back.width + (x * 20.0) as usize];
    assert!(inside(13.0, 7.0)[2] < 0.3 && inside(16.0, 10.0)[2] < 0.3, "the area is red");
    assert!(inside(14.5, 8.5)[2] > 0.9, "its hole is bare");
}

#[test]
fn every_style_s_ink_is_read_back() {
    let photo = sample("bust-light.png");
    for (style, set, most) in [
        ("hedcut", &[("blob", "0.5")][..], 0.03),
        ("grid", &[("primitive", "tile")], 0.03),
        ("engrave", &[], 0.03),
        ("charcoal", &[("shading", "off"), ("background", "off"), ("features", "off")], 0.05),
        ("glass", &[], 0.03),
    ] {
        let mut drawing = Order::new(style, &photo, (24.0, 32.0), set).draw();
        if style == "charcoal" {
            // Its pressure is the hand's, not the width; grains have none.
            drawing.layers.retain(|layer| layer.name == "tone");
        }
        let own = rasterised(&drawing, 16.0);
        let traces = read(&written(&drawing));
        let back = rasterised(&drawn(&traces, drawing.page), 16.0);
        let off = differs(&own, &back);
        println!("{style}: {} traces for {} marks, mean difference {off:.4}", traces.len(), drawing.marks().count());
        assert!(off <= most, "{style}: {off}");
    }
}
