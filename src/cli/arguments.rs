//! Options, their units and their help.

use crate::drawing::Ink;
use crate::geometry::{parse_length, parse_size};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Turns a photograph into vector stroke art and takes it to ink.
///
/// Lengths take mm (the default), cm, in or pt. `-` is stdin or stdout. Data goes to stdout, everything else to stderr.
/// Exit status: 0 done, 1 it could not be done, 2 the command line is wrong, 130 interrupted.
#[derive(Debug, Parser)]
#[command(name = "drypoint", version, max_term_width = 100)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Draw a photograph: to print SVG, or with --profile to a plotter's HP-GL or G-code.
    Draw(DrawOptions),
    /// Plot any SVG: ordered tool paths for a machine.
    Plot(PlotOptions),
    /// Write every intermediate result of a style, numbered and named, as PNG or SVG.
    Stages(StagesOptions),
    /// Say what is in a drawing: sheet, layers, pens, marks, lengths, time.
    Inspect(InspectOptions),
    /// List the styles, or one style's parameters with default, unit, range, meaning and source.
    Styles(ListOptions),
    /// List the plotters, or print one profile as TOML.
    Profiles(ListOptions),
    /// Print shell completions.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual page.
    Man,
}

/// How to report.
#[derive(Args, Clone, Debug)]
pub(super) struct Reporting {
    /// No progress and no summary; warnings and errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print one JSON object on stdout.
    #[arg(long)]
    pub json: bool,
}

/// What a photograph becomes.
#[derive(Args, Clone, Debug)]
pub(super) struct PictureOptions {
    /// The photograph: JPEG, PNG, WebP, TIFF, BMP or GIF; `-` for stdin.
    pub photo: String,
    /// The style; `drypoint styles` lists them.
    #[arg(long, default_value = "hedcut")]
    pub style: String,
    /// A parameter of the style; `drypoint styles NAME` lists them. May be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    pub set: Vec<(String, String)>,
    /// Parameters from a TOML file; --set wins.
    #[arg(long, value_name = "FILE")]
    pub params: Option<PathBuf>,
    /// The sheet: a6 to a0, letter, legal, tabloid, with -landscape, or `WxH` [default: the picture's own size].
    #[arg(long, value_name = "NAME|WxH")]
    pub page: Option<String>,
    /// Kept free on the sheet [default: 0, with --page 10mm].
    #[arg(long, value_name = "LENGTH", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub margin: Option<f64>,
    /// The box that the picture is fitted into [default: the sheet less its margin; without a sheet 90x120mm].
    #[arg(long, value_name = "WxH", value_parser = size_above_zero, allow_hyphen_values = true)]
    pub size: Option<(f64, f64)>,
    /// How the photograph fills the box.
    #[arg(long, value_enum, default_value_t = Fit::Contain)]
    pub fit: Fit,
    /// The part of the photograph used, in pixels or %.
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop, allow_hyphen_values = true)]
    pub crop: Option<[CropNumber; 4]>,
    /// Distance of neighbouring dots or lines [default: the style's].
    #[arg(long, value_name = "LENGTH", value_parser = length_above_zero, allow_negative_numbers = true)]
    pub pitch: Option<f64>,
    /// A region, white inside, on the photograph's pixel grid; ROLE is subject, detail, edges or isophotes.
    #[arg(long, value_name = "ROLE=FILE", value_parser = key_value)]
    pub mask: Vec<(String, String)>,
    /// What the ink must match: CIE L*/100 or luminance Y.
    #[arg(long, value_enum, default_value_t = Tone::Lightness)]
    pub tone: Tone,
    /// Middle tones: above 1 lightens (0.1 to 10).
    #[arg(long, value_name = "G", default_value_t = 1.0, value_parser = gamma, allow_negative_numbers = true)]
    pub gamma: f64,
    /// Tone that becomes full ink (0 to 1).
    #[arg(long, value_name = "F", default_value_t = 0.0, value_parser = fraction, allow_negative_numbers = true)]
    pub black: f64,
    /// Tone that becomes bare paper (0 to 1).
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = fraction, allow_negative_numbers = true)]
    pub white: f64,
    /// All random choices follow from this number.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Worker threads [default: all cores]; the bytes written do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

#[derive(Args, Clone, Debug)]
pub(super) struct DrawOptions {
    #[command(flatten)]
    pub picture: PictureOptions,
    /// The file to write, its format by extension: .svg, .hpgl or .plt, .gcode, .nc or .ngc, .inkml; `-` for stdout. `{layer}` in it
    /// writes one file for each layer.
    #[arg(long, short, value_name = "FILE")]
    pub output: String,
    /// The format, whatever the extension.
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// Nib width: for plotter output, and for lines that have no width of their own.
    #[arg(long, value_name = "LENGTH", default_value = "0.3mm", value_parser = length_above_zero, allow_negative_numbers = true)]
    pub pen: f64,
    /// CSS colour, or k for the black plate only, or spot:NAME.
    #[arg(long, value_name = "COLOUR", default_value = "k", value_parser = ink)]
    pub ink: Ink,
    /// Write only these layers, by name, separated by commas.
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub layers: Vec<String>,
    /// The plotter: a name (`drypoint profiles` lists them) or a TOML file. With .svg the tool paths are written.
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    #[command(flatten)]
    pub toolpaths: ToolpathOptions,
    /// Do all the work and write nothing.
    #[arg(long)]
    pub dry_run: bool,
    #[command(flatten)]
    pub reporting: Reporting,
}

/// How tool paths are made.
#[derive(Args, Clone, Debug)]
pub(super) struct ToolpathOptions {
    /// Of flattening curves.
    #[arg(long, value_name = "LENGTH", default_value = "0.02mm", value_parser = length_above_zero, allow_negative_numbers = true)]
    pub tolerance: f64,
    /// How hard to look for a short way; counted in work, so that the order is the same everywhere.
    #[arg(long, value_enum, default_value_t = Order::Full)]
    pub order: Order,
    /// Draw every path in its own direction.
    #[arg(long)]
    pub keep_direction: bool,
    /// Join ends that lie this near.
    #[arg(long, value_name = "LENGTH", default_value = "0.05mm", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub merge: f64,
    /// Cut at the sheet and the machine's limits instead of refusing.
    #[arg(long)]
    pub clip: bool,
    /// Drawing speed in mm/s [default: the profile's].
    #[arg(long, value_name = "MM/S", value_parser = number_above_zero, allow_negative_numbers = true)]
    pub speed: Option<f64>,
    /// Pen-up speed in mm/s [default: the profile's].
    #[arg(long, value_name = "MM/S", value_parser = number_above_zero, allow_negative_numbers = true)]
    pub travel_speed: Option<f64>,
}

#[derive(Args, Clone, Debug)]
pub(super) struct PlotOptions {
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
    /// Nib width.
    #[arg(long, value_name = "LENGTH", default_value = "0.3mm", value_parser = length_above_zero, allow_negative_numbers = true)]
    pub pen: f64,
    /// Draw only these layers, by name or pen number, separated by commas.
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub layers: Vec<String>,
    /// The sheet: a6 to a0, letter, legal, tabloid, with -landscape, or `WxH` [default: the SVG's own size].
    #[arg(long, value_name = "NAME|WxH")]
    pub page: Option<String>,
    /// Kept free on the sheet with --fit page.
    #[arg(long, value_name = "LENGTH", default_value = "10mm", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub margin: f64,
    /// lines: strokes' centre lines, fills are ignored and counted; ink: widths and fills are laid down with the nib. White is
    /// never ink [default: ink for files that drypoint wrote, else lines].
    #[arg(long, value_enum)]
    pub ink_model: Option<InkModelOption>,
    /// Scale the drawing to the page less its margin.
    #[arg(long, value_enum, default_value_t = PlotFit::None)]
    pub fit: PlotFit,
    /// Scale by this factor.
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = number_above_zero, allow_negative_numbers = true)]
    pub scale: f64,
    /// Move the drawing to the middle of the page.
    #[arg(long)]
    pub center: bool,
    /// Turn clockwise by degrees.
    #[arg(long, value_enum, default_value_t = Rotate::None)]
    pub rotate: Rotate,
    #[command(flatten)]
    pub toolpaths: ToolpathOptions,
    /// Worker threads [default: all cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Do all the work and write nothing.
    #[arg(long)]
    pub dry_run: bool,
    #[command(flatten)]
    pub reporting: Reporting,
}

#[derive(Args, Clone, Debug)]
pub(super) struct StagesOptions {
    #[command(flatten)]
    pub picture: PictureOptions,
    /// The folder to write into; it is made if need be.
    #[arg(long, short, value_name = "DIR")]
    pub output: PathBuf,
    /// No progress and no summary; warnings and errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
}

#[derive(Args, Clone, Debug)]
pub(super) struct InspectOptions {
    /// SVG, HP-GL or G-code; `-` for stdin.
    pub file: String,
    /// Adds the time on this plotter.
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// Print one JSON object on stdout.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args, Clone, Debug)]
pub(super) struct ListOptions {
    /// One of them.
    pub name: Option<String>,
    /// Print one JSON object on stdout.
    #[arg(long)]
    pub json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Fit {
    /// All of the photograph is inside the box.
    Contain,
    /// The photograph fills the box; what stands out is cut.
    Cover,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum PlotFit {
    /// As it is.
    None,
    /// To the page less its margin.
    Page,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Tone {
    /// CIE L*/100.
    Lightness,
    /// Luminance Y.
    Linear,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Scalable vector graphics.
    Svg,
    /// HP-GL for pen plotters.
    Hpgl,
    /// G-code.
    Gcode,
    /// `InkML`: the strokes with force and time, for painting programs; of `draw` only.
    Inkml,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Order {
    /// The best.
    Full,
    /// Nearly as good, in a fraction of the time.
    Fast,
    /// As in the file.
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum InkModelOption {
    /// Strokes' centre lines only.
    Lines,
    /// Widths and fills too.
    Ink,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Rotate {
    /// Not at all.
    #[value(name = "0")]
    None,
    /// A quarter, clockwise.
    #[value(name = "90")]
    Quarter,
    /// A half.
    #[value(name = "180")]
    Half,
    /// A quarter, anticlockwise.
    #[value(name = "270")]
    ThreeQuarters,
    /// A quarter when it fits only so.
    Auto,
}

/// A border of the crop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CropNumber {
    Pixels(f64),
    Percent(f64),
}

fn key_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => Ok((key.trim().to_owned(), value.trim().to_owned())),
        _ => Err("write it as KEY=VALUE".to_owned()),
    }
}

fn length_above_zero(text: &str) -> Result<f64, String> {
    let mm = parse_length(text).map_err(|error| error.to_string())?;
    if mm > 0.0 { length_from_zero(text) } else { Err("must be above 0".to_owned()) }
}

fn length_from_zero(text: &str) -> Result<f64, String> {
    let mm = parse_length(text).map_err(|error| error.to_string())?;
    if (0.0..=100_000.0).contains(&mm) { Ok(mm) } else { Err("must be from 0 to 100 m".to_owned()) }
}

fn size_above_zero(text: &str) -> Result<(f64, f64), String> {
    let (width, height) = parse_size(text).map_err(|error| error.to_string())?;
    let sound = |mm: f64| (1.0..=100_000.0).contains(&mm);
    if sound(width) && sound(height) { Ok((width, height)) } else { Err("both sides must be from 1 mm to 100 m".to_owned()) }
}

fn number_above_zero(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("must be a number above 0".to_owned()),
    }
}

fn gamma(text: &str) -> Result<f64, String> {
    number_above_zero(text).ok().filter(|g| (0.1..=10.0).contains(g)).ok_or_else(|| "must be a number from 0.1 to 10".to_owned())
}

fn fraction(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|f| (0.0..=1.0).contains(f)).ok_or_else(|| "must be a number from 0 to 1".to_owned())
}

fn ink(text: &str) -> Result<Ink, String> {
    text.parse().map_err(|error: crate::drawing::ColourError| error.to_string())
}

fn crop(text: &str) -> Result<[CropNumber; 4], String> {
    let refuse = || "write it as X,Y,W,H in pixels or %, such as 10%,0,80%,100%".to_owned();
    let numbers: Vec<CropNumber> = text
        .split(',')
        .map(|part| {
            let part = part.trim();
            let (number, is_percent) = part.strip_suffix('%').map_or((part, false), |n| (n, true));
            let value: f64 = number.trim().parse().ok().filter(|v: &f64| v.is_finite())?;
            Some(if is_percent { CropNumber::Percent(value) } else { CropNumber::Pixels(value) })
        })
        .collect::<Option<_>>()
        .ok_or_else(refuse)?;
    numbers.try_into().map_err(|_| refuse())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn crops() {
        assert_eq!(crop("10%,0,80%,100").unwrap()[0], CropNumber::Percent(10.0));
        assert!(crop("1,2,3").is_err() && crop("a,b,c,d").is_err() && crop("NaN,0,1,1").is_err());
    }
}
