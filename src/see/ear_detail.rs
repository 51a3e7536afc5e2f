//! Ears as detail: their folds are as fine as those of eyes, and drawn as coarsely as a cheek they are part of it.

use super::detail::distance;
use crate::geometry::{Point, Rect, Vec2, convex_hull};
use crate::raster::Raster;
use crate::source::{Landmarks, outlines};

/// Where ears are: skin beside the face's outline, at these heights above the chin in heights of the face, and so far from the outline in its
/// widths; and the soft edges.
const HEIGHTS: [f64; 2] = [0.3, 0.76];
const BESIDE: [f64; 2] = [0.01, 0.3];
const SOFT: f64 = 0.03;
/// Eyes, nose and mouth stand out beside the outline of a turned face: so near them there is no ear, in widths of the face.
const ROUND_FRONT: f64 = 0.08;
/// The least area of an ear in squared widths of the face: less is a seam between cheek and hair.
const LEAST_AREA: f64 = 0.01;

/// The detail with the ears of all faces, by their skin.
pub(super) fn with_ears(mut detail: Raster<u8>, skin: &Raster<u8>, faces: &[Landmarks]) -> Raster<u8> {
    for face in faces {
        let head = Head::of(face);
        let shares = head.shares(skin);
        let area = |side: f64| shares.iter().filter(|(p, _)| side * head.across(*p) > 0.0).map(|(_, share)| share).sum::<f64>();
        for side in [-1.0, 1.0] {
            if area(side) < LEAST_AREA * head.width * head.width {
                continue;
            }
            for (p, share) in shares.iter().filter(|(p, _)| side * head.across(*p) > 0.0) {
                let (x, y) = (p.x as usize, p.y as usize);
                let value = (share * f64::from(skin.get(x, y))).round() as u8;
                detail.set(x, y, detail.get(x, y).max(value));
            }
        }
    }
    detail
}

/// A face, in pixels.
struct Head {
    oval: Vec<Point>,
    front: Vec<Point>,
    chin: Point,
    /// From the chin to the forehead.
    up: Vec2,
    width: f64,
}

impl Head {
    fn of(face: &Landmarks) -> Self {
        Self {
            oval: convex_hull(face.line(&outlines::OVAL)),
            front: convex_hull(outlines::FRONT.iter().flat_map(|line| face.line(line)).collect()),
            chin: face.point(152),
            up: face.point(10) - face.point(152),
            width: face.width(),
        }
    }

    /// How far to one side of the face's middle a place lies.
    fn across(&self, p: Point) -> f64 {
        (p - self.chin).cross(self.up)
    }

    /// The pixels' middles that are of ears, and how far they are, 0 to 1.
    fn shares(&self, skin: &Raster<u8>) -> Vec<(Point, f64)> {
        let reach = BESIDE[1] * self.width;
        let round = self.oval.iter().fold(Rect::from_points(self.chin, self.chin), |round, p| round.union_pt(*p));
        let round = round.inflate(reach, reach);
        let range =
            |from: f64, to: f64, count: usize| from.clamp(0.0, count as f64) as usize..to.clamp(0.0, count as f64) as usize;
        let (columns, rows) = (range(round.x0, round.x1, skin.width()), range(round.y0, round.y1, skin.height()));
        let places = rows.flat_map(|y| columns.clone().map(move |x| (x, y))).filter(|(x, y)| skin.get(*x, *y) > 127);
        let shares = places.map(|(x, y)| Point::new(x as f64 + 0.5, y as f64 + 0.5)).map(|p| (p, self.share(p)));
        shares.filter(|(_, share)| *share > 0.0).collect()
    }

    fn share(&self, p: Point) -> f64 {
        let height = (p - self.chin).dot(self.up) / self.up.hypot2().max(f64::MIN_POSITIVE);
        let soft = SOFT * self.width;
        let level = (height - HEIGHTS[0]).min(HEIGHTS[1] - height) / SOFT;
        if level <= 0.0 {
            return 0.0;
        }
        let away = distance(&self.oval, p);
        let beside = (away - BESIDE[0] * self.width).min(BESIDE[1] * self.width - away) / soft;
        let from_front = (distance(&self.front, p) - ROUND_FRONT * self.width) / soft;
        level.min(beside).min(from_front).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;
    use crate::source::{Iris, POINTS};
    use std::f64::consts::TAU;

    #[test]
    fn skin_beside_the_face_is_an_ear_and_a_seam_beside_hair_is_none() {
        let middle = Point::new(120.0, 100.0);
        let mut points = vec![[middle.x, middle.y, 0.0]; POINTS];
        let mut round = |line: &[usize], [x, y]: [f64; 2]| {
            for (i, index) in line.iter().enumerate() {
                // From the middle of the forehead on.
                let out = unit_at(TAU * (i as f64 / line.len() as f64 - 0.25));
                points[*index] = [middle.x + x * out.x, middle.y + y * out.y, 0.0];
            }
        };
        round(&outlines::LIPS, [8.0, 8.0]);
        round(&outlines::OVAL, [50.0, 70.0]);
        let face = Landmarks { points, irises: [Iris { centre: middle, radius: 2.0 }; 2], spectacles: None, pearls: Vec::new() };
        let is_skin = |x: usize, y: usize| (30..172).contains(&x) && (20..190).contains(&y);
        let skin = Raster::from_fn(240, 220, |x, y| if is_skin(x, y) { 255_u8 } else { 0 });
        let detail = with_ears(skin.map(|_| 0), &skin, &[face]);
        assert_eq!((detail.get(60, 100), detail.get(120, 100), detail.get(60, 40)), (255, 0, 0));
        assert_eq!(detail.get(171, 100), 0, "two pixels beside the cheek");
    }
}
