//! Colour by the pens that one owns: inks on paper, the separation of a photograph into them, and which pen draws which mark.
mod appearance;
mod bands;
mod choice;
mod dealing;
mod eye;
mod library;
mod matching;
mod neugebauer;
mod overlap;
mod overprints;
mod pens;
mod rendering;
mod separation;
pub mod sheet;
mod solver;
mod space;
mod table;

pub use appearance::appearance;
pub use choice::choose;
pub use dealing::{Candidate, Dealt, deal};
pub use library::{KnownPen, known_pen_named, known_pens};
pub use neugebauer::{Model, yule_nielsen};
pub use overlap::Overlap;
pub use pens::{ColourPen, MOST_PENS, Opacity, Overprint, Paper, PenSet, PensError, PensWarning, drawing_order, on_screen};
pub use separation::{Black, GamutError, Separation, SeparationError, Separator, Settings};
pub use space::Lab;
