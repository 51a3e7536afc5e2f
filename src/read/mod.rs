//! Reading SVG as a drawing. Machines' files are read by [`Profile::read`](crate::plot::Profile::read).
//!
//! In: the bytes of a file. Out: a [`Drawing`](crate::drawing::Drawing) and a count of what could not be taken. This is what `plot` draws and what `inspect` and the round-trip tests measure; it shares no code with the writers.

mod budget;
mod census;
mod clip_paths;
mod colour_names;
mod curves;
mod dropped;
mod expansion;
mod importer;
mod layers;
mod paint;
mod styles;
mod svg;
mod text;

pub use budget::{Budget, MOST_WORK, TooMuchWork};
pub(crate) use budget::{PATH, POINT};
pub use dropped::Dropped;
pub use layers::LabelSpeeds;
pub use svg::{Imported, ImportedLayer, SvgError, read_svg, read_svg_within};
