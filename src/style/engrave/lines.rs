//! Parallel lines displaced by depth (Galarza 2017, sections 3.5 and 3.6), kept in order and at a minimum distance.

use crate::elementary::Elementary as _;
use crate::geometry::{Gap, Point, Rect, Vec2};
use crate::parallel::collected;

/// Axes along and across the lines of one direction, in page millimetres; across points to the left of along on the page.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    along: Vec2,
    across: Vec2,
}

impl Frame {
    /// Lines at an angle in degrees, anticlockwise from the right.
    pub(super) fn new(degrees: f64) -> Self {
        let (sin, cos) = degrees.to_radians().sine_and_cosine();
        Self { along: Vec2::new(cos, -sin), across: Vec2::new(-sin, -cos) }
    }

    pub(super) fn to_page(self, u: f64, v: f64) -> Point {
        (self.along * u + self.across * v).to_point()
    }

    pub(super) fn place(self, p: Point) -> (f64, f64) {
        (p.to_vec2().dot(self.along), p.to_vec2().dot(self.across))
    }

    /// The smallest rectangle in these axes around one of the page: x along, y across.
    fn bounds(self, page: Rect) -> Rect {
        let corners = [(page.x0, page.y0), (page.x1, page.y0), (page.x1, page.y1), (page.x0, page.y1)];
        let places = corners.map(|corner| self.place(corner.into()));
        places.iter().fold(Rect::new(f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY), |r, &(u, v)| {
            Rect::new(r.x0.min(u), r.y0.min(v), r.x1.max(u), r.y1.max(v))
        })
    }
}

/// One line: its height and presence at every column.
#[derive(Clone, Debug)]
pub(super) struct Line {
    /// Its first column.
    pub first: usize,
    /// Heights across, in millimetres, from its first column on.
    pub heights: Vec<f64>,
    /// 1 where it is drawn in full, 0 where it is absent, between where it tapers.
    pub presence: Vec<f32>,
}

/// Layout of one family's lines, in millimetres.
#[derive(Clone, Copy, Debug)]
pub(super) struct FamilyLayout {
    pub pitch: f64,
    pub sampling: f64,
    pub min_gap: f64,
    /// Minimum and maximum displacement.
    pub displaced: (f64, f64),
}

/// All lines of one direction in one region, lowest first.
#[derive(Clone, Debug)]
pub(super) struct Family {
    pub frame: Frame,
    /// Position of the first column along the lines.
    pub first: f64,
    /// Distance between columns.
    pub step: f64,
    pub columns: usize,
    pub pitch: f64,
    pub gap: Gap,
    pub lines: Vec<Line>,
    /// Indices of the base lines, which are one pitch apart before displacement.
    pub bases: Vec<usize>,
    /// Number of the lowest base line, counted from the page's origin.
    pub first_base: i64,
}

/// Tolerance of the curves fitted to the lines, on either side, in millimetres.
pub(super) const FIT_ROOM: f64 = 0.005;

impl Family {
    /// The base lines over a part of the page, each moved across by `displacement` at its undisplaced place.
    pub(super) fn new(frame: Frame, page: Rect, laying: FamilyLayout, displacement: impl Fn(Point) -> f64 + Sync) -> Self {
        let bounds = frame.bounds(page);
        let gap = Gap::new(laying.min_gap + 2.0 * FIT_ROOM);
        let first = ((bounds.x0 - laying.pitch) / gap.step).floor() * gap.step;
        let columns = ((bounds.x1 + laying.pitch - first) / gap.step).ceil() as usize + 1;
        // Starts so far outside that displacement leaves no margin empty.
        let first_base = ((bounds.y0 - laying.displaced.1) / laying.pitch).floor() as i64 - 1;
        let last_base = ((bounds.y1 - laying.displaced.0) / laying.pitch).ceil() as i64 + 1;
        let wanted: Vec<Vec<f64>> = collected((last_base + 1 - first_base).max(0) as usize, &|k| {
            let v = (first_base + k as i64) as f64 * laying.pitch;
            displaced(first, gap.step, columns, laying.sampling, |u| v + displacement(frame.to_page(u, v)))
        });
        let lines: Vec<Line> =
            gap.keep(&wanted).into_iter().map(|heights| Line { first: 0, presence: vec![1.0; heights.len()], heights }).collect();
        let bases = (0..lines.len()).collect();
        Self { frame, first, step: gap.step, columns, pitch: laying.pitch, gap, lines, bases, first_base }
    }

    /// Index of the base line at a place, with the fraction of the way to the next; `hint` is a nearby index and is updated.
    pub(super) fn index_at(&self, p: Point, hint: &mut usize) -> f64 {
        let (u, v) = self.frame.place(p);
        let column = (((u - self.first) / self.step).round().max(0.0) as usize).min(self.columns - 1);
        let height = |i: usize| self.lines[self.bases[i]].heights[column];
        let last = self.bases.len() - 2;
        let mut i = (*hint).min(last);
        while i > 0 && height(i) > v {
            i -= 1;
        }
        while i < last && height(i + 1) <= v {
            i += 1;
        }
        *hint = i;
        let (below, above) = (height(i), height(i + 1));
        self.first_base as f64 + i as f64 + ((v - below) / (above - below)).clamp(0.0, 1.0)
    }
}

/// Heights at every column, from a Catmull-Rom spline through the heights at every `sampling`.
fn displaced(first: f64, step: f64, columns: usize, sampling: f64, height: impl Fn(f64) -> f64) -> Vec<f64> {
    let start = (first / sampling).floor() - 1.0;
    let end = ((first + step * columns as f64) / sampling).ceil() + 2.0;
    let samples: Vec<f64> = (0..=(end - start) as usize).map(|i| height((start + i as f64) * sampling)).collect();
    (0..columns)
        .map(|column| {
            let x = (first + column as f64 * step) / sampling - start;
            let i = (x as usize).clamp(1, samples.len() - 3);
            catmull_rom([samples[i - 1], samples[i], samples[i + 1], samples[i + 2]], x - i as f64)
        })
        .collect()
}

/// The uniform Catmull-Rom spline from the second to the third of four values.
fn catmull_rom([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    let (m0, m1) = (0.5 * (c - a), 0.5 * (d - b));
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * b + (t3 - 2.0 * t2 + t) * m0 + (3.0 * t2 - 2.0 * t3) * c + (t3 - t2) * m1
}
