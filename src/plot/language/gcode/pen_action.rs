//! The effect of a profile's pen commands on the machine.

use super::words::{is_named, words};
use super::{PenAction, Rate};

/// The parts of a command of one or more lines. `dwell` is the profile's wait command, which shows its unit.
pub(super) fn pen_actions(command: &str, dwell: &str) -> Vec<PenAction> {
    command.lines().filter_map(|line| action(line.split(['(', ';']).next().unwrap_or(""), dwell)).collect()
}

fn action(line: &str, dwell: &str) -> Option<PenAction> {
    let words = words(line);
    if is_named(line.trim()) {
        return Some(PenAction::Rest);
    }
    let value = |letter: char| words.iter().find(|word| word.0 == letter).map(|word| word.1);
    if words.is_empty() {
        return None;
    }
    let is_code = |code: f64| words.iter().any(|word| word.0 == 'G' && (word.1 - code).abs() < 1e-9);
    let target = [value('X'), value('Y'), value('Z')];
    if is_code(4.0) {
        let unit = if dwell.contains("{milliseconds}") { 0.001 } else { 1.0 };
        return Some(PenAction::Wait(value('P').unwrap_or(0.0) * unit));
    }
    let rate = match value('F') {
        _ if is_code(0.0) => Rate::Greatest,
        Some(rate) if rate > 0.0 => Rate::Given(rate / 60.0),
        _ => Rate::Last,
    };
    let moves = (is_code(0.0) || is_code(1.0)) && target.iter().any(Option::is_some);
    Some(if moves { PenAction::Move { target, rate } } else { PenAction::Rest })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_servo_rests_and_a_z_axis_moves() {
        assert_eq!(pen_actions("M3 S300", "G4 P{seconds}"), [PenAction::Rest]);
        let z = |z, rate| PenAction::Move { target: [None, None, Some(z)], rate };
        assert_eq!(pen_actions("G0 Z5", "G4 P{seconds}"), [z(5.0, Rate::Greatest)]);
        let lowered = pen_actions("G1Z-.5F300 (down)\nG4 P200", "G4 P{milliseconds}");
        assert_eq!(lowered, [z(-0.5, Rate::Given(5.0)), PenAction::Wait(0.2)]);
        assert_eq!(pen_actions("G1 Z1\n\n", "G4 P{seconds}"), [z(1.0, Rate::Last)]);
    }
}
