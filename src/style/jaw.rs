//! The line of the jaw, where a face ends above the neck.
//!
//! ```text
//!   columns   along the lower border of the face, from below one ear over the chin to below the other
//!   line      the way through the columns along which the neck is darkest against the face
//!   kept      where skin lies below it: collars, beards and the subject's border have lines of their own
//! ```

use super::feature_line::feature_stroke;
use crate::drawing::Mark;
use crate::field::{CoherentLine, Curve, distance_to_curves};
use crate::geometry::{Point, Ring, Vec2, lengths_along, resample, smooth_polyline};
use crate::raster::{Raster, best_way, gaussian_blur};
use crate::source::{Landmarks, MaskRole, Placement, Portrait, outlines};

/// Columns along a jaw, and rows across it.
const COLUMNS: usize = 96;
const ROWS: usize = 31;
/// The part of the face's border that is the jaw.
const JAW: std::ops::Range<usize> = 11..26;
/// How far the line may lie inside and outside the border that was found, the distance on both sides at which it is compared, and the blur
/// before that, in widths of the face.
const INSIDE: f64 = 0.04;
const OUTSIDE: f64 = 0.08;
const BESIDE: f64 = 0.025;
const BLUR: f64 = 0.008;
/// The price of a bend by one row, and of a line at the farthest row. Looked at on eight portraits in charcoal: chins of 10, 12 and 13, which ran
/// into their necks, have an edge.
const BEND: f32 = 0.004;
const AWAY: f32 = 0.06;
/// The least step of lightness at which there is a line, and its shortest length in widths of the face.
const LEAST_STEP: f64 = 0.012;
const LEAST_LENGTH: f64 = 0.12;
/// Where one looks for skin below the line, in widths of the face; and from which share it is skin, or anything else.
const BELOW: f64 = 0.05;
const HALF: f32 = 0.5;
/// Columns over which steps are averaged, and those over which the line is smoothed.
const AVERAGED: usize = 4;
const SMOOTHED: f64 = 4.0;

/// A face of fewer pitches has no line of its own.
const LEAST_WIDTH: f64 = 30.0;
/// Distance within which a line that was found is the jaw's, in pitches; and below it, where it is no collar's, in widths of the face: shade
/// under a chin ends in a second jaw (06).
const BESIDE_JAW: f64 = 3.0;
const SHADE_OF_JAW: f64 = 0.09;
/// The side of a jaw's line on which the neck lies.
const NECK: i8 = -1;
/// Clothing below which a place is no collar's border.
const NO_COLLAR: f32 = 0.1;
/// The width of a line, in widths of the face, at the step from which it is full; and its least share of that.
const WIDEST: f64 = 0.0065;
const FULL: f64 = 0.15;
const LEAST: f64 = 0.35;

/// The jaws of a portrait.
pub(super) struct Jaws<'a> {
    portrait: &'a Portrait,
    pitch: f64,
    lines: Vec<CoherentLine>,
}

impl<'a> Jaws<'a> {
    /// Of the faces that were found, in working pixels; `pitch` in these.
    pub(super) fn of(portrait: &'a Portrait, pitch: f64) -> Self {
        let large = portrait.faces.iter().filter(|face| face.width() >= LEAST_WIDTH * pitch);
        let lines = large.filter_map(Jaw::of).flat_map(|jaw| jaw.lines(portrait)).collect();
        Self { portrait, pitch, lines }
    }

    /// Where they run.
    pub(super) fn curves(&self) -> Vec<Curve> {
        self.lines.iter().map(|line| line.curve.clone()).collect()
    }

    /// Their strokes on the page, of a share of their widths.
    pub(super) fn strokes(&self, placement: &Placement, share: f64) -> Vec<Mark> {
        self.lines.iter().filter_map(|line| feature_stroke(&line.widened(share), placement, f64::INFINITY)).collect()
    }

    /// Lines that were found, with the jaws' own in place of those beside them; what is left of one is at least `least` long.
    pub(super) fn redrawn(&self, found: Vec<CoherentLine>, least: f64) -> Vec<CoherentLine> {
        let (width, height) = (self.portrait.subject.width(), self.portrait.subject.height());
        let Some(field) = distance_to_curves(&self.curves(), width, height) else { return found };
        let reach = (BESIDE_JAW * self.pitch) as f32;
        let widest = self.portrait.faces.iter().map(Landmarks::width).fold(0.0, f64::max);
        let below = reach.max((SHADE_OF_JAW * widest) as f32);
        let cloth = self.portrait.masks.get(&MaskRole::Clothing);
        let is_apart = |p: &Point| {
            let distance = field.distance.sample(p.x, p.y);
            let is_neck = field.side.clamped(p.x as isize, p.y as isize) == NECK
                && cloth.is_none_or(|cloth| cloth.sample(p.x, p.y) < NO_COLLAR);
            distance >= if is_neck { below } else { reach }
        };
        let kept = found.iter().flat_map(|line| line.parts_where(is_apart, least));
        kept.chain(self.lines.iter().cloned()).collect()
    }
}

/// The lower border of a face: even points with the ways outwards.
struct Jaw {
    width: f64,
    points: Vec<Point>,
    outwards: Vec<Vec2>,
}

impl Jaw {
    fn of(face: &Landmarks) -> Option<Self> {
        let border = face.line(&outlines::OVAL[JAW]);
        let length = lengths_along(&border).last().copied().filter(|length| *length > 0.0)?;
        let points = resample(&border, length / (COLUMNS - 1) as f64);
        let middle =
            outlines::OVAL.iter().fold(Vec2::ZERO, |sum, i| sum + face.point(*i).to_vec2()) / outlines::OVAL.len() as f64;
        let outwards = (0..points.len()).map(|i| {
            let along = points[(i + 1).min(points.len() - 1)] - points[i.saturating_sub(1)];
            let across = along.turn_90() / along.hypot().max(1e-9);
            if across.dot(points[i].to_vec2() - middle) < 0.0 { -across } else { across }
        });
        Some(Self { width: face.width(), outwards: outwards.collect(), points }).filter(|jaw| jaw.points.len() == COLUMNS)
    }

    fn lines(&self, portrait: &Portrait) -> Vec<CoherentLine> {
        let light = gaussian_blur(&portrait.lightness, (BLUR * self.width) as f32);
        let steps = Raster::from_fn(ROWS, COLUMNS, |row, column| self.step(&light, row, column));
        let away = |row: usize| ((offset(row) / OUTSIDE) as f32).powi(2);
        let way = best_way(&Raster::from_fn(ROWS, COLUMNS, |row, column| steps.get(row, column) - AWAY * away(row)), 1, BEND);
        let found: Vec<f64> = way.iter().enumerate().map(|(column, row)| f64::from(steps.get(*row, column))).collect();
        let line: Vec<Point> = way.iter().enumerate().map(|(column, row)| self.place(*row, column)).collect();
        let is_drawn = |column: usize| {
            mean(&found, column) > LEAST_STEP
                && self.has_skin_below(portrait, line[column], column)
                && !self.is_bearded(portrait, line[column], column)
        };
        let drawn: Vec<bool> = (0..COLUMNS).map(is_drawn).collect();
        let mut lines = Vec::new();
        let mut first = 0;
        for run in drawn.chunk_by(|a, b| a == b) {
            let (part, steps) = (&line[first..first + run.len()], &found[first..first + run.len()]);
            first += run.len();
            let length = lengths_along(part).last().copied().unwrap_or(0.0);
            if run[0] && length >= LEAST_LENGTH * self.width {
                let spacing = (length / part.len() as f64).max(1.0);
                let points = smooth_polyline(part, Ring::Open, SMOOTHED * spacing, spacing);
                let last = points.len().max(2) - 1;
                let step = |i: usize| mean(steps, (i * (steps.len() - 1) + last / 2) / last);
                let width = |i: usize| WIDEST * self.width * (step(i) / FULL).clamp(LEAST, 1.0);
                let widths = (0..points.len()).map(width).collect();
                lines.push(CoherentLine { curve: Curve { points, closed: false }, widths, contrast: 1.0 });
            }
        }
        lines
    }

    fn place(&self, row: usize, column: usize) -> Point {
        self.points[column] + self.outwards[column] * (offset(row) * self.width)
    }

    /// By how much the neck is darker than the face.
    fn step(&self, light: &Raster<f32>, row: usize, column: usize) -> f32 {
        let (p, beside) = (self.place(row, column), self.outwards[column] * (BESIDE * self.width));
        let at = |p: Point| light.sample(p.x, p.y);
        at(p - beside) - at(p + beside)
    }

    fn has_skin_below(&self, portrait: &Portrait, line: Point, column: usize) -> bool {
        let below = line + self.outwards[column] * (BELOW * self.width);
        let is_in = |mask: &Raster<f32>| mask.sample(below.x, below.y) > HALF;
        let others = [MaskRole::Hair, MaskRole::FacialHair, MaskRole::Clothing, MaskRole::Headwear];
        is_in(&portrait.subject) && !others.iter().filter_map(|role| portrait.masks.get(role)).any(is_in)
    }

    /// True where a beard covers the jaw, and ends a little above the neck.
    fn is_bearded(&self, portrait: &Portrait, line: Point, column: usize) -> bool {
        let above = line - self.outwards[column] * (BELOW * self.width);
        let beard = portrait.masks.get(&MaskRole::FacialHair);
        beard.is_some_and(|beard| [line, above].iter().any(|p| beard.sample(p.x, p.y) > HALF))
    }
}

/// Where a row lies, outwards from the border that was found, in widths of the face.
fn offset(row: usize) -> f64 {
    -INSIDE + (INSIDE + OUTSIDE) * row as f64 / (ROWS - 1) as f64
}

fn mean(values: &[f64], column: usize) -> f64 {
    let near = &values[column.saturating_sub(AVERAGED)..(column + AVERAGED + 1).min(values.len())];
    near.iter().sum::<f64>() / near.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;
    use crate::source::{Iris, POINTS};
    use std::f64::consts::{FRAC_PI_2, TAU};

    /// A face of 100 by 120 pixels about (80, 70).
    fn face() -> Landmarks {
        let mut points = vec![[80.0, 70.0, 0.0]; POINTS];
        for (i, index) in outlines::OVAL.iter().enumerate() {
            let turn = unit_at(TAU * i as f64 / 36.0 - FRAC_PI_2);
            points[*index] = [80.0 + 50.0 * turn.x, 70.0 + 60.0 * turn.y, 0.0];
        }
        let irises = [60.0, 100.0].map(|x| Iris { centre: Point::new(x, 50.0), radius: 4.0 });
        Landmarks { points, irises, spectacles: None, pearls: Vec::new() }
    }

    #[test]
    fn the_line_lies_where_the_neck_begins_to_be_dark() {
        let jaw = Jaw::of(&face()).expect("it has a border");
        // The neck begins 3 pixels below the border that was found.
        let light = Raster::from_fn(160, 160, |x, y| {
            let off = Vec2::new((x as f64 + 0.5 - 80.0) / 50.0, (y as f64 + 0.5 - 70.0) / 60.0).hypot();
            if off < 1.05 { 0.8 } else { 0.5 }
        });
        let steps: Vec<f32> = (0..ROWS).map(|row| jaw.step(&light, row, COLUMNS / 2)).collect();
        let steepest = (0..ROWS).max_by(|a, b| steps[*a].total_cmp(&steps[*b])).expect("there are rows");
        let chin = jaw.place(steepest, COLUMNS / 2);
        assert!((chin.y - 133.0).abs() < 2.5 && (chin.x - 80.0).abs() < 1.5, "{chin:?}");
        assert!(jaw.outwards.iter().all(|way| way.y > 0.0), "outwards is down");
    }

    #[test]
    fn a_jaw_under_a_beard_has_no_line() {
        let mut portrait = crate::style::form::mean_portrait(6.0, 0.0, |_| 100);
        let jaw = Jaw::of(&portrait.faces[0]).expect("it has a border");
        let chin = jaw.points[COLUMNS / 2];
        assert!(!jaw.is_bearded(&portrait, chin, COLUMNS / 2));
        let (width, height) = (portrait.subject.width(), portrait.subject.height());
        let mask = |end: f64| Raster::from_fn(width, height, |_, y| f32::from(u8::from((y as f64) < end)));
        // A beard that ends at the chin, and a moustache.
        portrait.masks.insert(MaskRole::FacialHair, mask(chin.y));
        assert!(jaw.is_bearded(&portrait, chin, COLUMNS / 2));
        portrait.masks.insert(MaskRole::FacialHair, mask(chin.y - 0.3 * jaw.width));
        assert!(!jaw.is_bearded(&portrait, chin, COLUMNS / 2));
    }

    #[test]
    fn the_shade_below_a_jaw_has_no_line() {
        let portrait = crate::style::form::mean_portrait(6.0, 0.0, |_| 100);
        let face = &portrait.faces[0];
        let jaw = |down: f64| {
            let points = face.line(&outlines::OVAL[JAW]).iter().map(|p| *p + Vec2::new(0.0, down * face.width())).collect();
            CoherentLine::plain(Curve { points, closed: false }, 1.0)
        };
        let jaws = Jaws { portrait: &portrait, pitch: 1.0, lines: vec![jaw(0.0)] };
        let lengths = |down: f64| jaws.redrawn(vec![jaw(down)], 1.0).iter().map(|line| line.curve.length()).sum::<f64>();
        let own = jaw(0.0).curve.length();
        assert!(lengths(0.06) < 1.2 * own, "{} of {own}", lengths(0.06));
        assert!(lengths(-0.08) > 1.7 * own, "{} of {own}", lengths(-0.08));
    }
}
