//! A drawing in progress: what every style is given, and the changes between the page and the working grid.

use super::{Observer, Request, StyleError};
use crate::drawing::Page;
use crate::geometry::Millimetres;
use crate::source::Portrait;

/// State of one drawing in progress, with the values of the style's own parameters.
pub(super) struct Drawer<'a, P> {
    pub portrait: &'a Portrait,
    pub parameters: P,
    pub seed: u64,
    pub observer: &'a dyn Observer,
}

/// Parameters of a style, which has a pitch.
pub(super) trait Pitched {
    /// Distance between neighbouring marks.
    fn pitch(&self) -> Millimetres;
}

impl<P: Copy> Drawer<'_, P> {
    /// The same drawing of another portrait on its grid.
    pub(super) fn on<'b>(&'b self, portrait: &'b Portrait) -> Drawer<'b, P> {
        Drawer { portrait, ..*self }
    }
}

impl<P> Drawer<'_, P> {
    /// A part of the drawing in another style.
    pub(super) fn in_style<Q>(&self, parameters: Q) -> Drawer<'_, Q> {
        Drawer { portrait: self.portrait, parameters, seed: self.seed, observer: self.observer }
    }

    /// The portrait's page.
    pub(super) const fn page(&self) -> Page {
        self.portrait.page
    }

    /// Columns and rows of the working grid.
    pub(super) const fn size(&self) -> (usize, usize) {
        (self.portrait.placement.columns, self.portrait.placement.rows)
    }

    /// A length of the page in working pixels.
    pub(super) fn pixels(&self, length: Millimetres) -> f64 {
        self.portrait.placement.pixels(length)
    }

    /// Ends the drawing when the user wants it to stop.
    pub(super) fn check(&self) -> Result<(), StyleError> {
        if self.observer.is_interrupted() { Err(StyleError::Interrupted) } else { Ok(()) }
    }
}

impl<P: Pitched> Drawer<'_, P> {
    /// The pitch in working pixels.
    pub(super) fn pitch(&self) -> f64 {
        self.pixels(self.parameters.pitch())
    }
}

impl<'a> Request<'a> {
    /// The drawing in progress, with the values of the style's own parameters.
    pub(super) fn drawer<P>(&self, parameters: P) -> Drawer<'a, P> {
        Drawer { portrait: self.portrait, parameters, seed: self.seed, observer: self.observer }
    }
}
