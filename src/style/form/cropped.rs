//! Cropped hair: nowhere thicker than a finger beside the head's outline. Its strokes are short, where long ones comb it.

use crate::raster::{Raster, erode};
use crate::source::{Landmarks, MaskRole};
use crate::style::Drawer;
use crate::style::drawer::Pitched;

/// What a head of hair is eroded by, in widths of the face, and the shares of it that are left up to which it is cropped, and from which it is
/// not. Of the sixteen portraits one has cropped hair (06: nothing is left); slicked and combed hair that recedes has 0.09 and more (04, 14).
const DEEP: f64 = 0.06;
const LEFT: [f64; 2] = [0.005, 0.02];

impl<P: Pitched> Drawer<'_, P> {
    /// How far the hair of heads is cropped, 0 to 1. Not under hats or where the picture cuts the head, which hide the rest of it.
    pub(in crate::style) fn cropped(&self, hair: &Raster<f32>) -> f64 {
        let hat = self.portrait.masks.get(&MaskRole::Headwear);
        let has_hat = hat.is_some_and(|hat| hat.pixels().iter().any(|v| *v > 0.5));
        let is_cut = (0..hair.width()).any(|x| hair.get(x, 0) > 0.5);
        let Some(width) = self.portrait.faces.iter().map(Landmarks::width).reduce(f64::max).filter(|_| !has_hat && !is_cut)
        else {
            return 0.0;
        };
        let hair = hair.map(|v| u8::from(v > 0.5));
        let count = |mask: &Raster<u8>| mask.pixels().iter().map(|v| u64::from(*v)).sum::<u64>() as f64;
        let left = count(&erode(&hair, (DEEP * width) as usize)) / count(&hair).max(1.0);
        ((LEFT[1] - left) / (LEFT[1] - LEFT[0])).clamp(0.0, 1.0)
    }
}
