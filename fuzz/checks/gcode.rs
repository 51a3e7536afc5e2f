//! G-code: refused with a reason, or motion that is finite, by either kind of pen lift; and the rest of it after any stop.

use super::{machine, refusal};
use drypoint::plot::{Language, Profile};
use drypoint::read::Budget;

pub fn check(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    for machine in ["grbl-servo", "grbl-z"] {
        let profile = Profile::built_in(machine).expect("it is compiled in");
        match profile.read(text, &mut Budget::of_millions(super::STEPS)) {
            Err(error) => refusal::is_told(&error),
            Ok(motion) => machine::is_sound(&motion, None),
        }
    }
    for stop in super::stops(bytes) {
        match Language::Gcode.resume(text, stop, 2.0) {
            Err(error) => refusal::is_told(&error),
            Ok(rest) => assert!(rest.is_char_boundary(rest.len()), "{rest}"),
        }
    }
}
