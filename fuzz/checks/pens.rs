//! The TOML of a pens file: refused with a reason, or pens.

use super::refusal;
use drypoint::cli::count_pens;

pub fn check(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match count_pens(text) {
        Err(error) => refusal::is_told(&error),
        Ok(count) => assert!(count <= text.len(), "{count} pens"),
    }
}
