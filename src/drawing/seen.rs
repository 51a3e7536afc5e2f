//! The visible ink of a drawing: opaque paint covers what lies below it, so it counts once.

use std::ops::Range;

use super::{Drawing, Layer, Mark, Mixing};
use crate::geometry::{BezPath, Rect, flatten};
use crate::parallel::{mapped, shares};

/// Distance of the scan lines along which paint is measured, in millimetres; along a line the measure is exact. At 0.05 a
/// painting's ink is off by less than 0.05 %.
const LINE: f64 = 0.05;
/// Maximum scan lines per page: a large page is measured more coarsely.
const MOST_LINES: f64 = 20_000.0;
/// Flattening tolerance of outlines, in millimetres.
const TOLERANCE: f64 = 0.002;
/// Scan lines measured together.
const BAND: usize = 64;

impl Drawing {
    /// Ink of each layer in square millimetres: for transparent ink the sum of its marks, for opaque paint its visible part. Ink
    /// hidden under paint still counts, as the press prints it.
    pub fn ink_mm2(&self) -> Vec<f64> {
        let is_paint = |layer: &&Layer| layer.mixing == Mixing::Paint;
        let painted = self.layers.iter().filter(is_paint).flat_map(|layer| &layer.marks);
        let Some(bounds) = painted.map(Mark::bounding_box).reduce(|a, b| a.union(b)) else {
            return self.layers.iter().map(Layer::ink_mm2).collect();
        };
        let lines = Lines::over(bounds);
        let mut seen: Vec<f64> = self.layers.iter().map(|layer| if is_paint(&layer) { 0.0 } else { layer.ink_mm2() }).collect();
        // From the top down, each layer adds what no paint above it covers.
        let mut above: Vec<Spans> = vec![Spans::new(); lines.count];
        for (ink, layer) in seen.iter_mut().zip(&self.layers).rev().filter(|(_, layer)| is_paint(layer)) {
            let before: f64 = above.iter().map(|spans| length(spans)).sum();
            lines.add(&mut above, layer);
            *ink = (above.iter().map(|spans| length(spans)).sum::<f64>() - before) * lines.step;
        }
        seen
    }
}

/// Disjoint intervals of one line from left to right.
type Spans = Vec<(f64, f64)>;

fn length(spans: &[(f64, f64)]) -> f64 {
    spans.iter().map(|(from, to)| to - from).sum()
}

/// Evenly spaced horizontal lines.
struct Lines {
    top: f64,
    step: f64,
    count: usize,
}

impl Lines {
    fn over(bounds: Rect) -> Self {
        let step = LINE.max(bounds.height() / MOST_LINES);
        Self { top: bounds.y0, step, count: (bounds.height() / step).ceil().max(1.0) as usize }
    }

    /// Adds what a layer's marks cover.
    fn add(&self, covered: &mut [Spans], layer: &Layer) {
        let marks: Vec<Vec<Edge>> = mapped(&layer.marks, &|mark| self.edges(&ink_outline(mark)));
        let reach: Vec<Range<usize>> = marks.iter().map(|edges| reach(edges)).collect();
        shares(covered, BAND, &|band, rows| {
            let (first, end) = (band * BAND, band * BAND + rows.len());
            let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); rows.len()];
            for (edges, reach) in marks.iter().zip(&reach).filter(|(_, reach)| reach.start < end && reach.end > first) {
                for edge in edges {
                    for line in edge.lines.start.max(first)..edge.lines.end.min(end) {
                        crossings[line - first].push((edge.at(self.height(line)), edge.winding));
                    }
                }
                for line in reach.start.max(first)..reach.end.min(end) {
                    append_inside(&mut rows[line - first], &mut crossings[line - first]);
                }
            }
            rows.iter_mut().for_each(join);
        });
    }

    fn height(&self, line: usize) -> f64 {
        self.top + (line as f64 + 0.5) * self.step
    }

    /// The sides of an outline that cross lines.
    fn edges(&self, outline: &BezPath) -> Vec<Edge> {
        let mut edges = Vec::new();
        for (polygon, _) in flatten(outline, TOLERANCE) {
            for (i, a) in polygon.iter().enumerate() {
                let b = polygon[(i + 1) % polygon.len()];
                let (a, b) = ((a.x, a.y), (b.x, b.y));
                let (top, bottom, winding) = if a.1 < b.1 { (a, b, 1) } else { (b, a, -1) };
                let lines = self.crossed(top.1, bottom.1);
                if !lines.is_empty() {
                    edges.push(Edge { top, bottom, winding, lines });
                }
            }
        }
        edges
    }

    /// The lines from one height to another, including the first and excluding the last.
    fn crossed(&self, top: f64, bottom: f64) -> Range<usize> {
        let index = |y: f64| ((y - self.top) / self.step - 0.5).ceil().clamp(0.0, self.count as f64) as usize;
        index(top)..index(bottom)
    }
}

/// A side of an outline, from its upper end down. `winding` is +1 if the outline runs downwards along it, else -1.
struct Edge {
    top: (f64, f64),
    bottom: (f64, f64),
    winding: i32,
    /// The lines that it crosses.
    lines: Range<usize>,
}

impl Edge {
    fn at(&self, y: f64) -> f64 {
        self.top.0 + (self.bottom.0 - self.top.0) * (y - self.top.1) / (self.bottom.1 - self.top.1)
    }
}

fn ink_outline(mark: &Mark) -> BezPath {
    match mark {
        Mark::Dot(dot) => dot.path(),
        Mark::Stroke(stroke) => stroke.ink_outline(TOLERANCE),
        Mark::Area(area) => area.outline.clone(),
    }
}

/// The lines that these edges cross, from the first to the last.
fn reach(edges: &[Edge]) -> Range<usize> {
    edges.iter().map(|edge| edge.lines.clone()).reduce(|a, b| a.start.min(b.start)..a.end.max(b.end)).unwrap_or(0..0)
}

/// Adds the intervals of a line inside one outline, by the nonzero rule, and clears its crossings.
fn append_inside(spans: &mut Spans, crossings: &mut Vec<(f64, i32)>) {
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut winding, mut from) = (0, 0.0);
    for (x, turn) in crossings.drain(..) {
        if winding == 0 {
            from = x;
        }
        winding += turn;
        if winding == 0 {
            spans.push((from, x));
        }
    }
}

/// Merges overlapping intervals.
fn join(spans: &mut Spans) {
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut joined: Spans = Vec::with_capacity(spans.len());
    for &(from, to) in spans.iter() {
        match joined.last_mut() {
            Some(last) if from <= last.1 => last.1 = last.1.max(to),
            _ => joined.push((from, to)),
        }
    }
    *spans = joined;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Area, Dot, Page};
    use crate::geometry::Point;

    fn square(x: f64, y: f64, side: f64) -> Mark {
        let outline = BezPath::from_svg(&format!("M{x},{y} h{side} v{side} h-{side} Z")).unwrap();
        Mark::Area(Area { outline, colour: None })
    }

    fn paint(name: &str, marks: Vec<Mark>) -> Layer {
        Layer { mixing: Mixing::Paint, marks, ..Layer::new(name, 1) }
    }

    #[test]
    fn paint_counts_once_and_ink_each_time() {
        let squares = vec![square(1.0, 1.0, 2.0), square(2.0, 1.0, 2.0)];
        let below = paint("below", squares.clone());
        let ink = Layer { marks: squares, ..Layer::new("ink", 1) };
        let above = paint("above", vec![square(2.0, 2.0, 2.0), Mark::Dot(Dot::circle(Point::new(8.0, 8.0), 1.0))]);
        let seen = Drawing { page: Page::new(10.0, 10.0), layers: vec![below, ink, above] }.ink_mm2();
        let expected = [6.0 - 2.0, 8.0, 4.0 + std::f64::consts::PI];
        for (seen, expected) in seen.iter().zip(expected) {
            assert!((seen - expected).abs() < 0.02, "{seen} of {expected}");
        }
    }
}
