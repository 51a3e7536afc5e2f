//! What is said on stderr. A stderr that is full or closed changes nothing of the work.

use std::io::{self, Write};

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

pub(super) fn warning_line(text: &str) {
    line(&format!("drypoint: warning: {text}"));
}
