//! Messages on stderr, and the warnings kept for `--json`. Errors while writing to stderr are ignored.

use std::io::{self, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};

static WARNED: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Prints one line for the user.
macro_rules! say {
    ($($part:tt)*) => { $crate::cli::messages::line(&format!($($part)*)) };
}

/// Prints a warning, even with `--quiet`.
macro_rules! warning {
    ($($part:tt)*) => { $crate::cli::messages::warning_line(&format!($($part)*)) };
}

pub(super) use {say, warning};

pub(super) fn line(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Prints each warning once: a search for a pitch draws repeatedly.
pub(super) fn warning_line(text: &str) {
    let mut warned = warned();
    if !warned.iter().any(|known| known == text) {
        warned.push(text.to_owned());
        line(&format!("drypoint: warning: {text}"));
    }
}

/// All warnings so far, in order.
pub(super) fn warnings() -> Vec<String> {
    warned().clone()
}

fn warned() -> MutexGuard<'static, Vec<String>> {
    WARNED.lock().unwrap_or_else(PoisonError::into_inner)
}
