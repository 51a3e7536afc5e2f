//! Step 11: a catchlight in irises that are black all over: eyes without one are holes.

use super::openings::{EYE_OPEN, eyes, openness};
use super::zones::polygon;
use crate::geometry::{Point, Rect};
use crate::raster::{Raster, median};
use crate::source::{Iris, Landmarks};

/// The part of an iris, in radii, that is surely iris: it is black if the median of its tone is below this, and has no light to be seen if less
/// than a share of it is lighter by so much.
const WITHIN: f64 = 0.7;
const BLACK: f32 = 0.45;
const LIGHTER: f32 = 0.35;
const LEAST_SHARE: f64 = 0.035;
/// Openness from which an eye gets a light.
const LEAST_OPEN: f32 = 0.5;
/// The photograph's own light lies within this many radii of the iris, and not farther down, where the mean of a place as large as the catchlight is lighter than
/// the iris by so much.
const OWN_WITHIN: f64 = 0.45;
const OWN_DOWN: f64 = 0.1;
const OWN_LIGHTER: f32 = 0.06;
/// Place of the catchlight in radii of the iris where there is none: aside to where the light comes from, and up; its radius; that of its soft
/// edge; and its distance from the lids. With a radius of 0.24 eyes glare at 90 mm (13).
const ASIDE: f64 = 0.36;
const UP: f64 = 0.34;
const RADIUS: f64 = 0.2;
/// Radius of the disc by whose mean the photograph's light is found.
const SEEN: f64 = 0.17;
const SOFT: f64 = 0.1;
const FROM_LIDS: f64 = 0.15;

/// What is seen of an iris.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Seen {
    /// The eye is closed, or its iris is light.
    Enough,
    /// It is dark and has a light.
    Light,
    /// It is black all over.
    Black,
}

/// The tone with the catchlights that are missing; `lightness` tells their places, or the side of the light. If one of two dark eyes has none,
/// both get one of the same size.
pub(super) fn with_catchlights(tone: Raster<f32>, lightness: &Raster<f32>, faces: &[Landmarks]) -> Raster<f32> {
    faces.iter().fold(tone, |tone, face| {
        let aside = if face.lit_side(lightness) < 0.0 { -ASIDE } else { ASIDE };
        let eyes = eyes(face).map(|(lids, iris)| (seen(&tone, &lids, iris), lids, iris));
        if eyes.iter().all(|(seen, _, _)| *seen != Seen::Black) {
            return tone;
        }
        eyes.into_iter().filter(|(seen, _, _)| *seen != Seen::Enough).fold(tone, |tone, (_, lids, iris)| {
            let usual = iris.centre + Point::new(aside, -UP).to_vec2() * iris.radius;
            lit(tone, iris, between(&lids, iris, own_light(lightness, iris).unwrap_or(usual)))
        })
    })
}

/// What is seen of an iris in the opening between its lids.
fn seen(tone: &Raster<f32>, lids: &[Point], iris: Iris) -> Seen {
    if openness(lids, EYE_OPEN) < LEAST_OPEN {
        return Seen::Enough;
    }
    seen_within(tone, &polygon(tone.width(), tone.height(), lids), iris)
}

fn seen_within(tone: &Raster<f32>, opening: &Raster<u8>, iris: Iris) -> Seen {
    let inside: Vec<f32> = pixels_about(tone, iris.centre, WITHIN * iris.radius)
        .filter(|(x, y, _)| opening.get(*x, *y) == 1)
        .map(|(x, y, _)| tone.get(x, y))
        .collect();
    let Some(middle) = median(inside.clone()) else { return Seen::Enough };
    let lights = inside.iter().filter(|v| **v > middle + LIGHTER).count() as f64;
    match (middle < BLACK, lights < LEAST_SHARE * inside.len() as f64) {
        (false, _) => Seen::Enough,
        (true, false) => Seen::Light,
        (true, true) => Seen::Black,
    }
}

/// The lightest place in the iris, if it is a light.
fn own_light(lightness: &Raster<f32>, iris: Iris) -> Option<Point> {
    let mean = |p: Point| {
        let (sum, count) = pixels_about(lightness, p, SEEN * iris.radius)
            .fold((0.0, 0.0), |(sum, count), (x, y, _)| (sum + lightness.get(x, y), count + 1.0));
        sum / f32::max(count, 1.0)
    };
    let places = pixels_about(lightness, iris.centre, OWN_WITHIN * iris.radius)
        .filter(|(_, y, _)| *y as f64 + 0.5 < iris.centre.y + OWN_DOWN * iris.radius);
    let means: Vec<(Point, f32)> =
        places.map(|(x, y, _)| Point::new(x as f64 + 0.5, y as f64 + 0.5)).map(|p| (p, mean(p))).collect();
    let middle = median(means.iter().map(|(_, mean)| *mean).collect())?;
    let lightest = means.into_iter().reduce(|best, each| if each.1 > best.1 { each } else { best })?;
    (lightest.1 > middle + OWN_LIGHTER).then_some(lightest.0)
}

/// The place moved down or up until a catchlight there lies between the lids.
fn between(lids: &[Point], iris: Iris, p: Point) -> Point {
    let near = lids.iter().filter(|lid| (lid.x - iris.centre.x).abs() <= iris.radius);
    let Some(bounds) = near.map(|lid| Rect::from_points(*lid, *lid)).reduce(|all, lid| all.union(lid)) else { return p };
    let (top, bottom) = (bounds.y0 + (RADIUS + FROM_LIDS) * iris.radius, bounds.y1 - (RADIUS + FROM_LIDS) * iris.radius);
    Point::new(p.x, if top < bottom { p.y.clamp(top, bottom) } else { f64::midpoint(top, bottom) })
}

/// The tone with a light at a place.
fn lit(mut tone: Raster<f32>, iris: Iris, centre: Point) -> Raster<f32> {
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
pub(super) fn pixels_about<T>(
    raster: &Raster<T>,
    centre: Point,
    reach: f64,
) -> impl Iterator<Item = (usize, usize, f64)> + use<T> {
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
    use crate::elementary::unit_at;
    use crate::source::{POINTS, outlines};

    #[test]
    fn a_black_iris_gets_one_light_and_one_with_a_light_is_left() {
        let iris = Iris { centre: Point::new(20.0, 20.0), radius: 10.0 };
        let black = Raster::from_fn(40, 40, |_, _| 0.05_f32);
        let opening = Raster::filled(40, 40, 1_u8);
        assert!(seen_within(&black, &opening, iris) == Seen::Black);
        let with = lit(black, iris, Point::new(16.4, 16.6));
        assert!(seen_within(&with, &opening, iris) == Seen::Light);
        assert!(with.get(16, 16) > 0.95 && with.get(24, 16) < 0.06 && with.get(20, 24) < 0.06);
        assert!(seen_within(&Raster::from_fn(40, 40, |_, _| 0.5_f32), &opening, iris) == Seen::Enough, "a light iris needs none");
    }

    #[test]
    fn two_dark_eyes_get_a_light_each_if_one_has_none() {
        let mut points = vec![[0.0; 3]; POINTS];
        let irises = [Point::new(60.0, 40.0), Point::new(160.0, 40.0)].map(|centre| Iris { centre, radius: 12.0 });
        for (outline, iris) in [&outlines::RIGHT_EYE, &outlines::LEFT_EYE].into_iter().zip(irises) {
            for (i, point) in outline.iter().enumerate() {
                let p = unit_at(std::f64::consts::TAU * i as f64 / outline.len() as f64);
                points[*point] = [iris.centre.x + 26.0 * p.x, iris.centre.y + 13.0 * p.y, 0.0];
            }
        }
        let face = Landmarks { points, irises, spectacles: None };
        let own = Point::new(164.0, 36.0);
        let with_own =
            |x: usize, y: usize| if own.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5)) < 2.8 { 0.8 } else { 0.05_f32 };
        let lights = |tone: Raster<f32>| {
            let tone = with_catchlights(tone.clone(), &tone, std::slice::from_ref(&face));
            irises.map(|iris| pixels_about(&tone, iris.centre, iris.radius).filter(|(x, y, _)| tone.get(*x, *y) > 0.9).count())
        };
        let [made, matched] = lights(Raster::from_fn(220, 80, with_own));
        assert!(made > 10 && (made..2 * made).contains(&matched), "{made} {matched}");
        assert_eq!(lights(Raster::filled(220, 80, 0.6)), [0, 0], "light eyes");
    }

    #[test]
    fn a_light_lies_where_the_photograph_has_it_between_the_lids() {
        let iris = Iris { centre: Point::new(20.0, 20.0), radius: 10.0 };
        let spot = Point::new(23.0, 15.0);
        let seen =
            Raster::from_fn(
                40,
                40,
                |x, y| {
                    if spot.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5)) < 1.6 { 0.9 } else { 0.1_f32 }
                },
            );
        let own = own_light(&seen, iris).expect("a light");
        assert!(own.distance(spot) < 1.6, "{own:?}");
        assert!(own_light(&Raster::filled(40, 40, 0.1), iris).is_none());
        let lids = [(5.0, 20.0), (20.0, 14.0), (35.0, 20.0), (20.0, 27.0)].map(Point::from);
        let lowest = 14.0 + (RADIUS + FROM_LIDS) * iris.radius;
        assert_eq!(between(&lids, iris, own), Point::new(own.x, lowest));
    }
}
