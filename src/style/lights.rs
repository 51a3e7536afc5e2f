//! The lights of features, which are smaller than a dot's cell, are clean: catchlights and lights on lips.

use super::drawer::{Drawer, Pitched};
use super::solids::TOLERANCE;
use crate::drawing::{Dot, Layer, Mark};
use crate::geometry::{BezPath, Point, Region, flatten, polygon_area};
use crate::raster::Raster;
use crate::source::MaskRole;
use std::f64::consts::FRAC_PI_4;

/// Ink below which a place in a feature is a light.
const LIGHT: f32 = 0.06;
/// The same in irises, which are solid but for their light, and how far these go, in radii: dots of the light's soft edge are crumbs in it.
const IRIS_LIGHT: f32 = 0.4;
const INSIDE: f64 = 0.85;
/// The widest hole of a solid that is a catchlight, in pitches, and the most ink of its middle: the ring of a light iris is a hole too, but
/// with the pupil in its middle. Whites of small eyes and gaps between lips count too. Looked at on eight portraits: with 1.5 the largest
/// catchlights keep ragged borders.
const WIDEST: f64 = 2.0;
const MOST_INK: f32 = 0.3;

impl<P: Pitched> Drawer<'_, P> {
    /// Takes out dots that lie in the lights of features, and those that would reach into a catchlight from its soft edge.
    pub(super) fn clear_lights(&self, layers: &mut [Layer], solids: &BezPath, ink: &Raster<f32>) {
        let Some(detail) = self.portrait.masks.get(&MaskRole::Detail) else { return };
        let most = (WIDEST * self.parameters.pitch().0).powi(2) * FRAC_PI_4;
        let ink_at = |p: Point| {
            let p = self.portrait.placement.to_grid(p);
            ink.sample(p.x, p.y)
        };
        let catchlights = catchlights(solids, most, ink_at);
        let is_light = |dot: &Dot| {
            let p = self.portrait.placement.to_grid(dot.centre);
            let most = if self.is_iris(p) { IRIS_LIGHT } else { LIGHT };
            detail.sample(p.x, p.y) > 0.5 && (ink.sample(p.x, p.y) < most || catchlights.contains(dot.centre))
        };
        for layer in layers {
            layer.marks.retain(|mark| !matches!(mark, Mark::Dot(dot) if is_light(dot)));
        }
    }
}

impl<P: Pitched> Drawer<'_, P> {
    /// True for a place in an iris, in working pixels.
    fn is_iris(&self, p: Point) -> bool {
        let irises = self.portrait.faces.iter().flat_map(|face| &face.irises);
        irises.into_iter().any(|iris| iris.centre.distance(p) < INSIDE * iris.radius)
    }
}

/// The holes of solids that are no larger than an area and light in their middle; all on the page.
fn catchlights(solids: &BezPath, most: f64, ink_at: impl Fn(Point) -> f32) -> Region {
    let rings: Vec<Vec<Point>> = flatten(solids, TOLERANCE).into_iter().map(|(ring, _)| ring).collect();
    let whole = Region::new(solids, TOLERANCE);
    let is_catchlight = |ring: &Vec<Point>| {
        let middle = ring.iter().fold(Point::ZERO, |sum, p| sum + p.to_vec2() / ring.len() as f64);
        polygon_area(ring).abs() < most && !whole.contains(middle) && ink_at(middle) < MOST_INK
    };
    Region::of_polygons(rings.into_iter().filter(is_catchlight).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{Circle, Shape};

    #[test]
    fn a_small_light_hole_is_a_catchlight_and_the_ring_of_a_light_iris_is_none() {
        let centre = Point::new(5.0, 5.0);
        let iris = |hole: f64| {
            let hole = Circle::new(centre, hole).to_path(1e-3).reverse_subpaths();
            Circle::new(centre, 2.0).to_path(1e-3).iter().chain(hole.iter()).collect::<BezPath>()
        };
        let holds = |hole: f64, ink: f32| catchlights(&iris(hole), 1.0, |_| ink).contains(centre);
        assert!(holds(0.4, 0.1));
        assert!(!holds(0.4, 0.9), "a pupil stands in the middle");
        assert!(!holds(0.8, 0.1), "it is larger than a catchlight");
        let disc = Circle::new(centre, 0.4).to_path(1e-3);
        assert!(!catchlights(&disc, 1.0, |_| 0.1).contains(centre), "no hole");
    }
}
