//! Writing: a [`Drawing`](crate::drawing::Drawing) as the bytes of a file for print, for the screen or for a painting program. Files for
//! machines are written by a [`Job`](crate::plot::Job).
//!
//! Nothing here knows of styles or file names; numbers are snapped to the format's grid before they are differenced, so that
//! rounding never drifts.

mod number;
mod pdf;
mod svg;

pub(crate) use number::{decimal, thousandths};
pub use pdf::write_pdf;
pub use svg::{SvgHead, write_svg};
pub(crate) use svg::{document, finish, layer_group, lines_group, path_data};
