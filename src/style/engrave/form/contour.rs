//! The silhouette in a thin line.

use super::super::Drawer;
use crate::drawing::{Layer, Mark, Stroke};
use crate::field::contours;
use crate::geometry::{Point, Ring, catmull_rom, resample};
use crate::raster::{Raster, gaussian_blur};

/// Width of the contour in pitches where the subject is light, half dark and dark. In half tones the lines' ends show the silhouette, and
/// a contour beside them would be a wire; in the dark it covers the ends of thick lines, which would be teeth.
const CONTOUR: [f64; 3] = [0.15, 0.0, 0.3];
/// Distance of its nodes in pitches, and the width from which it is drawn.
const CONTOUR_NODE: f64 = 1.0;
const LEAST_WIDTH: f64 = 0.04;

/// Blur of the silhouette in pitches: less shows its wobbles, more leaves the lines' ends.
const SMOOTH: f64 = 0.5;

impl Drawer<'_> {
    /// The silhouette where lines alone do not show it.
    pub(super) fn contour(&self, ink: &Raster<f32>) -> Layer {
        let pitch = self.pitch();
        // The ink of the subject alone.
        let blur = |raster: &Raster<f32>, pitches: f64| gaussian_blur(raster, (pitches * pitch) as f32);
        let dark = blur(ink, 1.0).zip_map(&blur(&self.portrait.subject, 1.0), |ink, subject| ink / subject.max(0.05));
        let width = |p: &Point| {
            let along = 2.0 * f64::from(dark.sample(p.x, p.y)).clamp(0.0, 0.999);
            let (i, t) = (along as usize, along.fract());
            CONTOUR[i] + (CONTOUR[i + 1] - CONTOUR[i]) * t
        };
        let (columns, rows) = self.size();
        // At the picture's border the subject is cut, and ends without a line.
        let margin = 0.5 * CONTOUR[2] * pitch + 0.5;
        let is_between = |at: f64, side: usize| at > margin && at < side as f64 - margin;
        let is_drawn = |p: &Point| is_between(p.x, columns) && is_between(p.y, rows) && width(p) >= LEAST_WIDTH;
        let mut layer = Layer::new("contour", 1);
        for curve in contours(&blur(&self.portrait.subject, SMOOTH), 0.5) {
            let mut points = curve.points;
            if curve.closed {
                points.push(points[0]);
            }
            let nodes = resample(&points, CONTOUR_NODE * pitch);
            for run in nodes.chunk_by(|a, b| is_drawn(a) == is_drawn(b)).filter(|run| is_drawn(&run[0]) && run.len() > 2) {
                let places: Vec<Point> = run.iter().map(|p| self.portrait.placement.to_page(*p)).collect();
                let widths = run.iter().map(|p| self.parameters.pitch.0 * width(p)).collect();
                layer.marks.extend(Stroke::swelling(catmull_rom(&places, Ring::Open), widths).map(Mark::Stroke));
            }
        }
        layer
    }
}
