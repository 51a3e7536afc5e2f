//! Styles: from a [`Portrait`] to a [`Drawing`].
//!
//! A style is called with the portrait, its parameters (resolved [`Settings`]), a seed and an [`Observer`]; it draws on the
//! portrait's page and knows nothing of machines, formats or files. To add one: write its file and add it to [`STYLES`].

mod charcoal;
mod cost;
mod declaration;
mod drawer;
mod engrave;
mod feature_line;
mod glass;
mod grid;
mod hedcut;
mod need;
mod observer;
mod parameter;
mod places;
mod random;
mod reversed;

pub use cost::Cost;
use drawer::Drawer;
pub use need::Need;
pub use observer::{Observer, Picture, Silent};
pub use parameter::{DefaultLength, Kind, Parameter, ParameterError, Settings};
pub use places::Places;

use crate::drawing::Drawing;
use crate::geometry::Rect;
use crate::source::{MaskRole, Portrait};
use thiserror::Error;

/// A drawing style.
pub trait Style: Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;
    /// One line for a list of styles.
    fn summary(&self) -> &'static str;
    /// The paper or thesis that it follows.
    fn source(&self) -> &'static str;
    /// Its parameters, in the order of a help page.
    fn parameters(&self) -> &'static [Parameter];
    /// The mask roles that it uses; the others are refused.
    fn masks(&self) -> &'static [MaskRole];
    /// True if it uses a depth map; otherwise one is refused.
    fn uses_depth(&self) -> bool {
        false
    }
    /// True if the background behind a person is left out by default, as newspapers print heads on bare paper.
    fn leaves_out_background(&self) -> bool {
        false
    }
    /// Working pixels per millimetre with the given masks.
    fn pixels_per_mm(&self, settings: &Settings, masks: &[MaskRole]) -> f64;
    /// Working pixels per millimetre for a picture of this size on the page; for most styles the size does not matter.
    fn resolution(&self, settings: &Settings, masks: &[MaskRole], _picture: Rect) -> f64 {
        self.pixels_per_mm(settings, masks)
    }
    /// Estimated cost of a picture of this size at this resolution, from measured figures.
    fn cost(&self, settings: &Settings, picture: Rect, pixels_per_mm: f64) -> Cost;
    /// Makes the marks, which may extend beyond the picture's border.
    fn sketch(&self, portrait: &Portrait, settings: &Settings, seed: u64, observer: &dyn Observer)
    -> Result<Drawing, StyleError>;
    /// Draws the portrait with all ink inside the picture's box on the page; warns of settings that have no effect.
    fn draw(&self, portrait: &Portrait, settings: &Settings, seed: u64, observer: &dyn Observer) -> Result<Drawing, StyleError> {
        settings.idle(self.parameters(), portrait).iter().for_each(|sentence| observer.warn(sentence));
        let drawing = self.sketch(portrait, settings, seed, observer)?.confined_to(portrait.placement.picture);
        if drawing.marks().next().is_none() {
            return Err(StyleError::NothingToDraw("no mark lies inside the picture".to_owned()));
        }
        observer.picture("drawing", &|| Picture::Drawing(Box::new(drawing.clone())));
        Ok(drawing)
    }
}

/// Every style, the default first.
pub const STYLES: &[&dyn Style] = &[&hedcut::Hedcut, &grid::Grid, &engrave::Engrave, &charcoal::Charcoal, &glass::Glass];

/// Finds a style by name.
pub fn find(name: &str) -> Option<&'static dyn Style> {
    STYLES.iter().copied().find(|style| style.name() == name)
}

/// Why a portrait could not be drawn.
#[derive(Debug, Error, PartialEq)]
pub enum StyleError {
    /// The user stopped it.
    #[error("interrupted")]
    Interrupted,
    /// No part of the picture needs ink.
    #[error("there is nothing to draw: {0}")]
    NothingToDraw(String),
    /// A setting suppresses all ink.
    #[error("there is nothing to draw: {why}; {setting} draws it")]
    NothingLeft {
        /// What suppresses it.
        why: &'static str,
        /// The parameter and the value that would draw it.
        setting: &'static str,
    },
}
