//! Step 11: a catchlight in each open eye: without one it is a hole, with three it looks broken.

use super::openings::{EYE_OPEN, eyes, openness};
use crate::geometry::{Point, Rect, Vec2, polygon_area};
use crate::raster::{Raster, median};
use crate::source::{Iris, Landmarks};

/// Openness from which an eye gets a light.
pub(super) const LEAST_OPEN: f32 = 0.3;
/// The photograph's own light lies within this many radii of the iris, and not farther down, where the mean of a place as large as the catchlight is lighter than
/// the iris by so much.
const OWN_WITHIN: f64 = 0.45;
const OWN_DOWN: f64 = 0.1;
const OWN_LIGHTER: f32 = 0.06;
/// Lights of one lamp lie at the same place of both irises: up to this distance, in radii, each stays where it is.
const SAME_LAMP: f64 = 0.3;
/// Place of the catchlight in radii of the iris where there is none: aside to where the light comes from, and up; its radius; that of its soft
/// edge; and its distance from the lids. At 0.2 and 0.23 the face finder misses the dark bust in a newspaper's column; at 0.25 one light of the
/// sixteen portraits' joins the white beside it (10).
const ASIDE: f64 = 0.36;
const UP: f64 = 0.34;
const RADIUS: f64 = 0.25;
/// In large irises, where that is more pixels than this, it is smaller, down to this radius in radii of the iris: a quarter is a button. With 2.2
/// pixels charcoal's are smaller too, and its noses are found farther away (brown faces 2.6 % in place of 2.0 %).
const LARGEST: f64 = 2.75;
const SMALLEST: f64 = 0.21;
/// From so many pixels a light is raised.
const RAISED: f64 = 2.2;
/// The least distance above a large iris' middle, in its radii: a light in the middle stares. In a newspaper's column, whose irises are small,
/// faces of light skin are then less alike (3.0 % in place of 2.4 %).
const LEAST_UP: f64 = 0.24;
/// Radius of the disc by whose mean the photograph's light is found.
const SEEN: f64 = 0.17;
const SOFT: f64 = 0.1;
const FROM_LIDS: f64 = 0.15;

/// The photograph's light in an iris: its place in radii from the middle, and how much lighter it is.
type OwnLight = (Vec2, f32);

/// The tone with one light in the iris of each open eye: where the photograph, or the other eye, has it, or at the side of the light.
pub(super) fn with_catchlights(tone: Raster<f32>, lightness: &Raster<f32>, faces: &[Landmarks]) -> Raster<f32> {
    faces.iter().fold(tone, |tone, face| {
        let open: Vec<(Vec<Point>, Iris)> =
            eyes(face).into_iter().filter(|(lids, _)| openness(lids, EYE_OPEN) >= LEAST_OPEN).collect();
        let own: Vec<Option<OwnLight>> = open.iter().map(|(_, iris)| own_light(lightness, *iris)).collect();
        let aside = if face.lit_side(lightness) < 0.0 { -ASIDE } else { ASIDE };
        let places = places(&own, Vec2::new(aside, -UP));
        open.iter().zip(places).fold(tone, |tone, ((lids, iris), away)| {
            lit(tone, *iris, between(lids, *iris, iris.centre + raised(away, *iris) * iris.radius))
        })
    })
}

/// Where the lights of a face's eyes are, in radii from the middle of each iris: the clearer one's place if they are not of one lamp.
fn places(own: &[Option<OwnLight>], usual: Vec2) -> Vec<Vec2> {
    let clearest = own.iter().flatten().copied().reduce(|best, each| if each.1 > best.1 { each } else { best });
    let Some((clearest, _)) = clearest else { return vec![usual; own.len()] };
    let place = |own: &Option<OwnLight>| own.map_or(clearest, |(own, _)| own);
    own.iter().map(place).map(|own| if (own - clearest).hypot() < SAME_LAMP { own } else { clearest }).collect()
}

/// The lightest place in the iris, if it is a light, and how much lighter it is than the iris.
fn own_light(lightness: &Raster<f32>, iris: Iris) -> Option<OwnLight> {
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
    (lightest.1 > middle + OWN_LIGHTER).then_some(((lightest.0 - iris.centre) / iris.radius, lightest.1 - middle))
}

/// The place moved down or up until a catchlight there lies between the lids.
fn between(lids: &[Point], iris: Iris, p: Point) -> Point {
    let near = lids.iter().filter(|lid| (lid.x - iris.centre.x).abs() <= iris.radius);
    let Some(bounds) = near.map(|lid| Rect::from_points(*lid, *lid)).reduce(|all, lid| all.union(lid)) else { return p };
    let room = radius_in(iris) + FROM_LIDS * iris.radius;
    let (top, bottom) = (bounds.y0 + room, bounds.y1 - room);
    Point::new(p.x, if top < bottom { p.y.clamp(top, bottom) } else { f64::midpoint(top, bottom) })
}

/// A light's place in a large iris above its middle.
fn raised(away: Vec2, iris: Iris) -> Vec2 {
    if RADIUS * iris.radius > RAISED { Vec2::new(away.x, away.y.min(-LEAST_UP)) } else { away }
}

/// The radius of the light in an iris.
fn radius_in(iris: Iris) -> f64 {
    (RADIUS * iris.radius).min(LARGEST).max(SMALLEST * iris.radius)
}

/// The tone with a light at a place.
fn lit(mut tone: Raster<f32>, iris: Iris, centre: Point) -> Raster<f32> {
    let (radius, soft) = (radius_in(iris), SOFT * iris.radius);
    let spot: Vec<(usize, usize, f64)> = pixels_about(&tone, centre, radius + soft).collect();
    for (x, y, distance) in spot {
        let share = ((radius - distance) / soft.max(0.5) + 0.5).clamp(0.0, 1.0) as f32;
        let v = tone.get(x, y);
        tone.set(x, y, v + share * (1.0 - v));
    }
    tone
}

/// The part of an eye's opening that its catchlight covers, 0 to 1.
pub(super) fn share_of_opening(lids: &[Point], iris: Iris) -> f32 {
    let is_lit = openness(lids, EYE_OPEN) >= LEAST_OPEN;
    let light = std::f64::consts::PI * radius_in(iris).powi(2);
    if is_lit { (light / polygon_area(lids).abs().max(light)) as f32 } else { 0.0 }
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

    /// Two open eyes 100 pixels apart, with irises of 12 pixels.
    fn face() -> Landmarks {
        let mut points = vec![[0.0; 3]; POINTS];
        let irises = [Point::new(60.0, 40.0), Point::new(160.0, 40.0)].map(|centre| Iris { centre, radius: 12.0 });
        for (outline, iris) in [&outlines::RIGHT_EYE, &outlines::LEFT_EYE].into_iter().zip(irises) {
            for (i, point) in outline.iter().enumerate() {
                let p = unit_at(std::f64::consts::TAU * i as f64 / outline.len() as f64);
                points[*point] = [iris.centre.x + 26.0 * p.x, iris.centre.y + 13.0 * p.y, 0.0];
            }
        }
        Landmarks { points, irises, spectacles: None, pearls: Vec::new() }
    }

    #[test]
    fn each_eye_gets_one_light_at_the_place_of_the_photographs() {
        let face = face();
        let own = Point::new(164.0, 38.0);
        let with_own =
            |x: usize, y: usize| if own.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5)) < 2.8 { 0.8 } else { 0.05 };
        let lightness = Raster::from_fn(220, 80, with_own);
        let tone = with_catchlights(Raster::filled(220, 80, 0.05), &lightness, std::slice::from_ref(&face));
        let lights = face
            .irises
            .map(|iris| pixels_about(&tone, iris.centre, iris.radius).filter(|(x, y, _)| tone.get(*x, *y) > 0.9).count());
        assert!(lights[0] > 6 && lights[0] == lights[1], "{lights:?}");
        assert!(tone.get(164, 38) > 0.95 && tone.get(64, 38) > 0.95 && tone.get(56, 38) < 0.06, "at the same place of both");
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
        let own = iris.centre + own.0 * iris.radius;
        assert!(own.distance(spot) < 1.6, "{own:?}");
        assert!(own_light(&Raster::filled(40, 40, 0.1), iris).is_none());
        let lids = [(5.0, 20.0), (20.0, 14.0), (35.0, 20.0), (20.0, 27.0)].map(Point::from);
        let lowest = 14.0 + radius_in(iris) + FROM_LIDS * iris.radius;
        assert_eq!(between(&lids, iris, own), Point::new(own.x, lowest));
    }
}
