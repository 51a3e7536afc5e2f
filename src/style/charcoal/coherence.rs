//! How far the directions of hair around a place agree, and what follows from it: strokes along them where they do, along the course of
//! the whole lock where they do not, and hooks where nothing has a course.

use super::Drawer;
use crate::elementary::Elementary as _;
use crate::field::OrientationField;
use crate::raster::{Raster, components, fast_gaussian, fast_gaussian_within, gaussian_blur};

/// The reach over which agreement is averaged, in reaches of the direction's own smoothing.
pub(super) const AROUND: f64 = 2.5;

impl Drawer<'_> {
    /// How much of the directions found is left in their mean, 0 to 1: near 1 in straight hair, less in curls, least in noise and coils.
    pub(super) fn coherence(&self, hair: &Raster<f32>, raw: &OrientationField, smoothed: &OrientationField) -> Raster<f32> {
        let sigma = self.smoothing();
        let all = gaussian_blur(&lengths(raw), sigma);
        let left = lengths(smoothed).zip_map(&all, |left, all| left / all.max(1e-9));
        // Where there are no lines there is nothing left and nothing to say.
        let weight = hair.zip_map(&all, |hair, all| if all > 0.0 { hair } else { 0.0 } + 1e-6);
        fast_gaussian_within(&left, &weight, AROUND as f32 * sigma)
    }

    /// Directions over a wider reach where those over a narrow one do not agree: in slicked, short or bearded hair there they are noise,
    /// and strokes along them are false whorls.
    pub(super) fn calm(&self, raw: &OrientationField, smoothed: &OrientationField, coherence: &Raster<f32>) -> OrientationField {
        /// Agreement up to which the wider reach counts alone, and from which the narrow one does. Straight hair has 0.85 and more; noise
        /// in the sixteen portraits 0.4 to 0.7. Lower ones leave whorls (14), higher ones comb waves and curls (05, 09, 13).
        const AGREEMENT: [f32; 2] = [0.58, 0.8];
        /// The wider reach in narrow ones.
        const WIDER: f32 = 3.0;
        let reach = WIDER * self.smoothing();
        let [x, y] = [0, 1].map(|i| fast_gaussian(&raw.doubled().map(|v| v[i]), reach));
        let share = coherence.map(|c| ((c - AGREEMENT[0]) / (AGREEMENT[1] - AGREEMENT[0])).clamp(0.0, 1.0));
        let narrow = smoothed.doubled().zip_map(&share, to_length);
        let wide = x.zip_map(&y, |x, y| [x, y]).zip_map(&share, |v, share| to_length(v, 1.0 - share));
        OrientationField::new(narrow.zip_map(&wide, |[a, b], [c, d]| [a + c, b + d]))
    }

    /// Where hair is coiled, 0 or 1: heads of hair as a whole whose directions agree nowhere. Directions drawn by hand are followed.
    pub(super) fn coiled_heads(&self, hair: &Raster<f32>, coherence: &Raster<f32>) -> Raster<f32> {
        /// The mean agreement of a head of hair below which it is coiled. Of the sixteen portraits those of coils have 0.58 and 0.70, curly
        /// and slicked heads 0.75 to 0.79, and the others up to 0.95.
        const COILED: f64 = 0.72;
        /// The side of the least head of hair in pitches: smaller pieces, as beside an ear, have too few directions.
        const LEAST: f64 = 25.0;
        if self.drawn_directions().is_some() {
            return hair.map(|_| 0.0);
        }
        let heads = self.hair_of_heads(hair);
        let (labels, count) = components(&heads.map(|hair| u8::from(hair > 0.5)));
        let mut sums = vec![(0.0, 0.0); count + 1];
        for (label, coherence) in labels.pixels().iter().zip(coherence.pixels()) {
            let (sum, pixels) = &mut sums[*label as usize];
            *sum += f64::from(*coherence);
            *pixels += 1.0;
        }
        let least = (LEAST * self.pixels(self.parameters.pitch)).powi(2);
        let are_coiled = |(sum, pixels): (f64, f64)| pixels > least && sum < COILED * pixels;
        labels.map(|label| if label > 0 && are_coiled(sums[label as usize]) { 1.0 } else { 0.0 })
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
    use crate::geometry::{Millimetres, Point};
    use crate::raster::paper_texture;
    use crate::source::MaskRole;
    use crate::style::charcoal::{CARD, CharcoalParameters};
    use crate::style::form::mean_portrait;
    use crate::style::observer::Silent;
    use std::f32::consts::PI;

    /// Directions that turn by up to a quarter of a circle within a few pixels on the left, and run down on the right.
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
        let coherence = drawer.coherence(&hair, &raw, &smoothed);
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
        assert!(drawer.coiled_heads(&hair.map(|_| 1.0), &coherence.map(|_| 0.5)).get(width / 2, height / 2) == 1.0);
        assert!(drawer.coiled_heads(&hair, &coherence.map(|_| 0.8)).get(width / 2, height / 2) == 0.0);
    }
}
