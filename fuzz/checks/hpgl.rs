//! HP-GL: refused with a reason, or motion that is finite; and the rest of it after any stop is read as well.

use super::{machine, refusal};
use drypoint::read::{Budget, HpglError, read_hpgl_within};
use drypoint::resume::resume_hpgl;

pub fn check(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let read = |text: &str| read_hpgl_within(text, &mut Budget::of_millions(super::STEPS));
    let motion = read(text);
    match &motion {
        Err(error) => refusal::is_told(error),
        Ok(motion) => machine::is_sound(motion, None),
    }
    for stop in super::stops(bytes) {
        let rest = match resume_hpgl(text, stop, 80.0) {
            Err(error) => {
                refusal::is_told(&error);
                continue;
            }
            Ok(rest) => rest,
        };
        let has_escapes = text.contains('\u{1b}');
        assert!(has_escapes || !rest.split(';').any(is_endless), "{rest}");
        // What is drawn again may be more than a file may hold.
        let is_read = motion.is_err() || matches!(read(&rest), Ok(_) | Err(HpglError::Work { .. }));
        assert!(is_read, "{rest}");
    }
}

/// Whether an instruction to move, which ends at the latest with its line, holds what is no number.
fn is_endless(text: &str) -> bool {
    let instruction = text.lines().next().unwrap_or_default();
    (instruction.starts_with("PU") || instruction.starts_with("PD"))
        && ["inf", "NaN"].iter().any(|none| instruction.contains(none))
}
