//! Face detection by the pattern of dark places (the template matching suggested in Wong 1999, chapter 8).
//!
//! ```text
//!      (--)   (--)      brows    -0.36        dark places are compared with light ones; the unit is the
//!       o   .   o       eyes      0           distance of the eyes, and down the face a stretch of it,
//!      .    .    .      cheeks                since faces differ in height and heads nod
//!           ^           nose      0.60
//!          ---          mouth     1.05
//! ```

use super::super::dark_relief::dark_relief;
use super::fit::fitted;
use super::frame::{FaceFrame, FeatureWindow};
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2};
use crate::parallel::mapped;
use crate::raster::{Raster, gaussian_blur};

/// Default windows of a face: brows, eyes, nose, mouth.
pub const USUAL_WINDOWS: [FeatureWindow; 6] = [
    [-0.5, -0.36, 0.45, 0.17],
    [0.5, -0.36, 0.45, 0.17],
    [-0.5, 0.0, 0.36, 0.17],
    [0.5, 0.0, 0.36, 0.17],
    [0.0, 0.6, 0.36, 0.2],
    [0.0, 1.06, 0.52, 0.22],
];

/// The template in units of the eye distance: place and weight. The weights of the dark places sum to one, as do those of the light
/// places. Tuned on the busts and portraits: with less weight on the brows they pass for the eyes of a dark face; without the upper lip,
/// the shadow under the nose passes for the mouth.
const DARK: [(f64, f64, f64); 7] = [
    (-0.5, 0.0, 0.23),
    (0.5, 0.0, 0.23),
    (0.0, 1.08, 0.2),
    (-0.2, 0.64, 0.04),
    (0.2, 0.64, 0.04),
    (-0.5, -0.34, 0.13),
    (0.5, -0.34, 0.13),
];
const LIGHT: [(f64, f64, f64); 10] = [
    (0.0, 0.12, 0.16),
    (0.0, -0.6, 0.1),
    (-0.5, 0.45, 0.13),
    (0.5, 0.45, 0.13),
    (-0.42, -0.7, 0.08),
    (0.42, -0.7, 0.08),
    (0.0, 1.45, 0.1),
    (0.0, 0.85, 0.06),
    (-0.45, 0.85, 0.08),
    (0.45, 0.85, 0.08),
];
/// Lower limit of the relief: a black cap's edge counts no darker than a brow.
const LEAST_RELIEF: f32 = 0.55;
/// Penalty for light places of unequal tone, as logarithms, and its limit. Tuned on the busts and portraits in even light and with the
/// light falling to half: without it hair over the brow passes for a forehead; with twice as much the lit side of a face no longer
/// agrees with the dark one.
const UNEVEN: f64 = 0.3;
const UNEVEN_LIMIT: f64 = 0.5;
/// Shares of the light places that are skin for a score of 0 and for the full score.
const SKIN_SHARE: (f64, f64) = (0.45, 0.85);
const STRETCHES: [f64; 5] = [0.8, 0.9, 1.0, 1.1, 1.2];
const TILTS: [f64; 5] = [-0.12, -0.06, 0.0, 0.06, 0.12];
/// Penalty for a face that is one tolerance off its expectation; a good face scores 0.3.
const SURPRISE: f64 = 0.04;
/// Tolerance of the eye distance, as a logarithm, and the searched sizes, in steps of 8 %: much hair makes a head wide.
const SIZE_TOLERANCE: f64 = 0.25;
const SIZES: std::ops::RangeInclusive<i32> = -7..=3;

/// The expected place and size of a face, in working pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceExpectation {
    /// Expected midpoint between the eyes.
    pub between_eyes: Point,
    /// Tolerance of that point, across and down; 2.5 times as much is searched.
    pub tolerance: Vec2,
    /// Expected eye distance; the search covers three fifths to five quarters of it.
    pub eye_distance: f64,
}

/// The face in `lightness` (0 to 1) on `skin` (0 to 1) that best matches the template and the expectation; none if nothing matches.
pub fn find_face(lightness: &Raster<f32>, skin: &Raster<f32>, expected: &FaceExpectation) -> Option<FaceFrame> {
    let sizes: Vec<f64> = SIZES.map(|i| expected.eye_distance * 1.08_f64.powi(i)).filter(|size| *size >= 4.0).collect();
    let best: Vec<Option<FaceFrame>> = mapped(&sizes, &|size| best_of_size(lightness, skin, expected, *size));
    let best = best.into_iter().flatten().fold(None, |best: Option<FaceFrame>, next| match best {
        Some(best) if best.score >= next.score => Some(best),
        _ => Some(next),
    });
    best.map(|frame| fitted(&frame, lightness, skin))
}

fn best_of_size(lightness: &Raster<f32>, skin: &Raster<f32>, expected: &FaceExpectation, size: f64) -> Option<FaceFrame> {
    // Relative to the surrounding light, so that the dark side of a face and dark skin are treated equally.
    let relief = dark_relief(lightness, size).relief.map(|relief| relief.clamp(LEAST_RELIEF, 1.0));
    let tone = gaussian_blur(lightness, (0.08 * size) as f32).map(|tone| (tone + 0.02).logarithm());
    // A feature may lie slightly off its place.
    let darkest = least_around(&relief, (0.08 * size) as usize);
    let likeness = Likeness { relief: &relief, darkest: &darkest, tone: &tone, skin };
    let step = (0.06 * size).max(1.0);
    let mut best: Option<FaceFrame> = None;
    let reach = |tolerance: f64| (2.5 * tolerance / step) as isize;
    for row in -reach(expected.tolerance.y)..=reach(expected.tolerance.y) {
        for column in -reach(expected.tolerance.x)..=reach(expected.tolerance.x) {
            let offset = Vec2::new(column as f64, row as f64) * step;
            let off = [
                offset.x / expected.tolerance.x,
                offset.y / expected.tolerance.y,
                (size / expected.eye_distance).logarithm() / SIZE_TOLERANCE,
            ];
            let surprise = SURPRISE * off.iter().map(|o| o * o).sum::<f64>();
            for (stretch, tilt) in STRETCHES.into_iter().flat_map(|s| TILTS.map(|t| (s, t))) {
                let between_eyes = expected.between_eyes + offset;
                let frame = FaceFrame { between_eyes, eye_distance: size, stretch, tilt, score: 0.0, windows: USUAL_WINDOWS };
                let score = likeness.of(&frame, surprise);
                if best.is_none_or(|best| score > best.score) {
                    best = Some(FaceFrame { score, ..frame });
                }
            }
        }
    }
    best.filter(|best| best.score > 0.0)
}

/// Minimum over a square of `2 radius + 1` pixels.
fn least_around(raster: &Raster<f32>, radius: usize) -> Raster<f32> {
    let along = |raster: &Raster<f32>| {
        let reach = radius as isize;
        Raster::from_fn(raster.width(), raster.height(), |x, y| {
            (-reach..=reach).map(|d| raster.clamped(x as isize + d, y as isize)).fold(f32::INFINITY, f32::min)
        })
    };
    along(&along(raster).transposed()).transposed()
}

/// Input of the comparison with the template.
struct Likeness<'a> {
    relief: &'a Raster<f32>,
    darkest: &'a Raster<f32>,
    /// The logarithm of the blurred lightness.
    tone: &'a Raster<f32>,
    skin: &'a Raster<f32>,
}

impl Likeness<'_> {
    /// How much lighter the light places are than the dark ones. Both sides must agree, and the light places must be skin of one tone.
    fn of(&self, frame: &FaceFrame, surprise: f64) -> f64 {
        let value = |raster: &Raster<f32>, across: f64, down: f64| {
            let p = frame.place(across, down);
            f64::from(raster.clamped(p.x as isize, p.y as isize))
        };
        let sum = |raster: &Raster<f32>, places: &[(f64, f64, f64)]| -> f64 {
            places.iter().map(|&(across, down, weight)| weight * value(raster, across, down)).sum()
        };
        let odd = (value(self.darkest, -0.5, 0.0) - value(self.darkest, 0.5, 0.0)).abs();
        // Ties go to the upright, unstretched face.
        let strange = 0.1 * (frame.stretch - 0.97).abs() + 0.2 * frame.tilt.abs();
        let share = sum(self.skin, &LIGHT);
        let on_skin = ((share - SKIN_SHARE.0) / (SKIN_SHARE.1 - SKIN_SHARE.0)).clamp(0.0, 1.0);
        let likeness = sum(self.relief, &LIGHT) - sum(self.darkest, &DARK);
        (likeness - 0.3 * odd - strange - surprise - UNEVEN * self.unevenness(frame)) * on_skin
    }

    /// Mean difference of the light places' tones from their median.
    fn unevenness(&self, frame: &FaceFrame) -> f64 {
        let tones = LIGHT.map(|(across, down, _)| {
            let p = frame.place(across, down);
            f64::from(self.tone.clamped(p.x as isize, p.y as isize))
        });
        let mut sorted = tones;
        sorted.sort_unstable_by(f64::total_cmp);
        let median = f64::midpoint(sorted[4], sorted[5]);
        tones.iter().zip(LIGHT).map(|(tone, (_, _, weight))| weight * (tone - median).abs().min(UNEVEN_LIMIT)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drawn_face_is_found() {
        let spots = [(80.0, 90.0), (140.0, 90.0), (110.0, 153.0), (80.0, 68.0), (140.0, 68.0), (110.0, 127.0)];
        let face = Raster::from_fn(220, 240, |x, y| {
            let near = spots
                .iter()
                .any(|&(sx, sy): &(f32, f32)| ((x as f32 - sx) / 12.0).powi(2) + ((y as f32 - sy) / 5.0).powi(2) < 1.0);
            if near { 0.25 } else { 0.7 }
        });
        let expected =
            FaceExpectation { between_eyes: Point::new(103.0, 98.0), tolerance: Vec2::new(15.0, 15.0), eye_distance: 55.0 };
        let frame = find_face(&face, &Raster::filled(220, 240, 1.0), &expected).unwrap();
        assert!(frame.between_eyes.distance(Point::new(110.0, 90.0)) < 8.0, "{frame:?}");
        assert!((frame.eye_distance - 60.0).abs() < 8.0 && frame.score > 0.1, "{frame:?}");
    }
}
