//! Drawings for the `AxiDraw`: an SVG of tool paths, planned here and sent as motor commands.

use super::super::arguments::SendOptions;
use super::super::failure::Failure;
use super::super::interruption::{interrupt, wait_for_machine};
use super::super::messages::say;
use super::super::remedies::advised;
use super::super::toolpaths::plain_profile;
use super::super::words::counted;
use super::{File, MOST_BYTES, conduct, digest, meeting, output, part, refuse_set_up};
use crate::drive::{Controller, Ebb, Handshake, LineSettings, PenHeights, Program, Rest, Stand, open_port};
use crate::plot::{Dialect, InkModel, Mounting, Nibs, PenLift, Plot, Profile, lower, mount};
use crate::read::{Budget, read_svg_within};

/// The paths of the file, where they lie on the machine.
struct Picture {
    plot: Plot,
    mounting: Mounting,
    profile: Profile,
}

/// Sends an SVG of tool paths.
pub(super) fn run(name: &str, bytes: &[u8], options: &SendOptions) -> Result<(), Failure> {
    refuse_set_up(options, "an AxiDraw has no such command")?;
    let picture = picture(name, bytes, options)?;
    let whole = picture.program(&Rest::default())?;
    let file = File { name: name.to_owned(), sha256: digest(bytes), program: whole };
    let port = open_port(&options.port, LineSettings { baud: options.baud.unwrap_or(9600), handshake: Handshake::None })?;
    let heights = PenHeights { up: options.pen_heights.0, down: options.pen_heights.1 };
    let lift = if let Dialect::Svg(svg) = &picture.profile.dialect { svg.pen_lift } else { PenLift::default() };
    let mut ebb = Ebb::greet(port, heights, lift, interrupt())?;
    wait_for_machine();
    if !options.quiet {
        say!("{}: {} answers", options.port, ebb.version());
    }
    if options.at_origin {
        ebb.set_zero()?;
    }
    let stand = ebb.stand().filter(|_| ebb.is_position_known());
    let from = stand.map_or([0.0; 2], |stand: Stand| [stand.at[0], stand.at[1]]);
    let planned = part::planned(stand, &picture.profile, &file, options)?;
    let Some(planned) = planned else {
        say!("{}: everything is drawn already; without --continue it is drawn again", file.name);
        return Ok(());
    };
    let rest = Rest { paths: planned.paths.clone(), along: planned.along, from };
    let program = picture.program(&rest)?;
    if options.dip.is_some() {
        return Err(Failure::Usage("--dip is for G-code".to_owned()));
    }
    meeting::check_reach(None, &program, &picture.profile)?;
    conduct(&mut ebb, &program, planned.into_chosen(), &picture.profile, &file, options)
}

fn picture(name: &str, bytes: &[u8], options: &SendOptions) -> Result<Picture, Failure> {
    let mut budget = Budget::default();
    let imported = read_svg_within(bytes, &mut budget).map_err(|error| Failure::about(name)(&advised(&error)))?;
    if !imported.is_toolpaths {
        let advice = "plot it first: drypoint plot DRAWING.svg -o paths.svg --profile axidraw-v3";
        return Err(Failure::Work(format!("{name} is a drawing, not tool paths in the order of a machine; {advice}")));
    }
    let machine = imported.speeds.as_ref().map(|speeds| speeds.machine.clone());
    let profile = match (&options.profile, machine) {
        (Some(profile), _) => plain_profile(profile, &options.set_profile)?,
        (None, Some(machine)) => plain_profile(&machine, &options.set_profile)?,
        (None, None) => plain_profile("axidraw-v3", &options.set_profile)?,
    };
    if profile.language() != crate::plot::Language::Svg {
        return Err(Failure::Usage(format!("{name} is an SVG, which {} does not draw", profile.name)));
    }
    let plot = lower(&imported.drawing(), InkModel::Lines, &Nibs::all(0.3), 0.02, interrupt())?;
    let mounting = mount(&profile, &plot.page)?;
    mounting.check(&profile, &plot)?;
    if plot.pens.iter().all(|pen| pen.paths.is_empty()) {
        return Err(Failure::Work(format!("{name}: there is nothing to draw")));
    }
    if !options.quiet {
        let count = plot.pens.iter().map(|pen| pen.paths.len()).sum();
        say!("{name}: {} for {}", counted(count, "path"), profile.name);
    }
    Ok(Picture { plot, mounting, profile })
}

impl Picture {
    fn program(&self, rest: &Rest) -> Result<Program, Failure> {
        Ok(Program::of_plot(&self.profile, &self.plot, &self.mounting, rest, interrupt())?)
    }
}

/// Reads the file, for the caller to see what it is.
pub(super) fn svg_bytes(name: &str) -> Result<Option<Vec<u8>>, Failure> {
    let ending = std::path::Path::new(name).extension().map(std::ffi::OsStr::to_ascii_lowercase);
    if !ending.is_some_and(|ending| ending == "svg" || ending == "svgz") {
        return Ok(None);
    }
    output::read(name, MOST_BYTES, "").map(Some)
}
