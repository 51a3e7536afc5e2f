//! Draws a wide stroke with one nib: passes side by side, the first half a nib inside the stroke's border, each next one pitch
//! further in.
//!
//! ```text
//!        ,-----------------.           pass 0 along the left side, round the end, back along the right
//!   ----(  ,-------------.  )----      pass 1 inside it, only where there is room
//!        `-----------------'           narrow ends are drawn once, along the middle
//! ```

use super::super::Toolpath;
use super::dash::{NEARLY_WHOLE, Sample, dashes};
use super::dot::{OVERLAP, fill_dot};
use crate::drawing::{Dot, Ends, Stroke, Width};
use crate::elementary::Elementary as _;
use crate::geometry::{BezPath, Point, Vec2};
use crate::interrupt::Interrupt;
use kurbo::PathEl;

/// Distance from the middle below which the two sides of a pass are one line, in nibs.
const ONE_LINE: f64 = 0.04;

/// Flattening tolerance of a stroke without length, in millimetres.
const POINT_TOLERANCE: f64 = 0.02;

/// Width in nibs up to which one pass is enough.
const ONE_PASS: f64 = 1.1;

/// The centre line at even steps, with unit normals and the nib's maximum offset to either side.
struct Spine {
    points: Vec<Point>,
    normals: Vec<Vec2>,
    room: Vec<f64>,
    is_closed: bool,
    ends: Ends,
}

/// The paths that lay down a stroke's ink: passes where it is wider than the nib, its centre line where it is as wide, dashes
/// where it is thinner; incomplete once the interrupt is raised. `phase` is the phase of the dashes.
pub(super) fn lower_stroke(stroke: &Stroke, nib: f64, phase: f64, interrupt: &Interrupt) -> Vec<Toolpath> {
    let samples = trimmed(samples(stroke, nib), stroke, nib);
    if samples.windows(2).all(|pair| pair[0].at == pair[1].at) {
        return point(stroke, samples.first().copied(), nib, interrupt);
    }
    let is_thin = |i: usize| samples[i].width < NEARLY_WHOLE * nib;
    let mut paths = Vec::new();
    let mut from = 0;
    while from < samples.len() && !interrupt.is_raised() {
        let to = (from..samples.len()).find(|&i| is_thin(i) != is_thin(from)).unwrap_or(samples.len());
        // Neighbouring runs share the sample at their transition.
        let run = &samples[from.saturating_sub(1)..to];
        if is_thin(from) {
            paths.extend(dashes(run, nib, phase));
        } else {
            let is_whole = run.len() == samples.len();
            let spine = Spine { is_closed: is_whole && stroke.is_closed(), ends: stroke.ends, ..Spine::of(run, nib) };
            paths.extend(fill(&spine, nib, interrupt));
        }
        from = to;
    }
    paths
}

/// True if a stroke wider than the nib turns so sharply that passes along it would leave the outside of the turn bare: at a
/// radius of less than 0.6 of its width.
pub(in crate::plot) fn turns_sharply(stroke: &Stroke, nib: f64) -> bool {
    if stroke.widest() <= ONE_PASS * nib {
        return false;
    }
    let mut samples = samples(stroke, nib);
    samples.dedup_by(|a, b| a.at == b.at);
    if stroke.is_closed() && samples.len() > 2 {
        samples.push(samples[1]);
    }
    samples.windows(3).any(|run| {
        let (before, after) = (run[1].at - run[0].at, run[2].at - run[1].at);
        let angle = before.cross(after).angle_over(before.dot(after)).abs();
        let step = 0.5 * (before.hypot() + after.hypot());
        run[1].width > ONE_PASS * nib && angle > (step / (0.6 * run[1].width)).clamp(0.02, 1.0)
    })
}

/// Draws a stroke without length as a dot of the stroke's width.
fn point(stroke: &Stroke, sample: Option<Sample>, nib: f64, interrupt: &Interrupt) -> Vec<Toolpath> {
    let at = sample.map(|sample| sample.at).or_else(|| stroke.curve().elements().first().and_then(PathEl::end_point));
    let Some(at) = at.filter(|at| at.is_finite()) else { return Vec::new() };
    let width = sample.map_or(stroke.widest(), |sample| sample.width);
    // Dots are thinned out together. A single one is drawn if at least half a touch is wanted.
    let asks_for_half = 2.0 * width * width >= nib * nib;
    let dot = || fill_dot(&Dot::circle(at, 0.5 * width), nib, POINT_TOLERANCE, interrupt);
    asks_for_half.then(dot).into_iter().collect()
}

/// The centre line with its widths, at steps of at most a quarter of a nib. Straight lines of one width that a pass or dashes
/// draw are sampled only at their vertices.
fn samples(stroke: &Stroke, nib: f64) -> Vec<Sample> {
    if let (Width::Constant(width), Some(points)) = (stroke.width(), corners(stroke.curve()))
        && *width <= ONE_PASS * nib
    {
        return points.into_iter().filter(|p| p.is_finite()).map(|at| Sample { at, width: *width }).collect();
    }
    let (points, widths) = stroke.sampled(0.25 * nib);
    let finite = points.into_iter().zip(widths).filter(|(at, width)| at.is_finite() && width.is_finite());
    finite.map(|(at, width)| Sample { at, width }).collect()
}

/// The vertices of a curve of straight lines only, ending at its start if it is closed.
fn corners(curve: &BezPath) -> Option<Vec<Point>> {
    let mut points: Vec<Point> = Vec::with_capacity(curve.elements().len());
    for element in curve.elements() {
        match element {
            PathEl::MoveTo(p) if points.is_empty() => points.push(*p),
            PathEl::LineTo(p) => points.push(*p),
            PathEl::ClosePath if points.last() == points.first() => {}
            PathEl::ClosePath => points.push(points[0]),
            _ => return None,
        }
    }
    (points.len() > 1).then_some(points)
}

/// Trims half a nib off both ends of a stroke with square ends, as the nib's own end is round. A stroke no longer than a nib
/// becomes its midpoint.
fn trimmed(samples: Vec<Sample>, stroke: &Stroke, nib: f64) -> Vec<Sample> {
    if stroke.ends != Ends::Flat || stroke.is_closed() || samples.len() < 2 {
        return samples;
    }
    let mut along = vec![0.0];
    samples.windows(2).for_each(|pair| along.push(along[along.len() - 1] + pair[0].at.distance(pair[1].at)));
    let length = along[along.len() - 1];
    let cut = (0.5 * nib).min(0.5 * length);
    let at = |place: f64| {
        let i = along.partition_point(|passed| *passed <= place).clamp(1, samples.len() - 1);
        let t = (place - along[i - 1]) / (along[i] - along[i - 1]).max(1e-12);
        let (a, b) = (samples[i - 1], samples[i]);
        Sample { at: a.at.lerp(b.at, t), width: a.width + (b.width - a.width) * t }
    };
    if length - 2.0 * cut <= 1e-9 {
        return vec![at(0.5 * length)];
    }
    let between = (0..samples.len()).filter(|&i| along[i] > cut + 1e-9 && along[i] < length - cut - 1e-9).map(|i| samples[i]);
    std::iter::once(at(cut)).chain(between).chain([at(length - cut)]).collect()
}

/// Passes side by side that fill a spine.
fn fill(spine: &Spine, nib: f64, interrupt: &Interrupt) -> Vec<Toolpath> {
    let pitch = nib * (1.0 - OVERLAP);
    let widest = spine.room.iter().copied().fold(0.0, f64::max);
    let passes = (widest / pitch + 0.5).ceil().max(1.0) as usize;
    let mut paths: Vec<Toolpath> = Vec::new();
    for pass in (0..passes).take_while(|_| !interrupt.is_raised()) {
        let inner = pass as f64 * pitch;
        // Pass 0 covers the whole length; later ones only where more than half a pitch is still open.
        let has_room = |i: usize| pass == 0 || spine.room[i] - inner > -0.5 * pitch;
        for run in runs(spine.points.len(), has_room) {
            append(&mut paths, spine.pass(run, inner, ONE_LINE * nib), 1.6 * pitch);
        }
    }
    paths
}

impl Spine {
    fn of(samples: &[Sample], nib: f64) -> Self {
        let points: Vec<Point> = samples.iter().map(|sample| sample.at).collect();
        let last = points.len() - 1;
        let normals = (0..points.len())
            .map(|i| {
                let along = points[(i + 1).min(last)] - points[i.saturating_sub(1)];
                if along.hypot() > 1e-12 { along.normalize().turn_90() } else { Vec2::new(0.0, 1.0) }
            })
            .collect();
        // A line barely wider than the nib gains nothing from a second pass.
        let widest = samples.iter().map(|sample| sample.width).fold(0.0, f64::max);
        let room = |width: f64| if widest <= ONE_PASS * nib { 0.0 } else { (0.5 * (width - nib)).max(0.0) };
        Self {
            room: samples.iter().map(|sample| room(sample.width)).collect(),
            points,
            normals,
            is_closed: false,
            ends: Ends::Round,
        }
    }

    /// One pass over a run of the spine: out along one side and back along the other, or a single line where the sides coincide.
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
            if self.ends == Ends::Round && self.points.len() > 1 {
                if back.end - 1 == last && last + 1 == self.points.len() {
                    let forward = self.points[last] - self.points[last - 1];
                    line.splice(0..0, arc(self.points[last], side(last, 1.0), side(last, -1.0), forward));
                }
                if back.start == first && first == 0 {
                    line.extend(arc(self.points[0], side(0, -1.0), side(0, 1.0), self.points[0] - self.points[1]));
                }
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

/// A half circle around the stroke's end from one side to the other, on the side of `forward`.
fn arc(centre: Point, from: Point, to: Point, forward: Vec2) -> Vec<Point> {
    let (a, b) = (from - centre, to - centre);
    let ahead = forward.normalize() * a.hypot();
    (1..8)
        .map(|k| {
            let angle = std::f64::consts::PI * f64::from(k) / 8.0;
            centre + (a - b) * (0.5 * angle.cosine()) + ahead * angle.sine()
        })
        .collect()
}

/// Appends pieces of line, joined to the last path if the step between them is short and so lies within the stroke's ink.
fn append(paths: &mut Vec<Toolpath>, pieces: Vec<Vec<Point>>, reach: f64) {
    for piece in pieces.into_iter().filter_map(Toolpath::new) {
        let distances = |path: &Toolpath| (path.last().distance(piece.first()), path.last().distance(piece.last()));
        match paths.last_mut().map(|path| (distances(path), path)) {
            Some(((to_first, to_last), path)) if to_first.min(to_last) <= reach => {
                let piece = if to_last < to_first { piece.reversed() } else { piece };
                path.extend(piece.points().iter().copied());
            }
            _ => paths.push(piece),
        }
    }
}

fn runs(count: usize, holds: impl Fn(usize) -> bool) -> Vec<std::ops::Range<usize>> {
    runs_in(0..count, holds)
}

/// The maximal runs of indices for which `holds` is true.
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

    #[test]
    fn square_ends_are_half_a_nib_off() {
        let mut line = BezPath::new();
        line.move_to((0.0, 0.0));
        line.line_to((1.6, 0.0));
        let stroke = Stroke::even(line, 2.3).with_ends(Ends::Flat);
        let paths = lower_stroke(&stroke, 0.92, 0.0, &Interrupt::never());
        let xs = || paths.iter().flat_map(Toolpath::points).map(|p| p.x);
        assert!((xs().fold(f64::INFINITY, f64::min) - 0.46).abs() < 1e-6 && (xs().fold(0.0, f64::max) - 1.14).abs() < 1e-6);
    }

    #[test]
    fn a_wide_line_is_one_path_inside_its_ink() {
        for (width, rows) in [(0.5, 2.0), (1.0, 4.0), (2.0, 8.0)] {
            let stroke = Stroke::even(BezPath::from_svg("M0,0 L20,0").unwrap(), width);
            let paths = lower_stroke(&stroke, 0.3, 0.0, &Interrupt::never());
            assert_eq!(paths.len(), 1, "width {width}");
            let reach = 0.5 * width - 0.15 + 1e-9;
            assert!(paths[0].points().iter().all(|p| p.y.abs() <= reach && p.x >= -reach && p.x <= 20.0 + reach));
            assert!(paths[0].length() < 20.0 * (rows + 1.0) + 10.0, "width {width}: {}", paths[0].length());
        }
    }

    #[test]
    fn a_spindle_s_tips_are_dashes_with_its_own_ink() {
        let stroke = Stroke::swelling(BezPath::from_svg("M0,0 L10,0 L20,0").unwrap(), vec![0.0, 0.6, 0.0]).unwrap();
        let paths = lower_stroke(&stroke, 0.3, 0.0, &Interrupt::never());
        let thin: Vec<&Toolpath> = paths.iter().filter(|path| path.points().iter().all(|p| p.x < 4.8)).collect();
        assert!(thin.len() > 3, "{}", thin.len());
        let ink: f64 = thin.iter().map(|path| path.length() * 0.3 + 0.0707).sum();
        let end = thin.iter().flat_map(|path| path.points()).map(|p| p.x).fold(0.0, f64::max) + 0.3;
        let (points, widths) = stroke.sampled(0.01);
        let asked: f64 =
            (1..points.len()).filter(|&i| points[i].x < end).map(|i| widths[i] * points[i].distance(points[i - 1])).sum();
        assert!((ink / asked - 1.0).abs() < 0.2, "{ink} for {asked}");
        // Out along the whole length, back only where it is wider than the nib.
        let wide: f64 = paths.iter().filter(|path| path.length() > 5.0).map(Toolpath::length).sum();
        assert!((17.0..24.0).contains(&wide), "{wide}");
    }

    #[test]
    fn square_ends_are_kept() {
        let line = BezPath::from_svg("M0,0 L10,0").unwrap();
        for width in [0.3, 0.9] {
            let stroke = Stroke::even(line.clone(), width).with_ends(Ends::Flat);
            let paths = lower_stroke(&stroke, 0.3, 0.0, &Interrupt::never());
            assert!(paths.iter().flat_map(Toolpath::points).all(|p| p.x > 0.149 && p.x < 9.851), "{width}: {paths:?}");
        }
    }
}
