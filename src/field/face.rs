//! Where a face is, by the pattern of its dark places (the template matching that Wong 1999, chapter 8 asks for).
//!
//! ```text
//!      (--)   (--)      brows    -0.36        dark places are compared with light ones; the unit is the
//!       o   .   o       eyes      0           distance of the eyes, and down the face a stretch of it,
//!      .    .    .      cheeks                since faces differ in height and heads nod
//!           ^           nose      0.60
//!          ---          mouth     1.05
//! ```

use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, gaussian_blur};
use rayon::prelude::*;

/// A face's place and size in working pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceFrame {
    /// The middle between the eyes.
    pub between_eyes: Point,
    /// Distance of the eyes' middles.
    pub eye_distance: f64,
    /// How much taller than the template the face is, about 1.
    pub stretch: f64,
    /// The tilt of the line through the eyes, in radians.
    pub tilt: f64,
    /// How far the pattern stands out, 0 (not at all) to about 1.
    pub score: f64,
}

/// The template in units of the eyes' distance: place and weight; the weights of the dark and of the light places add up to one
/// each. Tuned on the samples: with less on the eyes, nostrils and shadows of a collar win; without the bridge of the nose between
/// them, a single dark band does; without the upper lip, the shadow under the nose passes for the mouth.
const DARK: [(f64, f64, f64); 6] =
    [(-0.5, 0.0, 0.25), (0.5, 0.0, 0.25), (0.0, 1.08, 0.22), (0.0, 0.62, 0.08), (-0.5, -0.36, 0.1), (0.5, -0.36, 0.1)];
const LIGHT: [(f64, f64, f64); 10] = [
    (0.0, 0.15, 0.2),
    (0.0, -0.55, 0.12),
    (-0.5, 0.5, 0.15),
    (0.5, 0.5, 0.15),
    (-0.42, -0.75, 0.06),
    (0.42, -0.75, 0.06),
    (0.0, 1.42, 0.1),
    (0.0, 0.85, 0.06),
    (-0.3, 0.62, 0.05),
    (0.3, 0.62, 0.05),
];
/// Limits of the light against its surroundings': a white strap on black cloth is no more than a lit cheek.
const RELIEF: (f32, f32) = (0.35, 1.25);
/// Shares of the light places that must be skin, for a score of 0 and for the full score.
const SKIN_SHARE: (f64, f64) = (0.45, 0.85);
const STRETCHES: [f64; 5] = [0.8, 0.9, 1.0, 1.1, 1.2];
const TILTS: [f64; 5] = [-0.16, -0.08, 0.0, 0.08, 0.16];

impl FaceFrame {
    /// A place of the template on the page's raster: `across` and `down` in eye distances from between the eyes.
    pub fn place(&self, across: f64, down: f64) -> Point {
        let along = Vec2::from_angle(self.tilt);
        let downwards = Vec2::new(-along.y, along.x);
        self.between_eyes + along * (across * self.eye_distance) + downwards * (down * self.eye_distance * self.stretch)
    }

    /// A place of the raster in eye distances from between the eyes: across and down.
    pub fn relative(&self, p: Point) -> (f64, f64) {
        let along = Vec2::from_angle(self.tilt);
        let offset = p - self.between_eyes;
        let downwards = Vec2::new(-along.y, along.x);
        (offset.dot(along) / self.eye_distance, offset.dot(downwards) / (self.eye_distance * self.stretch))
    }
}

/// The face in `lightness` (0 to 1) with its middle between the eyes inside `zone` (0 to 1), on `skin` (0 to 1), whose eyes are
/// `least` to `most` pixels apart; none where nothing is like a face.
pub fn find_face(lightness: &Raster<f32>, skin: &Raster<f32>, zone: &Raster<f32>, least: f64, most: f64) -> Option<FaceFrame> {
    let mut sizes = Vec::new();
    let mut size = least;
    while size <= most {
        sizes.push(size);
        size *= 1.08;
    }
    let best: Vec<Option<FaceFrame>> = sizes.par_iter().map(|size| best_of_size(lightness, skin, zone, *size)).collect();
    best.into_iter().flatten().fold(None, |best: Option<FaceFrame>, next| match best {
        Some(best) if best.score >= next.score => Some(best),
        _ => Some(next),
    })
}

fn best_of_size(lightness: &Raster<f32>, skin: &Raster<f32>, zone: &Raster<f32>, size: f64) -> Option<FaceFrame> {
    let fine = gaussian_blur(lightness, (0.09 * size) as f32);
    let mean = gaussian_blur(lightness, (0.8 * size) as f32);
    // In shares of the surroundings' light, so that the dark side of a face and dark skin count alike.
    let relief = fine.zip_map(&mean, |fine, mean| (fine / (mean + 0.05)).clamp(RELIEF.0, RELIEF.1));
    let step = (0.06 * size).max(1.0);
    let mut best: Option<FaceFrame> = None;
    let (columns, rows) = ((relief.width() as f64 / step) as usize, (relief.height() as f64 / step) as usize);
    for (column, row) in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
        let between_eyes = Point::new((column as f64 + 0.5) * step, (row as f64 + 0.5) * step);
        if zone.sample(between_eyes.x, between_eyes.y) < 0.5 {
            continue;
        }
        for (stretch, tilt) in STRETCHES.into_iter().flat_map(|s| TILTS.map(|t| (s, t))) {
            let frame = FaceFrame { between_eyes, eye_distance: size, stretch, tilt, score: 0.0 };
            let score = score(&frame, &relief, skin);
            if best.is_none_or(|best| score > best.score) {
                best = Some(FaceFrame { score, ..frame });
            }
        }
    }
    best.filter(|best| best.score > 0.0)
}

/// How much lighter the light places are than the dark ones; both sides must agree, and the light places be skin.
fn score(frame: &FaceFrame, relief: &Raster<f32>, skin: &Raster<f32>) -> f64 {
    let value = |raster: &Raster<f32>, across: f64, down: f64| {
        let p = frame.place(across, down);
        f64::from(raster.clamped(p.x as isize, p.y as isize))
    };
    let at = |across: f64, down: f64| value(relief, across, down);
    let eyes = (at(-0.5, 0.0), at(0.5, 0.0));
    // An eye that is no darker than the bridge of the nose is no eye.
    if eyes.0.max(eyes.1) > at(0.0, 0.15) {
        return 0.0;
    }
    let dark: f64 = DARK.iter().map(|&(across, down, weight)| weight * at(across, down)).sum();
    let light: f64 = LIGHT.iter().map(|&(across, down, weight)| weight * at(across, down)).sum();
    let share: f64 = LIGHT.iter().map(|&(across, down, weight)| weight * value(skin, across, down)).sum();
    let odd = (eyes.0 - eyes.1).abs();
    // Equal darkness decides for the plain face.
    let strange = 0.06 * (frame.stretch - 0.97).abs() + 0.06 * frame.tilt.abs();
    let on_skin = ((share - SKIN_SHARE.0) / (SKIN_SHARE.1 - SKIN_SHARE.0)).clamp(0.0, 1.0);
    (light - dark - 0.3 * odd - strange) * on_skin
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
        let frame = find_face(&face, &Raster::filled(220, 240, 1.0), &Raster::filled(220, 240, 1.0), 48.0, 80.0).unwrap();
        assert!(frame.between_eyes.distance(Point::new(110.0, 90.0)) < 6.0, "{frame:?}");
        assert!((frame.eye_distance - 60.0).abs() < 8.0 && frame.score > 0.2, "{frame:?}");
    }
}
