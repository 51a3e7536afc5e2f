//! The silhouette in a thin line.

use super::super::Drawer;
use crate::drawing::{Layer, Mark, Stroke};
use crate::elementary::unit_at;
use crate::field::contours;
use crate::geometry::{Point, Ring, Vec2, catmull_rom, resample};
use crate::raster::{Raster, gaussian_blur};
use crate::style::columns::averaged;
use crate::style::form::{Directions, Surface, Surfaces};

/// Width of the contour in pitches where the subject is light, half dark and dark. In half tones the lines' ends show the silhouette, and
/// a contour beside them would be a wire; in the dark it covers the ends of thick lines, which would be teeth.
const CONTOUR: [f64; 3] = [0.15, 0.0, 0.36];
/// Its width where lines of skin and cloth end on it at an angle, in pitches, whatever the tone: their ends alone are teeth. And the sines of the
/// angles from which, and from which in full; along the silhouette it would be a wire.
const CROSSED: f64 = 0.3;
const SINES: [f64; 2] = [0.25, 0.6];
/// How far inside the lines are asked, in pitches, and over how many nodes to either side their angles are averaged.
const INSIDE: f64 = 1.2;
const EVEN: usize = 3;
/// Distance of its nodes in pitches, and the width from which it is drawn.
const CONTOUR_NODE: f64 = 1.0;
const LEAST_WIDTH: f64 = 0.04;

/// Blur of the silhouette in pitches: less shows its wobbles, more leaves the lines' ends.
const SMOOTH: f64 = 0.5;
/// The level of the smoothed silhouette at which the contour lies: at 0.5 it is a wire beside the ends of lines, at 0.74 these are
/// teeth outside it.
const LEVEL: f32 = 0.62;

impl Drawer<'_> {
    /// The silhouette where lines alone do not show it.
    pub(super) fn contour(&self, ink: &Raster<f32>, surfaces: &Surfaces, directions: &Directions) -> Layer {
        let pitch = self.pitch();
        // The ink of the subject alone.
        let blur = |raster: &Raster<f32>, pitches: f64| gaussian_blur(raster, (pitches * pitch) as f32);
        let soft = blur(&self.portrait.subject, 1.0);
        let dark = blur(ink, 1.0).zip_map(&soft, |ink, subject| ink / subject.max(0.05));
        let hair = blur(surfaces.of(Surface::Hair), 1.0);
        let by_tone = |p: &Point| {
            let along = 2.0 * f64::from(dark.sample(p.x, p.y)).clamp(0.0, 0.999);
            let (i, t) = (along as usize, along.fract());
            let hair = f64::from(hair.sample(p.x, p.y) / soft.sample(p.x, p.y).max(0.05)).min(1.0);
            // Strokes of dark hair end in tips, which a line would tie together.
            let of_dark = CONTOUR[2] * (1.0 - hair);
            let contour = [CONTOUR[0], CONTOUR[1], of_dark];
            contour[i] + (contour[i + 1] - contour[i]) * t
        };
        let (columns, rows) = self.size();
        // At the picture's border the subject is cut, and ends without a line.
        let margin = 0.5 * CONTOUR[2] * pitch + 0.5;
        let is_between = |at: f64, side: usize| at > margin && at < side as f64 - margin;
        let is_drawn = |(p, width): &(Point, f64)| is_between(p.x, columns) && is_between(p.y, rows) && *width >= LEAST_WIDTH;
        let mut layer = Layer::new("contour", 1);
        for curve in contours(&blur(&self.portrait.subject, SMOOTH), LEVEL) {
            let mut points = curve.points;
            if curve.closed {
                points.push(points[0]);
            }
            let nodes = resample(&points, CONTOUR_NODE * pitch);
            let along = |i: usize| nodes[(i + 1).min(nodes.len() - 1)] - nodes[i.saturating_sub(1)];
            let crossed = (0..nodes.len()).map(|i| self.crossing(surfaces, directions, nodes[i], along(i)));
            let crossed = averaged(&crossed.collect::<Vec<f64>>(), EVEN);
            let nodes: Vec<(Point, f64)> =
                nodes.iter().zip(crossed).map(|(p, crossed)| (*p, by_tone(p).max(CROSSED * crossed))).collect();
            for run in nodes.chunk_by(|a, b| is_drawn(a) == is_drawn(b)).filter(|run| is_drawn(&run[0]) && run.len() > 2) {
                let places: Vec<Point> = run.iter().map(|(p, _)| self.portrait.placement.to_page(*p)).collect();
                let widths = run.iter().map(|(_, width)| self.parameters.pitch.0 * width).collect();
                layer.marks.extend(Stroke::swelling(catmull_rom(&places, Ring::Open), widths).map(Mark::Stroke));
            }
        }
        layer
    }

    /// How much the lines inside a silhouette that runs in a direction end on it, 0 to 1; not in hair, whose strokes end in tips.
    fn crossing(&self, surfaces: &Surfaces, directions: &Directions, p: Point, along: Vec2) -> f64 {
        if along.hypot() == 0.0 {
            return 0.0;
        }
        let along = along / along.hypot();
        let aside = INSIDE * self.pitch() * Vec2::new(-along.y, along.x);
        let all = [Surface::Skin, Surface::Hair, Surface::Cloth];
        let shares = [p + aside, p - aside].into_iter().flat_map(|p| all.map(|s| (surfaces.of(s).sample(p.x, p.y), s, p)));
        let Some((_, surface, p)) = shares.reduce(|most, each| if each.0 > most.0 { each } else { most }) else { return 0.0 };
        if surface.is_hair() {
            return 0.0;
        }
        let angles = directions.of(surface);
        let angle = angles.clamped(p.x as isize, p.y as isize);
        let sine = along.cross(unit_at(f64::from(angle))).abs();
        ((sine - SINES[0]) / (SINES[1] - SINES[0])).clamp(0.0, 1.0)
    }
}
