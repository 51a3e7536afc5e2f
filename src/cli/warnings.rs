//! Warnings: said on stderr, and kept for `--json`.

use std::io::Write;
use std::sync::{Mutex, MutexGuard, PoisonError};

static TOLD: Mutex<Vec<String>> = Mutex::new(Vec::new());

fn kept() -> MutexGuard<'static, Vec<String>> {
    TOLD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Warns, once of each thing.
pub(super) fn warn(message: &str) {
    let mut told = kept();
    if told.iter().any(|known| known == message) {
        return;
    }
    told.push(message.to_owned());
    // A full or closed stderr is no reason to fail.
    let _ = writeln!(std::io::stderr(), "drypoint: warning: {message}");
}

/// All that was warned of, in order.
pub(super) fn told() -> Vec<String> {
    kept().clone()
}
