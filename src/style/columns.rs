//! Lines of a face as the best way through columns across the place where the landmarks have them.

use crate::field::{CoherentLine, Curve};
use crate::geometry::{Point, Ring, lengths_along, resample, smooth_polyline};

/// Columns along a line.
pub(super) const COLUMNS: usize = 96;
/// The smoothing of widths and line, in columns.
pub(super) const SMOOTH: usize = 4;
const SMOOTH_LINE: f64 = 3.5;

/// [`COLUMNS`] points at even distances along a line; none if it has no length.
pub(super) fn even(line: &[Point]) -> Option<Vec<Point>> {
    let length = lengths_along(line).last().copied().filter(|length| *length > 0.0)?;
    let points = resample(line, length / (COLUMNS - 1) as f64);
    (points.len() == COLUMNS).then_some(points)
}

/// The line so far on the way from one line to another of as many points.
pub(super) fn between(a: &[Point], b: &[Point], share: f64) -> Vec<Point> {
    a.iter().zip(b).map(|(a, b)| a.lerp(*b, share)).collect()
}

/// The mean of each value and so many on either side.
pub(super) fn averaged(values: &[f64], reach: usize) -> Vec<f64> {
    let mean = |i: usize| {
        let near = &values[i.saturating_sub(reach)..(i + reach + 1).min(values.len())];
        near.iter().sum::<f64>() / near.len() as f64
    };
    (0..values.len()).map(mean).collect()
}

/// A line of even points some pixels apart, with the widths there.
pub(super) fn smoothed(points: &[Point], widths: &[f64]) -> CoherentLine {
    let spacing = (lengths_along(points)[points.len() - 1] / points.len() as f64).max(1.0);
    let smooth = smooth_polyline(points, Ring::Open, SMOOTH_LINE * spacing, spacing);
    let last = smooth.len().max(2) - 1;
    let width = |i: usize| widths[(i * (widths.len() - 1) + last / 2) / last];
    let widths = (0..smooth.len()).map(width).collect();
    CoherentLine { curve: Curve { points: smooth, closed: false }, widths, contrast: 1.0 }
}
