//! The parts of a complete hedcut (Bruehl 2023, section 0.1.1): skin in dots, hair in flowing strokes, clothing in hatch lines
//! whose width is the tone.
//!
//! ```text
//!   hair ----> strokes along it          each part is drawn with the tone of its own region and white elsewhere,
//!   clothing -> hatches along its folds   so that marks end at the borders and the tone is the same across them
//!   the rest -> dots
//! ```

use super::Drawer;
use super::parameters::PartsRule;
use crate::drawing::{Layer, Mark};
use crate::raster::{Raster, gaussian_blur};
use crate::source::{MaskRole, Portrait};
use crate::style::{StyleError, charcoal, grid};

/// Blur of the regions in pitches, and the gain of their edges: borders as smooth as the marks, without steps.
const SMOOTH: f64 = 0.6;
const SHARP: f32 = 3.0;
/// Least area of a part in square pitches: what is smaller stays in dots.
const LEAST_AREA: f64 = 60.0;

/// Where the parts lie, each 0 to 1; they do not overlap.
pub(super) struct Parts {
    hair: Option<Raster<f32>>,
    clothing: Option<Raster<f32>>,
}

impl Drawer<'_> {
    /// The parts that are not drawn in dots; none without their masks.
    pub(super) fn parts(&self) -> Parts {
        if self.parameters.parts == PartsRule::Dots {
            return Parts { hair: None, clothing: None };
        }
        let masks = &self.portrait.masks;
        let hair = masks.get(&MaskRole::Hair).and_then(|mask| self.part(mask));
        let cloth = [MaskRole::Clothing, MaskRole::Headwear].into_iter().filter_map(|role| masks.get(&role).cloned());
        let cloth = cloth.reduce(|a, b| a.zip_map(&b, f32::max));
        let cloth = cloth.map(|cloth| hair.as_ref().map_or(cloth.clone(), |hair| cloth.zip_map(hair, |c, h| c.min(1.0 - h))));
        Parts { clothing: cloth.and_then(|cloth| self.part(&cloth)), hair }
    }

    /// A mask as a part with a smooth border; none if it is too small.
    fn part(&self, mask: &Raster<f32>) -> Option<Raster<f32>> {
        let soft = gaussian_blur(mask, (SMOOTH * self.pitch()) as f32);
        let part = soft.zip_map(&self.portrait.subject, |v, subject| ((v - 0.5) * SHARP + 0.5).clamp(0.0, 1.0) * subject);
        let area: f64 = part.pixels().iter().map(|v| f64::from(*v)).sum();
        (area >= LEAST_AREA * self.pitch().powi(2)).then_some(part)
    }

    /// The portrait with white paper where another part is drawn.
    pub(super) fn without(&self, parts: &Parts) -> Portrait {
        let mut rest = self.portrait.clone();
        for part in [&parts.hair, &parts.clothing].into_iter().flatten() {
            rest.tone = rest.tone.zip_map(part, |tone, part| 1.0 - (1.0 - tone) * (1.0 - part));
        }
        rest
    }

    /// Hair in strokes.
    pub(super) fn hair_layer(&self, parts: &Parts) -> Result<Option<Layer>, StyleError> {
        let Some(hair) = &parts.hair else { return Ok(None) };
        let marks = charcoal::hair_strokes(self.portrait, hair, self.parameters.pitch, (self.seed, self.observer))?;
        self.check()?;
        Ok(layer("hair", marks))
    }

    /// Clothing in hatches.
    pub(super) fn clothing_layer(&self, parts: &Parts) -> Result<Option<Layer>, StyleError> {
        let Some(clothing) = &parts.clothing else { return Ok(None) };
        let mut cloth = self.portrait.clone();
        cloth.tone = cloth.tone.zip_map(clothing, |tone, part| 1.0 - (1.0 - tone) * part);
        cloth.masks.clear();
        let marks = grid::hatches(&cloth, self.parameters.pitch, (self.seed, self.observer))?;
        Ok(layer("clothing", marks))
    }
}

impl Parts {
    /// True if all of it is drawn in dots.
    pub(super) fn is_empty(&self) -> bool {
        self.hair.is_none() && self.clothing.is_none()
    }

    /// How far a place lies in hair, 0 to 1; in working pixels.
    pub(super) fn hair_at(&self, x: f64, y: f64) -> f32 {
        self.hair.as_ref().map_or(0.0, |hair| hair.sample(x, y))
    }
}

fn layer(name: &str, marks: Vec<Mark>) -> Option<Layer> {
    let mut layer = Layer::new(name, 1);
    layer.marks = marks;
    (!layer.marks.is_empty()).then_some(layer)
}
