//! What a hand does before a drawing: the pen up or down, moves, zero, the frame, a check without moving.

use super::super::arguments::{PenPosition, SendOptions};
use super::super::failure::Failure;
use super::super::interruption::interrupt;
use super::super::messages::{say, warning};
use super::super::words::counted;
use super::{File, OLD_WORK};
use crate::drive::{Controller, DriveError, Grbl, MachineState, Program};
use crate::plot::{Act, Profile};

/// What is done by hand before a drawing. The pen is lifted before the machine moves.
pub(super) fn set_up(grbl: &mut Grbl, profile: Option<&Profile>, options: &SendOptions) -> Result<(), Failure> {
    let commands = profile.and_then(Profile::pen_commands);
    if options.unlock {
        grbl.command("$X")?;
    }
    if options.home || options.jog.is_some() {
        let is_locked = grbl.ask_status()? == MachineState::Alarm;
        match &commands {
            // A machine that is locked does not know where its axis stands; a servo may be moved.
            Some([up, _]) if !is_locked || profile.is_some_and(|profile| profile.height().is_none()) => {
                if is_locked {
                    grbl.command("$X")?;
                }
                say_to_pen(grbl, up, profile)?;
            }
            Some(_) => {}
            None => warning!("without --profile the pen is not lifted before the machine moves"),
        }
    }
    if options.home {
        grbl.home(interrupt())?;
    }
    if options.at_origin {
        grbl.set_zero()?;
    }
    if let Some(position) = options.pen {
        let [up, down] =
            commands.ok_or_else(|| Failure::Usage("--pen: the profile does not move its pen by G-code".to_owned()))?;
        say_to_pen(grbl, if position == PenPosition::Up { &up } else { &down }, profile)?;
    }
    if let Some((x, y)) = options.jog {
        // Half of a usual travel: the user watches.
        let feed = 60.0 * profile.map_or(50.0, |profile| 0.5 * profile.motion.travel_speed);
        grbl.command(&format!("$J=G91 G21 X{x:.3} Y{y:.3} F{feed:.0}"))?;
        grbl.wait_until_still(OLD_WORK, interrupt())?;
    }
    Ok(())
}

/// The machine reads the whole file without moving.
pub(super) fn check_file(grbl: &mut Grbl, file: &File) -> Result<(), Failure> {
    grbl.command("$C")?;
    let mut faults = 0;
    for line in file.program.lines.iter().filter(|line| !line.text.is_empty() && line.act != Act::Pause) {
        match grbl.command(&line.text) {
            Err(DriveError::Refused { code, meaning, .. }) => {
                faults += 1;
                warning!("line {}, '{}': error {code}, {meaning}", line.number, line.text);
            }
            other => drop(other?),
        }
    }
    // Leaving the check resets the machine.
    let _ = grbl.command("$C");
    grbl.clear()?;
    if faults > 0 {
        return Err(Failure::Work(format!("{}: the machine refuses {}", file.name, counted(faults, "line"))));
    }
    say!("{}: the machine takes every line", file.name);
    Ok(())
}

/// Lifts a pen that a servo holds: a reset leaves it without a signal. A pen on an axis stays where it is, since nothing moves before
/// consent.
pub(super) fn lift_servo(grbl: &mut Grbl, profile: Option<&Profile>) -> Result<(), Failure> {
    match profile.filter(|profile| profile.height().is_none()).and_then(Profile::pen_commands) {
        Some([up, _]) => say_to_pen(grbl, &up, profile),
        None => Ok(()),
    }
}

/// Says a pen command of one or more lines, and waits as long as the profile allows it.
fn say_to_pen(grbl: &mut Grbl, command: &str, profile: Option<&Profile>) -> Result<(), Failure> {
    for line in command.lines().filter(|line| !line.trim().is_empty()) {
        grbl.command(line)?;
    }
    if let Some(wait) = profile.and_then(|profile| profile.wait_command(profile.motion.pen_up_seconds)) {
        grbl.command(&wait)?;
    }
    Ok(())
}

/// Goes around the drawing with the pen up, and back to where it stood: the first travel may count from there.
pub(super) fn trace_frame(machine: &mut dyn Controller, program: &Program, profile: &Profile) -> Result<(), Failure> {
    let before = machine.stand();
    for line in program.to_lift() {
        machine.ask(&line.text)?;
    }
    let [x0, y0, x1, y1] = program.bounds();
    let rate = 60.0 * profile.motion.travel_speed * profile.units_per_mm;
    let back = before.map(|stand| [stand.at[0], stand.at[1]]);
    for corner in [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]].into_iter().chain(back) {
        machine.travel(corner, rate, interrupt())?;
    }
    Ok(())
}
