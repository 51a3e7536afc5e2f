//! What is known of a head's hair.

use super::mixture::Mixture;
use super::plate::Feature;
use crate::elementary::Elementary as _;
use crate::raster::Raster;

/// The appearance of hair, and where it hangs down.
pub(super) struct Hair {
    pub mixture: Mixture,
    pub middle: Feature,
    /// Whether the clothing on the shoulders looks clearly different.
    pub is_unlike_clothing: bool,
    /// Fraction of the area beside the jaw that it covers: the picture's left, then right.
    pub beside_jaw: [f32; 2],
    /// Whether both shoulders, where no hair lies, look like it.
    pub is_like_shoulders: bool,
    /// Whether it falls past the jaw without a gap, likewise.
    pub falls: [bool; 2],
    /// Whether it stands out beside the ears in a colour like skin's, likewise.
    pub stands_out: [bool; 2],
    /// The pixels of the face that it covers.
    pub over_face: Raster<bool>,
    /// The pixels of a fringe in a colour like skin's.
    pub fringe: Raster<bool>,
}

impl Hair {
    /// Hair of an appearance on a plate of this size, which hangs nowhere as far as is known.
    pub(super) fn of(mixture: Mixture, middle: Feature, (width, height): (usize, usize)) -> Self {
        Self {
            mixture,
            middle,
            is_unlike_clothing: false,
            beside_jaw: [0.0; 2],
            is_like_shoulders: false,
            falls: [false; 2],
            stands_out: [false; 2],
            over_face: Raster::filled(width, height, false),
            fringe: Raster::filled(width, height, false),
        }
    }

    /// Distance of a pixel from the median hair, with lightness and texture weighted by `light` and `texture`.
    pub(super) fn distance(&self, f: Feature, light: f32, texture: f32) -> f32 {
        let weights = [light, 1.0, 1.0, texture];
        (0..4).map(|k| (weights[k] * (f[k] - self.middle[k])).powi(2)).sum::<f32>().sqrt()
    }

    /// True if hair hangs down on the side of `u`: it falls past the jaw, or covers the area beside it, most of that if it looks like the
    /// jacket, of other hair some.
    pub(super) fn hangs(&self, u: f32) -> bool {
        /// Chroma from which hair can be distinguished from jackets.
        const COLOURED: f32 = 10.0;
        let is_coloured = self.middle[1].hypotenuse(self.middle[2]) > COLOURED;
        self.falls(u) || self.beside_jaw(u) > if is_coloured || self.is_unlike_clothing { 0.25 } else { 0.6 }
    }

    /// How far from the middle of the head it may lie on the shoulders, in `u`: hair that looks like the jacket lies near the neck.
    pub(super) fn widest(&self) -> f32 {
        if self.is_like_shoulders { 0.8 } else { 1.3 }
    }

    /// True if it falls past the jaw without a gap on the side of `u`.
    pub(super) fn falls(&self, u: f32) -> bool {
        self.falls[usize::from(u > 0.0)]
    }

    /// True if it stands out beside the ear on the side of `u`, in a colour like skin's.
    pub(super) fn stands_out(&self, u: f32) -> bool {
        self.falls(u) && self.stands_out[usize::from(u > 0.0)]
    }

    /// Fraction of the area beside the jaw that it covers on the side of `u`.
    pub(super) fn beside_jaw(&self, u: f32) -> f32 {
        self.beside_jaw[usize::from(u > 0.0)]
    }
}
