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
mod expansion;
mod gcode;
mod hpgl;
mod importer;
mod layers;
mod paint;
mod styles;
mod svg;
mod text;

pub use budget::{Budget, MOST_WORK, TooMuchWork};
pub use dropped::Dropped;
pub use gcode::{GcodeError, GcodeMotion, read_gcode, read_gcode_heights, read_gcode_within};
pub(crate) use hpgl::instructions as hpgl_instructions;
pub use hpgl::{HpglError, HpglMotion, read_hpgl, read_hpgl_within};
pub use layers::LabelSpeeds;
pub use svg::{Imported, ImportedLayer, SvgError, read_svg, read_svg_within};

use crate::geometry::Point;

/// How a G-code file moves its pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PenLift<'a> {
    /// By separate command lines.
    Commands {
        /// The line that lifts the pen.
        up: &'a str,
        /// The line that lowers the pen.
        down: &'a str,
    },
    /// By the z axis: the pen is down past the midpoint between two heights.
    Heights {
        /// Z height above the paper, in millimetres.
        up: f64,
        /// Z height on the paper, in millimetres.
        down: f64,
    },
}

/// The pen motion of a plotter file, in machine units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strokes {
    /// Each pen-down path with its pen number; a single point is a touch.
    pub paths: Vec<(u32, Vec<Point>)>,
    /// Every point the carriage visits, pen up or down, in order.
    pub visited: Vec<Point>,
    /// Pauses for the user.
    pub pauses: usize,
    /// True if the pen is up at the end.
    pub ends_up: bool,
}
