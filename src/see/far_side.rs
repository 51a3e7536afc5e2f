//! The far side of a turned face, where the face itself is the outline: what sticks out of it in a thin piece between brow and mouth is the arm or the
//! lens of spectacles. A part of it alone is a stub that nobody reads.

use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, components, dilate, open_round};
use crate::source::Landmarks;

/// Half the width of the widest stub and its least area, and the least area of a body, in widths of the face and their squares.
const STUB: f64 = 0.035;
const LEAST: f64 = 0.0015;
const BODY: f64 = 0.1;
/// Pixels around a body that belong to its soft edge, and the value above which a pixel of the subject is solid.
const SOFT: usize = 3;
const SOLID: u8 = 127;
/// The most of a face's width that lies beyond the tip of its nose if it is turned: profiles and nearly those.
const TURNED: f64 = 0.25;
/// How far beyond the face's border a stub's middle lies at most, in widths of the face.
const BEYOND: f64 = 0.8;

/// The subject without stubs; `faces` in its pixels.
pub(super) fn without_stubs(subject: Raster<u8>, faces: &[Landmarks]) -> Raster<u8> {
    faces.iter().filter_map(FarSide::of).fold(subject, |subject, side| {
        let solid = subject.map(|v| u8::from(v > SOLID));
        let opened = open_round(&solid, (STUB * side.width) as usize);
        let area = side.width * side.width;
        let is_stub = side.largest(&solid.zip_map(&opened, |solid, opened| solid & (1 - opened))) >= LEAST * area;
        if !is_stub {
            return subject;
        }
        // The joint at an arm's end is as wide as a nose, but hangs on nothing else.
        let body = dilate(&large(&opened, BODY * area), SOFT);
        Raster::from_fn(subject.width(), subject.height(), |x, y| {
            let is_left_out = body.get(x, y) == 0 && side.holds(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            if is_left_out { 0 } else { subject.get(x, y) }
        })
    })
}

/// The pieces of a mask, 0 or 1, that have an area at least.
fn large(mask: &Raster<u8>, least: f64) -> Raster<u8> {
    let (labels, count) = components(mask);
    let mut areas = vec![0.0; count + 1];
    labels.pixels().iter().for_each(|label| areas[*label as usize] += 1.0);
    labels.map(|label| u8::from(label != 0 && areas[label as usize] >= least))
}

/// The far side of a face.
struct FarSide {
    width: f64,
    /// The cheek there, and the way out from it, of length 1.
    cheek: Point,
    out: Vec2,
    /// From the brows down to the mouth.
    brow: Point,
    down: Vec2,
}

impl FarSide {
    /// `None` if the face is not turned.
    fn of(face: &Landmarks) -> Option<Self> {
        /// Cheeks on either side at the height of the ears; the nose's tip; between the brows, and the mouth's middle.
        const CHEEKS: [usize; 2] = [234, 454];
        const NOSE: usize = 1;
        const BETWEEN_BROWS: usize = 9;
        const MOUTH: usize = 13;
        let [a, b] = CHEEKS.map(|i| face.point(i));
        let across = (b - a).hypot();
        let along = (face.point(NOSE) - a).dot(b - a) / (across * across).max(1e-9);
        let (cheek, other) = if along < 0.5 { (a, b) } else { (b, a) };
        let (brow, down) = (face.point(BETWEEN_BROWS), face.point(MOUTH) - face.point(BETWEEN_BROWS));
        let is_turned = along.min(1.0 - along) < TURNED && across > 0.0 && down.hypot() > 0.0;
        is_turned.then(|| Self { width: face.width(), cheek, out: (cheek - other) / across, brow, down })
    }

    /// The area in pixels of the largest piece of a mask, 0 or 1, whose middle lies here.
    fn largest(&self, mask: &Raster<u8>) -> f64 {
        let (labels, count) = components(mask);
        let mut sums = vec![(0.0_f64, Vec2::ZERO); count + 1];
        for (i, label) in labels.pixels().iter().enumerate().filter(|(_, label)| **label != 0) {
            let (area, sum) = &mut sums[*label as usize];
            *area += 1.0;
            *sum += Vec2::new((i % labels.width()) as f64 + 0.5, (i / labels.width()) as f64 + 0.5);
        }
        let here = sums.into_iter().filter(|(area, sum)| *area > 0.0 && self.holds((*sum / *area).to_point()));
        here.map(|(area, _)| area).fold(0.0, f64::max)
    }

    /// Whether a place lies beyond the far cheek, between brow and mouth.
    fn holds(&self, p: Point) -> bool {
        let beyond = (p - self.cheek).dot(self.out) / self.width;
        let down = (p - self.brow).dot(self.down) / self.down.hypot2();
        (0.0..BEYOND).contains(&beyond) && (-0.3..1.0).contains(&down)
    }
}

#[cfg(test)]
mod tests {
    use super::super::regions::tests::face;
    use super::*;

    /// The share of an arm that is left beside a head that is turned by an angle, in radians.
    fn left(yaw: f64) -> f64 {
        let mut face = face(Point::new(150.0, 100.0), 240.0, yaw);
        let middle = if yaw > 0.5 { 98.0 } else { 150.0 };
        for (i, y) in [(1, 100.0), (9, 80.0), (13, 130.0)] {
            face.points[i] = [middle, y, 0.0];
        }
        let border = face.point(234).x as usize;
        let is_arm = |x: usize, y: usize| (border - 30..border).contains(&x) && (96..100).contains(&y);
        let subject = Raster::from_fn(300, 200, |x, y| if is_arm(x, y) || (x >= border && x < 220) { 255 } else { 0_u8 });
        let subject = without_stubs(subject, &[face]);
        let arm = (border - 30..border).flat_map(|x| (96..100).map(move |y| (x, y)));
        arm.filter(|(x, y)| subject.get(*x, *y) > SOLID).count() as f64 / 120.0
    }

    #[test]
    fn an_arm_beyond_the_far_cheek_goes_and_one_beside_a_face_seen_from_the_front_stays() {
        assert!(left(1.0) < 0.3, "{}", left(1.0));
        assert_eq!(left(0.0), 1.0);
    }
}
