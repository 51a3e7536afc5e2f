//! Coils: where hair turns within a lock's width its direction is no course to follow. Strokes are short hooks there.

use crate::elementary::Elementary as _;
use crate::field::OrientationField;
use crate::raster::{
    Raster, components, dilate, enlarge, fast_gaussian, gaussian_gradient, paper_texture, reduce, structure_tensor,
};
use crate::source::{Landmarks, MaskRole};
use crate::style::Drawer;
use crate::style::drawer::Pitched;
use std::f32::consts::PI;

/// The greatest turn of a curl from the hair's direction.
const MOST_TURNED: f32 = 0.5 * PI;

/// How much of the directions is left in their mean, below which hair is coiled. Of thirty heads of hair tight coils have 0.21 to 0.24, a close crop
/// of them 0.31 to 0.345 in three styles and at sizes from 45 to 160 mm, dark curls and waves 0.375 to 0.42, straight hair and braids 0.4 to 0.72. White curls have
/// 0.36, which the ink tells.
const LEFT: f64 = 0.36;
/// Least ink: light hair shows by the shade of its locks, which hooks would crumble.
const INK: f64 = 0.45;

/// What is seen of one head of hair.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// What is left of the directions, and their strength, by which it counts: in black hair without texture there is only noise.
    left: f64,
    strength: f64,
    ink: f64,
    pixels: f64,
}

impl Sums {
    fn add(&mut self, left: f32, ink: f32, strength: f32) {
        self.left += f64::from(left * strength);
        self.strength += f64::from(strength);
        self.ink += f64::from(ink);
        self.pixels += 1.0;
    }

    /// True for coils of at least so many pixels.
    fn are_coiled(&self, least: f64) -> bool {
        self.pixels > least && self.strength > 0.0 && self.left < LEFT * self.strength && self.ink > INK * self.pixels
    }
}

/// A field of hair that curls, by as much as each place is coiled (0 to 1); `size` of the curls in pixels.
pub(in crate::style) fn with_curls(field: &OrientationField, coils: &Raster<f32>, size: f64, seed: u64) -> OrientationField {
    let noise = paper_texture(coils.width(), coils.height(), (size as f32).max(2.0), seed ^ 0xc011);
    let turn = noise.zip_map(coils, |noise, coil| 2.0 * MOST_TURNED * (2.0 * noise - 1.0) * coil);
    OrientationField::new(field.doubled().zip_map(&turn, |[x, y], turn| {
        let (sin, cos) = turn.sine_and_cosine();
        [x * cos - y * sin, x * sin + y * cos]
    }))
}

impl<P: Pitched + Sync> Drawer<'_, P> {
    /// Hair without beards, whose hairs have a course.
    pub(in crate::style) fn hair_of_heads(&self, hair: &Raster<f32>) -> Raster<f32> {
        match self.portrait.masks.get(&MaskRole::FacialHair) {
            Some(beard) => hair.zip_map(beard, |hair, beard| (hair - beard).max(0.0)),
            None => hair.clone(),
        }
    }

    /// Where hair is coiled, 0 to 1, by the photograph: a head of hair as a whole or not at all. Directions drawn by hand are followed.
    pub(in crate::style) fn coiled_hair(&self, hair: &Raster<f32>) -> Raster<f32> {
        /// Least width of a face in pixels of the grid on which directions are measured: on a coarser one coils are smooth.
        const FACE_WIDTH: f64 = 250.0;
        /// Blur of the photograph and reach over which directions are averaged, in widths of a face: over 0.05 curls turn as much as a close
        /// crop of coils does.
        const FINE: f64 = 0.004;
        const LOCK: f64 = 0.03;
        /// The side of the least patch of hair in widths of a face.
        const LEAST: f64 = 0.25;
        if self.drawn_directions().is_some() || hair.pixels().iter().all(|share| *share <= 0.5) {
            return hair.map(|_| 0.0);
        }
        let widest = self.portrait.faces.iter().map(Landmarks::width).fold(1.0, f64::max);
        let factor = ((widest / FACE_WIDTH) as usize).max(1);
        let widest = widest / factor as f64;
        let tone = reduce(&self.portrait.lightness, factor);
        let gradient = gaussian_gradient(&tone, (FINE * widest).max(0.7) as f32);
        let tensor = structure_tensor(&[gradient]).unwrap_or_else(|| tone.map(|_| [0.0; 3]));
        let inside = reduce(hair, factor);
        // By the root of their strength: a few hard edges do not outweigh the rest.
        let doubled = tensor.zip_map(&inside, |[xx, xy, yy], hair| {
            let (x, y) = (xx - yy, 2.0 * xy);
            let share = hair / x.hypotenuse(y).sqrt().max(1e-12);
            [x * share, y * share]
        });
        let mean = |values: Raster<f32>| fast_gaussian(&values, (LOCK * widest) as f32);
        let [x, y, all] = [doubled.map(|[x, _]| x), doubled.map(|[_, y]| y), doubled.map(|[x, y]| x.hypotenuse(y))].map(mean);
        let left = x.zip_map(&y, f32::hypotenuse).zip_map(&all, |left, all| left / all.max(1e-9));
        let ink = reduce(&self.portrait.ink(), factor);
        let (labels, count) = components(&inside.map(|hair| u8::from(hair > 0.5)));
        let mut sums = vec![Sums::default(); count + 1];
        for (((label, left), ink), all) in labels.pixels().iter().zip(left.pixels()).zip(ink.pixels()).zip(all.pixels()) {
            sums[*label as usize].add(*left, *ink, *all);
        }
        let least = (LEAST * widest).powi(2);
        let coiled: Vec<bool> = sums.iter().map(|head| head.are_coiled(least)).collect();
        let is_coiled = |label: u32| label > 0 && coiled[label as usize];
        let coils = dilate(&labels.map(|label| u8::from(is_coiled(label))), factor).map(f32::from);
        enlarge(&coils, factor, hair.width(), hair.height())
    }
}
