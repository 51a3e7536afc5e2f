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

/// How a file comes to its machine.
const SENDING: &str = "\
Sending a file to its plotter:
  HP-GL   The plotter takes a few hundred bytes at once and stops the sender by handshake; without one it loses lines. Pens of the
          1980s raise DTR (pin 20), which the cable must bring to the computer's CTS:
              stty -F /dev/ttyUSB0 9600 cs8 -cstopb -parenb -ixon crtscts raw && cat drawing.hpgl > /dev/ttyUSB0
          With a plain cable use a sender that asks the plotter for room (ESC.B), such as chiplotle's plot_hpgl_file, or put XON/XOFF
          into the file: --set-profile 'hpgl.preamble=\"\\u001B.I81;;17:\\u001B.N;19:\"' with stty ... ixon -crtscts.
  G-code  A sender that waits for `ok`, such as Universal G-code Sender, bCNC, Candle or cncjs; printers take it from their card.
  SVG     For the AxiDraw: Inkscape's extension, axicli or saxi; layers are plotted in order and those with ! wait.";

/// What a test sheet says; the long form is docs/calibration.md.
pub(super) const READING: &str = "\
What to read off the sheet, and what to change (--set-profile KEY=VALUE, or the key in a TOML file that extends the profile):
  square  Measure its sides, 100 mm where there is room. scale_x = scale_x * drawn / measured, along the side marked X; scale_y alike.
  NIB     The first rung with white between its lines is wider than the nib: the one before it is --pen.
  Z       The highest line, in mm above gcode.height.down, that has no gap: add it (towards up), less 0.2, to gcode.height.down.
  DWELL   The shortest rest, in seconds, after which all touches are there and equally large: motion.touch_seconds.
  FILL    The least overlap without white hairlines. 10 % is what areas are filled with; for another, --pen nib * (1 - overlap) / 0.9.
  PENS    How far each cross lies off its ticks, in mm along the machine's X and Y: pen.N.offset = [x, y].
  SPEED   The fastest squares with sharp, closed corners: motion.draw_speed; if even the slowest tremble, lower the acceleration.";

// One of them is made, once.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Draw a photograph: to SVG or PDF for print, or with --profile to a plotter's HP-GL or G-code.
    #[command(after_long_help = SENDING)]
    Draw(DrawOptions),
    /// Plot any SVG: ordered tool paths for a machine.
    #[command(after_long_help = SENDING)]
    Plot(PlotOptions),
    /// Write every intermediate result of a style, numbered and named, as PNG or SVG.
    Stages(StagesOptions),
    /// Say what is in a drawing: sheet, layers, pens, marks, lengths, time.
    Inspect(InspectOptions),
    /// Write the rest of a plotter's file from where the machine stopped: state, pen and position restored.
    Resume(ResumeOptions),
    /// Draw a test sheet for a machine and its pens.
    #[command(after_help = READING)]
    Calibrate(CalibrateOptions),
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
    /// A region, white inside, on the photograph's pixel grid; ROLE is subject, detail, edges or isophotes, or
    /// scribbles with one colour for each region.
    #[arg(long, value_name = "ROLE=FILE", value_parser = key_value)]
    pub mask: Vec<(String, String)>,
    /// Depth map of 8 or 16 bits on the photograph's pixel grid: white is near, 0 is unknown or background.
    #[arg(long, value_name = "FILE")]
    pub depth: Option<String>,
    /// In the depth map white is far.
    #[arg(long, requires = "depth")]
    pub depth_far_white: bool,
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
    /// The file to write, its format by extension: .svg, .pdf, .hpgl or .plt, .gcode, .nc or .ngc, .inkml; `-` for stdout. `{layer}` in
    /// it writes one file for each layer.
    #[arg(long, short, value_name = "FILE")]
    pub output: String,
    /// The format, whatever the extension.
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// Nib width: for plotter output, and for lines that have no width of their own.
    #[arg(long, value_name = "LENGTH", default_value = "0.3mm", value_parser = length_above_zero, allow_negative_numbers = true)]
    pub pen: f64,
    /// Smallest dot and thinnest line that print may use; smaller marks are thinned out so that the tone stays. Offset holds
    /// about 0.05mm on coated paper and 0.1mm on newsprint; ask the printer.
    #[arg(long, value_name = "LENGTH", default_value = "0mm", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub min_mark: f64,
    /// Ink spread of the press, compensated: what it adds to a 50 % screen tint (0 to 0.5). Offset aims: coated paper 0.16,
    /// uncoated 0.22 (ISO 12647-2:2013, curves A and C), newsprint 0.26 with --dot-gain-screen 40 (ISO 12647-3:2013). The same
    /// spread takes less from coarse marks than from that tint.
    #[arg(long, value_name = "F", default_value_t = 0.0, value_parser = dot_gain, allow_negative_numbers = true)]
    pub dot_gain: f64,
    /// The screen that --dot-gain is quoted for, in lines per cm (10 to 200).
    #[arg(long, value_name = "N", default_value_t = 60.0, value_parser = screen, allow_negative_numbers = true)]
    pub dot_gain_screen: f64,
    /// CSS colour, or k for the black plate only, or spot:NAME.
    #[arg(long, value_name = "COLOUR", default_value = "k", value_parser = ink)]
    pub ink: Ink,
    /// Write only these layers, by name, separated by commas.
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub layers: Vec<String>,
    /// The plotter: a name (`drypoint profiles` lists them) or a TOML file. With .svg the tool paths are written.
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// Choose a larger pitch, if need be, so that the plot takes at most this long, such as 2h, 90min or 1h30m.
    #[arg(long, value_name = "TIME", value_parser = duration, requires = "profile", allow_negative_numbers = true)]
    pub max_time: Option<f64>,
    #[command(flatten)]
    pub toolpaths: ToolpathOptions,
    /// Do all the work and write nothing.
    #[arg(long)]
    pub dry_run: bool,
    #[command(flatten)]
    pub reporting: Reporting,
}

#[derive(Args, Clone, Debug)]
pub(super) struct CalibrateOptions {
    /// The plotter: a name (`drypoint profiles` lists them) or a TOML file.
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: String,
    /// The file to write, its format by extension: .svg, .hpgl or .plt, .gcode, .nc or .ngc; `-` for stdout.
    #[arg(long, short, value_name = "FILE")]
    pub output: String,
    /// The format, whatever the extension.
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// Nib width that is written on the pen.
    #[arg(long, value_name = "LENGTH", default_value = "0.3mm", value_parser = length_above_zero, allow_negative_numbers = true)]
    pub pen: f64,
    /// How many pens draw a cross [default: as many as the machine holds].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16))]
    pub pen_count: Option<u32>,
    /// The sheet: a6 to a0, letter, legal, tabloid, with -landscape, or `WxH` [default: the machine's first, else a4-landscape or
    /// smaller].
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

/// How tool paths are made.
// Switches of a command line are booleans.
#[allow(clippy::struct_excessive_bools)]
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
    /// Where loops begin and end.
    #[arg(long, value_enum, default_value_t = SeamOption::Nearest)]
    pub seam: SeamOption,
    /// Paths of one pen that repeat an earlier one within 0.005 mm, in either direction.
    #[arg(long, value_enum, default_value_t = DuplicatesOption::Drop)]
    pub duplicates: DuplicatesOption,
    /// Draw the whole order backwards, from the last path to the first.
    #[arg(long)]
    pub reverse: bool,
    /// The corner of the drawing where the order of each pen starts [default: the machine's home].
    #[arg(long, value_enum)]
    pub start_corner: Option<StartCorner>,
    /// The random order that --order random takes (a whole number from 0).
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub order_seed: u64,
    /// Join ends that lie this near, up to a turn of 90 degrees, or 150 where they coincide; 0 joins nothing.
    #[arg(long, value_name = "LENGTH", default_value = "0.05mm", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub merge: f64,
    /// A wet line is not crossed or touched again for so many seconds: paths are put off, and where nothing else is left to draw
    /// the machine waits (0 to 86400; G-code, and profiles whose language can wait).
    #[arg(long, value_name = "SECONDS", value_parser = dry_time, allow_negative_numbers = true)]
    pub dry_time: Option<f64>,
    /// Cut at the sheet and the machine's limits instead of refusing.
    #[arg(long)]
    pub clip: bool,
    /// Drawing speed in mm/s [default: the profile's].
    #[arg(long, value_name = "MM/S", value_parser = number_above_zero, allow_negative_numbers = true)]
    pub speed: Option<f64>,
    /// Pen-up speed in mm/s [default: the profile's].
    #[arg(long, value_name = "MM/S", value_parser = number_above_zero, allow_negative_numbers = true)]
    pub travel_speed: Option<f64>,
    /// How long the pen rests on a touch, in seconds [default: the profile's].
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub dwell: Option<f64>,
    /// A key of the profile, such as motion.acceleration=500 or paper.a4.zero=[10,206]. May be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    pub set_profile: Vec<(String, String)>,
    /// The pens, a TOML file: for each layer's name or number its width, slot, colour, speed, dwell and offset. Layers that it does
    /// not name go to the pen of the nearest colour.
    #[arg(long, value_name = "FILE")]
    pub pens: Option<String>,
    /// Trace the drawing's outline with the pen up, then wait, before anything is drawn.
    #[arg(long)]
    pub frame: bool,
    /// Draw small crosses into the corners with every pen, to see how pens meet.
    #[arg(long)]
    pub registration: bool,
    /// Wait each time that a pen has drawn this length, such as 20m, to sharpen, dip or fill it.
    #[arg(long, value_name = "METRES", value_parser = metres, allow_negative_numbers = true)]
    pub pause_every: Option<f64>,
    /// A picture of what the machine will do: sheet, reach, ink at nib width, travel, start and park.
    #[arg(long, value_name = "FILE.svg")]
    pub preview: Option<String>,
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
    /// Leave out what lies hidden under opaque ink of another colour or under white; with lines, what lies under any fill.
    #[arg(long)]
    pub occlude: bool,
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
pub(super) struct ResumeOptions {
    /// The HP-GL or G-code file that drypoint wrote; `-` for stdin.
    pub file: String,
    /// The line that was not finished, from 1, as a sender shows it.
    #[arg(long, value_name = "N")]
    pub line: Option<usize>,
    /// The byte that was not taken, from 0, as HP-GL senders count.
    #[arg(long, value_name = "N")]
    pub byte: Option<usize>,
    /// The pen-down path that was not finished, from 1 in the file's order; `inspect` says how many there are.
    #[arg(long, value_name = "N")]
    pub path: Option<usize>,
    /// No summary; errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
    /// How much of the line before the stop is drawn again.
    #[arg(long, value_name = "LENGTH", default_value = "3mm", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub again: f64,
    /// The file to write; `-` for stdout.
    #[arg(long, short, value_name = "FILE")]
    pub output: String,
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
    /// PDF for print.
    Pdf,
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
    /// At random, so that ink dries before the pen comes back.
    Random,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum SeamOption {
    /// Wherever the travel is shortest.
    Nearest,
    /// Where they begin in the drawing.
    Drawn,
    /// At their highest vertex on the page.
    Top,
    /// At their lowest vertex.
    Bottom,
    /// At their leftmost vertex.
    Left,
    /// At their rightmost vertex.
    Right,
    /// At their sharpest vertex.
    Corner,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum DuplicatesOption {
    /// Drawn once; how many went is reported.
    Drop,
    /// Drawn as often as they are there.
    Keep,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum StartCorner {
    /// Upper left.
    TopLeft,
    /// Upper right.
    TopRight,
    /// Lower left.
    BottomLeft,
    /// Lower right.
    BottomRight,
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

fn seconds(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix('s').unwrap_or(text).trim();
    number.parse().ok().filter(|s: &f64| (0.0..=60.0).contains(s)).ok_or_else(|| "must be from 0 to 60 seconds".to_owned())
}

/// A time such as `2h`, `90min`, `1h30m` or `45s`, in seconds.
fn duration(text: &str) -> Result<f64, String> {
    let refuse = || "write it as 2h, 90min, 1h30m or 45s, above 0".to_owned();
    let (mut rest, mut seconds, mut last) = (text.trim(), 0.0, f64::INFINITY);
    while !rest.is_empty() {
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').ok_or_else(refuse)?;
        let number: f64 = rest[..end].parse().map_err(|_| refuse())?;
        let after = rest[end..].trim_start();
        let unit = after.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(after.len());
        let size = match &after[..unit] {
            "h" => 3600.0,
            "m" | "min" => 60.0,
            "s" => 1.0,
            _ => return Err(refuse()),
        };
        // Larger units come first, and each once.
        if size >= last {
            return Err(refuse());
        }
        (seconds, last, rest) = (seconds + number * size, size, after[unit..].trim_start());
    }
    if seconds > 0.0 && seconds <= 1e7 { Ok(seconds) } else { Err(refuse()) }
}

/// A length in metres, or with another unit, in millimetres.
fn metres(text: &str) -> Result<f64, String> {
    let trimmed = text.trim();
    let (number, unit) = match trimmed.strip_suffix('m') {
        Some(number) if !number.ends_with(['m', 'c']) => (number.trim(), 1000.0),
        _ => (trimmed, if trimmed.ends_with(|c: char| c.is_ascii_digit()) { 1000.0 } else { 1.0 }),
    };
    length_above_zero(number).map(|length| length * unit)
}

fn dry_time(text: &str) -> Result<f64, String> {
    let seconds = number_above_zero(text).ok().filter(|seconds| *seconds <= 86_400.0);
    seconds.ok_or_else(|| "must be a number of seconds above 0, up to 86400".to_owned())
}

fn gamma(text: &str) -> Result<f64, String> {
    number_above_zero(text).ok().filter(|g| (0.1..=10.0).contains(g)).ok_or_else(|| "must be a number from 0.1 to 10".to_owned())
}

fn fraction(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|f| (0.0..=1.0).contains(f)).ok_or_else(|| "must be a number from 0 to 1".to_owned())
}

fn dot_gain(text: &str) -> Result<f64, String> {
    fraction(text).ok().filter(|gain| *gain <= 0.5).ok_or_else(|| "must be a number from 0 to 0.5".to_owned())
}

fn screen(text: &str) -> Result<f64, String> {
    number_above_zero(text)
        .ok()
        .filter(|lines| (10.0..=200.0).contains(lines))
        .ok_or_else(|| "must be from 10 to 200 lines per cm".to_owned())
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
    fn long_lengths() {
        assert_eq!(metres("20m"), Ok(20_000.0));
        assert_eq!(metres("2.5"), Ok(2500.0));
        assert_eq!((metres("500mm"), metres("30cm")), (Ok(500.0), Ok(300.0)));
        assert!(metres("0m").is_err() && metres("far").is_err());
    }

    #[test]
    fn durations() {
        assert_eq!((duration("2h"), duration("90min"), duration("1h30m")), (Ok(7200.0), Ok(5400.0), Ok(5400.0)));
        assert_eq!((duration("1.5h"), duration("1h 5 min"), duration("45s")), (Ok(5400.0), Ok(3900.0), Ok(45.0)));
        for wrong in ["", "2", "h", "30m1h", "1h2h", "0h", "-2h", "2 days", "1..5h"] {
            assert!(duration(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn crops() {
        assert_eq!(crop("10%,0,80%,100").unwrap()[0], CropNumber::Percent(10.0));
        assert!(crop("1,2,3").is_err() && crop("a,b,c,d").is_err() && crop("NaN,0,1,1").is_err());
    }
}
