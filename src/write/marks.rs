//! A drawing as data: one JSON object with the marks of each layer, for programs.
//!
//! ```text
//! {"drypoint": version, "page_mm": [width, height], "paper": "#rrggbb", "layers": [
//!   {"name", "pen", "pen_mm", "color",
//!    "dots":    [[x, y, radius], ...],  "outlines": [[index of the dot, ring], ...],
//!    "strokes": [{"points": [[x, y], ...], "widths": [...], "closed"}, ...],
//!    "areas":   [[ring, ...], ...], "order": [n, ...]}]}
//! ```
//!
//! Lengths are in millimetres on the grid of 0.001 mm. A ring is a closed polygon without its first point again; areas are filled by
//! the nonzero rule. `outlines` gives the shape of dots that are no discs. A mark with a colour of its own stands in `colors`, by
//! kind and index. `order` gives the order in which marks are laid, if it is not dots, strokes, areas: mark n is a dot, and from the
//! number of dots on a stroke, and then an area.

use crate::drawing::{Area, Dot, Drawing, Layer, Mark, Stroke, Width};
use crate::geometry::{BezPath, Point, flatten};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io;

/// Maximum distance of a polyline from its curve, in millimetres: a fifth of a fine nib's step at 600 dpi.
const TOLERANCE: f64 = 0.01;
/// Distance of points along a stroke whose width changes, in millimetres: half a fine nib, so that a width between two points is
/// the mean of theirs.
const SPACING: f64 = 0.15;

#[derive(Serialize)]
struct Sheet<'a> {
    drypoint: &'static str,
    page_mm: [f64; 2],
    paper: String,
    layers: Vec<LayerData<'a>>,
}

#[derive(Serialize)]
struct LayerData<'a> {
    name: &'a str,
    pen: u32,
    /// The nib's width; 0 if each mark has its own.
    pen_mm: f64,
    color: String,
    dots: Vec<[f64; 3]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    outlines: Vec<(usize, Ring)>,
    strokes: Vec<StrokeData>,
    areas: Vec<Vec<Ring>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    order: Vec<usize>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    colors: BTreeMap<&'static str, BTreeMap<usize, String>>,
}

#[derive(Serialize)]
struct StrokeData {
    points: Vec<[f64; 2]>,
    widths: Vec<f64>,
    closed: bool,
}

type Ring = Vec<[f64; 2]>;

/// Writes the marks. `nib` is the width in millimetres of the pen that draws a layer, by its index; 0 if there is none.
pub fn write_marks(drawing: &Drawing, nib: impl Fn(usize) -> f64, out: &mut impl io::Write) -> io::Result<()> {
    let layers = drawing.layers.iter().enumerate();
    let sheet = Sheet {
        drypoint: env!("CARGO_PKG_VERSION"),
        page_mm: [grid(drawing.page.width), grid(drawing.page.height)],
        paper: drawing.page.paper.to_string(),
        layers: layers.map(|(i, layer)| LayerData::of(layer, nib(i))).collect(),
    };
    serde_json::to_writer(&mut *out, &sheet)?;
    out.write_all(b"\n")
}

/// A length on the grid of files; never minus zero.
fn grid(mm: f64) -> f64 {
    super::thousandths(mm) as f64 / 1000.0
}

fn place(p: Point) -> [f64; 2] {
    [grid(p.x), grid(p.y)]
}

fn rings(outline: &BezPath) -> Vec<Ring> {
    flatten(outline, TOLERANCE).into_iter().map(|(points, _)| points.into_iter().map(place).collect()).collect()
}

/// The places of a layer's marks among its dots, strokes and areas; empty if they lie in that order.
fn order(layer: &Layer) -> Vec<usize> {
    let kind = |mark: &Mark| match mark {
        Mark::Dot(_) => 0,
        Mark::Stroke(_) => 1,
        Mark::Area(_) => 2,
    };
    if layer.marks.is_sorted_by_key(kind) {
        return Vec::new();
    }
    let [dots, strokes, _] = layer.counts();
    let mut next = [0, dots, dots + strokes];
    let mut place = |mark| {
        let next = &mut next[kind(mark)];
        *next += 1;
        *next - 1
    };
    layer.marks.iter().map(&mut place).collect()
}

impl<'a> LayerData<'a> {
    fn of(layer: &'a Layer, nib: f64) -> Self {
        let mut data = Self {
            name: &layer.name,
            pen: layer.pen,
            pen_mm: grid(nib),
            color: layer.ink.colour().to_string(),
            dots: Vec::new(),
            outlines: Vec::new(),
            strokes: Vec::new(),
            areas: Vec::new(),
            order: order(layer),
            colors: BTreeMap::new(),
        };
        layer.marks.iter().for_each(|mark| data.add(mark));
        data
    }

    fn add(&mut self, mark: &Mark) {
        let (kind, index) = match mark {
            Mark::Dot(Dot { centre, radius, outline, .. }) => {
                let index = self.dots.len();
                self.dots.push([grid(centre.x), grid(centre.y), grid(*radius)]);
                self.outlines.extend(outline.iter().flat_map(|outline| rings(outline)).map(|ring| (index, ring)));
                ("dots", index)
            }
            Mark::Stroke(stroke) => {
                self.strokes.push(StrokeData::of(stroke));
                ("strokes", self.strokes.len() - 1)
            }
            Mark::Area(Area { outline, .. }) => {
                self.areas.push(rings(outline));
                ("areas", self.areas.len() - 1)
            }
        };
        if let Some(colour) = mark.colour() {
            self.colors.entry(kind).or_default().insert(index, colour.to_string());
        }
    }
}

impl StrokeData {
    fn of(stroke: &Stroke) -> Self {
        let (points, widths) = match *stroke.width() {
            Width::Constant(width) => {
                // A stroke is one subpath.
                let points = flatten(stroke.curve(), TOLERANCE).into_iter().next().map(|(points, _)| points).unwrap_or_default();
                let widths = vec![width; points.len()];
                (points, widths)
            }
            Width::Along(_) => stroke.sampled(SPACING),
        };
        Self {
            points: points.into_iter().map(place).collect(),
            widths: widths.into_iter().map(grid).collect(),
            closed: stroke.is_closed(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Colour, Page};
    use serde_json::json;

    #[test]
    fn every_mark_is_written_with_its_shape_and_colour() {
        let curve = |text| BezPath::from_svg(text).unwrap();
        let mut layer = Layer::new("marks", 2);
        let blob = Dot { outline: Some(Box::new(curve("M0,0 L1,0 L0,1 Z"))), ..Dot::circle(Point::new(0.3, 0.3), 0.4) };
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(1.0, 2.0), 0.25)));
        layer.marks.push(Mark::Dot(blob));
        layer.marks.push(Mark::Stroke(Stroke::swelling(curve("M0,0 L0.1,0"), vec![0.1, 0.2]).unwrap()));
        layer.marks.push(Mark::Stroke(Stroke::even(curve("M0,0 L3,0 L3,3 Z"), 0.3).with_colour(Some(Colour::WHITE))));
        layer.marks.push(Mark::Area(Area { outline: curve("M0,0 L4,0 L4,4 Z M1,1 L2,1 L2,2 Z"), colour: None }));
        let drawing = Drawing { page: Page::new(10.0, 20.0), layers: vec![layer] };
        let mut bytes = Vec::new();
        write_marks(&drawing, |_| 0.3, &mut bytes).unwrap();
        let read: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
        assert_eq!((&read["page_mm"], &read["paper"]), (&json!([10.0, 20.0]), &json!("#ffffff")));
        let layer = &read["layers"][0];
        assert_eq!(layer["dots"], json!([[1.0, 2.0, 0.25], [0.3, 0.3, 0.4]]));
        assert_eq!(layer["outlines"], json!([[1, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]]]));
        assert_eq!(layer["strokes"][0], json!({"points": [[0.0, 0.0], [0.1, 0.0]], "widths": [0.1, 0.2], "closed": false}));
        assert!(layer.get("order").is_none());
        assert_eq!(
            layer["strokes"][1],
            json!({"points": [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0]], "widths": [0.3, 0.3, 0.3], "closed": true})
        );
        assert_eq!(layer["areas"][0].as_array().unwrap().len(), 2);
        assert_eq!(layer["colors"], json!({"strokes": {"1": "#ffffff"}}));
    }

    #[test]
    fn marks_that_are_mixed_keep_their_order() {
        let dot = || Mark::Dot(Dot::circle(Point::ZERO, 0.2));
        let stroke = || Mark::Stroke(Stroke::even(BezPath::from_svg("M0,0 L1,0").unwrap(), 0.3));
        let layer = Layer { marks: vec![stroke(), dot(), stroke(), dot()], ..Layer::new("mixed", 1) };
        assert_eq!(order(&layer), [2, 0, 3, 1]);
        assert!(order(&Layer { marks: vec![dot(), dot(), stroke()], ..Layer::new("sorted", 1) }).is_empty());
    }
}
