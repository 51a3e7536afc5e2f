//! The pose of a head: where the picture certainly shows the person, and where head, shoulders and body are expected.

use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect, Vec2};
use crate::raster::{Raster, filled_polygon};
use crate::source::LEAST_FACE_WIDTH;
use crate::source::outlines::OVAL;

/// A close-up: the face is wider than this fraction of the picture, or the top of the head, `TOP` heights of the face above the
/// forehead, is outside it.
const CLOSE_UP: f64 = 0.5;
const TOP: f64 = 0.3;
/// Extent of the expected head above and below its middle, and height of its middle above the face's, in widths of the face: hats
/// and high hair are common above, and flags and lamps are rare there.
const HEIGHTS: [f64; 2] = [1.35, 1.0];
const RAISED: f64 = 0.12;

/// A piecewise linear function given by its corners; constant beyond the first and last.
fn through_corners<const N: usize>(corners: [(f64, f64); N], x: f64) -> f64 {
    let inside = corners.windows(2).find(|pair| x < pair[1].0);
    let [(x0, y0), (x1, y1)] = inside.map_or([corners[N - 1]; 2], |pair| [pair[0], pair[1]]);
    if x1 > x0 { y0 + (y1 - y0) * ((x - x0) / (x1 - x0)).clamp(0.0, 1.0) } else { y1 }
}

/// Width of a head at a height, relative to that at the eyes: it narrows to the chin, beside which hair that ends at the ears leaves shadows
/// on walls.
fn narrowing(down: f64) -> f64 {
    const JAW: f64 = 0.35;
    through_corners([(-0.2, 1.0), (0.6, 1.0 - JAW)], down)
}

/// The pose of a head, in pixels of the upright picture.
#[derive(Clone)]
pub(super) struct Head {
    oval: Vec<Point>,
    /// The midpoint between the ears.
    pub centre: Point,
    forehead: Point,
    /// From ear to ear.
    pub width: f64,
    crown: f64,
    /// The middle of the face, and the unit vector from the person's right to left.
    middle: Point,
    across: Vec2,
    /// Extent of the face's oval to either side of the middle, in widths of the face.
    sides: [f64; 2],
    /// The same of the expected head.
    reach: [f64; 2],
    /// The same of the skull with its ears.
    skull: [f64; 2],
}

impl Head {
    /// From a face's 468 landmarks.
    pub(super) fn new(points: &[[f64; 3]]) -> Self {
        /// Hair and ears beside the oval, in widths of the face; the rest of it at the far side of a face turned so far that the
        /// nose is `TURNED` widths from the middle; and the widths that the back of the head adds on the near side per width of
        /// the nose's offset.
        const BESIDE: f64 = 0.22;
        const FAR: f64 = 0.03;
        const TURNED: f64 = 0.3;
        const BACK: f64 = 0.8;
        /// Ears beside the oval, and how far the oval of a turned face extends beyond its far cheek.
        const EAR: f64 = 0.1;
        const BEYOND: f64 = 0.083;
        let at = |i: usize| Point::new(points[i][0], points[i][1]);
        let (nose, forehead, chin, right, left) = (at(1), at(10), at(152), at(234), at(454));
        let up = forehead - chin;
        let width = (left - right).hypot().max(LEAST_FACE_WIDTH * up.hypot()).max(1.0);
        let eyes = at(263) - at(33);
        let across = if eyes.hypot() > 0.0 { eyes.normalize() } else { Vec2::new(1.0, 0.0) };
        let (oval, centre) = (OVAL.map(at).to_vec(), right.midpoint(left));
        let down = Vec2::new(-across.y, across.x);
        let middle = centre + down * (forehead.midpoint(chin) - centre).dot(down);
        let turn = (nose - centre).dot(across) / width;
        let turned = (turn.abs() / TURNED).min(1.0);
        let (far, near) = (FAR + BESIDE * (1.0 - turned), BESIDE + BACK * turn.abs());
        let beside = if turn < 0.0 { [far, near] } else { [near, far] };
        let most = |sign: f64| oval.iter().map(|p| sign * (*p - middle).dot(across)).fold(0.0, f64::max) / width;
        let sides = [most(-1.0), most(1.0)];
        let reach = [sides[0] + beside[0], sides[1] + beside[1]];
        let far_ear = EAR - turned * (EAR + BEYOND);
        let ears = if turn < 0.0 { [far_ear, EAR] } else { [EAR, far_ear] };
        let skull = [sides[0] + ears[0], sides[1] + ears[1]];
        Self { oval, centre, forehead, width, crown: forehead.y + TOP * up.y, middle, across, sides, reach, skull }
    }

    pub(super) fn is_close_up(&self, picture: Rect) -> bool {
        self.width > CLOSE_UP * picture.width() || self.crown < picture.y0
    }

    /// The part of the picture around this head, down to the lower border.
    pub(super) fn surroundings(&self, picture: Rect) -> Rect {
        /// Extent of the surroundings of the head, in widths of the face: to either side, and above the forehead.
        const NEAR_SIDE: f64 = 1.7;
        const NEAR_TOP: f64 = 1.0;
        let reach = NEAR_SIDE * self.width;
        let top = self.forehead.y - NEAR_TOP * self.width;
        Rect::new(self.centre.x - reach, top, self.centre.x + reach, picture.y1).intersect(picture)
    }

    /// The face without its rim, on a grid of `columns` by `rows` over a picture.
    pub(super) fn sure(&self, picture: Rect, columns: usize, rows: usize) -> Raster<u8> {
        /// Scale of the oval, about its middle, that is certainly person: the oval of a turned face extends beyond its far cheek,
        /// by up to a twelfth of the face; at 1 a strip of background stays there, at 0.7 highlights on a forehead are lost.
        const SURE: f64 = 0.85;
        self.scaled(SURE, picture, columns, rows)
    }

    /// The face with what is beside it, on such a grid: the far cheek of a turned head lies beside its landmarks.
    pub(super) fn with_cheeks(&self, picture: Rect, columns: usize, rows: usize) -> Raster<u8> {
        /// Scale of the oval about its middle. The cheek of one turned head reaches to 1.13, and a man behind it begins there.
        const CHEEKS: f64 = 1.12;
        self.scaled(CHEEKS, picture, columns, rows)
    }

    /// The oval of the face, scaled about its middle.
    fn scaled(&self, scale: f64, picture: Rect, columns: usize, rows: usize) -> Raster<u8> {
        let middle = self.oval.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2()) / self.oval.len() as f64;
        let outline: Vec<[f64; 2]> = self
            .oval
            .iter()
            .map(|p| middle + scale * (p.to_vec2() - middle) - picture.origin().to_vec2())
            .map(|p| [p.x * columns as f64 / picture.width(), p.y * rows as f64 / picture.height()])
            .collect();
        filled_polygon(columns, rows, &outline)
    }

    /// A place across and down from the face's middle, in widths of the face.
    fn relative(&self, place: Point) -> (f64, f64) {
        let from = (place - self.middle) / self.width;
        (from.dot(self.across), from.dot(Vec2::new(-self.across.y, self.across.x)))
    }

    /// True beside the jaw and the neck.
    pub(super) fn is_at_neck(&self, place: Point) -> bool {
        /// From the ears to the shoulders below the face's middle, and to either side of it, in widths of the face.
        const DOWN: [f64; 2] = [0.1, 0.95];
        const ASIDE: f64 = 0.95;
        let (across, down) = self.relative(place);
        across.abs() < ASIDE && (DOWN[0]..DOWN[1]).contains(&down)
    }

    /// True above the shoulders and beyond a head with short hair.
    pub(super) fn is_beside(&self, place: Point) -> bool {
        /// Short hair and ears beside the oval, in widths of the face.
        const SHORT: f64 = 0.1;
        const SHORT_HEIGHT: f64 = 1.15;
        /// Height of the shoulders below the face's middle, in widths of the face.
        const SHOULDERS: f64 = 0.55;
        let (across, down) = self.relative(place);
        let side = self.sides[usize::from(across >= 0.0)] + SHORT;
        let reach = side * narrowing(down);
        let down_from_middle = down + RAISED;
        let height = if down_from_middle >= 0.0 { 1.0 } else { SHORT_HEIGHT };
        down <= SHOULDERS && (across / reach).hypotenuse(down_from_middle / height) >= 1.0
    }

    /// How surely a point is in the skull or an ear: from 1 to 0. Below the ears it is 0, as collars and shadows are beside the jaw.
    pub(super) fn skull_at(&self, place: Point) -> f64 {
        /// Height of a skull with short hair above its middle, and the lobes' depth below the face's, in widths of the face.
        const HEIGHT: f64 = 1.05;
        const LOBES: f64 = 0.3;
        let (across, down) = self.relative(place);
        let reach = self.skull[usize::from(across >= 0.0)] * narrowing(down);
        let down_from_middle = down + RAISED;
        let height = if down_from_middle >= 0.0 { 1.0 } else { HEIGHT };
        let skull = through_corners([(0.95, 1.0), (1.05, 0.0)], (across / reach).hypotenuse(down_from_middle / height));
        if down > LOBES { 0.0 } else { skull }
    }

    /// How much this person is expected at a point, whatever the hair or hat: from 1, in head and body, to 0.
    pub(super) fn expectation_at(&self, place: Point) -> f64 {
        let (across, down) = self.relative(place);
        let reach = self.reach[usize::from(across >= 0.0)] * narrowing(down);
        let down_from_middle = down + RAISED;
        let height = HEIGHTS[usize::from(down_from_middle >= 0.0)];
        let head = through_corners([(0.9, 1.0), (1.25, 0.0)], (across / reach).hypotenuse(down_from_middle / height));
        // Below the chin, half a width down, shoulders widen to either side.
        let shoulders = through_corners([(0.5, 0.4), (0.8, 1.15), (1.2, 2.2)], down);
        let body = if down > 0.45 { through_corners([(1.0, 1.0), (1.4, 0.0)], across.abs() / shoulders) } else { 0.0 };
        head.max(body)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A face 100 wide and 140 high about `(x, y)`, with its nose `nose` to the side.
    pub(in super::super) fn face(x: f64, y: f64, nose: f64) -> Vec<[f64; 3]> {
        let mut points = vec![[x, y, 0.0]; 468];
        for (i, k) in OVAL.iter().enumerate() {
            let (sin, cos) = (i as f64 / OVAL.len() as f64 * std::f64::consts::TAU).sine_and_cosine();
            points[*k] = [x + 50.0 * sin, y - 70.0 * cos, 0.0];
        }
        (points[33], points[263], points[1]) = ([x - 30.0, y - 20.0, 0.0], [x + 30.0, y - 20.0, 0.0], [x + nose, y, 0.0]);
        (points[10], points[152]) = ([x, y - 70.0, 0.0], [x, y + 70.0, 0.0]);
        (points[234], points[454]) = ([x - 50.0, y, 0.0], [x + 50.0, y, 0.0]);
        points
    }

    #[test]
    fn head_and_shoulders_are_expected_and_what_is_beside_them_is_not() {
        let head = Head::new(&face(300.0, 200.0, 0.0));
        for (x, y) in [(300.0, 200.0), (300.0, 110.0), (245.0, 180.0), (300.0, 300.0), (400.0, 320.0)] {
            assert_eq!(head.expectation_at(Point::new(x, y)), 1.0, "{x} {y}");
        }
        for (x, y) in [(200.0, 180.0), (235.0, 255.0), (300.0, 20.0), (120.0, 260.0)] {
            assert!(head.expectation_at(Point::new(x, y)) < 0.5, "{x} {y}: {}", head.expectation_at(Point::new(x, y)));
        }
    }

    #[test]
    fn ears_are_the_heads_and_the_far_one_of_a_turned_head_is_hidden() {
        let (front, turned) = (Head::new(&face(300.0, 200.0, 0.0)), Head::new(&face(300.0, 200.0, -30.0)));
        let at = |head: &Head, x: f64, y: f64| head.skull_at(Point::new(x, y));
        assert_eq!([at(&front, 246.0, 190.0), at(&front, 354.0, 190.0), at(&turned, 354.0, 190.0)], [1.0; 3]);
        assert_eq!([at(&turned, 246.0, 190.0), at(&front, 235.0, 190.0), at(&front, 257.0, 235.0)], [0.0; 3]);
    }

    #[test]
    fn a_turned_head_has_its_back_on_the_other_side() {
        let head = Head::new(&face(300.0, 200.0, -30.0));
        let (far, near) = (head.expectation_at(Point::new(237.0, 190.0)), head.expectation_at(Point::new(380.0, 190.0)));
        assert!(far < 0.2 && near == 1.0, "{far} {near}");
    }
}
