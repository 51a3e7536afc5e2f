//! Writers: a [`Drawing`](crate::drawing::Drawing) or a [`Plot`](crate::plot::Plot) as the bytes of a file.
//!
//! Nothing here knows of styles or file names. Numbers are snapped to the format's grid before differences are taken, so rounding
//! errors never accumulate.

mod gcode;
mod hpgl;
mod inkml;
mod job;
mod number;
mod pdf;
mod preview;
mod svg;

pub use gcode::write_gcode;
pub use hpgl::write_hpgl;
pub use inkml::write_inkml;
pub use job::write_job;
pub use number::{decimal, thousandths};
pub use pdf::write_pdf;
pub use preview::{ShownTravel, write_preview};
pub use svg::{SvgHead, write_svg, write_svg_plot, write_svg_plotter};
