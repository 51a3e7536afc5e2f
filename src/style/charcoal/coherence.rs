//! How far the directions of hair around a place agree: strokes follow them where they do, and the course of the whole lock where they do
//! not.

use super::Drawer;
use crate::elementary::{Elementary as _, unit_at};
use crate::field::OrientationField;
use crate::geometry::Point;
use crate::raster::{Raster, fast_gaussian, fast_gaussian_within, gaussian_blur};
use crate::source::MaskRole;
use crate::style::form::{Growth, growth_at};

/// The reach over which agreement is averaged, in reaches of the direction's own smoothing.
pub(super) const AROUND: f32 = 2.5;

/// How far directions agree, 0 to 1, and the hair in which any were found.
pub(super) struct Coherence {
    pub agreement: Raster<f32>,
    pub directed: Raster<f32>,
}

impl Drawer<'_> {
    /// How much of the directions found is left in their mean: near 1 in straight hair, less in curls, least in noise and coils. Where none
    /// were found their neighbours' counts.
    pub(super) fn coherence(&self, hair: &Raster<f32>, raw: &OrientationField, smoothed: &OrientationField) -> Coherence {
        let sigma = self.smoothing();
        let all = gaussian_blur(&lengths(raw), sigma);
        let left = lengths(smoothed).zip_map(&all, |left, all| left / all.max(1e-9));
        // Where there are no lines there is nothing left and nothing to say.
        let directed = hair.zip_map(&all, |hair, all| if all > 0.0 { hair } else { 0.0 } + 1e-6);
        let agreement = fast_gaussian_within(&left, &directed, AROUND * sigma);
        Coherence { agreement, directed }
    }

    /// Directions over a wider reach where those over a narrow one do not agree, and in beards those of their growth: in slicked, short or
    /// bearded hair narrow ones are noise, and strokes along them are false whorls.
    pub(super) fn calm(&self, raw: &OrientationField, smoothed: &OrientationField, agreement: &Raster<f32>) -> OrientationField {
        /// Agreement up to which the wider reach counts alone, and from which the narrow one does. Straight hair has 0.8 and more; noise
        /// in the sixteen portraits 0.4 to 0.7. Lower ones leave whorls (14), higher ones comb waves and curls (05, 09, 13).
        const AGREEMENT: [f32; 2] = [0.58, 0.8];
        /// The same in beards, whose growth is known: what agrees by chance is a whorl (14).
        const IN_BEARDS: [f32; 2] = [0.72, 0.95];
        /// The wider reach in narrow ones.
        const WIDER: f32 = 3.0;
        let reach = WIDER * self.smoothing();
        let [x, y] = [0, 1].map(|i| fast_gaussian(&raw.doubled().map(|v| v[i]), reach));
        let beard = self.portrait.masks.get(&MaskRole::FacialHair);
        let share = Raster::from_fn(agreement.width(), agreement.height(), |x, y| {
            let is_beard = beard.is_some_and(|beard| beard.get(x, y) > 0.5);
            let [least, full] = if is_beard { IN_BEARDS } else { AGREEMENT };
            let is_known = smoothed.doubled().get(x, y) != [0.0, 0.0];
            if is_known { ((agreement.get(x, y) - least) / (full - least)).clamp(0.0, 1.0) } else { 0.0 }
        });
        let narrow = smoothed.doubled().zip_map(&share, to_length);
        let wide = self.with_growth(x.zip_map(&y, |x, y| [x, y])).zip_map(&share, |v, share| to_length(v, 1.0 - share));
        OrientationField::new(narrow.zip_map(&wide, |[a, b], [c, d]| [a + c, b + d]))
    }

    /// Doubled directions, in beards as they grow.
    fn with_growth(&self, doubled: Raster<[f32; 2]>) -> Raster<[f32; 2]> {
        let Some(beard) = self.portrait.masks.get(&MaskRole::FacialHair) else { return doubled };
        let growth: Vec<Growth> = self.portrait.faces.iter().map(Growth::of).collect();
        if growth.is_empty() {
            return doubled;
        }
        Raster::from_fn(doubled.width(), doubled.height(), |x, y| {
            if beard.get(x, y) < 0.5 {
                return doubled.get(x, y);
            }
            let way = unit_at(2.0 * growth_at(&growth, Point::new(x as f64 + 0.5, y as f64 + 0.5)));
            [way.x as f32, way.y as f32]
        })
    }

    /// Reach of the smoothing of hair's direction in pixels.
    pub(super) fn smoothing(&self) -> f32 {
        self.pixels(self.parameters.hair_smoothing) as f32
    }
}

fn to_length([x, y]: [f32; 2], length: f32) -> [f32; 2] {
    let factor = length / x.hypotenuse(y).max(1e-9);
    [factor * x, factor * y]
}

fn lengths(field: &OrientationField) -> Raster<f32> {
    field.doubled().map(|[x, y]| x.hypotenuse(y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Millimetres;
    use crate::raster::paper_texture;
    use crate::style::charcoal::{CARD, CharcoalParameters};
    use crate::style::form::mean_portrait;
    use crate::style::observer::Silent;
    use std::f32::consts::PI;

    /// Directions that turn by up to half a circle within a few pixels on the left, and run down on the right.
    fn directions(width: usize, height: usize) -> OrientationField {
        let noise = paper_texture(width, height, 6.0, 1);
        OrientationField::new(Raster::from_fn(width, height, |x, y| {
            let angle = if x < width / 2 { 0.5 * PI + 2.0 * PI * (noise.get(x, y) - 0.5) } else { 0.5 * PI };
            [(2.0 * angle).cosine(), (2.0 * angle).sine()]
        }))
    }

    #[test]
    fn directions_that_do_not_agree_are_calm_and_others_are_kept() {
        let mut portrait = mean_portrait(6.0, 0.0, |_| 100);
        let (width, height) = (portrait.lightness.width(), portrait.lightness.height());
        let hair = Raster::filled(width, height, 1.0_f32);
        portrait.masks.insert(MaskRole::Hair, hair.clone());
        let settings = CARD.settings_at(Millimetres(0.6), &[]).expect("a pitch in its range");
        let mut parameters = CharcoalParameters::new(&settings);
        parameters.hair_smoothing = 0.3 * parameters.hair_smoothing;
        let drawer = Drawer { portrait: &portrait, parameters, seed: 0, observer: &Silent };
        let raw = directions(width, height);
        let smoothed = raw.smoothed(drawer.smoothing());
        let coherence = drawer.coherence(&hair, &raw, &smoothed).agreement;
        let at = |raster: &Raster<f32>, share: f64| raster.get((share * width as f64) as usize, height / 2);
        assert!(at(&coherence, 0.75) > 0.9 && at(&coherence, 0.25) < 0.7, "{} {}", at(&coherence, 0.75), at(&coherence, 0.25));
        let calm = drawer.calm(&raw, &smoothed, &coherence);
        let turned = |field: &OrientationField, columns: std::ops::Range<usize>| {
            let off = columns.map(|x| {
                let at = Point::new(x as f64 + 0.5, 0.5 * height as f64 + 0.5);
                field.angle(at.x, at.y).map_or(0.0, |angle| (0.5 * std::f64::consts::PI - angle.abs()).abs())
            });
            off.sum::<f64>() / (width as f64 / 4.0)
        };
        let (left, right) = (width / 8..3 * width / 8, 5 * width / 8..7 * width / 8);
        assert!(turned(&calm, left.clone()) < 0.7 * turned(&smoothed, left), "whorls are left");
        assert!(turned(&calm, right) < 0.01);
    }
}
