//! Scenes: regions of a picture, each in a style of its own, composed into one drawing.
//!
//! ```text
//!   masks, later ones over earlier ones -> Parts: each point of the page belongs to one part (the first is the rest)
//!   the drawing of each part            -> confined to its part, with the border that it asks for
//!   several drawings                    -> Grid: one sheet, the layers of each pen merged
//! ```

mod confine;
mod inside;
mod parts;
mod sheet;

pub use parts::Parts;
#[doc(hidden)]
pub use sheet::{CropMarks, Grid, Piece, SheetError, scale_into};

/// What happens at the border between a region and what lies around it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Border {
    /// Marks end at the border.
    #[default]
    Butt,
    /// Marks end this far before the border, in millimetres, on the region's side.
    Gap(f64),
    /// Marks of both sides thin out within a band of this width about the border, in millimetres.
    Fade(f64),
}
