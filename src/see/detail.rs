//! The features by which a face is recognised: eyes, brows, nose and mouth, from its landmarks.

use crate::geometry::{Point, Vec2, convex_hull};
use crate::raster::Raster;
use crate::source::Landmarks;
use crate::source::outlines::{LEFT_BROW, LEFT_EYE, LIPS, RIGHT_BROW, RIGHT_EYE};

/// The nose's underside and wings, up to its tip.
const NOSE: [usize; 11] = [1, 48, 64, 98, 97, 2, 326, 327, 294, 278, 4];
/// Margin of the lids around the eye, in widths of the face.
const LIDS: f64 = 0.02;
/// Width of the soft edge, in widths of the face.
const SOFT: f64 = 0.02;

/// A part of a face that needs finer strokes.
#[derive(Clone, Debug, PartialEq)]
pub struct DetailRegion {
    /// What it is; left and right are the person's.
    pub name: &'static str,
    /// Its outline, closed and convex, in the landmarks' unit.
    pub outline: Vec<Point>,
    /// How far it extends beyond the outline, in that unit.
    pub margin: f64,
}

/// The parts of a face that need finer strokes.
pub fn detail_regions(face: &Landmarks) -> Vec<DetailRegion> {
    let lids = LIDS * face.width();
    let region = |name, indices: &[usize], margin| DetailRegion { name, outline: convex_hull(face.line(indices)), margin };
    vec![
        region("right eye", &RIGHT_EYE, lids),
        region("left eye", &LEFT_EYE, lids),
        region("right brow", &RIGHT_BROW, 0.0),
        region("left brow", &LEFT_BROW, 0.0),
        region("nose", &NOSE, 0.0),
        region("mouth", &LIPS, 0.0),
    ]
}

/// All parts of all faces, 0 to 255 with a soft edge, never more than the subject; the faces are in its pixels.
pub(super) fn detail(subject: &Raster<u8>, faces: &[Landmarks]) -> Raster<u8> {
    let mut out = subject.map(|_| 0_u8);
    for face in faces {
        let soft = (SOFT * face.width()).max(1.0);
        for region in detail_regions(face) {
            paint(&mut out, &region, soft);
        }
    }
    out.zip_map(subject, u8::min)
}

fn paint(out: &mut Raster<u8>, region: &DetailRegion, soft: f64) {
    let reach = region.margin + soft;
    let range = |of: &dyn Fn(&Point) -> f64, count: usize| {
        let ends = region.outline.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let end = |v: f64| v.clamp(0.0, count as f64) as usize;
        end(ends.0 - reach)..end(ends.1 + reach + 1.0)
    };
    let (columns, rows) = (range(&|p| p.x, out.width()), range(&|p| p.y, out.height()));
    for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
        let beyond = distance(&region.outline, Point::new(x as f64 + 0.5, y as f64 + 0.5)) - region.margin;
        let t = (0.5 - beyond / soft).clamp(0.0, 1.0);
        let value = (255.0 * t * t * (3.0 - 2.0 * t)).round() as u8;
        out.set(x, y, out.get(x, y).max(value));
    }
}

/// Distance of a point from a convex polygon, negative inside.
pub(super) fn distance(outline: &[Point], p: Point) -> f64 {
    let mut nearest = f64::INFINITY;
    let (mut left, mut right) = (false, false);
    for (a, b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
        let (along, to): (Vec2, Vec2) = (*b - *a, p - *a);
        let t = (to.dot(along) / along.hypot2().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        nearest = nearest.min((to - along * t).hypot());
        let cross = along.cross(to);
        left |= cross > 0.0;
        right |= cross < 0.0;
    }
    if left && right { nearest } else { -nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_to_a_square() {
        let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(Point::from);
        assert_eq!(distance(&square, Point::new(2.0, 1.0)), -1.0);
        assert_eq!(distance(&square, Point::new(7.0, 8.0)), 5.0);
    }

    #[test]
    fn a_painted_region_is_soft_and_within_the_raster() {
        let outline = [(2.0, 2.0), (60.0, 2.0), (60.0, 12.0), (2.0, 12.0)].map(Point::from).to_vec();
        let mut out = Raster::filled(30, 20, 0_u8);
        paint(&mut out, &DetailRegion { name: "nose", outline, margin: 2.0 }, 4.0);
        assert_eq!((out.get(20, 7), out.get(20, 19)), (255, 0));
        assert!((60..200).contains(&out.get(20, 13)), "{}", out.get(20, 13));
    }
}
