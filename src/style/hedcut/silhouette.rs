//! Lines along the silhouette lie inside it, with the whole of their width: outside the paper stays bare.

use crate::field::CoherentLine;
use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, gaussian_blur};
use crate::source::Portrait;

/// The blur from which distances to the silhouette are read, in pixels: narrower finds no direction at a soft border, wider cuts corners.
const BLUR: f32 = 3.0;
/// Distances beyond this multiple of the blur cannot be read.
const READ: f64 = 2.0;
/// What stays free between a line and the silhouette, in pixels.
const FREE: f64 = 0.6;

pub(super) struct Silhouette {
    blurred: Raster<f32>,
}

impl Silhouette {
    pub(super) fn of(portrait: &Portrait) -> Self {
        Self { blurred: gaussian_blur(&portrait.subject.map(|v| f32::from(u8::from(v >= 0.5))), BLUR) }
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
        if slope.hypot() < 0.15 * steepest {
            return Vec2::ZERO;
        }
        let inside = ((at(0.0, 0.0) - 0.5) / steepest).clamp(-READ * f64::from(BLUR), READ * f64::from(BLUR));
        (depth - inside).max(0.0) / slope.hypot() * slope
    }
}
