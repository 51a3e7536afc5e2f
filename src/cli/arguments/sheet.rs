//! Options of `sheet`.

use super::choices::Format;
use super::toolpaths::ToolpathOptions;
use super::values::{cells, length_from_zero, nib};
use clap::Args;

/// Options of `sheet`.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct SheetOptions {
    /// Scenes (.toml), which are drawn, and SVGs, which are placed by their page.
    #[arg(required = true, value_name = "SCENE|SVG")]
    pub files: Vec<String>,
    /// The file to write, its format by extension: .svg, .svgz, .pdf, .hpgl or .plt, .gcode, .nc or .ngc, .inkml, .json; `-` for stdout.
    #[arg(long, short, value_name = "FILE")]
    pub output: String,
    /// The format, whatever the extension.
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// The sheet: a6 to a0, letter, legal, tabloid, with -landscape, or `WxH`.
    #[arg(long, value_name = "NAME|WxH", default_value = "a4")]
    pub page: String,
    /// Free border of the sheet.
    #[arg(long, value_name = "LENGTH", default_value = "10mm", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub margin: f64,
    /// Cells side by side and above one another, such as 3x2, each up to 100 [default: as many as the drawings need].
    #[arg(long, value_name = "CxR", value_parser = cells)]
    pub grid: Option<(usize, usize)>,
    /// Space between the cells.
    #[arg(long, value_name = "LENGTH", default_value = "5mm", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub gap: f64,
    /// How often each drawing is on the sheet (1 to 1000).
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub copies: u16,
    /// Mark the corners of each picture for cutting.
    #[arg(long)]
    pub crop_marks: bool,
    /// Nib width (0.01 to 20 mm), for plotter output.
    #[arg(long, value_name = "LENGTH", default_value = "0.3mm", value_parser = nib, allow_negative_numbers = true)]
    pub pen: f64,
    /// The plotter: a name (`drypoint profiles` lists them) or a TOML file. An .svg output then holds the tool paths.
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    #[command(flatten)]
    pub toolpaths: ToolpathOptions,
    /// Worker threads [default: all cores]; the bytes written do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// No progress and no summary; warnings and errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
}
