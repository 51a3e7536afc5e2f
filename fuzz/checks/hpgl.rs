//! HP-GL: refused with a reason, or motion that is finite; and the rest of it after any stop.

use super::{machine, refusal};
use drypoint::read::{Budget, read_hpgl_within};
use drypoint::resume::resume_hpgl;

pub fn check(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match read_hpgl_within(text, &mut Budget::of_millions(super::STEPS)) {
        Err(error) => refusal::is_told(&error),
        Ok(motion) => machine::is_sound(&motion, None),
    }
    for stop in super::stops(bytes) {
        match resume_hpgl(text, stop, 80.0) {
            Err(error) => refusal::is_told(&error),
            Ok(rest) => assert!(!rest.contains("NaN") && !rest.contains("inf"), "{rest}"),
        }
    }
}
