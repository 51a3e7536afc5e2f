//! Options of `inspect`, `resume`, `styles` and `profiles`.

use super::values::{length_from_zero, work};
use clap::Args;

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct InspectOptions {
    /// SVG, HP-GL or G-code; `-` for stdin.
    pub file: String,
    /// Add the plotting time on this plotter: a name (`drypoint profiles` lists them) or a TOML file.
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
    /// Limit of the work for reading the file, in millions of steps (up to 1000); 12 stay below 2 GB of memory.
    #[arg(long, value_name = "MILLIONS", default_value_t = 12.0, value_parser = work, allow_negative_numbers = true)]
    pub most_work: f64,
    /// Print one JSON object on stdout.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct ResumeOptions {
    /// An HP-GL or G-code file written by drypoint; `-` for stdin.
    pub file: String,
    /// The unfinished line, counted from 1, as a sender shows it.
    #[arg(long, value_name = "N")]
    pub line: Option<usize>,
    /// The first byte not accepted, counted from 0, as HP-GL senders count.
    #[arg(long, value_name = "N")]
    pub byte: Option<usize>,
    /// The unfinished pen-down path, counted from 1 in the file's order; `inspect` shows how many there are.
    #[arg(long, value_name = "N")]
    pub path: Option<usize>,
    /// No summary; errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
    /// Length of line before the stop that is drawn again.
    #[arg(long, value_name = "LENGTH", default_value = "3mm", value_parser = length_from_zero, allow_negative_numbers = true)]
    pub again: f64,
    /// The file to write; `-` for stdout.
    #[arg(long, short, value_name = "FILE")]
    pub output: String,
}

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct ProfilesOptions {
    #[command(flatten)]
    pub list: ListOptions,
    /// Print a working example file for --pens, with each key explained.
    #[arg(long, conflicts_with_all = ["name", "json"])]
    pub pens_example: bool,
}

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct ListOptions {
    /// Show only this one.
    pub name: Option<String>,
    /// Print one JSON object on stdout.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct ManualOptions {
    /// The folder for the pages, drypoint.1, drypoint-draw.1 and so on; it is made if need be [default: all pages on stdout].
    #[arg(short = 'o', long = "output", value_name = "FOLDER")]
    pub folder: Option<String>,
}
