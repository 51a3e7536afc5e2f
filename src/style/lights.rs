//! The lights of features, which are smaller than a dot's cell, are clean: catchlights and lights on lips.

use super::drawer::{Drawer, Pitched};
use super::solids::TOLERANCE;
use crate::drawing::{Dot, Layer, Mark};
use crate::geometry::{BezPath, Point, Region, flatten, polygon_area};
use crate::raster::Raster;
use crate::source::MaskRole;

/// Ink below which a place in a feature is a light.
const LIGHT: f32 = 0.06;
/// The widest hole of a solid that is a catchlight, in pitches, and the most ink of its middle: the ring of a light iris is a hole too, but
/// with the pupil in its middle. Whites of small eyes and gaps between lips count too. Looked at on eight portraits: with 1.5 the largest
/// catchlights keep ragged borders.
const WIDEST: f64 = 2.0;
const MOST_INK: f32 = 0.3;

impl<P: Pitched> Drawer<'_, P> {
    /// Takes out dots that lie in the lights of features, and those that would reach into a catchlight from its soft edge.
    pub(super) fn clear_lights(&self, layers: &mut [Layer], solids: &BezPath, ink: &Raster<f32>) {
        let Some(detail) = self.portrait.masks.get(&MaskRole::Detail) else { return };
        let catchlights = self.catchlights(solids, ink);
        let is_light = |dot: &Dot| {
            let p = self.portrait.placement.to_grid(dot.centre);
            detail.sample(p.x, p.y) > 0.5 && (ink.sample(p.x, p.y) < LIGHT || catchlights.contains(dot.centre))
        };
        for layer in layers {
            layer.marks.retain(|mark| !matches!(mark, Mark::Dot(dot) if is_light(dot)));
        }
    }

    /// The small light holes of the solids.
    fn catchlights(&self, solids: &BezPath, ink: &Raster<f32>) -> Region {
        let most = (WIDEST * self.parameters.pitch().0).powi(2) * std::f64::consts::FRAC_PI_4;
        let rings: Vec<Vec<Point>> = flatten(solids, TOLERANCE).into_iter().map(|(ring, _)| ring).collect();
        let whole = Region::new(solids, TOLERANCE);
        let is_catchlight = |ring: &Vec<Point>| {
            let middle = ring.iter().fold(Point::ZERO, |sum, p| sum + p.to_vec2() / ring.len() as f64);
            let at = self.portrait.placement.to_grid(middle);
            polygon_area(ring).abs() < most && !whole.contains(middle) && ink.sample(at.x, at.y) < MOST_INK
        };
        Region::of_polygons(rings.into_iter().filter(is_catchlight).collect())
    }
}
