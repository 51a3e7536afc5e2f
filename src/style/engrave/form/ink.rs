//! The ink that the lines are to make: without grain, sharper in details, smooth along the locks of hair.

use super::super::Drawer;
use super::LEAST_SHARE;
use crate::elementary::unit_at;
use crate::geometry::Point;
use crate::raster::{Raster, fast_gaussian, gaussian_blur, self_guided};
use crate::source::outlines;
use crate::style::rubbing::rubbed;
use crate::style::solids::{eyes_and_mouths, inside_outlines};
use crate::style::teeth::{Gaps, with_whole_teeth};

impl Drawer<'_> {
    /// The detail without the brows: their hairs are finer than the lines, and sharpened they tear them.
    pub(super) fn without_brows(&self, detail: &Raster<f32>) -> Raster<f32> {
        /// Blur of the brows' border, in pitches.
        const BROWS: f64 = 1.0;
        let brows = [&outlines::LEFT_BROW[..], &outlines::RIGHT_BROW];
        let brows = inside_outlines(&self.portrait.faces, brows, (detail.width(), detail.height()));
        let soft = gaussian_blur(&brows, (BROWS * self.pitch()) as f32);
        detail.zip_map(&soft, |detail, brow| detail * (1.0 - (2.0 * brow).min(1.0)))
    }

    /// The ink wanted: without grain, and sharper in detail.
    pub(super) fn form_ink(&self, detail: &Raster<f32>) -> Raster<f32> {
        /// Blur of the tone in pitches: grain makes lines shake. Details keep theirs, and are sharpened by this share.
        const TONE_BLUR: f64 = 0.22;
        const SHARPEN: f32 = 0.6;
        let sigma = (TONE_BLUR * self.pitch()) as f32;
        let ink = self.portrait.ink();
        let (smooth, wide) = (gaussian_blur(&ink, sigma), gaussian_blur(&ink, 2.0 * sigma));
        let sharp = ink.zip_map(&wide, |ink, wide| ink + SHARPEN * (ink - wide));
        let mixed = smooth.zip_map(&sharp, |smooth, sharp| (smooth, sharp));
        let mixed = mixed.zip_map(detail, |(smooth, sharp), detail| smooth + (sharp - smooth) * detail);
        let mixed = with_whole_teeth(self.portrait, mixed, Gaps::Drawn);
        mixed.zip_map(&self.portrait.subject, |ink, subject| if subject > LEAST_SHARE { ink.clamp(0.0, 1.0) } else { 0.0 })
    }

    /// The ink with half tones in the lights of skin, which lines then reach as dots.
    pub(super) fn with_half_tones(&self, ink: &Raster<f32>, skin: &Raster<f32>, detail: &Raster<f32>) -> Raster<f32> {
        /// Reach of half tones into a face's lights, in pitches: at their borders, and over foreheads and cheeks.
        const HALF_TONES: [f64; 2] = [8.0, 24.0];
        let soft = gaussian_blur(skin, self.pitch() as f32).zip_map(skin, |soft, skin| (soft * 2.0 - 1.0).max(0.0).min(skin));
        let features = eyes_and_mouths(self.portrait, self.pitch());
        // Details beside a face, as pearls, keep their lights too.
        let faces = inside_outlines(&self.portrait.faces, [&outlines::OVAL, &outlines::OVAL], (ink.width(), ink.height()));
        let beside = detail.zip_map(&faces, |detail, face| detail * (1.0 - face));
        let features = features.zip_map(&beside, f32::max);
        let skin = soft.zip_map(&features, |skin, feature| skin * (1.0 - feature));
        let plain = skin.zip_map(detail, |skin, detail| skin * (1.0 - detail));
        HALF_TONES.iter().fold(self.even_skin(ink, &plain), |ink, reach| rubbed(&ink, &skin, (reach * self.pitch()) as f32))
    }

    /// The ink without the grain of skin, which makes crumbs where lines break into dots; borders of shadows stay.
    fn even_skin(&self, ink: &Raster<f32>, skin: &Raster<f32>) -> Raster<f32> {
        /// Reach in pitches, and the square of the step of ink that stays.
        const REACH: f64 = 2.0;
        const STEP: f32 = 0.05 * 0.05;
        /// Ink below which lights are soft, and no longer are; and their blur in pitches. With a sharp border a light is an island of
        /// dots among lines.
        const LIGHTS: [f32; 2] = [0.12, 0.3];
        const LIGHTS_BLUR: f64 = 3.5;
        let even = self_guided(ink, (REACH * self.pitch()).round().max(1.0) as usize, STEP);
        let sigma = (LIGHTS_BLUR * self.pitch()) as f32;
        let sum = fast_gaussian(&even.zip_map(skin, |ink, skin| ink * skin), sigma);
        let soft = sum.zip_map(&fast_gaussian(skin, sigma), |sum, skin| sum / skin.max(1e-3));
        let even = even.zip_map(&soft, |even, soft| {
            let light = ((LIGHTS[1] - soft) / (LIGHTS[1] - LIGHTS[0])).clamp(0.0, 1.0);
            even + (soft - even) * light
        });
        self.with_creases(ink, &even)
            .zip_map(ink, |even, ink| (even, ink))
            .zip_map(skin, |(even, ink), skin| ink + (even - ink) * skin)
    }

    /// Even ink with what is darker over some length: frowns, folds and scars are the person's, pores and specks are not.
    fn with_creases(&self, ink: &Raster<f32>, even: &Raster<f32>) -> Raster<f32> {
        /// Reach of the mean that leaves creases and no specks, in pitches; how much darker they are at least, and where they stay in full.
        const REACH: f64 = 0.7;
        const DARKER: [f32; 2] = [0.02, 0.07];
        let darker = ink.zip_map(even, |ink, even| ink - even);
        let crease = gaussian_blur(&darker, (REACH * self.pitch()) as f32);
        let kept =
            darker.zip_map(&crease, |darker, crease| darker * ((crease - DARKER[0]) / (DARKER[1] - DARKER[0])).clamp(0.0, 1.0));
        even.zip_map(&kept, |even, kept| even + kept)
    }

    /// The ink with hair that grows thinner towards the silhouette: lines cut there at their full width are the teeth of a comb.
    pub(super) fn with_hair_tips(&self, ink: &Raster<f32>, hair: &Raster<f32>) -> Raster<f32> {
        /// Blur of the silhouette in pitches; from where to where in it hair is whole.
        const REACH: f64 = 1.3;
        const WHOLE: [f32; 2] = [0.5, 0.95];
        /// Ink that lines keep up to their tips, and the share of the rest that goes.
        const LEAST: f32 = 0.28;
        const GOES: f32 = 0.8;
        let soft = gaussian_blur(&self.portrait.subject, (REACH * self.pitch()) as f32);
        Raster::from_fn(ink.width(), ink.height(), |x, y| {
            let (ink, hair) = (ink.get(x, y), hair.get(x, y));
            let inside = ((soft.get(x, y) - WHOLE[0]) / (WHOLE[1] - WHOLE[0])).clamp(0.0, 1.0);
            ink - hair * GOES * (1.0 - inside) * (ink - LEAST).max(0.0)
        })
    }

    /// The ink of hair smooth along its locks and with more contrast between them; its mean stays.
    pub(super) fn with_locks(&self, ink: &Raster<f32>, hair: &Raster<f32>, directions: &Raster<f32>) -> Raster<f32> {
        /// How far ink is averaged along a lock to either side, in pitches, and by how many steps.
        const ALONG: f64 = 1.6;
        const ALONG_STEPS: i32 = 4;
        /// Reach of the mean from which locks of hair differ, in pitches, and how much their difference grows in half tones.
        const LOCK: f64 = 6.0;
        const LOCK_CONTRAST: f32 = 0.7;
        let step = ALONG * self.pitch() / f64::from(ALONG_STEPS);
        let along = Raster::from_fn(ink.width(), ink.height(), |x, y| {
            if hair.get(x, y) <= 0.0 {
                return ink.get(x, y);
            }
            let way = unit_at(f64::from(directions.get(x, y))) * step;
            let place = |i: i32| Point::new(x as f64 + 0.5, y as f64 + 0.5) + way * f64::from(i);
            let sum: f32 = (-ALONG_STEPS..=ALONG_STEPS).map(|i| ink.sample(place(i).x, place(i).y)).sum();
            sum / (2 * ALONG_STEPS + 1) as f32
        });
        let ink = &ink.zip_map(&along, |ink, along| (ink, along)).zip_map(hair, |(ink, along), hair| ink + (along - ink) * hair);
        let reach = (LOCK * self.pitch()) as f32;
        let around = fast_gaussian(&ink.zip_map(hair, |ink, hair| ink * hair), reach);
        let mean = around.zip_map(&fast_gaussian(hair, reach), |ink, hair| ink / hair.max(1e-3));
        let apart = ink.zip_map(&mean, |ink, mean| LOCK_CONTRAST * (ink - mean) * (4.0 * mean * (1.0 - mean)).max(0.0));
        ink.zip_map(&apart.zip_map(hair, |apart, hair| apart * hair), |ink, apart| (ink + apart).clamp(0.0, 1.0))
    }
}
