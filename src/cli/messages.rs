//! What is said on stderr. A stderr that is full or closed changes nothing of the work.

use std::io::{self, Write};

/// One line for the user.
pub(super) fn say(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}

/// One line that the user should see whatever was asked for.
pub(super) fn warn(line: &str) {
    say(&format!("drypoint: warning: {line}"));
}
