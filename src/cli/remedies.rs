//! Turns errors of the library into messages of the command line: what was wrong, and the options that help.

use crate::plot::{CalibrationError, KeyPlace, ProfileError, TooMuch};
use crate::read::TooMuchWork;
use crate::source::SourceError;
use crate::style::StyleError;
use std::error::Error;

/// The error's message, with advice for it or for the error that caused it.
pub(super) fn advised(error: &(dyn Error + 'static)) -> String {
    if let Some(ProfileError::Syntax { place: KeyPlace::Set, .. } | ProfileError::Value { place: KeyPlace::Set, .. }) =
        error.downcast_ref()
    {
        return error.to_string().replacen(&KeyPlace::Set.to_string(), "--set-profile", 1);
    }
    if let Some(StyleError::NothingLeft { why, setting }) = error.downcast_ref() {
        return format!("there is nothing to draw: {why}; draw it with --set {setting}");
    }
    let remedy = std::iter::successors(Some(error), |error| (*error).source()).find_map(remedy);
    format!("{error}{}", remedy.unwrap_or_default())
}

fn remedy(error: &(dyn Error + 'static)) -> Option<String> {
    if let Some(work) = error.downcast_ref::<TooMuchWork>() {
        let millions = work.sufficient_limit()?;
        return Some(format!("; --most-work {millions:.0} or more allows it, and takes more memory"));
    }
    if let Some(SourceError::WorkTooLarge { .. }) = error.downcast_ref() {
        return Some("; use a larger --pitch or a smaller --size".to_owned());
    }
    let fixed = match (error.downcast_ref(), error.downcast_ref()) {
        (Some(TooMuch::Crossings { .. }), _) => {
            ": draw only the lines (--ink-model lines), leave out --occlude, or draw it in parts (--layers)"
        }
        (Some(TooMuch::Length { .. }), _) => {
            ": use a wider pen (--pen), make it smaller (--scale), or draw it in parts (--layers)"
        }
        (_, Some(CalibrationError::NoRoom { .. })) => "; choose a larger --page",
        (_, Some(CalibrationError::TooMuch { .. })) => "; choose a larger --page, a thinner --pen or a smaller --pen-count",
        _ => return None,
    };
    Some(fixed.to_owned())
}
