//! Frames of spectacles: an engraver draws each rim first, in one line. Thick dark ones are solid shapes.

use super::creases::share;
use super::solids::shapes;
use super::thick_frame::thick_frame;
use crate::drawing::{Area, Mark, Stroke};
use crate::field::Curve;
use crate::geometry::{Ends, Point, Ring, catmull_rom, polygon_area, resample, smooth_polyline};
use crate::raster::{Raster, dilate, gaussian_blur};
use crate::source::{Landmarks, MaskRole, Portrait, Spectacles};

/// The frames of all faces' spectacles on the page; `pitch` in working pixels.
pub(super) fn frames(portrait: &Portrait, pitch: f64) -> Vec<Mark> {
    let faces = portrait.faces.iter().filter_map(|face| Some((face, face.spectacles.as_ref()?)));
    let of = |(face, frame)| {
        let mask = thick_frame(face, &portrait.lightness, portrait.masks.get(&MaskRole::Hair));
        let mut marks = marks(frame, portrait, pitch, mask.as_ref());
        marks.extend(mask.and_then(|mask| solid(&mask, portrait, pitch)));
        marks
    };
    faces.flat_map(of).collect()
}

/// Blur of a thick frame's mask in pitches: its pixels' steps vanish, its corners stay.
const MASK_BLUR: f64 = 0.2;

/// The shape of a thick frame; none if it is smaller than a dot.
fn solid(mask: &Raster<u8>, portrait: &Portrait, pitch: f64) -> Option<Mark> {
    let smooth = gaussian_blur(&mask.map(f32::from), (MASK_BLUR * pitch).max(0.7) as f32);
    let outline = shapes(portrait, pitch, &smooth, 0.5, |curve| polygon_area(curve).abs() >= pitch * pitch);
    (!outline.is_empty()).then_some(Mark::Area(Area { outline, colour: None }))
}

/// Share of the width measured in the photograph, whose blur widens lines, and limits in pitches.
const SHARPER: f64 = 0.75;
const WIDTHS: [f64; 2] = [0.4, 1.6];

/// The width that a frame is drawn with, in working pixels.
fn drawn_width(frame: &Spectacles, pitch: f64) -> f64 {
    (SHARPER * frame.width).clamp(WIDTHS[0] * pitch, WIDTHS[1] * pitch)
}

/// How much thinner a rim is above, and wider below where it is in shade.
const SWELL: f64 = 0.25;
/// Distance of the lines' nodes in pitches; ends of temples taper over so many pitches.
const NODE: f64 = 1.0;
const TAPER: f64 = 4.0;
/// Smoothing of the lines, in widths of the frame: they were found on a grid of pixels.
const SMOOTH: f64 = 1.0;

/// The lines of a frame. A bridge or temple that lies in the mask of a thick frame is in its shape: its line would run along an edge.
fn marks(frame: &Spectacles, portrait: &Portrait, pitch: f64, mask: Option<&Raster<u8>>) -> Vec<Mark> {
    let scale = portrait.placement.mm_per_pixel();
    let width = drawn_width(frame, pitch) * scale;
    let fine = |weight: f64| (width * weight).max(FINEST * pitch * scale);
    let smooth = |line: &[Point], ring| smooth_polyline(line, ring, SMOOTH * frame.width, NODE * pitch);
    let on_page = |line: &[Point]| line.iter().map(|p| portrait.placement.to_page(*p)).collect::<Vec<Point>>();
    let weights = |line: &[Point], ring| weights(line, ring, frame.width, &portrait.lightness);
    let rims = frame.rims.iter().filter_map(|rim| {
        let line = smooth(rim, Ring::Closed);
        let (nodes, weights) = (on_page(&line), weights(&line, Ring::Closed));
        if nodes.len() < 3 {
            return None;
        }
        let (top, bottom) = nodes.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(t, b), p| (t.min(p.y), b.max(p.y)));
        let swelling = |p: &Point| 1.0 + SWELL * (2.0 * (p.y - top) / (bottom - top).max(1e-9) - 1.0);
        let mut widths: Vec<f64> = nodes.iter().zip(weights).map(|(p, weight)| fine(weight) * swelling(p)).collect();
        widths.push(widths[0]);
        Stroke::swelling(catmull_rom(&nodes, Ring::Closed), widths).map(Mark::Stroke)
    });
    let open = std::iter::once((&frame.bridge, false)).chain(frame.temples.iter().map(|temple| (temple, true)));
    let open = open.filter(|(line, _)| line.len() > 1 && !mask.is_some_and(|mask| is_largely_in(line, mask))).filter_map(
        |(line, tapers)| {
            let line = smooth(line, Ring::Open);
            let (nodes, weights) = (on_page(&line), weights(&line, Ring::Open));
            let last = (nodes.len() - 1) as f64;
            let rest = |i: usize| if tapers { ((last - i as f64) * NODE / TAPER).min(1.0) } else { 1.0 };
            let widths = weights.iter().enumerate().map(|(i, weight)| fine(*weight) * (0.2 + 0.8 * rest(i))).collect();
            let stroke = Stroke::swelling(catmull_rom(&nodes, Ring::Open), widths)?;
            Some(Mark::Stroke(stroke.with_ends(Ends::Flat)))
        },
    );
    rims.chain(open).collect()
}

/// Contrast of a frame from which its line is of full width, and the least share of that: clear plastic and the edges of lenses without rims are
/// fine lines. The least width in pitches: among a hedcut's dots a finer rim is lost (portrait 02).
const FIRM: f32 = 0.12;
const FINE: f64 = 0.4;
const FINEST: f64 = 0.28;
/// Where a line is sought, and with what it is compared, to either side in widths of the frame; and nodes over which that is evened out.
const ON: f64 = 1.0;
const BESIDE: f64 = 2.2;
const EVEN: usize = 6;

/// The width of a line at each of its nodes, as a share: as firm as the frame parts from what is around it.
fn weights(line: &[Point], ring: Ring, width: f64, lightness: &Raster<f32>) -> Vec<f64> {
    let count = line.len();
    let around = |i: usize, by: isize| match ring {
        Ring::Closed => (i as isize + by).rem_euclid(count as isize) as usize,
        Ring::Open => (i as isize + by).clamp(0, count as isize - 1) as usize,
    };
    let contrast = |i: usize| {
        let along = line[around(i, 1)] - line[around(i, -1)];
        let across = along.turn_90() / along.hypot().max(1e-9) * width.max(1.0);
        let at = |share: f64| lightness.sample(line[i].x + share * across.x, line[i].y + share * across.y);
        let darkest = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|share| at(ON * share)).into_iter().fold(f32::INFINITY, f32::min);
        f32::midpoint(at(BESIDE), at(-BESIDE)) - darkest
    };
    let shares: Vec<f64> = (0..count).map(|i| f64::from(contrast(i) / FIRM).clamp(FINE, 1.0)).collect();
    let reach = EVEN as isize;
    (0..count).map(|i| (-reach..=reach).map(|by| shares[around(i, by)]).sum::<f64>() / (2 * EVEN + 1) as f64).collect()
}

fn is_largely_in(line: &[Point], mask: &Raster<u8>) -> bool {
    let inside = line.iter().filter(|p| mask.clamped(p.x as isize, p.y as isize) == 1).count();
    3 * inside > line.len()
}

/// Lines that frames take the place of.
pub(super) struct Frames(Raster<u8>);

impl Frames {
    /// Of the spectacles in front of a portrait's faces.
    pub(super) fn of(portrait: &Portrait) -> Self {
        let lightness = &portrait.lightness;
        Self(zone(&portrait.faces, lightness.width(), lightness.height()))
    }

    /// True for a line, in working pixels, that runs along a frame.
    pub(super) fn have(&self, line: &Curve) -> bool {
        share(line, |p| self.0.clamped(p.x as isize, p.y as isize) == 1) > 0.5
    }
}

/// Reach of a frame to either side of its lines, in its widths: nearer dark lines are its own, others crumbs of skin.
const OWN: f64 = 1.2;

/// 1 on the lines of a face's frame and close beside them.
pub(super) fn zone(faces: &[Landmarks], width: usize, height: usize) -> Raster<u8> {
    let mut all = Raster::filled(width, height, 0_u8);
    for frame in faces.iter().filter_map(|face| face.spectacles.as_ref()) {
        let lines = frame_lines(frame, width, height);
        all = all.zip_map(&dilate(&lines, (OWN * frame.width).round().max(1.0) as usize), u8::max);
    }
    all
}

/// 1 on the lines of a frame, one pixel wide.
pub(super) fn frame_lines(frame: &Spectacles, width: usize, height: usize) -> Raster<u8> {
    let mut lines = Raster::filled(width, height, 0_u8);
    for p in frame.lines().iter().flat_map(|line| resample(line, 0.7)) {
        if p.x >= 0.0 && p.y >= 0.0 && p.x < width as f64 && p.y < height as f64 {
            lines.set(p.x as usize, p.y as usize, 1);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_fine_where_it_is_as_light_as_what_is_around_it() {
        let light = Raster::from_fn(120, 40, |x, y| if x < 60 && y.abs_diff(20) < 2 { 0.3 } else { 0.7 });
        let line: Vec<Point> = (0..=20).map(|i| Point::new(10.0 + 5.0 * f64::from(i), 20.0)).collect();
        let weights = weights(&line, Ring::Open, 3.0, &light);
        assert!(weights[..3].iter().all(|weight| *weight > 0.99), "{weights:?}");
        assert!(weights[18..].iter().all(|weight| (*weight - FINE).abs() < 1e-6), "{weights:?}");
    }
}
