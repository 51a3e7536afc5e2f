//! Light irises stay lighter than their pupils: as discs of black, blue and green eyes stare.

use super::catchlights::pixels_about;
use super::openings::{eyes, openness};
use super::zones::polygon;

use crate::raster::{Raster, median};
use crate::source::{Iris, Landmarks};

/// The pupil, and the ring around it that is surely iris and neither pupil nor its dark rim, in radii of the iris.
const PUPIL: f64 = 0.34;
const RING: [f64; 2] = [0.45, 0.82];
/// The part of the ring that is counted is its darker share: lights and lids are none of it.
const DARKER: f64 = 0.7;
/// A ring's lightness above its pupil, in shares of the white of the eye above the pupil, from which it is raised: below it is noise. Black
/// eyes have 0.05, brown ones up to 0.2, blue and grey ones 0.2 and more. And how much of that it gets in the tone: eyes are small.
const LIGHT: f32 = 0.08;
const GAIN: f32 = 1.6;
const MOST: f32 = 0.5;
/// Soft edge of the ring in radii of the iris.
const SOFT: f64 = 0.12;
/// Openness of a face's eyes below which light irises stay as dark as they are, and from which they are raised in full: between narrow lids
/// an iris is the only dark of the eye (portraits 04 and 14), and the blue and grey eyes that have a ring to see are at 0.18 and more.
const WIDE: [f64; 2] = [0.155, 0.18];
/// Irises of fewer pixels have no ring.
const LEAST_RADIUS: f64 = 4.0;

/// The tone with light irises, by the photograph's lightness; `strength` is that of the tone, 0 to 1.
pub(super) fn with_light_irises(tone: Raster<f32>, lightness: &Raster<f32>, faces: &[Landmarks], strength: f32) -> Raster<f32> {
    let large = faces.iter().filter(|face| face.irises.iter().any(|iris| iris.radius >= LEAST_RADIUS));
    large.fold(tone, |tone, face| {
        let open = eyes(face).iter().map(|(lids, _)| openness(lids, WIDE)).sum::<f32>() / 2.0;
        let eyes = eyes(face).map(|(lids, iris)| (polygon(tone.width(), tone.height(), &lids), iris));
        // Both eyes of a face have one colour.
        let seen: Vec<f32> = eyes.iter().filter_map(|(opening, iris)| iris_light(lightness, opening, *iris)).collect();
        let light = seen.iter().sum::<f32>() / seen.len().max(1) as f32;
        if light < LIGHT {
            return tone;
        }
        eyes.into_iter().fold(tone, |tone, (opening, iris)| {
            let Some(was) = Eye::of(&tone, &opening, iris) else { return tone };
            let more = (GAIN * light).min(MOST) * (was.white - was.pupil) - (was.ring - was.pupil);
            raised(tone, &opening, iris, strength * open * more.max(0.0))
        })
    })
}

/// How light an iris is in the photograph, from 0, as its pupil, to 1, as the white of the eye. None if it is too small to tell.
fn iris_light(lightness: &Raster<f32>, opening: &Raster<u8>, iris: Iris) -> Option<f32> {
    let seen = Eye::of(lightness, opening, iris).filter(|_| iris.radius >= LEAST_RADIUS)?;
    Some(((seen.ring - seen.pupil) / (seen.white - seen.pupil).max(0.02)).clamp(0.0, 1.0))
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
        let share = ((away - PUPIL) / SOFT).min((RING[1] + 0.5 * SOFT - away) / SOFT).clamp(0.0, 1.0) as f32;
        let v = tone.get(x, y);
        // Lights of the iris are light already.
        tone.set(x, y, v + share * more * (1.0 - v).clamp(0.0, 1.0));
    }
    tone
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

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
    fn blue_irises_are_light_and_brown_ones_are_not() {
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
}
