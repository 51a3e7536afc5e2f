//! Irises as they are drawn: brown ones black, light ones lighter than their pupils: as discs of black, blue and green eyes stare.

use super::catchlights::pixels_about;
use super::openings::{eyes, openness};
use super::zones::polygon;
use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, median};
use crate::source::{Iris, Landmarks};

/// The pupil, and the ring around it that is surely iris and neither pupil nor its dark rim, in radii of the iris.
const PUPIL: f64 = 0.34;
const RING: [f64; 2] = [0.45, 0.82];
/// The part of the ring that is counted is its darker share: lights and lids are none of it.
const DARKER: f64 = 0.7;
/// A ring's lightness above its pupil, in shares of the white of the eye above the pupil, from which an iris is light if its colour is, and
/// from which it is in black and white. Black eyes have 0.05, brown ones up to 0.2, blue, green and grey ones 0.16 to 0.3.
const LIGHT: f32 = 0.1;
const LIGHT_IN_GREY: f32 = 0.24;
/// Green over red of the irises in linear light, in shares of the skin's, from which they are blue, green or grey: of sixteen portraits such
/// eyes have 1.6 and more, brown ones that are light enough at most 1.2. In black and white all have 1.
const GREENER_THAN_SKIN: f32 = 1.4;
const GREY: f32 = 0.03;
/// How much of its lightness a light ring gets in the tone, as eyes are small, and its least and most tone: in shade whites are dark too, and a
/// share of them makes black discs (13).
const GAIN: f32 = 1.6;
const MOST: f32 = 0.5;
const LEAST: f32 = 0.3;
/// The tone of a brown ring.
const BLACK: f32 = 0.04;
/// The part of a brown ring that glows, opposite the catchlight: the cosines of the angle from there at which it begins and is whole, its ring
/// in radii, and its tone; and the lightness above the pupil from which it glows, and glows in full.
const LOBE: [f64; 2] = [0.35, 0.75];
const GLOW_RING: [f64; 2] = [0.5, 0.82];
const GLOW: f32 = 0.34;
const GLOWS: [f32; 2] = [0.04, 0.1];
/// The least of it that is seen between the lids.
const SEEN: f32 = 0.85;
/// Where the skin's colour is taken: the middles of the cheeks, and the radius around them in widths of the face.
const CHEEKS: [usize; 2] = [50, 280];
const CHEEK: f64 = 0.06;
/// Where the raised ring begins, in radii of the iris: from the pupil on, eyes stare from wide white rings (13). And where a darkened one ends.
const RAISED: f64 = 0.44;
const DARKENED: f64 = 0.82;
/// Soft edge of the ring in radii of the iris.
const SOFT: f64 = 0.12;
/// Openness of a face's eyes below which light irises stay as dark as they are, and from which they are raised in full: between narrow lids
/// an iris is the only dark of the eye (portraits 04 and 14), and the blue and grey eyes that have a ring to see are at 0.18 and more.
const WIDE: [f64; 2] = [0.155, 0.18];
/// Irises of fewer pixels have no ring.
const LEAST_RADIUS: f64 = 4.0;

/// The tone with the irises' own colours, by the photograph's lightness and linear light; `strength` is that of the tone, 0 to 1.
pub(super) fn with_irises(
    tone: Raster<f32>,
    lightness: &Raster<f32>,
    light: &Raster<[f32; 3]>,
    faces: &[Landmarks],
    strength: f32,
) -> Raster<f32> {
    let large = faces.iter().filter(|face| face.irises.iter().any(|iris| iris.radius >= LEAST_RADIUS));
    large.fold(tone, |tone, face| {
        let open = eyes(face).iter().map(|(lids, _)| openness(lids, WIDE)).sum::<f32>() / 2.0;
        let eyes = eyes(face).map(|(lids, iris)| (polygon(tone.width(), tone.height(), &lids), iris));
        // Both eyes of a face have one colour.
        let seen: Vec<f32> = eyes.iter().filter_map(|(opening, iris)| iris_light(lightness, opening, *iris)).collect();
        let above_pupil = seen.iter().sum::<f32>() / seen.len().max(1) as f32;
        let is_light = is_light(above_pupil, greener_than_skin(light, face, &eyes));
        let away_from_light = Vec2::new(if face.lit_side(lightness) < 0.0 { 1.0 } else { -1.0 }, 1.0).normalize();
        eyes.into_iter().fold(tone, |tone, (opening, iris)| {
            let Some(was) = Eye::of(&tone, &opening, iris) else { return tone };
            if !is_light {
                let tone = darkened(tone, &opening, iris, strength * (1.0 - BLACK / was.ring.max(BLACK)));
                let brown = ((above_pupil - GLOWS[0]) / (GLOWS[1] - GLOWS[0])).clamp(0.0, 1.0);
                return glowing(tone, &opening, iris, away_from_light, strength * open * brown);
            }
            let more = (GAIN * above_pupil).min(MOST) * (was.white - was.pupil) - (was.ring - was.pupil);
            let more = more.max((LEAST - was.ring) / (1.0 - was.ring).max(0.1));
            raised(tone, &opening, iris, strength * open * more.max(0.0))
        })
    })
}

/// Whether irises are blue, green or grey: by their lightness above the pupil, and how much greener than the skin they are.
fn is_light(above_pupil: f32, greener: Option<f32>) -> bool {
    let is_coloured = greener.is_some_and(|greener| greener >= GREENER_THAN_SKIN);
    let is_grey = greener.is_some_and(|greener| (greener - 1.0).abs() < GREY);
    (is_coloured && above_pupil >= LIGHT) || (is_grey && above_pupil >= LIGHT_IN_GREY)
}

/// How light an iris is in the photograph, from 0, as its pupil, to 1, as the white of the eye. None if it is too small to tell.
fn iris_light(lightness: &Raster<f32>, opening: &Raster<u8>, iris: Iris) -> Option<f32> {
    let seen = Eye::of(lightness, opening, iris).filter(|_| iris.radius >= LEAST_RADIUS)?;
    Some(((seen.ring - seen.pupil) / (seen.white - seen.pupil).max(0.02)).clamp(0.0, 1.0))
}

/// Green over red of both irises together, in shares of the skin's.
fn greener_than_skin(light: &Raster<[f32; 3]>, face: &Landmarks, eyes: &[(Raster<u8>, Iris); 2]) -> Option<f32> {
    let green_over_red = |places: &[(usize, usize)]| {
        let [red, green] = [0, 1].map(|channel| median(places.iter().map(|(x, y)| light.get(*x, *y)[channel]).collect()));
        Some(green? / red?.max(1e-3))
    };
    let ring = |(opening, iris): &(Raster<u8>, Iris)| {
        let near = pixels_about(light, iris.centre, RING[1] * iris.radius).filter(|(_, _, away)| *away >= RING[0] * iris.radius);
        let places: Vec<_> = near.filter(|(x, y, _)| opening.get(*x, *y) == 1).map(|(x, y, _)| (x, y)).collect();
        green_over_red(&places)
    };
    let cheeks = CHEEKS.into_iter().flat_map(|cheek| pixels_about(light, face.point(cheek), CHEEK * face.width()));
    let cheeks: Vec<_> = cheeks.map(|(x, y, _)| (x, y)).collect();
    Some(0.5 * (ring(&eyes[0])? + ring(&eyes[1])?) / green_over_red(&cheeks)?)
}

/// Values of the three parts of an eye.
struct Eye {
    pupil: f32,
    ring: f32,
    white: f32,
}

impl Eye {
    /// None where a part is not between the lids.
    fn of(values: &Raster<f32>, opening: &Raster<u8>, iris: Iris) -> Option<Self> {
        let within = |from: f64, to: f64| -> Vec<f32> {
            let near = pixels_about(values, iris.centre, to * iris.radius).filter(|(_, _, away)| *away >= from * iris.radius);
            let mut inside: Vec<f32> =
                near.filter(|(x, y, _)| opening.get(*x, *y) == 1).map(|(x, y, _)| values.get(x, y)).collect();
            inside.sort_unstable_by(f32::total_cmp);
            inside
        };
        let darker = |mut values: Vec<f32>| {
            values.truncate((DARKER * values.len() as f64).ceil() as usize);
            median(values)
        };
        let whites = within(1.1, 2.0);
        let white = whites.get((0.8 * whites.len() as f64) as usize).copied();
        Some(Self { pupil: darker(within(0.0, PUPIL))?, ring: darker(within(RING[0], RING[1]))?, white: white? })
    }
}

fn raised(mut tone: Raster<f32>, opening: &Raster<u8>, iris: Iris, more: f32) -> Raster<f32> {
    let ring: Vec<(usize, usize, f64)> = pixels_about(&tone, iris.centre, iris.radius).collect();
    for (x, y, away) in ring.into_iter().filter(|(x, y, _)| opening.get(*x, *y) == 1) {
        let away = away / iris.radius;
        let share = ((away - RAISED) / SOFT).min((RING[1] + 0.5 * SOFT - away) / SOFT).clamp(0.0, 1.0) as f32;
        let v = tone.get(x, y);
        // Lights of the iris are light already.
        tone.set(x, y, v + share * more * (1.0 - v).clamp(0.0, 1.0));
    }
    tone
}

/// The tone with an iris darker by a share of itself.
fn darkened(mut tone: Raster<f32>, opening: &Raster<u8>, iris: Iris, less: f32) -> Raster<f32> {
    let disc: Vec<(usize, usize, f64)> = pixels_about(&tone, iris.centre, DARKENED * iris.radius).collect();
    for (x, y, away) in disc.into_iter().filter(|(x, y, _)| opening.get(*x, *y) == 1) {
        let share = ((DARKENED - away / iris.radius) / SOFT).clamp(0.0, 1.0) as f32;
        tone.set(x, y, tone.get(x, y) * (1.0 - share * less));
    }
    tone
}

/// The tone with the part of a dark iris lighter where the light leaves it, opposite the catchlight: as a disc of black it is a button. Where
/// a lid covers some of that part, what is left would be a slit.
fn glowing(mut tone: Raster<f32>, opening: &Raster<u8>, iris: Iris, towards: Vec2, share: f32) -> Raster<f32> {
    let glow = |(x, y, away): (usize, usize, f64)| {
        let along = (Point::new(x as f64 + 0.5, y as f64 + 0.5) - iris.centre).dot(towards) / away.max(1e-6);
        let lobe = ((along - LOBE[0]) / (LOBE[1] - LOBE[0])).clamp(0.0, 1.0);
        let away = away / iris.radius;
        let ring = ((away - GLOW_RING[0]) / SOFT).min((GLOW_RING[1] - away) / SOFT).clamp(0.0, 1.0);
        (x, y, (lobe * ring) as f32)
    };
    let all: Vec<(usize, usize, f32)> = pixels_about(&tone, iris.centre, iris.radius).map(glow).collect();
    let sum = |pixels: &mut dyn Iterator<Item = &(usize, usize, f32)>| pixels.map(|(.., glow)| glow).sum::<f32>();
    let is_open = |(x, y, _): &&(usize, usize, f32)| opening.get(*x, *y) == 1;
    if sum(&mut all.iter().filter(is_open)) < SEEN * sum(&mut all.iter()) {
        return tone;
    }
    for (x, y, glow) in all.iter().filter(is_open) {
        let v = tone.get(*x, *y);
        tone.set(*x, *y, v + share * glow * (GLOW - v).max(0.0));
    }
    tone
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::POINTS;

    fn eye(ring: f32) -> (Raster<f32>, Raster<u8>, Iris) {
        let iris = Iris { centre: Point::new(30.0, 20.0), radius: 10.0 };
        let eye = Raster::from_fn(60, 40, |x, y| {
            let away = iris.centre.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            if away < 4.0 {
                0.05
            } else if away < 10.0 {
                ring
            } else {
                0.8
            }
        });
        (eye, Raster::filled(60, 40, 1_u8), iris)
    }

    #[test]
    fn how_light_an_iris_is_is_told_by_its_ring() {
        let of = |ring: f32| {
            let (eye, opening, iris) = eye(ring);
            iris_light(&eye, &opening, iris)
        };
        assert!(of(0.09).is_some_and(|light| light < LIGHT), "{:?}", of(0.09));
        assert!(of(0.4).is_some_and(|light| light > 0.4), "{:?}", of(0.4));
    }

    #[test]
    fn the_ring_is_raised_and_the_pupil_is_not() {
        let (tone, opening, iris) = eye(0.05);
        let tone = raised(tone, &opening, iris, 0.3);
        assert_eq!(tone.get(30, 20), 0.05);
        assert!(tone.get(36, 20) > 0.25, "{}", tone.get(36, 20));
        assert_eq!(tone.get(50, 20), 0.8);
    }

    #[test]
    fn a_brown_iris_is_made_black_and_the_white_is_not() {
        let (tone, opening, iris) = eye(0.2);
        let tone = darkened(tone, &opening, iris, 0.8);
        assert!(tone.get(36, 20) < 0.05, "{}", tone.get(36, 20));
        assert_eq!(tone.get(50, 20), 0.8);
    }

    #[test]
    fn a_brown_iris_glows_opposite_its_light() {
        let (tone, opening, iris) = eye(0.04);
        let tone = glowing(tone, &opening, iris, Vec2::new(-1.0, 1.0).normalize(), 1.0);
        assert!(tone.get(25, 24) > 0.3, "{}", tone.get(25, 24));
        assert_eq!(
            [tone.get(34, 15), tone.get(30, 20), tone.get(34, 24)],
            [0.04, 0.05, 0.04],
            "beside the light, pupil and aside"
        );
    }

    #[test]
    fn irises_are_light_by_their_own_colour_not_by_the_lights() {
        let iris = Iris { centre: Point::new(30.0, 20.0), radius: 10.0 };
        let (skin, lit) = ([0.3, 0.15, 0.1], [0.3, 0.3, 0.4]);
        let is_light = |skin: [f32; 3], ring: [f32; 3], above_pupil: f32| {
            let mut points = vec![[150.0, 150.0, 0.0]; POINTS];
            [points[234], points[454]] = [[50.0, 150.0, 0.0], [250.0, 150.0, 0.0]];
            let face = Landmarks { points, irises: [iris; 2], spectacles: None, pearls: Vec::new() };
            let light = Raster::from_fn(300, 300, |x, y| {
                if iris.centre.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5)) < 10.0 { ring } else { skin }
            });
            let eyes = [0, 1].map(|_| (Raster::filled(300, 300, 1_u8), iris));
            super::is_light(above_pupil, greener_than_skin(&light, &face, &eyes))
        };
        assert!(is_light(skin, [0.009, 0.009, 0.014], 0.16), "dark blue");
        assert!(!is_light(skin, [0.009, 0.009, 0.014], 0.02), "black with the sky in it");
        assert!(!is_light(skin, [0.05, 0.02, 0.01], 0.2), "brown");
        assert!(!is_light([0.2; 3], [0.1; 3], 0.19) && is_light([0.2; 3], [0.1; 3], 0.3), "in black and white");
        assert!(!is_light(lit, [0.05, 0.05, 0.07], 0.2), "in blue light");
    }
}
