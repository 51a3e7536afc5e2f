//! Lines along the silhouette lie inside it, with the whole of their width: outside the paper stays bare. Hair has no line
//! around it: its strokes are its edge, and a line that follows every wisp is a wire with knots.

use super::parts::Parts;
use crate::field::CoherentLine;
use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, gaussian_blur};
use crate::source::Portrait;
use crate::style::creases::share;

/// The blur from which distances to the silhouette are read, in pixels: narrower finds no direction at a soft border, wider cuts corners.
const BLUR: f32 = 3.0;
/// Greatest depth in blurs at which a line can be held: distances are read from the blur, which ends there.
const DEEPEST: f64 = 1.1;
/// Share of a straight border's slope from which there is a direction inwards, and from which a point moves in full.
const SLOPES: [f64; 2] = [0.1, 0.3];
/// Share of a line along the silhouette from which it is that.
const MOSTLY: f64 = 0.6;
/// Values of the blur between which a place is on the silhouette.
const NEAR: [f32; 2] = [0.1, 0.9];
/// What stays free between a line and the silhouette, in pixels.
const FREE: f64 = 0.6;

pub(super) struct Silhouette {
    blurred: Raster<f32>,
}

impl Silhouette {
    pub(super) fn of(portrait: &Portrait) -> Self {
        Self { blurred: gaussian_blur(&portrait.subject.map(|v| f32::from(u8::from(v >= 0.5))), BLUR) }
    }

    /// The parts of a line, in working pixels, that do not run outside: where the subject's border is soft, a line may be found beyond it.
    pub(super) fn keeps(&self, line: &CoherentLine, least: f64) -> Vec<CoherentLine> {
        line.parts_where(|p| self.blurred.sample(p.x, p.y) >= NEAR[0], least)
    }

    /// The parts of a line, in working pixels, that do not run along the border of hair; a line that only ends there stays whole.
    pub(super) fn without_hair(&self, line: &CoherentLine, parts: &Parts, least: f64) -> Vec<CoherentLine> {
        if share(&line.curve, |p| self.is_near(p)) < MOSTLY {
            return vec![line.clone()];
        }
        line.parts_where(|p| !(self.is_near(*p) && parts.is_beside_hair(*p)), least)
    }

    /// True for a place on the silhouette.
    fn is_near(&self, p: Point) -> bool {
        (NEAR[0]..=NEAR[1]).contains(&self.blurred.sample(p.x, p.y))
    }

    /// A line, in working pixels, moved inwards where it would reach over the silhouette.
    pub(super) fn holds(&self, line: CoherentLine) -> CoherentLine {
        let mut line = line;
        for (point, width) in line.curve.points.iter_mut().zip(&line.widths) {
            *point += self.inwards(*point, 0.5 * width + FREE);
        }
        line
    }

    /// How far a point must move to lie so deep inside.
    fn inwards(&self, p: Point, depth: f64) -> Vec2 {
        let at = |dx: f64, dy: f64| f64::from(self.blurred.sample(p.x + dx, p.y + dy));
        let slope = Vec2::new(0.5 * (at(1.0, 0.0) - at(-1.0, 0.0)), 0.5 * (at(0.0, 1.0) - at(0.0, -1.0)));
        // The slope of the blur of a straight border at its middle is 1 / (sqrt(2 pi) sigma).
        let steepest = 1.0 / ((2.0 * std::f64::consts::PI).sqrt() * f64::from(BLUR));
        let sure = ((slope.hypot() / steepest - SLOPES[0]) / (SLOPES[1] - SLOPES[0])).clamp(0.0, 1.0);
        if sure == 0.0 {
            return Vec2::ZERO;
        }
        let inside = (at(0.0, 0.0) - 0.5) / steepest;
        sure * (depth.min(DEEPEST * f64::from(BLUR)) - inside).max(0.0) / slope.hypot() * slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_beyond_the_border_goes_and_one_on_it_stays() {
        let subject = Raster::from_fn(60, 40, |x, _| f32::from(u8::from(x < 30)));
        let silhouette = Silhouette { blurred: gaussian_blur(&subject, BLUR) };
        let line = |x: f64| {
            let points = (0..30).map(|y| Point::new(x, 5.0 + f64::from(y))).collect();
            CoherentLine::plain(crate::field::Curve { points, closed: false }, 1.0)
        };
        assert!(silhouette.keeps(&line(40.0), 5.0).is_empty());
        assert_eq!(silhouette.keeps(&line(30.0), 5.0).len(), 1);
    }

    #[test]
    fn a_line_on_a_straight_border_moves_inside_and_one_far_from_it_stays() {
        let subject = Raster::from_fn(60, 40, |x, _| f32::from(u8::from(x < 30)));
        let silhouette = Silhouette { blurred: gaussian_blur(&subject, BLUR) };
        let moved = silhouette.inwards(Point::new(30.0, 20.0), 2.0);
        assert!((moved.x + 2.0).abs() < 0.2 && moved.y.abs() < 1e-6, "{moved:?}");
        assert_eq!(silhouette.inwards(Point::new(10.0, 20.0), 2.0), Vec2::ZERO);
        assert_eq!(silhouette.inwards(Point::new(26.0, 20.0), 2.0), Vec2::ZERO, "it is deep enough");
    }
}
