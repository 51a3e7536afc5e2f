//! Irises without specks: the reflections of lenses, lamps and windows break them into pieces.

use super::catchlights::{LEAST_OPEN, pixels_about};
use super::openings::{EYE_OPEN, eyes, openness};
use super::zones::polygon;
use crate::raster::Raster;
use crate::source::{Iris, Landmarks};

/// An iris is made even around its middle up to here, in radii, with a soft edge: what is lighter than this quantile of as far from the middle
/// is a speck. Beyond it the landmarks' place may be that of the white: at 0.8 and 0.95 irises are discs that small drawings lose.
const EVEN: [f64; 2] = [0.72, 0.86];
const RINGS: usize = 10;
const USUAL: f64 = 0.4;

/// The tone with the irises of open eyes even around their middles; `strength` is that of the tone, 0 to 1.
pub(super) fn without_specks(tone: Raster<f32>, faces: &[Landmarks], strength: f32) -> Raster<f32> {
    let eyes = faces.iter().flat_map(eyes).filter(|(lids, _)| openness(lids, EYE_OPEN) >= LEAST_OPEN);
    eyes.fold(tone, |tone, (lids, iris)| {
        let opening = polygon(tone.width(), tone.height(), &lids);
        evened(tone, &opening, iris, strength)
    })
}

fn evened(mut tone: Raster<f32>, opening: &Raster<u8>, iris: Iris, strength: f32) -> Raster<f32> {
    let ring = |away: f64| ((away / (EVEN[1] * iris.radius) * RINGS as f64) as usize).min(RINGS - 1);
    let near = pixels_about(&tone, iris.centre, EVEN[1] * iris.radius);
    let inside: Vec<(usize, usize, f64)> = near.filter(|(x, y, _)| opening.get(*x, *y) == 1).collect();
    let mut values = vec![Vec::new(); RINGS];
    for (x, y, away) in &inside {
        values[ring(*away)].push(tone.get(*x, *y));
    }
    let usual: Vec<f32> = values.into_iter().map(usual).collect();
    for (x, y, away) in inside {
        let share = ((EVEN[1] - away / iris.radius) / (EVEN[1] - EVEN[0])).clamp(0.0, 1.0) as f32;
        let v = tone.get(x, y);
        tone.set(x, y, v + strength * share * (usual[ring(away)] - v).min(0.0));
    }
    tone
}

fn usual(mut values: Vec<f32>) -> f32 {
    values.sort_unstable_by(f32::total_cmp);
    values.get((USUAL * values.len() as f64) as usize).copied().unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

    #[test]
    fn a_window_in_an_iris_goes_and_its_pupil_and_the_white_stay() {
        let iris = Iris { centre: Point::new(30.0, 20.0), radius: 10.0 };
        let eye = Raster::from_fn(60, 40, |x, y| {
            let away = iris.centre.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            let is_window = (33..36).contains(&x) && (13..18).contains(&y);
            if is_window {
                0.9
            } else if away < 4.0 {
                0.05
            } else if away < 10.0 {
                0.3
            } else {
                0.8_f32
            }
        });
        let even = evened(eye.clone(), &eye.map(|_| 1), iris, 1.0);
        assert!(even.get(34, 15) < 0.31 && even.get(36, 20) == 0.3 && even.get(30, 20) == 0.05, "{}", even.get(34, 15));
        assert_eq!(even.get(50, 20), 0.8);
        assert_eq!(evened(eye.clone(), &eye.map(|_| 1), iris, 0.0), eye);
    }
}
