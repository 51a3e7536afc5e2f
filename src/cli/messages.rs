//! What is said on stderr, and the warnings kept for `--json`. A stderr that is full or closed changes nothing of the work.

use std::io::{self, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};

static WARNED: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// One line for the user.
macro_rules! say {
    ($($part:tt)*) => { $crate::cli::messages::line(&format!($($part)*)) };
}

/// One line that the user should see whatever was asked for.
macro_rules! warning {
    ($($part:tt)*) => { $crate::cli::messages::warning_line(&format!($($part)*)) };
}

pub(super) use {say, warning};

pub(super) fn line(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Warns, once of each thing: a search for a pitch draws again and again.
pub(super) fn warning_line(text: &str) {
    let mut warned = warned();
    if !warned.iter().any(|known| known == text) {
        warned.push(text.to_owned());
        line(&format!("drypoint: warning: {text}"));
    }
}

/// All that was warned of, in order.
pub(super) fn warnings() -> Vec<String> {
    warned().clone()
}

fn warned() -> MutexGuard<'static, Vec<String>> {
    WARNED.lock().unwrap_or_else(PoisonError::into_inner)
}
