//! How HP-GL is written for one machine.

use crate::plot::language::Refusal;
use serde::Deserialize;

/// HP-GL for one machine.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct HpglDialect {
    /// Greatest length of one instruction in bytes.
    pub chunk: usize,
    /// What stands before everything, such as escape sequences for a handshake.
    #[serde(default)]
    pub preamble: String,
    /// What stands after everything, such as a command that puts out the sheet.
    #[serde(default)]
    pub postamble: String,
    /// Whether `AA` is written.
    #[serde(default)]
    pub arcs: bool,
    /// Whether lines are written packed, as `PE` of HP-GL/2.
    #[serde(default)]
    pub packed: bool,
    /// The pen's force (`FS`), where it can be told.
    pub force: Option<u32>,
    /// The pen's acceleration (`AS`) in g, where it can be told.
    pub acceleration: Option<u32>,
}

impl HpglDialect {
    pub(super) fn check(&self) -> Result<(), Refusal> {
        if self.chunk < 40 {
            return Err(Refusal::new("hpgl.chunk", "must be at least 40 bytes, which hold two points"));
        }
        for (key, text) in [("hpgl.preamble", &self.preamble), ("hpgl.postamble", &self.postamble)] {
            if !text.is_ascii() || text.contains(['\n', '\r']) {
                return Err(Refusal::new(key, "must be ASCII on one line"));
            }
        }
        if self.acceleration.is_some_and(|g| !(1..=10).contains(&g)) || self.force.is_some_and(|f| !(1..=127).contains(&f)) {
            return Err(Refusal::new("hpgl.force", "must be from 1 to 127, and hpgl.acceleration from 1 to 10"));
        }
        Ok(())
    }
}
