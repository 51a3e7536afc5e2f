//! Nearness of the people: the subject inflated like a cushion, with the faces' own relief on it and bodies set back behind
//! chins.
//!
//! Slopes are combined, not heights: within a face they follow its landmarks, elsewhere the cushion, with a soft seam between;
//! Poisson's equation gives the heights. So no border has a step, and hair keeps the volume of its silhouette.

mod face_relief;
mod heads;

use super::sight::Face;
use super::view::View;
use crate::elementary::Elementary as _;
use crate::field::{poisson, screened_poisson};
use crate::geometry::Point;
use crate::raster::{Raster, enlarge_smoothly, gaussian_blur, reduce};
use crate::source::Landmarks;
use face_relief::FaceRelief;
use heads::Heads;

/// Longest side of the depth grid, in pixels; depth is smooth throughout.
const LONGEST: usize = 280;
/// V-cycles of each Poisson solution.
const CYCLES: usize = 6;
/// Blur of the silhouette in widths of the face, and the threshold for inside: curls and a raster's steps would show as waves in
/// the lines inside.
const OUTLINE_SMOOTHING: f64 = 0.04;
const OUTLINE: f32 = 0.15;
/// Reach of the silhouette in widths of the face: a head is round; a torso, which is much wider, is at most half as thick again.
const REACH: f64 = 0.4;
/// Rounding at the silhouette in widths of the face: a hemisphere's edge is infinitely steep, which crowds lines.
const EDGE: f64 = 0.2;
/// Blur of the result in pixels of the grid.
const SMOOTHING: f32 = 1.0;
/// Least depth range of the whole picture, in its longer sides: in a picture of small faces their relief is small too.
const LEAST_RANGE: f64 = 0.3;
/// Nearness grows with this power of the height: faces, which are high, take more of the range, and the silhouette is flatter. At
/// 1 an engraving's lines hardly bend over a face; at 2 shoulders are flat.
const POWER: f64 = 1.6;
/// Nearness of the subject's farthest pixel, and the least mask value that has depth.
const FARTHEST: f64 = 0.05;
const LEAST_SUBJECT: u8 = 26;

/// Nearness of each pixel of the view: 65535 the nearest, 0 where there is no subject.
pub(super) fn depth(subject: &Raster<u8>, view: &View, faces: &[Face]) -> Raster<u16> {
    let step = view.step();
    let placed = |face: &Face| {
        let from = view.part.origin();
        face.landmarks.placed(|p| Point::new((p.x - from.x) / step.x, (p.y - from.y) / step.y), 1.0 / step.x)
    };
    let faces: Vec<Landmarks> = faces.iter().map(placed).collect();
    depth_of(subject, &faces)
}

/// [`depth`] for faces in pixels of the subject.
fn depth_of(subject: &Raster<u8>, faces: &[Landmarks]) -> Raster<u16> {
    let (width, height) = (subject.width(), subject.height());
    let factor = width.max(height).div_ceil(LONGEST).max(1);
    let scale = 1.0 / factor as f64;
    let small = reduce(&subject.map(|v| f32::from(v) / 255.0), factor);
    let faces: Vec<Landmarks> = faces.iter().map(|face| face.placed(|p| Point::new(scale * p.x, scale * p.y), scale)).collect();
    let Some(heads) = Heads::new(&faces, [small.width(), small.height()]) else { return subject.map(|_| 0) };
    let heights = heights(&small, &faces, &heads);
    let heights = enlarge_smoothly(&gaussian_blur(&heights, SMOOTHING), factor, width, height);
    as_nearness(&heights, subject, LEAST_RANGE * scale * width.max(height) as f64)
}

/// Heights above the background's plane, in pixels of the grid.
fn heights(subject: &Raster<f32>, faces: &[Landmarks], heads: &Heads) -> Raster<f32> {
    let width = heads.largest();
    let is_outside = gaussian_blur(subject, (OUTLINE_SMOOTHING * width) as f32).map(|v| v < OUTLINE);
    let given = is_outside.map(|outside| outside.then_some(0.0_f32));
    let cushion = cushion(&given, width);
    let base = cushion.zip_map(&heads.set_back(subject.width(), subject.height()), |cushion, set_back| cushion - set_back);
    let mut steps = Raster::filled(subject.width(), subject.height(), [0.0_f32; 2]);
    for face in faces {
        FaceRelief::new(face).lay(&base, &mut steps);
    }
    let source = Raster::from_fn(subject.width(), subject.height(), |x, y| {
        let [right, down] = steps.get(x, y);
        let left = if x > 0 { steps.get(x - 1, y)[0] } else { 0.0 };
        let up = if y > 0 { steps.get(x, y - 1)[1] } else { 0.0 };
        right - left + down - up
    });
    base.zip_map(&poisson(&source, &given, CYCLES), |base, relief| base + relief)
}

fn centre(x: usize, y: usize) -> Point {
    Point::new(x as f64 + 0.5, y as f64 + 0.5)
}

/// The inflated subject: a disc becomes a hemisphere, flatter far from its silhouette. The photograph's edge is no silhouette.
fn cushion(given: &Raster<Option<f32>>, width: f64) -> Raster<f32> {
    let edge = (EDGE * width) as f32;
    let squares = screened_poisson(&given.map(|_| -4.0), given, (REACH * width) as f32, CYCLES);
    squares.map(|square| (square.max(0.0) + edge * edge).sqrt() - edge)
}

/// Heights in 16 bits: the nearest pixel of the subject is 65535; the range is at least `least_range`.
fn as_nearness(heights: &Raster<f32>, subject: &Raster<u8>, least_range: f64) -> Raster<u16> {
    let inside = || heights.pixels().iter().zip(subject.pixels()).filter(|(_, s)| **s >= LEAST_SUBJECT).map(|(h, _)| *h);
    let (lowest, highest) = inside().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
    let range = f64::from(highest - lowest).max(least_range).max(1e-6);
    heights.zip_map(subject, |height, subject| {
        if subject < LEAST_SUBJECT {
            return 0;
        }
        let share = (1.0 - f64::from(highest - height) / range).clamp(0.0, 1.0);
        let nearness = FARTHEST + (1.0 - FARTHEST) * share.power(POWER);
        (65535.0 * nearness).round() as u16
    })
}
