//! G-code: refused with a reason, or motion that is finite, by either kind of pen lift; and the rest of it after any stop.

use super::{machine, refusal};
use drypoint::read::{Budget, PenLift, read_gcode_within};
use drypoint::resume::resume_gcode;

pub fn check(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    for lift in [PenLift::Commands { up: "M3 S300", down: "M3 S700" }, PenLift::Heights { up: 2.0, down: -0.2 }] {
        match read_gcode_within(text, &lift, &mut Budget::of_millions(super::STEPS)) {
            Err(error) => refusal::is_told(&error),
            Ok(motion) => machine::is_sound(&motion, None),
        }
    }
    for stop in super::stops(bytes) {
        match resume_gcode(text, stop, 2.0) {
            Err(error) => refusal::is_told(&error),
            Ok(rest) => assert!(rest.is_char_boundary(rest.len()), "{rest}"),
        }
    }
}
