//! Options of `plot`, and of tool paths in all commands.

use super::choices::{Format, Order, PlotFit};
use super::placing::PlacingOptions;
use super::reporting::Reporting;
use super::values::{
    drawn_length_from_zero, dry_time, duration, key_value, metres, nib, number_above_zero, registration, scale, seconds,
    tolerance, work,
};
use crate::plot::{DrawingCorner, Duplicates, InkModel, Seam, ShownTravel};
use clap::Args;

/// Options of tool paths.
// Switches of a command line are booleans.
#[allow(clippy::struct_excessive_bools)]
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct ToolpathOptions {
    /// Largest deviation when curves are flattened or fitted with arcs (0.001 to 1 mm).
    #[arg(long, value_name = "LENGTH", default_value = "0.02mm", value_parser = tolerance, allow_negative_numbers = true)]
    pub tolerance: f64,
    /// Effort of the search for short travel. It is limited by work, not by time, so the order is the same on every machine.
    #[arg(long, value_enum, default_value_t = Order::Full)]
    pub order: Order,
    /// Draw every path in its own direction.
    #[arg(long)]
    pub keep_direction: bool,
    /// Where loops begin and end.
    #[arg(long, value_enum, default_value_t = Seam::Nearest)]
    pub seam: Seam,
    /// What happens to paths that repeat an earlier path of the same pen within 0.005 mm, in either direction.
    #[arg(long, value_enum, default_value_t = Duplicates::Drop)]
    pub duplicates: Duplicates,
    /// Draw the whole order backwards, from the last path to the first.
    #[arg(long)]
    pub reverse: bool,
    /// The corner of the drawing where the order of each pen starts [default: the machine's home].
    #[arg(long, value_enum)]
    pub start_corner: Option<DrawingCorner>,
    /// Seed of --order random (a whole number from 0).
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub order_seed: u64,
    /// Join path ends at most this far apart, with a turn of up to 90 degrees, or 150 where the ends coincide; 0 joins nothing.
    #[arg(long, value_name = "LENGTH", default_value = "0.05mm", value_parser = drawn_length_from_zero, allow_negative_numbers = true)]
    pub merge: f64,
    /// Drying time of the ink in seconds (up to 86400): until then no path crosses or touches the line. Such paths are drawn later,
    /// and if nothing else is left the machine waits (G-code, and other profiles with a wait command).
    #[arg(long, value_name = "SECONDS", value_parser = dry_time, allow_negative_numbers = true)]
    pub dry_time: Option<f64>,
    /// Cut the drawing at the sheet and the machine's limits instead of refusing it.
    #[arg(long)]
    pub clip: bool,
    /// Drawing speed in mm/s, up to the machine's maximum [default: the profile's].
    #[arg(long, value_name = "MM/S", value_parser = number_above_zero, allow_negative_numbers = true)]
    pub speed: Option<f64>,
    /// Pen-up speed in mm/s, up to the machine's maximum [default: the profile's].
    #[arg(long, value_name = "MM/S", value_parser = number_above_zero, allow_negative_numbers = true)]
    pub travel_speed: Option<f64>,
    /// Time that the pen rests when it touches the paper, in seconds (0 to 60; G-code) [default: the profile's].
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub dwell: Option<f64>,
    /// Set a key of the profile, such as motion.acceleration=500 or paper.a4.zero=[10,206]. May be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    pub set_profile: Vec<(String, String)>,
    /// The pens, a TOML file with a table for each layer name or pen number, such as [black]. Its keys are all optional: width = "0.3mm",
    /// slot = 1, colour = "black", speed = 30 (mm/s), dwell = 0.1 (s), offset = [0, 0] (mm). Other layers go to the pen of the nearest
    /// colour; `drypoint profiles --pens-example` prints such a file. Without --pens each layer uses the pen of its number; if there
    /// are more colours than pens, the others go to the pen of the nearest colour.
    #[arg(long, value_name = "FILE")]
    pub pens: Option<String>,
    /// Trace the drawing's bounding box with the pen up, then wait, before drawing.
    #[arg(long)]
    pub frame: bool,
    /// Draw small crosses in the corners with every pen, to check how the pens align.
    #[arg(long)]
    pub registration: bool,
    /// Wait whenever a pen has drawn this length, such as 20m, to sharpen, dip or fill it.
    #[arg(long, value_name = "METRES", value_parser = metres, allow_negative_numbers = true)]
    pub pause_every: Option<f64>,
    /// Send the file to the machine at this port and draw it, as `drypoint send` does.
    #[cfg(feature = "drive")]
    #[arg(long, value_name = "PORT")]
    pub send: Option<String>,
    /// With --send: do not ask before the machine moves.
    #[cfg(feature = "drive")]
    #[arg(long, short, requires = "send")]
    pub yes: bool,
    /// Write a picture of what the machine will do: sheet, reach, ink at nib width in a colour per pen, travel, start and park.
    #[arg(long, value_name = "FILE.svg")]
    pub preview: Option<String>,
    /// How the preview shows pen-up travel.
    #[arg(long, value_enum, default_value_t = ShownTravel::Faint, requires = "preview")]
    pub preview_travel: ShownTravel,
    /// Show the preview as ink on paper instead: pens in their own colours, multiplied where they lie on one another, which miss each
    /// other by this much (0 to 2 mm); 0.3 mm is usual.
    #[arg(long, value_name = "LENGTH", requires = "preview", conflicts_with = "preview_travel", value_parser = registration, allow_negative_numbers = true)]
    pub preview_registration: Option<f64>,
}

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct PlotOptions {
    /// The SVG; `-` for stdin.
    pub drawing: String,
    /// The file to write, its format by extension: .svg, .hpgl or .plt, .gcode, .nc or .ngc; `-` for stdout.
    #[arg(long, short, value_name = "FILE")]
    pub output: String,
    /// The format, whatever the extension.
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// The plotter: a name (`drypoint profiles` lists them) or a TOML file; needed for HP-GL and G-code.
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// Nib width (0.01 to 20 mm).
    #[arg(long, value_name = "LENGTH", default_value = "0.3mm", value_parser = nib, allow_negative_numbers = true)]
    pub pen: f64,
    /// Draw only these layers, by name or pen number, separated by commas.
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub layers: Vec<String>,
    /// The sheet: a6 to a0, letter, legal, tabloid, with -landscape, or `WxH` [default: the SVG's own size].
    #[arg(long, value_name = "NAME|WxH")]
    pub page: Option<String>,
    /// Free border of the sheet with --fit page.
    #[arg(long, value_name = "LENGTH", default_value = "10mm", value_parser = drawn_length_from_zero, allow_negative_numbers = true)]
    pub margin: f64,
    /// lines: only the centre lines of strokes; fills are skipped and counted. ink: widths and fills are filled with the nib. White is
    /// never ink [default: ink for files written by drypoint, else lines].
    #[arg(long, value_enum)]
    pub ink_model: Option<InkModel>,
    /// Leave out what is hidden under opaque ink of another colour or under white; with lines, what is hidden under any fill.
    #[arg(long)]
    pub occlude: bool,
    /// Scale the drawing to the page less its margin.
    #[arg(long, value_enum, default_value_t = PlotFit::None)]
    pub fit: PlotFit,
    /// Scale by this factor (0.001 to 1000), from the upper left corner [default: 1].
    #[arg(long, value_name = "F", value_parser = scale, allow_negative_numbers = true)]
    pub scale: Option<f64>,
    #[command(flatten)]
    pub placing: PlacingOptions,
    /// Longest plotting time, such as 2h, 90min or 1h30m; if needed, the drawing is scaled down about its middle. With --fit or
    /// --scale a longer plot is refused, and the message names a scale that fits.
    #[arg(long, value_name = "TIME", value_parser = duration, requires = "profile", allow_negative_numbers = true)]
    pub max_time: Option<f64>,
    #[command(flatten)]
    pub toolpaths: ToolpathOptions,
    /// Limit of the work for reading the drawing, in millions of steps (up to 1000): elements, counted once per use, segments and
    /// dashes. 12 stay below 2 GB of memory.
    #[arg(long, value_name = "MILLIONS", default_value_t = 12.0, value_parser = work, allow_negative_numbers = true)]
    pub most_work: f64,
    /// Worker threads [default: all cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Estimate the plot, without the search for short travel, and write nothing.
    #[arg(long)]
    pub dry_run: bool,
    #[command(flatten)]
    pub reporting: Reporting,
}
