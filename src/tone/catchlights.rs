//! Step 11: a catchlight in irises that are black all over, where the photograph has none: eyes without one are holes.

use super::openings::{EYE_OPEN, eyes, openness};
use crate::geometry::Point;
use crate::raster::{Raster, median};
use crate::source::{Iris, Landmarks};

/// An iris is black if the median of its tone is below this, and has no light if less than a share of it is lighter by so much.
const BLACK: f32 = 0.3;
const LIGHTER: f32 = 0.25;
const LEAST_SHARE: f64 = 0.012;
/// Place of the catchlight in radii of the iris: aside to where the light comes from, and up; its radius; and that of its soft edge.
const ASIDE: f64 = 0.36;
const UP: f64 = 0.34;
const RADIUS: f64 = 0.24;
const SOFT: f64 = 0.1;

/// The tone with the catchlights that are missing; `lightness` tells the side of the light.
pub(super) fn with_catchlights(tone: Raster<f32>, lightness: &Raster<f32>, faces: &[Landmarks]) -> Raster<f32> {
    let all = faces.iter().flat_map(|face| {
        let aside = if face.lit_side(lightness) < 0.0 { -ASIDE } else { ASIDE };
        eyes(face).map(|(lids, iris)| (iris, openness(&lids, EYE_OPEN), aside))
    });
    all.fold(tone, |tone, (iris, open, aside)| if open >= 1.0 && is_black(&tone, iris) { lit(tone, iris, aside) } else { tone })
}

/// True for an iris without a light.
fn is_black(tone: &Raster<f32>, iris: Iris) -> bool {
    let inside: Vec<f32> = pixels_about(tone, iris.centre, 0.9 * iris.radius).map(|(x, y, _)| tone.get(x, y)).collect();
    let Some(middle) = median(inside.clone()) else { return false };
    let lights = inside.iter().filter(|v| **v > middle + LIGHTER).count() as f64;
    middle < BLACK && lights < LEAST_SHARE * inside.len() as f64
}

fn lit(mut tone: Raster<f32>, iris: Iris, aside: f64) -> Raster<f32> {
    let centre = iris.centre + Point::new(aside, -UP).to_vec2() * iris.radius;
    let (radius, soft) = (RADIUS * iris.radius, SOFT * iris.radius);
    let spot: Vec<(usize, usize, f64)> = pixels_about(&tone, centre, radius + soft).collect();
    for (x, y, distance) in spot {
        let share = ((radius - distance) / soft.max(0.5) + 0.5).clamp(0.0, 1.0) as f32;
        let v = tone.get(x, y);
        tone.set(x, y, v + share * (1.0 - v));
    }
    tone
}

/// The pixels whose centres lie within a distance of a place, and how far.
fn pixels_about(raster: &Raster<f32>, centre: Point, reach: f64) -> impl Iterator<Item = (usize, usize, f64)> + use<> {
    let range = |middle: f64, size: usize| {
        ((middle - reach).max(0.0) as usize).min(size)..((middle + reach).ceil().max(0.0) as usize).min(size)
    };
    let (columns, rows) = (range(centre.x, raster.width()), range(centre.y, raster.height()));
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y))).filter_map(move |(x, y)| {
        let distance = centre.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5));
        (distance <= reach).then_some((x, y, distance))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_black_iris_gets_one_light_and_one_with_a_light_is_left() {
        let iris = Iris { centre: Point::new(20.0, 20.0), radius: 10.0 };
        let black = Raster::from_fn(40, 40, |_, _| 0.05_f32);
        assert!(is_black(&black, iris));
        let with = lit(black, iris, -ASIDE);
        assert!(!is_black(&with, iris));
        assert!(with.get(16, 16) > 0.95 && with.get(24, 16) < 0.06 && with.get(20, 24) < 0.06);
        assert!(!is_black(&Raster::from_fn(40, 40, |_, _| 0.5_f32), iris), "a light iris needs none");
    }
}
