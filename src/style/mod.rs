//! Styles: from a [`Portrait`] to a [`Drawing`].
//!
//! A style is called with the portrait, its parameters (resolved [`Settings`]), a seed and an [`Observer`]; it draws on the
//! portrait's page and knows nothing of machines, formats or files. To add one: write its folder and add it to [`STYLES`].

mod brows;
mod charcoal;
mod columns;
mod cost;
mod coverage;
mod creases;
mod declaration;
mod drawer;
mod drawn_directions;
mod drawn_irises;
mod ears;
mod engrave;
mod feature_line;
mod form;
mod glass;
mod grid;
mod guide_lines;
mod head;
mod hedcut;
mod jaw;
mod lids;
mod lights;
mod lip_borders;
mod mouth;
mod need;
mod observer;
mod parameter;
mod pearls;
mod places;
mod random;
mod reversed;
mod rim;
mod rubbing;
mod settings;
mod solids;
mod spectacles;
mod strays;
mod streaks;
mod teeth;
mod thick_frame;
mod tone_error;
mod tooth_gaps;
mod under_eyes;

pub use cost::Cost;
#[cfg(feature = "cli")]
pub(crate) use coverage::covered;
use drawer::Drawer;
pub use need::Need;
pub use observer::{Observer, Picture, Silent};
pub use parameter::{DefaultLength, Kind, Parameter, ParameterError};
pub use places::Places;
pub use settings::Settings;
#[doc(hidden)]
pub use tone_error::tone_error;

use crate::drawing::Drawing;
use crate::geometry::{Millimetres, Rect};
use crate::source::{MaskRole, Portrait};
use thiserror::Error;

/// What a style is, for lists and help.
#[derive(Clone, Copy, Debug)]
pub struct StyleCard {
    /// Its name on the command line.
    pub name: &'static str,
    /// One line for a list of styles.
    pub summary: &'static str,
    /// The paper or thesis that it follows.
    pub source: &'static str,
    /// Its parameters, in the order of a help page.
    pub parameters: &'static [Parameter],
    /// The mask roles that it uses; the others are refused.
    pub masks: &'static [MaskRole],
    /// True if it can use a depth map; else one is refused.
    pub uses_depth: bool,
    /// True if the background is left out by default: newspapers print heads on bare paper.
    pub leaves_out_background: bool,
}

impl StyleCard {
    /// The settings with which another style has a part drawn by this one, at its own pitch.
    fn settings_at(&self, pitch: Millimetres, words: &[(&str, &str)]) -> Result<Settings, StyleError> {
        let pitch = ("pitch".to_owned(), format!("{}mm", pitch.0));
        let words = words.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned()));
        let given: Vec<(String, String)> = std::iter::once(pitch).chain(words).collect();
        Settings::resolve(self.name, self.parameters, &given).map_err(|error| StyleError::NothingToDraw(error.to_string()))
    }
}

/// What a style is asked for.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// What is drawn, at the style's resolution.
    pub portrait: &'a Portrait,
    /// The style's parameters.
    pub settings: &'a Settings,
    /// Where random numbers start.
    pub seed: u64,
    /// Who watches.
    pub observer: &'a dyn Observer,
}

/// One way of drawing.
pub trait Style: Sync {
    /// What it is.
    fn card(&self) -> &StyleCard;
    /// Working pixels per millimetre with the masks at hand.
    fn pixels_per_mm(&self, settings: &Settings, masks: &[MaskRole]) -> f64;
    /// Working pixels per millimetre for a picture of this size on the page; for most styles the size does not matter.
    fn resolution(&self, settings: &Settings, masks: &[MaskRole], _picture: Rect) -> f64 {
        self.pixels_per_mm(settings, masks)
    }
    /// True if it draws a ground of its own where the background is left out.
    fn draws_ground(&self) -> bool {
        false
    }
    /// Estimated cost of drawing a picture of this size at this resolution, from measured figures.
    fn cost(&self, settings: &Settings, picture: Rect, pixels_per_mm: f64) -> Cost;
    /// Finds, once, what several drawings of a portrait share: one for each pen, whose seeds differ by the pen's number.
    fn prepare(&self, _portrait: &mut Portrait, _settings: &Settings, _seed: u64, _observer: &dyn Observer) {}
    /// Makes the marks, which may reach over the picture's border.
    fn sketch(&self, request: &Request<'_>) -> Result<Drawing, StyleError>;

    /// Its name on the command line.
    fn name(&self) -> &'static str {
        self.card().name
    }
    /// Its parameters, in the order of a help page.
    fn parameters(&self) -> &'static [Parameter] {
        self.card().parameters
    }
    /// The mask roles that it uses.
    fn masks(&self) -> &'static [MaskRole] {
        self.card().masks
    }
    /// Draws the portrait, all of its ink inside the picture's box on the page; warns of settings without effect.
    fn draw(&self, portrait: &Portrait, settings: &Settings, seed: u64, observer: &dyn Observer) -> Result<Drawing, StyleError> {
        settings.idle(self.parameters(), portrait).iter().for_each(|sentence| observer.warn(sentence));
        let drawing = self.sketch(&Request { portrait, settings, seed, observer })?.confined_to(portrait.placement.picture);
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
///
/// ```
/// let engrave = drypoint::style::find("engrave").unwrap();
/// assert!(engrave.card().uses_depth && engrave.parameters().iter().any(|parameter| parameter.name == "pitch"));
/// ```
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
