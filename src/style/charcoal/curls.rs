//! Curls: where hair turns within a lock's width its direction is no course to follow. Strokes are short hooks there, as coils are drawn.

use super::coherence::{AROUND, Coherence};
use super::{Drawer, Hairs};
use crate::drawing::Mark;
use crate::field::OrientationField;
use crate::geometry::Millimetres;
use crate::raster::{Raster, fast_gaussian_within};
use crate::source::MaskRole;
use crate::style::declaration::Radians;
use crate::style::form::with_curls;

/// How much of the directions around a place is left in their mean, in a curly beard and in a straight one. Of sixteen portraits tight coils
/// and a close crop have 0.55 to 0.61, curly beards and blond curls 0.63 to 0.65, set hair 0.71 to 0.78, and straight hair and braids 0.82
/// to 0.88. And the ink from which a beard is dark.
const COHERENCE: [f32; 2] = [0.56, 0.66];
const DARK: f32 = 0.45;
/// Length of a hook as a share of a stroke's, and its greatest angle to the curls, in degrees.
const LENGTH: f64 = 0.42;
const TURN: f64 = 25.0;
/// The size of curls in pitches.
const CURL: f64 = 2.6;
/// The share of coils from which strokes are hooks.
const HOOKS: f32 = 0.5;

impl Drawer<'_> {
    /// How far hair is coiled at each place, 0 to 1: a head of hair as a whole, and beards by their directions before and after smoothing.
    /// Directions drawn by hand are followed.
    pub(super) fn coils(&self, hair: &Raster<f32>, raw: &OrientationField, smoothed: &OrientationField) -> Raster<f32> {
        if self.drawn_directions().is_some() {
            return hair.map(|_| 0.0);
        }
        let of_heads = self.coiled_hair(&self.hair_of_heads(hair));
        let Some(beard) = self.portrait.masks.get(&MaskRole::FacialHair) else { return of_heads };
        let Coherence { agreement, directed } = self.coherence(hair, raw, smoothed);
        let curly = agreement.map(|left| ((COHERENCE[1] - left) / (COHERENCE[1] - COHERENCE[0])).clamp(0.0, 1.0));
        // White hairs of a beard would be crumbs.
        let ink = fast_gaussian_within(&self.darkness(), &directed, AROUND * self.smoothing());
        let dark = ink.map(|ink| if ink > DARK { 1.0 } else { 0.0 });
        let of_beards = curly.zip_map(beard, |curly, beard| curly * beard).zip_map(&dark, |curly, dark| curly * dark);
        of_heads.zip_map(&of_beards, f32::max)
    }

    /// Strokes of hair, and hooks where it is coiled.
    pub(super) fn curled(
        &self,
        field: &OrientationField,
        coils: &Raster<f32>,
        hair: &Raster<f32>,
        ink: &Raster<f32>,
        sizes: Hairs,
    ) -> Vec<Mark> {
        let is_coil = |coil: f32| coil >= HOOKS;
        if !coils.pixels().iter().zip(hair.pixels()).any(|(coil, hair)| is_coil(*coil) && *hair >= 0.5) {
            return self.hairs(field, hair, ink, sizes);
        }
        let part = |of_coils: bool| hair.zip_map(coils, |hair, coil| if is_coil(coil) == of_coils { hair } else { 0.0 });
        let mut marks = self.hairs(field, &part(false), ink, sizes);
        let hooks =
            Hairs { length: Millimetres(LENGTH * sizes.length.0), turn: Radians(TURN.to_radians()), combed: 1.0, ..sizes };
        let curls = with_curls(field, coils, self.pixels(CURL * sizes.pitch), self.seed);
        marks.extend(self.hairs(&curls, &part(true), ink, hooks));
        marks
    }
}
