//! The command line. Only this module opens files, writes to stdout, shows progress and sets exit codes.

mod advice;
mod affordable;
mod amounts;
mod arguments;
mod batch;
mod calibrate;
mod claims;
mod coloured;
mod composed;
mod crop;
mod draw;
mod draw_report;
mod dry_run;
mod estimate;
mod estimate_plot;
mod exact_ink;
mod eyes;
mod failure;
mod few_pens;
mod formats;
mod inking;
mod inspect;
mod interruption;
mod job;
mod known;
mod label_speeds;
mod layer_files;
mod layout;
mod lists;
mod long_waits;
mod looking;
mod manner;
mod manual;
mod masks;
mod max_time;
mod messages;
mod output;
mod overlay;
mod palette;
mod pen_file;
mod pens;
mod placing;
mod plot;
mod plotted_part;
mod png;
mod progress;
mod proof;
mod recipe;
mod region;
mod regions;
mod remedies;
mod resume;
mod roles;
mod scale_to_time;
mod scene;
mod see;
mod seen;
mod seen_stages;
#[cfg(feature = "drive")]
mod send;
mod sheet;
mod sight_folder;
mod stages;
#[cfg(feature = "studio")]
mod studio;
mod task;
mod threads;
mod tone_error;
mod toolpaths;
mod vector_mask;
mod words;

use arguments::Spelled;
use arguments::{Arguments, Command, ToolpathOptions};
use clap::{ArgMatches, CommandFactory, FromArgMatches};
use failure::Failure;
use scene::Refusal;
use std::ffi::OsString;
use std::io::IsTerminal;
use std::process::ExitCode;

/// What to do first, for those who have just installed the command.
const FIRST_STEPS: &str = "\
drypoint turns a photograph into vector stroke art for print or a pen plotter.

  drypoint draw portrait.jpg -o portrait.svg                         a hedcut; open the file in a browser
  drypoint draw portrait.jpg -o portrait.svg --style engrave         lines as on banknotes; `drypoint styles` lists the styles
  drypoint draw portrait.jpg -o column.pdf --preset wsj-column       for print; `drypoint presets` lists the purposes
  drypoint draw portrait.jpg -o portrait.gcode --profile grbl-servo  for a plotter; `drypoint profiles` lists the machines
  drypoint see portrait.jpg -o sight                                 what is found in the photograph, to correct it

`drypoint --help` lists all commands, `drypoint draw --help` all options.";

/// Runs the command with the process's arguments.
///
/// Exit status: 0 success, 1 the work failed, 2 the command line is wrong, 130 interrupted, 143 terminated. A closed pipe ends the
/// process quietly with status 0.
pub fn main() -> ExitCode {
    let words: Vec<OsString> = std::env::args_os().collect();
    if words.len() == 1 && std::io::stderr().is_terminal() {
        messages::say!("{FIRST_STEPS}");
        return ExitCode::from(2);
    }
    let parsed = scene::matches(&words).and_then(|(matches, origins)| Ok((arguments(&matches)?, origins)));
    let (arguments, origins) = match parsed {
        Ok(parsed) => parsed,
        Err(Refusal::Usage(error)) => {
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
        Err(Refusal::File(failure)) => return ended(Err(failure)),
    };
    interruption::catch();
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        // What usvg cannot use is told as an error of the file.
        if !crate::read::is_parsing() {
            usual(panic);
        }
    }));
    ended(run(arguments).map_err(|failure| origins.explain(failure)))
}

/// The arguments of a parsed command line.
fn arguments(matches: &ArgMatches) -> Result<Arguments, Refusal> {
    let mut arguments = Arguments::from_arg_matches(matches)?;
    if let (Command::Draw(options) | Command::Scene(options), Some((_, given))) = (&mut arguments.command, matches.subcommand()) {
        options.spelled = Spelled::of(given);
    }
    if let (Command::Batch(options), Some((_, given))) = (&mut arguments.command, matches.subcommand()) {
        options.draw.spelled = Spelled::of(given);
        let inputs = given.get_raw("photo").into_iter().flatten();
        options.inputs = inputs.map(|input| input.to_string_lossy().into_owned()).collect();
    }
    Ok(arguments)
}

/// The exit status, after the message of a failure.
fn ended(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) | Err(Failure::ClosedPipe) => ExitCode::SUCCESS,
        Err(failure) => {
            messages::say!("drypoint: {failure}");
            ExitCode::from(failure.exit_status())
        }
    }
}

/// Number of pens in the text of a `--pens` file, or the error message. Public only for tests and fuzzing.
#[doc(hidden)]
pub fn count_pens(text: &str) -> Result<usize, String> {
    pen_file::read_pens("pens.toml", text).map(|pens| pens.len()).map_err(|failure| failure.to_string())
}

fn run(arguments: Arguments) -> Result<(), Failure> {
    match arguments.command {
        // A redone drawing's recipe has become the options of `draw`.
        Command::Draw(options) | Command::Redo(options) => {
            let what = Sent { output: &options.output, profile: options.profile.as_deref(), toolpaths: &options.toolpaths };
            what.after(options.dry_run, || draw::run(&options))
        }
        Command::Plot(options) => {
            let what = Sent { output: &options.output, profile: options.profile.as_deref(), toolpaths: &options.toolpaths };
            what.after(options.dry_run, || plot::run(&options))
        }
        Command::Stages(options) => stages::run(&options),
        Command::See(options) => see::run(&options),
        Command::Scene(options) => scene::run(&options),
        Command::Presets(options) => scene::presets(&options),
        Command::Batch(options) => batch::run(&options),
        Command::Sheet(options) => {
            let what = Sent { output: &options.output, profile: options.profile.as_deref(), toolpaths: &options.toolpaths };
            what.after(false, || sheet::run(&options))
        }
        Command::Schema => scene::schema(),
        Command::Inspect(options) => inspect::run(&options),
        Command::Resume(options) => resume::run(&options),
        #[cfg(feature = "drive")]
        Command::Send(options) => send::run(&options),
        #[cfg(feature = "drive")]
        Command::Ports(options) => send::list_ports(&options),
        Command::Calibrate(options) => {
            let what = Sent { output: &options.output, profile: options.profile.as_deref(), toolpaths: &options.toolpaths };
            what.after(options.dry_run, || calibrate::run(&options))
        }
        Command::Styles(options) => lists::styles(&options),
        Command::Pens(options) => palette::list(&options),
        Command::Profiles(options) => lists::profiles(&options),
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "drypoint", &mut text);
            output::to_stdout(&text)
        }
        #[cfg(feature = "studio")]
        Command::Studio(options) => studio::run(&options),
        Command::Man(options) => manual::run(&options),
    }
}

/// A machine's file that is written and, with `--send`, sent.
#[cfg_attr(not(feature = "drive"), allow(dead_code))]
struct Sent<'a> {
    output: &'a str,
    profile: Option<&'a str>,
    toolpaths: &'a ToolpathOptions,
}

impl Sent<'_> {
    /// Writes the file, then sends it unless nothing was written.
    #[cfg_attr(not(feature = "drive"), allow(clippy::unused_self))]
    fn after(&self, is_dry: bool, write: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
        #[cfg(feature = "drive")]
        send::check_sendable(self.output, self.profile, self.toolpaths)?;
        write()?;
        #[cfg(feature = "drive")]
        if !is_dry {
            send::written(self.output, self.profile, self.toolpaths)?;
        }
        let _ = is_dry;
        Ok(())
    }
}
