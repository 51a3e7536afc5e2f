//! Strokes: thinned by the spread on both sides, and broken into dashes of the thinnest line where that is too thin for print.

use super::plan::{Broken, Piece, Plan, Speck};
use super::{Press, widened};
use crate::drawing::{Dot, Ends, Mark, Stroke, Width};
use crate::geometry::{BezPath, Point, Ring, catmull_rom, polyline_length, simplify};
use std::f64::consts::PI;

/// Length of a dash in widths of the thinnest line. Dashes of 2 look like a dotted line; from 5 on, the gaps between them look
/// like breaks.
const DASH_WIDTHS: f64 = 3.0;
/// Samples per dash; cuts fall between them.
const SAMPLES_A_DASH: f64 = 4.0;
/// Maximum step between samples in millimetres, so that a swelling stroke keeps its shape.
const LONGEST_STEP: f64 = 0.25;
/// Maximum deviation of a dash from the original curve, in millimetres; half of it cannot be printed.
const DASH_TOLERANCE: f64 = 0.003;

/// Plans a stroke: whole if it is wide enough everywhere, else broken.
pub(super) fn plan(stroke: &Stroke, press: &Press) -> Plan {
    let least = 2.0 * press.least_printed_radius();
    let thinnest = match stroke.width() {
        Width::Constant(width) => *width,
        Width::Along(widths) => widths.iter().copied().fold(f64::INFINITY, f64::min),
    };
    if thinnest >= least - 1e-6 || stroke.curve().elements().is_empty() {
        return Plan::Whole(Mark::Stroke(widened(stroke, -2.0 * press.spread)));
    }
    let step = (least * DASH_WIDTHS / SAMPLES_A_DASH).min(LONGEST_STEP);
    let (points, widths) = stroke.sampled(step);
    let length = polyline_length(&points);
    if points.len() < 2 || length < least && stroke.widest() < least {
        return speck(stroke, &points, &widths, press);
    }
    let mut pieces = pieces(&points, &widths, least);
    add_caps(&mut pieces, stroke, least);
    Plan::Broken(Broken { stroke: stroke.clone(), pieces })
}

/// A thin stroke shorter than the least printable width.
fn speck(stroke: &Stroke, points: &[Point], widths: &[f64], press: &Press) -> Plan {
    // A touch has no length and so no samples.
    let touch = match stroke.curve().elements().first() {
        Some(kurbo::PathEl::MoveTo(at)) => Some(*at),
        _ => None,
    };
    let Some(at) = points.get(points.len() / 2).copied().or(touch) else { return Plan::Specks(None, Vec::new()) };
    let caps = if stroke.ends == Ends::Round { PI / 4.0 * stroke.widest().powi(2) } else { 0.0 };
    let share = (ink(points, widths) + caps) / (PI * press.least_printed_radius().powi(2));
    let mark = Mark::Dot(Dot { colour: stroke.colour, ..Dot::circle(at, 0.5 * press.least) });
    Plan::Specks(None, vec![Speck { at, share, mark }])
}

/// Ink area along the samples.
fn ink(points: &[Point], widths: &[f64]) -> f64 {
    points.windows(2).zip(widths.windows(2)).map(|(p, w)| p[0].distance(p[1]) * 0.5 * (w[0] + w[1])).sum()
}

/// Splits a line into runs that are wide enough and thin runs cut into dashes.
fn pieces(points: &[Point], widths: &[f64], least: f64) -> Vec<Piece> {
    let is_thin = |step: usize| 0.5 * (widths[step] + widths[step + 1]) < least;
    let mut pieces = Vec::new();
    let (mut first, last) = (0, points.len() - 1);
    while first < last {
        let end = (first + 1..last).find(|&step| is_thin(step) != is_thin(first)).unwrap_or(last);
        let run = |a: usize, b: usize, share| Piece { points: points[a..=b].to_vec(), widths: widths[a..=b].to_vec(), share };
        if is_thin(first) {
            let length = polyline_length(&points[first..=end]);
            let dashes = ((length / (DASH_WIDTHS * least)).round() as usize).clamp(1, end - first);
            for dash in 0..dashes {
                let at = |k: usize| first + k * (end - first) / dashes;
                let (a, b) = (at(dash), at(dash + 1));
                let full = least * polyline_length(&points[a..=b]);
                let share = if full > 0.0 { ink(&points[a..=b], &widths[a..=b]) / full } else { 0.0 };
                pieces.push(run(a, b, Some(share)));
            }
        } else {
            pieces.push(run(first, end, None));
        }
        first = end;
    }
    pieces
}

/// Adds the ink of the stroke's round ends to the dashes there.
fn add_caps(pieces: &mut [Piece], stroke: &Stroke, least: f64) {
    if stroke.ends == Ends::Flat || stroke.is_closed() || pieces.is_empty() {
        return;
    }
    let last = pieces.len() - 1;
    for (i, is_start) in [(0, true), (last, false)] {
        let piece = &mut pieces[i];
        let full = least * polyline_length(&piece.points);
        let width = if is_start { piece.widths[0] } else { piece.widths[piece.widths.len() - 1] };
        if let Some(share) = &mut piece.share
            && full > 0.0
        {
            *share += PI / 8.0 * width * width / full;
        }
    }
}

impl Broken {
    /// The midpoint and the share of each piece that may be left out.
    pub(super) fn dashes(&self) -> impl Iterator<Item = (Point, f64)> + '_ {
        self.pieces.iter().filter_map(|piece| Some((piece.points[piece.points.len() / 2], piece.share?)))
    }

    /// The remaining parts of the stroke; `kept` tells for each dash whether it stays.
    pub(super) fn strokes(&self, kept: &[bool], press: &Press) -> Vec<Stroke> {
        let mut kept = kept.iter();
        let is_printed: Vec<bool> =
            self.pieces.iter().map(|piece| piece.share.is_none() || kept.next().copied().unwrap_or(false)).collect();
        let mut strokes = Vec::new();
        let mut first = 0;
        while first < self.pieces.len() {
            let end = (first..self.pieces.len()).find(|&i| !is_printed[i]).unwrap_or(self.pieces.len());
            strokes.extend(self.joined(first, end, press));
            first = end + 1;
        }
        strokes
    }

    /// The pieces from `first` up to `end` as one stroke.
    fn joined(&self, first: usize, end: usize, press: &Press) -> Option<Stroke> {
        let pieces = self.pieces.get(first..end).filter(|pieces| !pieces.is_empty())?;
        let (mut points, mut widths) = (vec![pieces[0].points[0]], vec![pieces[0].plate_width(0, press)]);
        for piece in pieces {
            points.extend(&piece.points[1..]);
            widths.extend((1..piece.points.len()).map(|i| piece.plate_width(i, press)));
        }
        let is_whole = first == 0 && end == self.pieces.len();
        if !(is_whole && self.stroke.is_closed()) {
            // A dash's ink already includes its ends: trim what the press and a round end add beyond them.
            let least = 2.0 * press.least_printed_radius();
            let beyond = if self.stroke.ends == Ends::Round { PI / 8.0 * least } else { press.spread };
            let length = polyline_length(&points);
            if first > 0 || pieces[0].share.is_some() {
                trim(&mut points, &mut widths, beyond.min(0.49 * length));
            }
            if end < self.pieces.len() || pieces[pieces.len() - 1].share.is_some() {
                points.reverse();
                widths.reverse();
                trim(&mut points, &mut widths, beyond.min(0.49 * length));
                points.reverse();
                widths.reverse();
            }
        }
        Some(line(&points, widths)?.like(&self.stroke))
    }
}

impl Piece {
    /// The width on the plate at one of its points.
    fn plate_width(&self, i: usize, press: &Press) -> f64 {
        if self.share.is_some() { press.least } else { (self.widths[i] - 2.0 * press.spread).max(press.least) }
    }
}

/// Removes a length from the beginning.
fn trim(points: &mut Vec<Point>, widths: &mut Vec<f64>, mut length: f64) {
    let mut dropped = 0;
    while points.len() - dropped > 2 && points[dropped].distance(points[dropped + 1]) <= length {
        length -= points[dropped].distance(points[dropped + 1]);
        dropped += 1;
    }
    points.drain(..dropped);
    widths.drain(..dropped);
    let step = points[0].distance(points[1]);
    if step > 0.0 {
        let t = (length / step).min(1.0);
        points[0] = points[0].lerp(points[1], t);
        widths[0] += (widths[1] - widths[0]) * t;
    }
}

/// A dash of constant width as a polyline, a swelling stroke as a spline.
fn line(points: &[Point], widths: Vec<f64>) -> Option<Stroke> {
    if widths.iter().all(|width| *width == widths[0]) {
        let mut curve = BezPath::new();
        let points = simplify(points, DASH_TOLERANCE);
        curve.move_to(points[0]);
        points[1..].iter().for_each(|p| curve.line_to(*p));
        return Some(Stroke::even(curve, widths[0]));
    }
    Stroke::swelling(catmull_rom(points, Ring::Open), widths)
}
