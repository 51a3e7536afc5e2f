//! A profile's TOML: refused with a reason, or a machine for which a small plot can be written.

use super::machine::{small_plot, written};
use super::refusal;
use drypoint::drawing::Page;
use drypoint::plot::Profile;

/// The longest profile that is tried, in bytes.
const LONGEST: usize = 20_000;

pub fn check(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if text.len() > LONGEST {
        return;
    }
    match Profile::parse("machine.toml", text) {
        Err(error) => refusal::is_told(&error),
        Ok(profile) => {
            for (width, height) in [(40.0, 30.0), (210.0, 297.0)] {
                written(&profile, small_plot(Page::new(width, height)));
            }
        }
    }
}
