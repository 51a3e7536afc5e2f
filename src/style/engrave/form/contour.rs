//! The silhouette in a thin line.

use super::super::Drawer;
use crate::drawing::{Layer, Mark, Stroke, Width};
use crate::field::contours;
use crate::geometry::{Point, Ring, catmull_rom, resample};
use crate::raster::{Raster, gaussian_blur};

/// Width of the contour in pitches where the subject is light, half dark and dark, and the distance of its nodes. In the dark it covers
/// the ends of thick lines, which would be teeth.
const CONTOUR: [f64; 3] = [0.2, 0.12, 0.4];
const CONTOUR_NODE: f64 = 1.0;

impl Drawer<'_> {
    /// The silhouette in a thin line, thicker where the subject is light.
    pub(super) fn contour(&self, ink: &Raster<f32>) -> Layer {
        let (placement, pitch) = (&self.portrait.placement, self.parameters.pitch.0);
        // The ink of the subject alone.
        let blur = |raster: &Raster<f32>| gaussian_blur(raster, self.pixels(self.parameters.pitch) as f32);
        let dark = blur(ink).zip_map(&blur(&self.portrait.subject), |ink, subject| ink / subject.max(0.05));
        let mut layer = Layer::new("contour", 1);
        let (columns, rows) = self.size();
        // At the picture's border the subject is cut, and ends without a line.
        let margin = 0.5 * CONTOUR[2] * self.pixels(self.parameters.pitch) + 0.5;
        let is_between = |at: f64, side: usize| at > margin && at < side as f64 - margin;
        let is_inside = |p: &Point| is_between(p.x, columns) && is_between(p.y, rows);
        for curve in contours(&gaussian_blur(&self.portrait.subject, 1.5), 0.5) {
            let mut points = curve.points;
            if curve.closed {
                points.push(points[0]);
            }
            let nodes = resample(&points, CONTOUR_NODE * self.pixels(self.parameters.pitch));
            for run in nodes.chunk_by(|a, b| is_inside(a) == is_inside(b)).filter(|run| is_inside(&run[0]) && run.len() > 2) {
                let width = |p: &Point| {
                    let along = 2.0 * f64::from(dark.sample(p.x, p.y)).clamp(0.0, 0.999);
                    let (i, t) = (along as usize, along.fract());
                    pitch * (CONTOUR[i] + (CONTOUR[i + 1] - CONTOUR[i]) * t)
                };
                let places: Vec<Point> = run.iter().map(|p| placement.to_page(*p)).collect();
                let widths = run.iter().map(width).collect();
                layer.marks.push(Mark::Stroke(Stroke::new(catmull_rom(&places, Ring::Open), Width::Along(widths))));
            }
        }
        layer
    }
}
