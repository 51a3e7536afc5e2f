//! How much of the drawing's ink a plot lays down, and how much it spills: both inks are cut by the same horizontal lines.
//!
//! ```text
//!   asked   ----=======-----====----      along each line the intervals are exact; the lines are a sixteenth of a nib apart, so
//!   laid    ------=======---====----      a dot of the nib's size is accurate to 2 %, and many of them to much less
//!   covered       xxxxx     xxxx     spilt      xx
//! ```

use super::lower::Nibs;
use super::{PenPaths, Plot};
use crate::drawing::{Drawing, Ends, Mark, Stroke, Width};
use crate::geometry::{BezPath, Point, flatten};
use crate::interrupt::{Interrupt, Interrupted};
use crate::parallel::collected;

/// Flattening tolerance of outlines, in millimetres.
const TOLERANCE: f64 = 0.004;

/// Areas in square millimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coverage {
    /// The drawing's ink; overlapping marks count once.
    pub asked: f64,
    /// Ink of the drawing that is laid down.
    pub covered: f64,
    /// Ink laid down outside the drawing's ink.
    pub spilt: f64,
}

impl Coverage {
    /// Share of the drawing's ink that is laid down, 0 to 1; 1 for a drawing without ink.
    pub fn covered_fraction(&self) -> f64 {
        if self.asked > 0.0 { self.covered / self.asked } else { 1.0 }
    }

    /// The sum of two pens' ink.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self { asked: self.asked + other.asked, covered: self.covered + other.covered, spilt: self.spilt + other.spilt }
    }

    /// Spilt ink as a share of the drawing's ink; 0 for a drawing without ink.
    pub fn spill_fraction(&self) -> f64 {
        if self.asked > 0.0 { self.spilt / self.asked } else { 0.0 }
    }
}

/// The coverage of each entry of a plot's pens, in their order. Entries of one pen number share their coverage.
pub fn coverage(drawing: &Drawing, plot: &Plot, nibs: &Nibs, interrupt: &Interrupt) -> Result<Vec<Coverage>, Interrupted> {
    let measured = |pen| {
        let coverage = coverage_of_pen(drawing, plot, nibs, pen, interrupt);
        interrupt.check().map(|()| coverage)
    };
    plot.pens.iter().map(measured).collect()
}

/// Scan lines per nib.
const LINES_A_NIB: f64 = 16.0;
/// Scan lines processed together.
const BAND: usize = 32;
/// Maximum scan lines per page: a page of many metres is cut more coarsely.
const MOST_LINES: f64 = 40_000.0;

/// The coverage of one pen. Meaningless if the interrupt was raised meanwhile.
fn coverage_of_pen(drawing: &Drawing, plot: &Plot, nibs: &Nibs, pen: &PenPaths, interrupt: &Interrupt) -> Coverage {
    let layers = drawing.layers.iter().filter(|layer| layer.pen == pen.number);
    let goes_on = || !interrupt.is_raised();
    let asked: Vec<Shape> = layers.flat_map(|layer| &layer.marks).take_while(|_| goes_on()).flat_map(shapes_of_mark).collect();
    let laid: Vec<Shape> = plot.pens.iter().filter(|p| p.number == pen.number).flat_map(|p| shapes_of_pen(p, nibs)).collect();
    let extent =
        |shapes: &[Shape]| shapes.iter().map(Shape::rows).fold((f64::MAX, f64::MIN), |a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (a, b) = (extent(&asked), extent(&laid));
    let (top, bottom) = (a.0.min(b.0), a.1.max(b.1));
    if top > bottom {
        return Coverage::default();
    }
    let step = (pen.nib / LINES_A_NIB).max((bottom - top) / MOST_LINES);
    let bands = ((bottom - top) / (step * BAND as f64)) as usize + 1;
    let band_of = |y: f64| (((y - top) / (step * BAND as f64)).max(0.0) as usize).min(bands - 1);
    let (asked, laid) = (by_band(&asked, bands, band_of, interrupt), by_band(&laid, bands, band_of, interrupt));
    let sums: Vec<[f64; 3]> = collected(bands, &|band| {
        let (mut cuts, mut total) = (Cuts::default(), [0.0; 3]);
        for line in (0..BAND).take_while(|_| goes_on()) {
            let y = top + ((band * BAND + line) as f64 + 0.5) * step;
            let sums = cuts.across(y, &asked[band], &laid[band]);
            (0..3).for_each(|i| total[i] += sums[i] * step);
        }
        total
    });
    let sum = |i: usize| sums.iter().map(|sums| sums[i]).sum::<f64>();
    Coverage { asked: sum(0), covered: sum(1), spilt: sum(2) }
}

/// An inked shape that scan lines cut.
enum Shape {
    /// All points within `radius` of a segment.
    Capsule { a: Point, b: Point, radius: f64 },
    /// The inside of closed polygons, by the nonzero rule.
    Polygons(Vec<[Point; 2]>),
}

impl Shape {
    fn rows(&self) -> (f64, f64) {
        match self {
            Self::Capsule { a, b, radius } => (a.y.min(b.y) - radius, a.y.max(b.y) + radius),
            Self::Polygons(edges) => {
                edges.iter().flatten().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.y), high.max(p.y)))
            }
        }
    }

    /// Adds the shape's intervals on the line at `y`.
    fn cut(&self, y: f64, intervals: &mut Vec<(f64, f64)>, crossings: &mut Vec<(f64, i32)>) {
        match self {
            Self::Capsule { a, b, radius } => intervals.extend(cut_capsule(*a, *b, *radius, y)),
            Self::Polygons(edges) => {
                crossings.clear();
                for [a, b] in edges {
                    if (a.y <= y) != (b.y <= y) {
                        crossings.push((a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y), if b.y > a.y { 1 } else { -1 }));
                    }
                }
                crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
                let mut winding = 0;
                for pair in crossings.windows(2) {
                    winding += pair[0].1;
                    if winding != 0 {
                        intervals.push((pair[0].0, pair[1].0));
                    }
                }
            }
        }
    }
}

/// The interval of a capsule on the line at `y`. A capsule is convex: two discs and the strip between them meet a line in one
/// interval.
fn cut_capsule(a: Point, b: Point, radius: f64, y: f64) -> Option<(f64, f64)> {
    let disc = |c: Point| {
        let square = radius * radius - (y - c.y) * (y - c.y);
        (square >= 0.0).then(|| (c.x - square.sqrt(), c.x + square.sqrt()))
    };
    let mut hit = [disc(a), disc(b)].into_iter().flatten().reduce(|p, q| (p.0.min(q.0), p.1.max(q.1)));
    let along = b - a;
    let length = along.hypot();
    if length > 0.0 {
        let normal = along.turn_90() * (radius / length);
        for (p, q) in [(a + normal, b + normal), (a - normal, b - normal)] {
            if (p.y <= y) != (q.y <= y) {
                let x = p.x + (q.x - p.x) * (y - p.y) / (q.y - p.y);
                hit = Some(hit.map_or((x, x), |(low, high)| (low.min(x), high.max(x))));
            }
        }
    }
    hit
}

/// The shapes that each band of lines may meet; polygons are reduced to their edges there.
fn by_band(shapes: &[Shape], bands: usize, band_of: impl Fn(f64) -> usize, interrupt: &Interrupt) -> Vec<Vec<Shape>> {
    let mut all: Vec<Vec<Shape>> = (0..bands).map(|_| Vec::new()).collect();
    for shape in shapes.iter().take_while(|_| !interrupt.is_raised()) {
        let (low, high) = shape.rows();
        // An outline without edges has no rows.
        if low > high {
            continue;
        }
        match shape {
            &Shape::Capsule { a, b, radius } => {
                (band_of(low)..=band_of(high)).for_each(|band| all[band].push(Shape::Capsule { a, b, radius }));
            }
            Shape::Polygons(edges) => {
                let first = band_of(low);
                let mut parts: Vec<Vec<[Point; 2]>> = vec![Vec::new(); band_of(high) + 1 - first];
                for &[a, b] in edges {
                    (band_of(a.y.min(b.y))..=band_of(a.y.max(b.y))).for_each(|band| parts[band - first].push([a, b]));
                }
                parts.into_iter().enumerate().for_each(|(i, edges)| all[first + i].push(Shape::Polygons(edges)));
            }
        }
    }
    all
}

/// Buffers reused from line to line.
#[derive(Default)]
struct Cuts {
    asked: Vec<(f64, f64)>,
    laid: Vec<(f64, f64)>,
    crossings: Vec<(f64, i32)>,
}

impl Cuts {
    /// Lengths along one line: `[asked, covered, spilt]`.
    fn across(&mut self, y: f64, asked: &[Shape], laid: &[Shape]) -> [f64; 3] {
        self.asked.clear();
        self.laid.clear();
        asked.iter().for_each(|shape| shape.cut(y, &mut self.asked, &mut self.crossings));
        laid.iter().for_each(|shape| shape.cut(y, &mut self.laid, &mut self.crossings));
        unite(&mut self.asked);
        unite(&mut self.laid);
        let length = |intervals: &[(f64, f64)]| intervals.iter().map(|(a, b)| b - a).sum::<f64>();
        let covered = common_length(&self.asked, &self.laid);
        [length(&self.asked), covered, length(&self.laid) - covered]
    }
}

/// Sorts intervals and merges those that overlap.
fn unite(intervals: &mut Vec<(f64, f64)>) {
    intervals.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut last = 0;
    for i in 1..intervals.len() {
        if intervals[i].0 <= intervals[last].1 {
            intervals[last].1 = intervals[last].1.max(intervals[i].1);
        } else {
            last += 1;
            intervals[last] = intervals[i];
        }
    }
    intervals.truncate(last + 1);
}

fn common_length(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    let (mut i, mut j, mut length) = (0, 0, 0.0);
    while i < a.len() && j < b.len() {
        length += (a[i].1.min(b[j].1) - a[i].0.max(b[j].0)).max(0.0);
        if a[i].1 < b[j].1 { i += 1 } else { j += 1 }
    }
    length
}

fn shapes_of_mark(mark: &Mark) -> Vec<Shape> {
    match mark {
        Mark::Dot(dot) if dot.outline.is_none() => vec![Shape::Capsule { a: dot.centre, b: dot.centre, radius: dot.radius }],
        Mark::Dot(dot) => vec![polygons(&dot.path())],
        Mark::Area(area) => vec![polygons(&area.outline)],
        Mark::Stroke(stroke) => shapes_of_stroke(stroke),
    }
}

fn shapes_of_stroke(stroke: &Stroke) -> Vec<Shape> {
    match (stroke.width(), stroke.ends) {
        (Width::Along(_), _) => stroke.outline().iter().map(polygons).collect(),
        (Width::Constant(_), Ends::Flat) if !stroke.is_closed() => vec![polygons(&stroke.ink_outline(TOLERANCE))],
        (Width::Constant(width), _) => flatten(stroke.curve(), TOLERANCE)
            .into_iter()
            .flat_map(|(mut points, closed)| {
                points.extend(closed.then(|| points[0]));
                capsules(&points, |_| 0.5 * width)
            })
            .collect(),
    }
}

fn shapes_of_pen(pen: &PenPaths, nibs: &Nibs) -> Vec<Shape> {
    let shapes = pen.paths.iter().flat_map(|path| match (path.heights(), &nibs.swell) {
        (Some(heights), Some(swell)) => capsules(path.points(), |i| 0.5 * swell.width(heights[i])),
        _ => capsules(path.points(), |_| 0.5 * pen.nib),
    });
    shapes.collect()
}

/// A polyline's segments as capsules with the radius at their vertices; a changing radius is split into steps.
fn capsules(points: &[Point], radius: impl Fn(usize) -> f64) -> Vec<Shape> {
    if let [p] = points {
        return vec![Shape::Capsule { a: *p, b: *p, radius: radius(0) }];
    }
    let mut shapes = Vec::with_capacity(points.len());
    for i in 1..points.len() {
        let (a, b) = (points[i - 1], points[i]);
        let (from, to) = (radius(i - 1), radius(i));
        let steps = ((to - from).abs() / (0.02 * from.max(to).max(1e-6))).ceil().clamp(1.0, 50.0);
        let at = |k: f64| a.lerp(b, k / steps);
        shapes.extend((0..steps as usize).map(|k| {
            let k = k as f64;
            Shape::Capsule { a: at(k), b: at(k + 1.0), radius: from + (to - from) * (k + 0.5) / steps }
        }));
    }
    shapes
}

fn polygons(outline: &BezPath) -> Shape {
    let finite = |points: &Vec<Point>| points.iter().all(|p| p.is_finite());
    let rings = flatten(outline, TOLERANCE).into_iter().map(|(points, _)| points).filter(finite);
    Shape::Polygons(
        rings.flat_map(|ring| (0..ring.len()).map(move |i| [ring[i], ring[(i + 1) % ring.len()]]).collect::<Vec<_>>()).collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Area, Dot, Layer, Page};
    use crate::plot::{InkModel, lower};
    use std::f64::consts::PI;

    fn measured(marks: Vec<Mark>, nib: f64) -> Coverage {
        let drawing = Drawing { page: Page::new(50.0, 50.0), layers: vec![Layer { marks, ..Layer::new("x", 1) }] };
        let nibs = Nibs::all(nib);
        let plot = lower(&drawing, InkModel::Ink, &nibs, 0.01, &Interrupt::never()).unwrap();
        coverage(&drawing, &plot, &nibs, &Interrupt::never()).unwrap()[0]
    }

    #[test]
    fn a_touch_within_a_larger_dot_and_beyond_a_smaller_one() {
        let dot = |radius| Mark::Dot(Dot::circle(Point::new(10.0, 10.0), radius));
        let exact = measured(vec![dot(0.5)], 1.0);
        assert!(
            (exact.asked / (0.25 * PI) - 1.0).abs() < 0.03 && exact.covered_fraction() > 0.999 && exact.spill_fraction() < 1e-3
        );
        let spilling = measured(vec![dot(0.45)], 1.0);
        assert!((spilling.spill_fraction() - (0.25 / 0.2025 - 1.0)).abs() < 0.04, "{spilling:?}");
        let large = measured(vec![dot(0.505)], 1.0);
        assert!((large.covered_fraction() - 0.25 / 0.255).abs() < 0.02, "{large:?}");
    }

    #[test]
    fn overlapping_marks_count_once_and_holes_do_not() {
        let area = |text: &str| Mark::Area(Area { outline: BezPath::from_svg(text).unwrap(), colour: None });
        let twice = measured(vec![area("M5,5 H15 V15 H5 Z"), area("M5,5 H15 V15 H5 Z")], 0.5);
        assert!((twice.asked - 100.0).abs() < 0.6, "{twice:?}");
        let frame = measured(vec![area("M5,5 H15 V15 H5 Z M8,8 V12 H12 V8 Z")], 0.5);
        assert!(
            (frame.asked - 84.0).abs() < 0.6 && frame.covered_fraction() > 0.98 && frame.spill_fraction() < 0.01,
            "{frame:?}"
        );
    }
}
