//! Short faint lines that grain and the texture of cloth, skin and walls make by chance: they are no features.

use crate::field::CoherentLine;
use crate::geometry::Point;
use crate::raster::{Raster, fast_gaussian};
use crate::source::{MaskRole, Portrait};
use crate::style::creases::{Creases, is_near_iris};

/// What a line's strength must exceed: this, and so many times the texture around it. Strength is the contrast, and grows with the
/// root of the length, as the agreement of independent places does. Tuned on the necks, jackets and walls of Grace Hopper, plain and
/// with grain of 9 levels of 255, and looked at on portraits 02, 04, 06, 08, 13 and 15: with 2 textures jackets keep ticks and
/// necks combs of them, with 6 badges and the inside of ears are lost.
const LEAST: f64 = 0.05;
const TEXTURES: f64 = 4.0;
/// Length in pitches at which a line's strength is its contrast, the row of dots that a tick spans; and the longest that counts, as a
/// multiple of it: a fold of faint cloth that long is seen.
const LENGTH: f64 = 4.0;
const LONGEST: f64 = 9.0;
/// Not tuned but chosen: the surroundings that a place is compared with, and the reach over which its texture is averaged, in pitches; and the difference of
/// lightness from which a place is an edge and no texture.
const AROUND: f64 = 0.5;
const REACH: f64 = 3.0;
const EDGE: f32 = 0.06;
/// Mean of a mask along a line from which it lies there.
const INSIDE: f64 = 0.3;

/// What tells strays from features.
pub(super) struct Strays<'a> {
    portrait: &'a Portrait,
    pitch: f64,
    /// How far the places around differ from their surroundings.
    texture: Raster<f32>,
}

impl<'a> Strays<'a> {
    /// `lightness` is that in which lines are found, `pitch` in its pixels.
    pub(super) fn of(portrait: &'a Portrait, lightness: &Raster<f32>, pitch: f64) -> Self {
        let around = fast_gaussian(lightness, (AROUND * pitch) as f32);
        let off = lightness.zip_map(&around, |v, mean| (v - mean).abs().min(EDGE));
        Self { portrait, pitch, texture: fast_gaussian(&off, (REACH * pitch) as f32) }
    }

    /// The lines without strays, and without curls on foreheads. In eyes, noses and mouths all are features, and in hair where its mask is known, as it is with a tone made for
    /// faces.
    pub(super) fn dropped_from(&self, lines: Vec<CoherentLine>) -> Vec<CoherentLine> {
        let creases = Creases::of(self.portrait);
        let is_curl = |line: &CoherentLine| !self.is_feature(&line.curve.points) && creases.have_curl(&line.curve);
        let kept = lines.into_iter().filter(|line| self.is_strong(line) || self.is_feature(&line.curve.points));
        kept.filter(|line| !is_curl(line)).collect()
    }

    fn is_strong(&self, line: &CoherentLine) -> bool {
        let length = (line.curve.length() / (LENGTH * self.pitch)).min(LONGEST);
        line.contrast * length.sqrt() >= LEAST + TEXTURES * mean_along(&self.texture, &line.curve.points)
    }

    fn is_feature(&self, points: &[Point]) -> bool {
        let roles = [MaskRole::Hair, MaskRole::FacialHair, MaskRole::Detail];
        let is_inside = |mask: &Raster<f32>| mean_along(mask, points) > INSIDE;
        let Some(middle) = points.get(points.len() / 2).copied() else { return false };
        roles.iter().any(|role| self.portrait.masks.get(role).is_some_and(is_inside)) || is_near_iris(self.portrait, middle)
    }
}

/// Mean of a raster along a line.
pub(super) fn mean_along(raster: &Raster<f32>, points: &[Point]) -> f64 {
    points.iter().map(|p| f64::from(raster.sample(p.x, p.y))).sum::<f64>() / points.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Curve;
    use crate::raster::paper_texture;
    use crate::style::form::mean_portrait;

    /// A straight line of `length` pixels in the upper corner, away from the face.
    fn line(length: usize, contrast: f64) -> CoherentLine {
        let points = (0..length).map(|i| Point::new(5.0 + i as f64, 8.0)).collect();
        CoherentLine { contrast, ..CoherentLine::plain(Curve { points, closed: false }, 1.0) }
    }

    #[test]
    fn short_faint_lines_go_and_strong_or_long_ones_stay() {
        let portrait = mean_portrait(6.0, 0.0, |_| 100);
        let (width, height) = (portrait.lightness.width(), portrait.lightness.height());
        let pitch = 4.0;
        let kept = |lightness: &Raster<f32>, line: CoherentLine| {
            !Strays::of(&portrait, lightness, pitch).dropped_from(vec![line]).is_empty()
        };
        let plain = Raster::filled(width, height, 0.4);
        assert!(kept(&plain, line(16, 0.06)) && !kept(&plain, line(8, 0.06)));
        let grain = paper_texture(width, height, 1.5, 1).map(|v| 0.4 + 0.14 * (v - 0.5));
        assert!(!kept(&grain, line(16, 0.06)) && !kept(&grain, line(16, 0.1)));
        assert!(kept(&grain, line(16, 0.4)) && kept(&grain, line(140, 0.1)));
    }

    #[test]
    fn in_hair_and_features_faint_lines_stay() {
        let mut portrait = mean_portrait(6.0, 0.0, |_| 100);
        let plain = portrait.lightness.map(|_| 0.4);
        portrait.masks.insert(MaskRole::Hair, plain.map(|_| 1.0));
        assert_eq!(Strays::of(&portrait, &plain, 4.0).dropped_from(vec![line(8, 0.06)]).len(), 1);
    }
}
