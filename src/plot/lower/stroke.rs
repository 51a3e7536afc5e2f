//! A wide stroke with one nib: passes side by side, each half a nib and then a pitch further inside the stroke's border.
//!
//! ```text
//!        ,-----------------.           pass 0 along the left side, round the end, back along the right
//!   ----(  ,-------------.  )----      pass 1 inside it, only where there is room
//!        `-----------------'           narrow ends are drawn once, along the middle
//! ```

use super::super::Toolpath;
use super::dot::OVERLAP;
use crate::drawing::Stroke;
use crate::geometry::{Point, Vec2};

/// Distance from the middle below which the two sides of a pass are one line, in nibs.
const ONE_LINE: f64 = 0.04;

/// The centre line at even steps with its unit normals and how far from it the nib may go to either side.
struct Spine {
    points: Vec<Point>,
    normals: Vec<Vec2>,
    room: Vec<f64>,
    is_closed: bool,
}

/// The paths that fill a stroke wider than the nib.
pub(super) fn fill_stroke(stroke: &Stroke, nib: f64) -> Vec<Toolpath> {
    let Some(spine) = Spine::of(stroke, nib) else { return Vec::new() };
    let pitch = nib * (1.0 - OVERLAP);
    let widest = spine.room.iter().copied().fold(0.0, f64::max);
    let passes = (widest / pitch + 0.5).ceil().max(1.0) as usize;
    let mut paths: Vec<Toolpath> = Vec::new();
    for pass in 0..passes {
        let inner = pass as f64 * pitch;
        // Pass 0 goes the whole way; the next ones wherever more than half a pitch is still open.
        let has_room = |i: usize| pass == 0 || spine.room[i] - inner > -0.5 * pitch;
        for run in runs(spine.points.len(), has_room) {
            append(&mut paths, spine.pass(run, inner, ONE_LINE * nib), 1.6 * pitch);
        }
    }
    paths
}

impl Spine {
    fn of(stroke: &Stroke, nib: f64) -> Option<Self> {
        let (points, widths) = stroke.sampled(0.25 * nib);
        if points.len() < 2 {
            return None;
        }
        let last = points.len() - 1;
        let normals = (0..points.len())
            .map(|i| {
                let along = points[(i + 1).min(last)] - points[i.saturating_sub(1)];
                if along.hypot() > 1e-12 { along.normalize().turn_90() } else { Vec2::new(0.0, 1.0) }
            })
            .collect();
        let room = widths.into_iter().map(|width| (0.5 * (width - nib)).max(0.0)).collect();
        Some(Self { points, normals, room, is_closed: stroke.is_closed() })
    }

    /// One pass over a run of the spine: out along one side and back along the other, the sides together where there is no room
    /// between them.
    fn pass(&self, run: std::ops::Range<usize>, inner: f64, one_line: f64) -> Vec<Vec<Point>> {
        let offset = |i: usize| (self.room[i] - inner).max(0.0);
        let side = |i: usize, sign: f64| self.points[i] + self.normals[i] * (sign * offset(i));
        let mut out: Vec<Point> = run.clone().map(|i| side(i, 1.0)).collect();
        let backs = runs_in(run.clone(), |i| offset(i) > one_line);
        let (first, last) = (run.start, run.end - 1);
        if backs.is_empty() {
            return vec![out];
        }
        if self.is_closed {
            return vec![out, run.rev().map(|i| side(i, -1.0)).collect()];
        }
        let mut pieces = Vec::new();
        for back in backs.into_iter().rev() {
            let mut line: Vec<Point> = back.clone().rev().map(|i| side(i, -1.0)).collect();
            if back.end - 1 == last && last + 1 == self.points.len() {
                line.splice(
                    0..0,
                    arc(self.points[last], side(last, 1.0), side(last, -1.0), self.points[last] - self.points[last - 1]),
                );
            }
            if back.start == first && first == 0 {
                line.extend(arc(self.points[0], side(0, -1.0), side(0, 1.0), self.points[0] - self.points[1]));
            }
            pieces.push(line);
        }
        if pieces.len() == 1 {
            out.append(&mut pieces[0]);
            return vec![out];
        }
        pieces.insert(0, out);
        pieces
    }
}

/// A half circle around the stroke's end from one side to the other, past `forward`.
fn arc(centre: Point, from: Point, to: Point, forward: Vec2) -> Vec<Point> {
    let (a, b) = (from - centre, to - centre);
    let ahead = forward.normalize() * a.hypot();
    (1..8)
        .map(|k| {
            let angle = std::f64::consts::PI * f64::from(k) / 8.0;
            centre + (a - b) * (0.5 * angle.cos()) + ahead * angle.sin()
        })
        .collect()
}

/// Adds pieces of line, joined to the last path where the step over is short: it lies within the stroke's ink.
fn append(paths: &mut Vec<Toolpath>, pieces: Vec<Vec<Point>>, reach: f64) {
    for mut piece in pieces.into_iter().filter(|piece| !piece.is_empty()) {
        let end = paths.last().and_then(|path| path.points.last().copied());
        let ends = (piece[0], piece[piece.len() - 1]);
        match end {
            Some(end) if end.distance(ends.0).min(end.distance(ends.1)) <= reach => {
                if end.distance(ends.1) < end.distance(ends.0) {
                    piece.reverse();
                }
                if let Some(path) = paths.last_mut() {
                    path.points.append(&mut piece);
                }
            }
            _ => paths.push(Toolpath::new(piece)),
        }
    }
}

fn runs(count: usize, holds: impl Fn(usize) -> bool) -> Vec<std::ops::Range<usize>> {
    runs_in(0..count, holds)
}

/// The longest runs of indices for which something holds.
fn runs_in(range: std::ops::Range<usize>, holds: impl Fn(usize) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut found: Vec<std::ops::Range<usize>> = Vec::new();
    for i in range.filter(|&i| holds(i)) {
        match found.last_mut() {
            Some(run) if run.end == i => run.end = i + 1,
            _ => found.push(i..i + 1),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Width;
    use crate::geometry::BezPath;

    #[test]
    fn a_wide_line_is_one_path_inside_its_ink() {
        for (width, rows) in [(0.5, 2.0), (1.0, 4.0), (2.0, 8.0)] {
            let stroke = Stroke::new(BezPath::from_svg("M0,0 L20,0").unwrap(), Width::Constant(width));
            let paths = fill_stroke(&stroke, 0.3);
            assert_eq!(paths.len(), 1, "width {width}");
            let reach = 0.5 * width - 0.15 + 1e-9;
            assert!(paths[0].points.iter().all(|p| p.y.abs() <= reach && p.x >= -reach && p.x <= 20.0 + reach));
            assert!(paths[0].length() < 20.0 * (rows + 1.0) + 10.0, "width {width}: {}", paths[0].length());
        }
    }

    #[test]
    fn a_spindle_s_tips_are_drawn_once() {
        let stroke = Stroke::new(BezPath::from_svg("M0,0 L10,0 L20,0").unwrap(), Width::Along(vec![0.0, 0.6, 0.0]));
        let paths = fill_stroke(&stroke, 0.3);
        // Out the whole way, back only where it is wider than the nib.
        let length: f64 = paths.iter().map(Toolpath::length).sum();
        assert!((29.0..40.0).contains(&length), "{length}");
    }
}
