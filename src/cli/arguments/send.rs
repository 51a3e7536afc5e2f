//! Options of `send` and `ports`.

use super::values::{dip, key_value, length_from_zero, pen_heights, percent, place, region, seconds};
use crate::cli::failure::Failure;
use crate::drive::{Dip, Handshake};
use clap::{Args, Command, FromArgMatches, ValueEnum};

// Switches of a command line are booleans.
#[allow(clippy::struct_excessive_bools)]
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct SendOptions {
    /// The machine's file: G-code for GRBL and `FluidNC`, HP-GL, or an SVG of
    /// tool paths for the `AxiDraw`. Without one, only what --home, --jog, --pen or --adopt ask for is done.
    pub file: Option<String>,
    /// The machine's port: a serial line such as /dev/ttyUSB0 or COM3 (`drypoint ports` lists them), or tcp://HOST:PORT.
    #[arg(long, value_name = "PORT")]
    pub port: String,
    /// The plotter: a name or a TOML file [default: the one that the file names].
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// Set a key of the profile, such as area.x=[0,430]. May be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    pub set_profile: Vec<(String, String)>,
    /// Speed of the serial line in bits per second [default: link.baud of the profile, else 115200, for HP-GL 9600].
    #[arg(long, value_name = "N")]
    pub baud: Option<u32>,
    /// What keeps an HP-GL plotter's buffer from running over.
    #[arg(long, value_enum, default_value_t = Handshake::None)]
    pub handshake: Handshake,
    /// Do not ask before the machine moves.
    #[arg(long, short)]
    pub yes: bool,
    /// Go on where an earlier drawing of this file stopped, for whatever reason.
    #[arg(long = "continue", conflicts_with_all = ["from", "path", "line", "region", "layer"])]
    pub goes_on: bool,
    /// With --continue: go on in the very stroke, drawing this length of it again [default: the whole path under the pen].
    #[arg(long, value_name = "LENGTH", value_parser = length_from_zero, requires = "goes_on")]
    pub overlap: Option<f64>,
    /// Begin at the path that is under the pen after this share of the time, such as 35%.
    #[arg(long, value_name = "PERCENT", value_parser = percent, group = "part")]
    pub from: Option<f64>,
    /// Begin at this path, counted from 1.
    #[arg(long, value_name = "N", group = "part")]
    pub path: Option<usize>,
    /// Begin at the path that holds this line of the file, counted from 1.
    #[arg(long, value_name = "N", group = "part")]
    pub line: Option<usize>,
    /// Draw only the paths that touch this box, in the machine's coordinates in mm.
    #[arg(long, value_name = "X,Y,W,H", value_parser = region, allow_hyphen_values = true)]
    pub region: Option<[f64; 4]>,
    /// Draw only the layers of this name or pen number.
    #[arg(long, value_name = "NAME")]
    pub layer: Option<String>,
    /// Heights of an `AxiDraw`'s pen, up and down, in percent of its servo's range.
    #[arg(long, value_name = "UP,DOWN", value_parser = pen_heights, default_value = "60,30")]
    pub pen_heights: (f64, f64),
    /// Refill the pen after each such length of line or time of drawing, such as 3m or 5min: at the place --at, by gcode.refill of the
    /// profile, or without both by you, while the machine waits.
    #[arg(long, value_name = "LENGTH|TIME", value_parser = dip)]
    pub dip: Option<Dip>,
    /// Where the ink stands, in the machine's coordinates in mm.
    #[arg(long, value_name = "X,Y", value_parser = place, requires = "dip", allow_hyphen_values = true)]
    pub at: Option<(f64, f64)>,
    /// How long the pen stays in the ink, in seconds (0 to 60).
    #[arg(long, value_name = "S", value_parser = seconds, default_value_t = 0.5)]
    pub dip_time: f64,
    /// Trace the box around the drawing first, with the pen up.
    #[arg(long)]
    pub frame: bool,
    /// Let the machine check the whole file without moving ($C), then end.
    #[arg(long)]
    pub check: bool,
    /// Home the machine first ($H).
    #[arg(long)]
    pub home: bool,
    /// The pen stands at the origin now: zero is set there.
    #[arg(long, conflicts_with = "home")]
    pub at_origin: bool,
    /// Unlock the machine after an alarm ($X). The pen must stand where the machine believes it does.
    #[arg(long, conflicts_with = "home")]
    pub unlock: bool,
    /// Move the pen by X,Y in mm, then go on.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    pub jog: Option<(f64, f64)>,
    /// Lift or lower the pen, then go on.
    #[arg(long, value_enum)]
    pub pen: Option<PenPosition>,
    /// Write a profile with the machine's own settings.
    #[arg(long, value_name = "FILE.toml")]
    pub adopt: Option<String>,
    /// The journal, by which --continue knows where to go on [default: FILE.journal].
    #[arg(long, value_name = "FILE")]
    pub journal: Option<String>,
    /// Write what happens as JSON lines; `-` for stdout.
    #[arg(long, value_name = "FILE")]
    pub status: Option<String>,
    /// No progress and no summary; warnings, questions and errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
}

/// Where the pen goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum PenPosition {
    Up,
    Down,
}

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct PortsOptions {
    /// Print one JSON object on stdout.
    #[arg(long)]
    pub json: bool,
}

impl SendOptions {
    /// The options that some words amount to.
    pub fn of(words: &[String]) -> Result<Self, Failure> {
        let command = Self::augment_args(Command::new("send"));
        let matches = command.try_get_matches_from(words).map_err(|error| Failure::Usage(error.to_string()))?;
        Self::from_arg_matches(&matches).map_err(|error| Failure::Usage(error.to_string()))
    }
}
