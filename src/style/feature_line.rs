//! A feature line as a stroke of its detected width, tapering at both ends.

use crate::drawing::{Mark, Stroke};
use crate::field::CoherentLine;
use crate::geometry::catmull_rom;
use crate::source::Placement;

/// One in this many points of a line becomes a node of its stroke: 4.5 pixels, less than a pitch.
const STRIDE: usize = 3;
/// Share of a line at each end over which it tapers.
const TAPER: f64 = 0.25;

/// The stroke of a line; it tapers over a quarter of its length at each end, at most `longest_taper` pixels. None for a line too
/// short to be a curve.
pub(super) fn feature_stroke(line: &CoherentLine, placement: &Placement, longest_taper: f64) -> Option<Mark> {
    let count = line.curve.points.len();
    let mut picked: Vec<usize> = (0..count).step_by(STRIDE).collect();
    if !line.curve.closed && picked.last() != Some(&(count - 1)) {
        picked.push(count - 1);
    }
    if picked.len() < 3 {
        return None;
    }
    let page: Vec<_> = picked.iter().map(|&i| placement.to_page(line.curve.points[i])).collect();
    let scale = placement.mm_per_pixel();
    let length = line.curve.length();
    let taper = (TAPER * length).min(longest_taper);
    let mut widths: Vec<f64> = picked
        .iter()
        .map(|&i| {
            let along = length * i as f64 / (count - 1) as f64;
            let share = if line.curve.closed { 1.0 } else { (along.min(length - along) / taper).clamp(0.0, 1.0).sqrt() };
            line.widths[i] * scale * share
        })
        .collect();
    if line.curve.closed {
        widths.push(widths[0]);
    }
    Stroke::swelling(catmull_rom(&page, line.curve.closed.into()), widths).map(Mark::Stroke)
}
