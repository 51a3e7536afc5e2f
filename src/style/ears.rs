//! The places beside faces where ears are: hedcut and grid set finer dots there, but solid shapes and sharpened lines would be blots.

use super::solids::inside_outlines;
use crate::geometry::{Point, convex_hull};
use crate::raster::{Raster, dilate, filled_polygon, gaussian_blur};
use crate::source::{Portrait, outlines};
use std::ops::Range;

/// Heights above the chin, in heights of the face, and how far from its middle, in its widths: around all that is found as ears.
const HEIGHTS: Range<f64> = 0.24..0.82;
const FARTHEST: f64 = 1.1;
/// Eyes, nose and mouth stand out beside the outline of a turned face: so near them there is no ear, in widths of the face.
const ROUND_FRONT: f64 = 0.07;
/// Pearls and what is so near them are none, in radii.
const PEARL: f64 = 1.5;
/// Blur of the border in pitches.
const SOFT: f64 = 1.0;

/// 1 beside the faces at the height of their ears, but for pearls; `pitch` in working pixels.
pub(super) fn beside_faces(portrait: &Portrait, pitch: f64) -> Raster<f32> {
    let (columns, rows) = (portrait.subject.width(), portrait.subject.height());
    let inside = inside_outlines(&portrait.faces, [&outlines::OVAL, &outlines::OVAL], (columns, rows));
    let front = portrait.faces.iter().fold(inside.map(|_| 0_u8), |all, face| {
        let brows: [&[usize]; 2] = [&outlines::LEFT_BROW, &outlines::RIGHT_BROW];
        let hull = convex_hull(outlines::FRONT.iter().chain(&brows).flat_map(|line| face.line(line)).collect());
        let corners: Vec<[f64; 2]> = hull.iter().map(|p| [p.x, p.y]).collect();
        let reach = (ROUND_FRONT * face.width()).round().max(1.0) as usize;
        all.zip_map(&dilate(&filled_polygon(columns, rows, &corners), reach), u8::max)
    });
    let is_beside = |p: Point| {
        portrait.faces.iter().any(|face| {
            let (off, up) = (p - face.point(152), face.point(10) - face.point(152));
            let (along, across) = (off.dot(up) / up.hypot2().max(1e-9), off.cross(up).abs() / up.hypot().max(1e-9));
            across < FARTHEST * face.width() && HEIGHTS.contains(&along)
        })
    };
    let is_pearl = |p: Point| {
        let mut all = portrait.faces.iter().flat_map(|face| &face.pearls);
        all.any(|pearl| pearl.center.distance(p) < PEARL * pearl.radius)
    };
    let zone = Raster::from_fn(columns, rows, |x, y| {
        let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
        let is_out = inside.get(x, y) < 0.5 && front.get(x, y) == 0;
        if is_out && is_beside(p) && !is_pearl(p) { 1.0_f32 } else { 0.0 }
    });
    gaussian_blur(&zone, (SOFT * pitch) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::form::mean_portrait;
    use kurbo::Circle;

    #[test]
    fn ears_are_beside_the_face_and_a_pearl_is_none() {
        let mut portrait = mean_portrait(6.0, 0.0, |_| 100);
        let face = &portrait.faces[0];
        let out = 0.12 * face.width();
        let [ear, nose] = [face.point(454) + (out, 0.0), face.point(1)];
        let at = |portrait: &Portrait, p: Point| beside_faces(portrait, 1.0).clamped(p.x as isize, p.y as isize);
        assert!(at(&portrait, ear) > 0.95 && at(&portrait, nose) < 0.01);
        portrait.faces[0].pearls = vec![Circle::new(ear, 0.05 * out / 0.12)];
        assert!(at(&portrait, ear) < 0.05);
    }
}
