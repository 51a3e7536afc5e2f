//! Reading back: SVG as a drawing, HP-GL and G-code as the motion that they order.
//!
//! In: the bytes of a file. Out: a [`Drawing`](crate::drawing::Drawing) or a [`Plot`](crate::plot::Plot) and a count of what could
//! not be taken. This is what `plot` draws and what `inspect` and the round-trip tests measure; it shares no code with the writers.

mod clip_paths;
mod curves;
mod dropped;
mod gcode;
mod hpgl;
mod importer;
mod layers;
mod paint;
mod svg;
mod text;

pub use dropped::Dropped;
pub use gcode::{GcodeError, GcodeMotion, read_gcode, read_gcode_heights};
pub use hpgl::{HpglError, HpglMotion, read_hpgl};
pub use layers::LabelSpeeds;
pub use svg::{Imported, ImportedLayer, SvgError, read_svg};

use crate::geometry::Point;

/// What a plotter file makes the pen do, in machine units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strokes {
    /// Each pen-down path with its pen's number; a single point is a touch.
    pub paths: Vec<(u32, Vec<Point>)>,
    /// Every place that the carriage visits, pen up or down, in order.
    pub visited: Vec<Point>,
    /// Pauses for the user.
    pub pauses: usize,
    /// Whether the pen is up at the end.
    pub ends_up: bool,
}
