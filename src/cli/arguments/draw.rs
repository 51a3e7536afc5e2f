//! Options of `draw` and `stages`: the photograph, its sheet and its style.

use super::choices::{Background, Fit, Format, Tone};
use super::placing::PlacingOptions;
use super::reporting::Reporting;
use super::toolpaths::ToolpathOptions;
use super::values::{
    CropPart, crop, dot_gain, duration, fraction, gamma, ink, key_value, length_above_zero, length_from_zero, nib, role_file,
    screen, size_above_zero,
};
use crate::cli::region::{RegionOption, region};
use crate::cli::roles::mask_roles;
use crate::colour::Black;
use crate::drawing::{Colour, Ink};
use clap::Args;
use std::path::PathBuf;

/// The options of a drawing that differ from their defaults, by their long names, in the order of the help.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::cli) struct Spelled(pub Vec<(String, Vec<String>)>);

impl Spelled {
    /// The values of an option; none if it was not given.
    pub(in crate::cli) fn get(&self, option: &str) -> Option<&[String]> {
        self.0.iter().find(|(name, _)| name == option).map(|(_, values)| values.as_slice())
    }
}

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct PictureOptions {
    /// The photograph: JPEG, PNG, WebP, TIFF, BMP or GIF; `-` for stdin. Or a scene, .toml.
    pub photo: String,
    /// The style; `drypoint styles` lists them.
    #[arg(long, default_value = "hedcut")]
    pub style: String,
    /// Options for a purpose, such as wsj-column; `drypoint presets` lists them. Options beside it win.
    #[arg(long, value_name = "NAME|FILE")]
    pub preset: Option<String>,
    /// A parameter of the style; `drypoint styles NAME` lists them. May be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    pub set: Vec<(String, String)>,
    /// Parameters of the style, or any options, from a TOML file; those on the command line win.
    #[arg(long, value_name = "FILE")]
    pub params: Option<PathBuf>,
    /// The sheet: a6 to a0, letter, legal, tabloid, with -landscape, or `WxH` [default: the picture's own size].
    #[arg(long, value_name = "NAME|WxH")]
    pub page: Option<String>,
    /// Free border of the sheet [default: 0, with --page 10mm].
    #[arg(long, value_name = "LENGTH", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub margin: Option<f64>,
    /// The box that the picture is fitted into, keeping its proportions; --fit cover fills it [default: the sheet less its margin,
    /// as far as the machine reaches; without a sheet 90x120mm].
    #[arg(long, value_name = "WxH", value_parser = size_above_zero, allow_hyphen_values = true)]
    pub size: Option<(f64, f64)>,
    /// How the photograph fills the box.
    #[arg(long, value_enum, default_value_t = Fit::Contain)]
    pub fit: Fit,
    /// The part of the photograph to draw: a box inside it, in pixels or %; or all faces found (face), with head and shoulders
    /// (head).
    #[arg(long, value_name = "head|face|X,Y,W,H", value_parser = crop, allow_hyphen_values = true)]
    pub crop: Option<CropPart>,
    /// Distance between neighbouring dots or lines [default: the style's].
    #[arg(long, value_name = "LENGTH", value_parser = length_above_zero, allow_negative_numbers = true)]
    pub pitch: Option<f64>,
    #[arg(long, value_name = "ROLE=FILE", value_parser = role_file, help = mask_roles())]
    pub mask: Vec<(String, String)>,
    /// A part of the picture in a style of its own, such as --region 'mask="hair", style="charcoal"'; once per part, later ones lie
    /// over earlier ones. Keys: mask (a role or a file), style, set, pen, ink, seed, gap or fade, flow, name.
    #[arg(long, value_name = "KEYS", value_parser = region)]
    pub region: Vec<RegionOption>,
    /// Use the folder that `drypoint see` wrote, edited or not: each PNG is the mask of its role, unless --mask gives that role.
    /// `none` turns detection off.
    #[arg(long, value_name = "DIR|none")]
    pub sight: Option<String>,
    /// What is behind the person.
    #[arg(long, value_enum, default_value_t = Background::Auto)]
    pub background: Background,
    /// Depth map with 8 or 16 bits and the photograph's proportions: white is near, 0 is unknown or background.
    #[arg(long, value_name = "FILE")]
    pub depth: Option<String>,
    /// White is far in the depth map.
    #[arg(long, requires = "depth")]
    pub depth_far_white: bool,
    /// The tone that the ink reproduces [default: portrait if a face is found, else lightness].
    #[arg(long, value_enum)]
    pub tone: Option<Tone>,
    /// Share of the portrait tone; the rest is lightness (0 to 1).
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = fraction, allow_negative_numbers = true)]
    pub tone_strength: f64,
    /// Gamma of the middle tones; above 1 lightens (0.1 to 10).
    #[arg(long, value_name = "G", default_value_t = 1.0, value_parser = gamma, allow_negative_numbers = true)]
    pub gamma: f64,
    /// Tone that becomes full ink (0 to 1).
    #[arg(long, value_name = "F", default_value_t = 0.0, value_parser = fraction, allow_negative_numbers = true)]
    pub black: f64,
    /// Tone that becomes bare paper (0 to 1).
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = fraction, allow_negative_numbers = true)]
    pub white: f64,
    /// Draw in the colours of the photograph with these pens, at most 8 or those of --choose: a file as for --pens, which is used for that too, in which
    /// each pen has its colour on the paper. One layer per pen, light ones first; the tone is the photograph's own.
    #[arg(long, value_name = "FILE", conflicts_with = "region")]
    pub colours: Option<String>,
    /// The colour of the paper, any CSS colour.
    #[arg(long, value_name = "COLOUR", default_value = "white")]
    pub paper: Colour,
    /// With --colours, only the pens of the file that suit the photograph best (1 to 8).
    #[arg(long, value_name = "N", requires = "colours", value_parser = clap::value_parser!(u8).range(1..=8))]
    pub choose: Option<u8>,
    /// With --colours, how far to do with few pens where few will do (0 to 1).
    #[arg(long, value_name = "F", default_value_t = 0.0, value_parser = fraction, allow_negative_numbers = true)]
    pub colours_simplify: f64,
    /// With --colours, what the black pen draws.
    #[arg(long, value_enum, default_value_t = Black::Tones)]
    pub black_pen: Black,
    /// Seed of all random choices.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true)]
    pub seed: u64,
    /// A quick look: marks three times as far apart, in less than half the time.
    #[arg(long)]
    pub draft: bool,
    /// Worker threads [default: all cores]; the bytes written do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct DrawOptions {
    #[command(flatten)]
    pub picture: PictureOptions,
    #[command(flatten)]
    pub placing: PlacingOptions,
    /// The file to write, its format by extension: .svg, .svgz, .pdf, .hpgl or .plt, .gcode, .nc or .ngc, .inkml, .json; `-` for stdout.
    /// With `{layer}` in the name, one file per layer.
    #[arg(long, short, value_name = "FILE")]
    pub output: String,
    /// The format, whatever the extension.
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// An SVG to be placed in a page: the box of its ink without the sheet, one path per layer, black as the colour of the text
    /// around it, a title and transparent ground.
    #[arg(long, conflicts_with = "profile")]
    pub embed: bool,
    /// Nib width (0.01 to 20 mm), for plotter output and for lines without a width of their own.
    #[arg(long, value_name = "LENGTH", default_value = "0.3mm", value_parser = nib, allow_negative_numbers = true)]
    pub pen: f64,
    /// Smallest dot and thinnest line that the press can print; smaller marks are thinned out, keeping the tone. Newsprint: 0.065mm
    /// (Torstar Printing Group: tints below 5 % do not print; the dot of that tint at 40 lines per cm). Books: 0.03mm (Printing
    /// Industry Exchange: a 2 % dot holds at 60 lines per cm). Lines: 0.07mm (Consolidated Press: never below 0.2 points).
    #[arg(long, value_name = "LENGTH", default_value = "0mm", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub min_mark: f64,
    /// Dot gain of the press to compensate: what it adds to a 50 % screen tint (0 to 0.5). Standard aims: coated paper 0.16, uncoated
    /// 0.22 (ISO 12647-2:2013, curves A and C), newsprint 0.26 with --dot-gain-screen 40 (ISO 12647-3:2013). Measured or required by
    /// printers: coated 0.22 for black (GATF, 35 sheetfed presses at 60 lines per cm), newsprint 0.25 (Torstar Printing Group) to
    /// 0.33 (Telegram & Gazette). Coarse marks are reduced less than that tint.
    #[arg(long, value_name = "F", default_value_t = 0.0, value_parser = dot_gain, allow_negative_numbers = true)]
    pub dot_gain: f64,
    /// Screen ruling for which --dot-gain is quoted, in lines per cm (10 to 200).
    #[arg(long, value_name = "N", default_value_t = 60.0, value_parser = screen, allow_negative_numbers = true)]
    pub dot_gain_screen: f64,
    /// The ink: a CSS colour, k for the black plate only, or spot:NAME.
    #[arg(long, value_name = "COLOUR", default_value = "k", value_parser = ink)]
    pub ink: Ink,
    /// Write only these layers, by name, separated by commas.
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub layers: Vec<String>,
    /// The plotter: a name (`drypoint profiles` lists them) or a TOML file. An .svg output then holds the tool paths.
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// Longest plotting time, such as 2h, 90min or 1h30m; if needed, a larger pitch is chosen.
    #[arg(long, value_name = "TIME", value_parser = duration, requires = "profile", allow_negative_numbers = true)]
    pub max_time: Option<f64>,
    #[command(flatten)]
    pub toolpaths: ToolpathOptions,
    /// Also write what this command line amounts to as a scene.
    #[arg(long, value_name = "FILE.toml")]
    pub save_scene: Option<String>,
    /// What was given, as it was typed.
    #[arg(skip)]
    pub spelled: Spelled,
    /// Estimate marks, memory and time of the drawing, and with --profile of the plot, and write nothing. Takes a second or two,
    /// from small pictures.
    #[arg(long)]
    pub dry_run: bool,
    /// Say what each pen lays down: ink in mm2, metres of line, share.
    #[arg(long)]
    pub explain: bool,
    #[command(flatten)]
    pub reporting: Reporting,
}

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct StagesOptions {
    #[command(flatten)]
    pub picture: PictureOptions,
    /// The folder to write into; created if missing.
    #[arg(long, short, value_name = "DIR")]
    pub output: PathBuf,
    /// No progress and no summary; warnings and errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
}

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct SeeOptions {
    /// The photograph: JPEG, PNG, WebP, TIFF, BMP or GIF; `-` for stdin.
    pub photo: String,
    /// The folder for sight.json, a PNG per region and overlay.png; created if missing. Files of an earlier `see` are replaced.
    #[arg(long, short, value_name = "DIR", required_unless_present = "json")]
    pub output: Option<PathBuf>,
    /// Worker threads [default: all cores]; the bytes written do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    #[command(flatten)]
    pub reporting: Reporting,
}
