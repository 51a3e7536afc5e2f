//! Options of `calibrate`.

use super::choices::Format;
use super::toolpaths::ToolpathOptions;
use super::values::{nib, reflectance};
use crate::drawing::Colour;
use clap::Args;

/// Options of `calibrate`.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct CalibrateOptions {
    /// The plotter: a name (`drypoint profiles` lists them) or a TOML file.
    #[arg(long, value_name = "NAME|FILE", required_unless_present = "colours")]
    pub profile: Option<String>,
    /// The file to write, its format by extension: .svg, .hpgl or .plt, .gcode, .nc or .ngc; with --colours and without --profile also
    /// .pdf; with --read a file of pens, .toml; `-` for stdout.
    #[arg(long, short, value_name = "FILE")]
    pub output: String,
    /// Draw the colour sheet of these pens, at most 8, instead of the machine's test sheet: a file as for `draw --colours`. Each pen's
    /// colour may be a guess, from which only follows that light pens are drawn first.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["pens", "pen_count"])]
    pub colours: Option<String>,
    /// Read a photograph or scan of the colour sheet that was drawn with the pens of --colours, and write their file anew with each
    /// pen's colour as measured, for `draw --colours`.
    #[arg(long, value_name = "PHOTO", requires = "colours", conflicts_with_all = ["ToolpathOptions", "profile", "format", "page"])]
    pub read: Option<String>,
    /// With --colours, the colour of the paper, any CSS colour [default: white].
    #[arg(long, value_name = "COLOUR", requires = "colours")]
    pub paper: Option<Colour>,
    /// With --read, the reflectance of a neutral card in the outlined field (0.02 to 0.98, such as 0.18): it tells the paper's colour
    /// or, with --paper, the camera's contrast.
    #[arg(long, value_name = "F", requires = "read", value_parser = reflectance, allow_negative_numbers = true)]
    pub grey_card: Option<f64>,
    /// The format, whatever the extension.
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// Nib width as marked on the pen (0.01 to 20 mm); with --colours, of the pens that have no width there.
    #[arg(long, value_name = "LENGTH", default_value = "0.3mm", value_parser = nib, allow_negative_numbers = true)]
    pub pen: f64,
    /// Number of pens that draw a cross [default: as many as the machine holds].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16))]
    pub pen_count: Option<u32>,
    /// The sheet: a6 to a0, letter, legal, tabloid, with -landscape, or `WxH` [default: the machine's first, else a4-landscape or
    /// smaller; for --colours the first that is large enough, else a4].
    #[arg(long, value_name = "NAME|WxH")]
    pub page: Option<String>,
    #[command(flatten)]
    pub toolpaths: ToolpathOptions,
    /// Do all the work and write nothing.
    #[arg(long)]
    pub dry_run: bool,
    /// No summary; warnings and errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
}
