//! HP-GL: refused with a reason, or motion that is finite; and the rest of it after any stop is read as well.

use super::{machine, refusal};
use drypoint::plot::{HpglError, Language, MotionError, Profile};
use drypoint::read::Budget;

pub fn check(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let profile = Profile::built_in("hp7475a").expect("it is compiled in");
    let read = |text: &str| profile.read(text, &mut Budget::of_millions(super::STEPS));
    let motion = read(text);
    match &motion {
        Err(error) => refusal::is_told(error),
        Ok(motion) => machine::is_sound(motion, None),
    }
    for stop in super::stops(bytes) {
        let rest = match Language::Hpgl.resume(text, stop, 2.0) {
            Err(error) => {
                refusal::is_told(&error);
                continue;
            }
            Ok(rest) => rest,
        };
        let has_escapes = text.contains('\u{1b}');
        assert!(has_escapes || !rest.split(';').any(is_endless), "{rest}");
        // What is drawn again may be more than a file may hold.
        let is_read = motion.is_err() || matches!(read(&rest), Ok(_) | Err(MotionError::Hpgl(HpglError::Work { .. })));
        assert!(is_read, "{rest}");
    }
}

/// Whether an instruction to move, which ends at the latest with its line, holds what is no number.
fn is_endless(text: &str) -> bool {
    let instruction = text.lines().next().unwrap_or_default();
    (instruction.starts_with("PU") || instruction.starts_with("PD"))
        && ["inf", "NaN"].iter().any(|none| instruction.contains(none))
}
