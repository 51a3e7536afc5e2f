//! Where each point of the sheet is seen: a perspective, then the bulge of a lens.

use super::solve::solved;
use crate::geometry::{Point, Vec2};

/// From cells of the sheet to pixels of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    /// The perspective by rows, without its last element, which is 1; in pixels from the picture's middle, over half its diagonal.
    h: [f64; 8],
    /// Relative displacement at the picture's corner.
    bulge: f64,
    middle: Vec2,
    half: f64,
}

/// Rounds of the fit.
const ROUNDS: usize = 12;
/// Errors beyond this number of deviations count less and less.
const OUTLIERS: f64 = 2.5;
/// Largest bulge that is believed.
const MOST_BULGE: f64 = 0.08;
/// Stiffness of the bulge, in squared pixels of a point: without evidence it stays 0.
const STIFF: f64 = 1e-3;

impl View {
    /// The perspective through four points, on a picture of this size; `None` if three of them lie on a line.
    pub(super) fn through(sheet: &[Point; 4], seen: &[Point; 4], width: usize, height: usize) -> Option<Self> {
        let middle = Vec2::new(0.5 * width as f64, 0.5 * height as f64);
        let half = middle.hypot();
        let (mut rows, mut right) = ([[0.0; 8]; 8], [0.0; 8]);
        for i in 0..4 {
            let (p, q) = (sheet[i], ((seen[i] - middle).to_vec2() / half));
            rows[2 * i] = [p.x, p.y, 1.0, 0.0, 0.0, 0.0, -q.x * p.x, -q.x * p.y];
            rows[2 * i + 1] = [0.0, 0.0, 0.0, p.x, p.y, 1.0, -q.y * p.x, -q.y * p.y];
            (right[2 * i], right[2 * i + 1]) = (q.x, q.y);
        }
        let h: [f64; 8] = solved(rows.map(|row| row.to_vec()).to_vec(), right.to_vec())?.try_into().ok()?;
        Some(Self { h, bulge: 0.0, middle, half })
    }

    /// The pixel of a point of the sheet.
    #[inline]
    pub(super) fn at(&self, p: Point) -> Point {
        let h = &self.h;
        let w = h[6] * p.x + h[7] * p.y + 1.0;
        let w = if w > 1e-9 { w } else { 1e-9 };
        let q = Vec2::new((h[0] * p.x + h[1] * p.y + h[2]) / w, (h[3] * p.x + h[4] * p.y + h[5]) / w);
        // Beyond the picture the polynomial has no meaning.
        let stretch = 1.0 + self.bulge * q.hypot2().min(4.0);
        (q * (stretch * self.half) + self.middle).to_point()
    }

    /// How the pixel moves as the point moves by one cell right and down.
    pub(super) fn steps(&self, p: Point) -> [Vec2; 2] {
        let e = 1e-4;
        [Vec2::new(e, 0.0), Vec2::new(0.0, e)].map(|d| (self.at(p + d) - self.at(p - d)) / (2.0 * e))
    }

    /// Pixels per cell, the lesser direction.
    pub(super) fn scale(&self, p: Point) -> f64 {
        let [a, b] = self.steps(p);
        a.hypot().min(b.hypot())
    }

    /// Whether the whole rectangle of cells lies before the camera and is not mirrored.
    pub(super) fn is_sound(&self, corners: &[Point]) -> bool {
        corners.iter().all(|p| {
            let [a, b] = self.steps(*p);
            self.h[6] * p.x + self.h[7] * p.y + 1.0 > 0.05 && a.cross(b) > 1.0
        })
    }

    /// The view fitted to points of the sheet and the pixels where they were found, by least squares with outliers held back; and the
    /// typical error in pixels.
    pub(super) fn fitted(self, found: &[(Point, Point)]) -> (Self, f64) {
        let mut view = self;
        for _ in 0..ROUNDS {
            let (scale, _) = view.errors(found);
            let Some(step) = view.step(found, scale.max(0.02)) else { break };
            (0..8).for_each(|i| view.h[i] += step[i]);
            view.bulge = (view.bulge + step[8]).clamp(-MOST_BULGE, MOST_BULGE);
        }
        let error = view.errors(found).0;
        (view, error)
    }

    /// Robust deviation of the errors, and the errors, in pixels.
    fn errors(&self, found: &[(Point, Point)]) -> (f64, Vec<f64>) {
        let errors: Vec<f64> = found.iter().map(|(p, q)| self.at(*p).distance(*q)).collect();
        let mut sorted = errors.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        // The median of a Rayleigh distribution is 1.18 deviations.
        (sorted.get(sorted.len() / 2).map_or(0.0, |median| median / 1.18), errors)
    }

    /// One step of Gauss and Newton over the eight numbers of the perspective and the bulge.
    fn step(&self, found: &[(Point, Point)], scale: f64) -> Option<Vec<f64>> {
        let (mut left, mut right) = (vec![vec![0.0; 9]; 9], vec![0.0; 9]);
        for (p, q) in found {
            let rest = *q - self.at(*p);
            let weight = 1.0 / (1.0 + (rest.hypot() / (OUTLIERS * scale)).powi(2));
            let slopes: Vec<Vec2> = (0..9).map(|i| self.slope(i, *p)).collect();
            for i in 0..9 {
                right[i] += weight * slopes[i].dot(rest);
                (0..9).for_each(|j| left[i][j] += weight * slopes[i].dot(slopes[j]));
            }
        }
        left[8][8] += STIFF * self.half * self.half;
        right[8] -= STIFF * self.half * self.half * self.bulge;
        (0..8).for_each(|i| left[i][i] *= 1.0 + 1e-9);
        solved(left, right)
    }

    /// How a pixel moves with a parameter.
    fn slope(&self, i: usize, p: Point) -> Vec2 {
        let e = 1e-6;
        let nudged = |e: f64| {
            let mut view = *self;
            if i < 8 {
                view.h[i] += e;
            } else {
                view.bulge += e;
            }
            view.at(p)
        };
        (nudged(e) - nudged(-e)) / (2.0 * e)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::sheet::grid::CORNERS;

    #[test]
    fn a_view_is_found_from_its_points() {
        let seen = [(120.0, 80.0), (900.0, 140.0), (850.0, 1300.0), (60.0, 1200.0)].map(Point::from);
        let start = View::through(&CORNERS, &seen, 1000, 1400).unwrap();
        assert!(CORNERS.iter().zip(seen).all(|(p, q)| start.at(*p).distance(q) < 1e-6));
        let truth = View { bulge: 0.02, ..start };
        let points = (0..40).map(|i| Point::new(f64::from(i % 6) * 1.8, f64::from(i / 6) * 2.2));
        let mut found: Vec<(Point, Point)> = points.map(|p| (p, truth.at(p))).collect();
        found[7].1.x += 60.0;
        let (view, error) = start.fitted(&found);
        assert!(error < 0.1 && (view.bulge - 0.02).abs() < 0.002, "{error} {view:?}");
        assert!(view.at(Point::new(5.0, 7.0)).distance(truth.at(Point::new(5.0, 7.0))) < 0.3);
    }

    #[test]
    fn points_on_a_line_give_no_view() {
        let seen = [(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)].map(Point::from);
        let view = View::through(&CORNERS, &seen, 100, 100);
        assert!(view.is_none_or(|view| !view.is_sound(&CORNERS)));
    }
}
