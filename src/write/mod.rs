//! Writers: a [`Drawing`](crate::drawing::Drawing) or a [`Plot`](crate::plot::Plot) as the bytes of a file.
//!
//! Nothing here knows of styles or file names. Numbers are snapped to the format's grid before differences are taken, so rounding
//! errors never accumulate.

mod marks;
mod number;
mod pdf;
mod svg;

pub(crate) use marks::write_marks;
pub(crate) use number::{decimal, thousandths};
pub use pdf::write_pdf;
pub(crate) use svg::{Names, document, finish, layer_group, lines_group, path_data};
pub use svg::{SvgHead, write_embedded_svg, write_svg};
