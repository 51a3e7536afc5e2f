//! `drypoint send` and `drypoint ports`: a file goes to its machine.
//!
//! ```text
//!   file, profile --checked--> program --part or place to continue--> summary --yes--> frame --> session, with its journal
//! ```

mod axidraw;
mod by_hand;
mod keys;
mod ledger;
mod meeting;
mod onlooker;
mod part;

use super::arguments::{PortsOptions, SendOptions, ToolpathOptions};
use super::claims;
use super::failure::Failure;
use super::inspect::usual_profile;
use super::interruption::{interrupt, wait_for_machine};
use super::messages::{say, warning};
use super::output;
use super::toolpaths::plain_profile;
use super::words::counted;
use crate::drive::{
    Beginning, Controller, DriveError, Ending, Grbl, Handshake, Hpgl, Journal, LineSettings, Marlin, Program, Session, Stand,
    adopted, open_port, ports,
};
use crate::plot::{Dialect, GcodeDialect, Language, Profile, Protocol};
use crate::read::Budget;
use keys::Keys;
use ledger::FileLedger;
use onlooker::{Terminal, lasting};
use part::Chosen;
use serde_json::json;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::time::Duration;

/// A file of many days' drawing, in bytes.
const MOST_BYTES: u64 = 1 << 26;
/// How long what is left of an earlier drawing may take to come to its end.
const OLD_WORK: Duration = Duration::from_mins(2);

/// Seconds of drawing between two checkpoints of a machine that needs them; each costs it a third of a second.
const CHECKPOINTS: f64 = 10.0;

impl From<DriveError> for Failure {
    fn from(error: DriveError) -> Self {
        match error {
            DriveError::Interrupted => Self::Interrupted,
            DriveError::Unpowered => Self::Work(format!("{error}; --at-origin says that it is there")),
            DriveError::Locked => Self::Work(format!("{error}: --home, or --unlock")),
            DriveError::Opening { .. } => {
                Self::Work(format!("{error}; `drypoint ports` lists what there is, and docs/sending.md says who may open it"))
            }
            other => Self::Work(other.to_string()),
        }
    }
}

/// The file, read and checked before a byte is sent.
struct File {
    name: String,
    sha256: String,
    program: Program,
}

pub(super) fn list_ports(options: &PortsOptions) -> Result<(), Failure> {
    let found = ports()?;
    if options.json {
        let list: Vec<_> = found.iter().map(|port| json!({ "port": port.name, "what": port.what, "usb": port.is_usb })).collect();
        return output::print_json(&json!({ "ports": list }));
    }
    if found.is_empty() {
        say!("no serial port was found; connect the machine, switch it on, and see docs/sending.md");
    }
    let width = found.iter().map(|port| port.name.len()).max().unwrap_or(0);
    let text: String = found.iter().fold(String::new(), |mut text, port| {
        let _ = writeln!(text, "{:width$}  {}", port.name, port.what);
        text
    });
    output::to_stdout(text.as_bytes())
}

pub(super) fn run(options: &SendOptions) -> Result<(), Failure> {
    if let Some(name) = &options.file
        && let Some(bytes) = axidraw::svg_bytes(name)?
    {
        return axidraw::run(name, &bytes, options);
    }
    let (profile, file) = read(options)?;
    match profile.as_ref().map(|profile| (&profile.dialect, &profile.name)) {
        Some((Dialect::Hpgl(_), _)) => return draw_on_plotter(profile, file, options),
        Some((Dialect::Gcode(GcodeDialect { protocol: Protocol::Marlin, .. }), _)) => {
            return draw_on_printer(profile, file, options);
        }
        Some((Dialect::Gcode(GcodeDialect { protocol: Protocol::File, .. }), name)) => {
            return Err(Failure::Usage(format!("{name} reads its file itself; copy it there")));
        }
        // The machine of an SVG is driven by its own program; its board is asked as GRBL is, and does not answer.
        None | Some((Dialect::Gcode(GcodeDialect { protocol: Protocol::Grbl, .. }) | Dialect::Svg(_), _)) => {}
    }
    let settings = LineSettings { baud: baud(options, profile.as_ref(), 115_200), handshake: Handshake::None };
    let (mut grbl, greeting) = Grbl::greet(open_port(&options.port, settings)?)?;
    wait_for_machine();
    let (settings, stand) = meeting::compare(&mut grbl, &greeting, profile.as_ref(), options)?;
    if let (Some(name), Some(profile)) = (&options.adopt, &profile) {
        output::write(name, |out| out.write_all(adopted(&settings, profile).as_bytes()))?;
        say!("{name}: {} with the machine's own settings; use it with --profile {name}", profile.name);
    }
    by_hand::set_up(&mut grbl, profile.as_ref(), options)?;
    let (Some(profile), Some(file)) = (profile, file) else { return Ok(()) };
    meeting::check_reach(Some(&settings), &file.program, &profile)?;
    if options.check {
        return by_hand::check_file(&mut grbl, &file);
    }
    draw(&mut grbl, stand, &profile, &file, options)
}

/// The drawing of an HP-GL plotter, which has neither settings nor commands to be set up by.
fn draw_on_plotter(profile: Option<Profile>, file: Option<File>, options: &SendOptions) -> Result<(), Failure> {
    let why = "an HP-GL plotter has no such command; use its front panel";
    refuse_set_up(options, why)?;
    if options.at_origin {
        return Err(Failure::Usage(format!("--at-origin: {why}")));
    }
    let (Some(profile), Some(file)) = (profile, file) else { return Ok(()) };
    meeting::check_reach(None, &file.program, &profile)?;
    let handshake = options.handshake;
    let port = open_port(&options.port, LineSettings { baud: baud(options, Some(&profile), 9600), handshake })?;
    let mut plotter = Hpgl::greet(port, handshake)?;
    wait_for_machine();
    if !options.quiet {
        say!("{}: {} answers", options.port, plotter.name());
    }
    let stand = plotter.stand();
    draw(&mut plotter, stand, &profile, &file, options)
}

/// The drawing of a machine that talks like a 3D printer.
fn draw_on_printer(profile: Option<Profile>, file: Option<File>, options: &SendOptions) -> Result<(), Failure> {
    refuse_set_up(options, "it is for GRBL; set the machine up by its own panel or program")?;
    if let (Some(profile), Some(file)) = (&profile, &file) {
        meeting::check_reach(None, &file.program, profile)?;
    }
    let settings = LineSettings { baud: baud(options, profile.as_ref(), 115_200), handshake: Handshake::None };
    let mut printer = Marlin::greet(open_port(&options.port, settings)?, interrupt())?;
    wait_for_machine();
    if !options.quiet {
        say!("{}: {} answers", options.port, printer.name());
    }
    if options.at_origin {
        printer.set_zero()?;
    }
    let (Some(profile), Some(file)) = (profile, file) else { return Ok(()) };
    let stand = printer.stand();
    draw(&mut printer, stand, &profile, &file, options)
}

/// Sends the file that `draw` or `plot` has written, if that was asked for.
pub(super) fn written(output: &str, profile: Option<&str>, toolpaths: &ToolpathOptions) -> Result<(), Failure> {
    let Some(port) = &toolpaths.send else { return Ok(()) };
    let mut words = vec!["send".to_owned(), output.to_owned(), "--port".to_owned(), port.clone()];
    words.extend(profile.iter().flat_map(|name| ["--profile".to_owned(), (*name).to_owned()]));
    words.extend(toolpaths.set_profile.iter().flat_map(|(key, value)| ["--set-profile".to_owned(), format!("{key}={value}")]));
    words.extend(toolpaths.yes.then(|| "--yes".to_owned()));
    run(&SendOptions::of(&words)?)
}

/// Refuses what cannot be sent, before any work is done.
pub(super) fn check_sendable(output: &str, profile: Option<&str>, toolpaths: &ToolpathOptions) -> Result<(), Failure> {
    if toolpaths.send.is_none() {
        return Ok(());
    }
    if profile.is_none() || output == "-" || output.contains("{layer}") {
        return Err(Failure::Usage("--send needs --profile, and a single file for -o".to_owned()));
    }
    Ok(())
}

/// Refuses what only GRBL can be told.
fn refuse_set_up(options: &SendOptions, why: &str) -> Result<(), Failure> {
    let of_grbl = [
        ("--home", options.home),
        ("--unlock", options.unlock),
        ("--jog", options.jog.is_some()),
        ("--pen", options.pen.is_some()),
        ("--adopt", options.adopt.is_some()),
        ("--check", options.check),
    ];
    match of_grbl.into_iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) => Err(Failure::Usage(format!("{option}: {why}"))),
        None => Ok(()),
    }
}

/// The profile and the file.
fn read(options: &SendOptions) -> Result<(Option<Profile>, Option<File>), Failure> {
    let named = options.profile.as_deref().map(|name| plain_profile(name, &options.set_profile)).transpose()?;
    let Some(name) = &options.file else {
        if options.adopt.is_none()
            && !options.home
            && options.jog.is_none()
            && options.pen.is_none()
            && !options.unlock
            && !options.at_origin
        {
            return Err(Failure::Usage(
                "give the file to draw, or --home, --jog, --pen, --unlock, --at-origin or --adopt".to_owned(),
            ));
        }
        if named.is_none() && (options.pen.is_some() || options.adopt.is_some()) {
            return Err(Failure::Usage("--pen and --adopt need --profile".to_owned()));
        }
        return Ok((named, None));
    };
    let text = String::from_utf8(output::read(name, MOST_BYTES, "")?)
        .map_err(|_| Failure::Work(format!("{name} is not G-code or HP-GL: it is not plain text")))?;
    let language = Language::of_text(&text).unwrap_or(Language::Gcode);
    let profile = named.map_or_else(|| usual_profile(language, &text), Ok)?;
    if profile.language() != language {
        return Err(Failure::Usage(format!("{name} is {}, which {} does not read", language.title(), profile.name)));
    }
    let file = checked(name, &text, &profile)?;
    Ok((Some(profile), Some(file)))
}

/// Reads the whole file as the machine would, before anything moves.
fn checked(name: &str, text: &str, profile: &Profile) -> Result<File, Failure> {
    let motion = profile.read(text, &mut Budget::default()).map_err(|error| Failure::Work(format!("{name}: {error}")))?;
    if !motion.ends_up {
        warning!("{name} ends with the pen down");
    }
    let program = Program::read(profile, text, interrupt()).map_err(|error| match error {
        DriveError::Unfit(problem) => Failure::Work(format!("{name}: {problem}")),
        other => other.into(),
    })?;
    let sha256 = digest(text.as_bytes());
    Ok(File { name: name.to_owned(), sha256, program })
}

/// The line's speed: as given, else the profile's, else the usual one.
fn baud(options: &SendOptions, profile: Option<&Profile>, usual: u32) -> u32 {
    options.baud.or_else(|| profile?.link.baud).unwrap_or(usual)
}

/// SHA-256 in hexadecimal.
fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut hex, byte| {
        let _ = write!(hex, "{byte:02x}");
        hex
    })
}

fn draw(
    machine: &mut dyn Controller,
    stand: Option<Stand>,
    profile: &Profile,
    file: &File,
    options: &SendOptions,
) -> Result<(), Failure> {
    let Some(planned) = part::planned(stand, profile, file, options)? else {
        say!("{}: everything is drawn already; without --continue it is drawn again", file.name);
        return Ok(());
    };
    let program = planned.program(profile, &file.program)?;
    let program = match machine.checkpoint() {
        Some(text) => program.with_checkpoints(profile, text, CHECKPOINTS, interrupt())?,
        None => program,
    };
    let program = match options.dip {
        Some(dip) => program.with_dips(profile, dip, &meeting::refill(profile, options)?, interrupt())?,
        None => program,
    };
    conduct(machine, &program, planned.into_chosen(), profile, file, options)
}

/// Asks for consent, draws, and keeps the journal.
fn conduct(
    machine: &mut dyn Controller,
    program: &Program,
    Chosen { paths, is_continued }: Chosen,
    profile: &Profile,
    file: &File,
    options: &SendOptions,
) -> Result<(), Failure> {
    let journal_name = journal_of(options, &file.name);
    // A journal that is continued was read, and is appended to.
    let written = Some(journal_name.as_str()).filter(|_| !is_continued);
    claims::check_distinct(written.into_iter().chain(options.status.as_deref().filter(|name| *name != "-")))?;
    meeting::check_lines(machine, program, &file.name)?;
    if !options.quiet || !options.yes {
        say!("{}", summary(&file.name, program, profile));
    }
    meeting::confirm(options.yes, "Draw it now?")?;
    if options.frame {
        by_hand::trace_frame(machine, program, profile)?;
        meeting::confirm(options.yes, "Was the frame where it should be?")?;
    }
    let mut ledger = if is_continued { FileLedger::append_to(&journal_name) } else { FileLedger::create(&journal_name) }?;
    let mut journal = if is_continued {
        Journal::go_on(&mut ledger)
    } else {
        let beginning = Beginning {
            file: super::words::file_name(&file.name).to_owned(),
            sha256: file.sha256.clone(),
            profile: profile.name.clone(),
            machine: machine.name().to_owned(),
            paths,
        };
        Journal::begin(&mut ledger, &beginning)?
    };
    let mut terminal = Terminal::new(options, Keys::of_terminal())?;
    let ending = Session::new(machine, program).run(&mut journal, &mut terminal, interrupt());
    terminal.finish(&ending);
    match ending {
        Ok(Ending::Done) => Ok(()),
        Ok(Ending::Stopped) => {
            let advice =
                format!("stopped with the pen up; to go on: drypoint send {} --port {} --continue", file.name, options.port);
            say!("drypoint: {advice}");
            Err(if interrupt().is_raised() { Failure::Interrupted } else { Failure::Stopped })
        }
        Err(error) => {
            Err(Failure::Work(format!("{error}; what was drawn is in {journal_name}, and --continue goes on from there")))
        }
    }
}

/// The name of the journal.
fn journal_of(options: &SendOptions, file: &str) -> String {
    options.journal.clone().unwrap_or_else(|| format!("{file}.journal"))
}

/// Size, time and pens of what will be drawn.
fn summary(name: &str, program: &Program, profile: &Profile) -> String {
    let [x0, y0, x1, y1] = program.bounds().map(|v| v / profile.units_per_mm);
    let pens: Vec<String> = program.pens().into_iter().map(|(number, name)| format!("pen {number} ({name})")).collect();
    format!(
        "{name}: {} in {}, {:.1} x {:.1} mm from x {x0:.1} y {y0:.1} to x {x1:.1} y {y1:.1}, on {}{}{}",
        counted(program.paths.len(), "path"),
        lasting(program.seconds()),
        x1 - x0,
        y1 - y0,
        profile.name,
        if pens.is_empty() { "" } else { "; " },
        pens.join(", then "),
    )
}
