//! Meeting the machine: its state, its settings against the profile's, its reach, and the user's word.

use super::super::arguments::SendOptions;
use super::super::failure::Failure;
use super::super::interruption::{interrupt, while_the_machine_rests};
use super::super::messages::{say, warning};
use super::{OLD_WORK, by_hand};
use crate::drive::{
    Controller, DriveError, Grbl, Greeting, Inkwell, MachineState, Program, Refill, Settings, Stand, differences, enforced_reach,
};
use crate::plot::{Dialect, Profile};
use std::io::{self, BufRead, IsTerminal};

/// Waits for what is left of an earlier drawing, reads the settings, and tells what differs from the profile. Returns the settings, and
/// where the machine stood, unless it restarted.
pub(super) fn compare(
    grbl: &mut Grbl,
    greeting: &Greeting,
    profile: Option<&Profile>,
    options: &SendOptions,
) -> Result<(Settings, Option<Stand>), Failure> {
    let state = grbl.wait_until_idle(OLD_WORK, interrupt())?;
    grbl.locate()?;
    let stand = grbl.stand().filter(|_| !greeting.is_restarted);
    let may_unlock = options.home || options.unlock;
    match state {
        MachineState::Alarm if !may_unlock => return Err(DriveError::Locked.into()),
        MachineState::Alarm => {}
        // Forgets half a line that a broken cable has left, or a drawing on hold.
        _ => {
            grbl.clear()?;
            by_hand::lift_servo(grbl, profile)?;
        }
    }
    grbl.read_build()?;
    if !options.quiet {
        say!("{}: {} answers", options.port, grbl.name());
    }
    let settings = grbl.settings()?;
    for difference in profile.map(|profile| differences(&settings, profile)).unwrap_or_default() {
        warning!(
            "${} ({}) is {} on the machine and {} in the profile: {}; --adopt FILE.toml writes a profile of the machine's own",
            difference.setting,
            difference.what,
            difference.machine,
            difference.profile,
            difference.effect
        );
    }
    Ok((settings, stand))
}

/// Refuses a file with a line that the machine cannot take.
pub(super) fn check_lines(machine: &dyn Controller, program: &Program, name: &str) -> Result<(), Failure> {
    let most = machine.longest_line();
    match program.lines.iter().find(|line| line.text.len() > most) {
        Some(line) => Err(Failure::Work(format!(
            "{name}: line {} has {} bytes, and {} takes {most}; write shorter lines (gcode.line_length of the profile)",
            line.number,
            line.text.len(),
            machine.name()
        ))),
        None => Ok(()),
    }
}

/// How the pen gets its ink: by the profile's own lines, at the place given, or by the user.
pub(super) fn refill(profile: &Profile, options: &SendOptions) -> Result<Refill, Failure> {
    let own = match &profile.dialect {
        Dialect::Gcode(gcode) => &gcode.refill[..],
        _ => &[],
    };
    let needs_place = own.iter().any(|line| line.contains("{x}") || line.contains("{y}"));
    let Some((x, y)) = options.at else {
        return match own {
            _ if needs_place => Err(Failure::Usage(format!("--dip: gcode.refill of {} needs --at X,Y", profile.name))),
            [] => Ok(Refill::User),
            own => Ok(Refill::Lines(own.to_vec())),
        };
    };
    check_place((x, y), profile)?;
    let at = [x, y].map(|v| v * profile.units_per_mm);
    if own.is_empty() {
        return Ok(Refill::Well(Inkwell { at, seconds: options.dip_time }));
    }
    let filled_in = |line: &String| line.replace("{x}", &format!("{:.3}", at[0])).replace("{y}", &format!("{:.3}", at[1]));
    Ok(Refill::Lines(own.iter().map(filled_in).collect()))
}

/// Refuses a place of the ink that the machine does not reach.
fn check_place((x, y): (f64, f64), profile: &Profile) -> Result<(), Failure> {
    let Some(area) = &profile.area else { return Ok(()) };
    let [x_mm, y_mm] = [area.x, area.y].map(|reach| reach.map(|v| v / profile.units_per_mm));
    if (x_mm[0]..=x_mm[1]).contains(&x) && (y_mm[0]..=y_mm[1]).contains(&y) {
        return Ok(());
    }
    Err(Failure::Work(format!(
        "--at {x},{y}: {} reaches from {},{} to {},{} mm",
        profile.name, x_mm[0], y_mm[0], x_mm[1], y_mm[1]
    )))
}

/// Refuses what lies beyond the profile's reach, or beyond a reach that the machine enforces itself.
pub(super) fn check_reach(settings: Option<&Settings>, program: &Program, profile: &Profile) -> Result<(), Failure> {
    let bounds = program.bounds();
    let [x0, y0, x1, y1] = bounds.map(|v| v / profile.units_per_mm);
    let per_mm = profile.units_per_mm;
    let inside = |low: f64, high: f64, reach: [f64; 2]| low >= reach[0] / per_mm - 0.02 && high <= reach[1] / per_mm + 0.02;
    let mut reaches =
        profile.area.iter().map(|area| (area.x, area.y)).chain(profile.paper.iter().map(|paper| (paper.x, paper.y))).peekable();
    if reaches.peek().is_some() && !reaches.any(|(x, y)| inside(x0, x1, x) && inside(y0, y1, y)) {
        return Err(Failure::Work(format!(
            "the file draws from x {x0:.1} y {y0:.1} to x {x1:.1} y {y1:.1} mm, beyond the reach of {}; make it anew with this profile, or \
             set the profile's area",
            profile.name
        )));
    }
    match settings.and_then(enforced_reach) {
        Some([width, height]) if x1 - x0 > width || y1 - y0 > height => Err(Failure::Work(format!(
            "the drawing has {:.1} x {:.1} mm, and the machine stops at {width} x {height} mm ($130, $131); draw it smaller",
            x1 - x0,
            y1 - y0
        ))),
        _ => Ok(()),
    }
}

/// Asks the user; without a terminal only `--yes` is an answer.
pub(super) fn confirm(is_agreed: bool, question: &str) -> Result<(), Failure> {
    if is_agreed {
        return Ok(());
    }
    if !io::stdin().is_terminal() {
        return Err(Failure::Usage(format!("{question} Nobody can answer here; give --yes")));
    }
    say!("{question} [y/N]");
    let mut answer = String::new();
    let _ = while_the_machine_rests(|| io::stdin().lock().read_line(&mut answer));
    interrupt().check().map_err(DriveError::from)?;
    if answer.trim().to_lowercase().starts_with('y') { Ok(()) } else { Err(Failure::Work("nothing was drawn".to_owned())) }
}
