//! Readers: SVG as a drawing, HP-GL and G-code as pen motion.
//!
//! In: the bytes of a file. Out: a [`Drawing`](crate::drawing::Drawing) or a [`Plot`](crate::plot::Plot), and a count of what
//! could not be read. `plot` draws the result; `inspect` and the round-trip tests measure it. The readers share no code with the
//! writers.

mod budget;
mod census;
mod clip_paths;
mod colour_names;
mod curves;
mod dropped;
mod error;
mod expansion;
mod imported;
mod importer;
mod layers;
mod paint;
mod shape_cost;
mod styles;
mod svg;
mod text;

pub use budget::{Budget, MOST_WORK, TooMuchWork};
pub(crate) use budget::{PATH, POINT};
pub use dropped::Dropped;
pub use error::SvgError;
pub use imported::ImportedLayer;
pub use layers::LabelSpeeds;
#[cfg(feature = "cli")]
pub(crate) use svg::is_parsing;
pub use svg::{Imported, read_svg, read_svg_within};
