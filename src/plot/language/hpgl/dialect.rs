//! The HP-GL dialect of a machine.

use crate::plot::language::Refusal;
use serde::Deserialize;

/// The HP-GL dialect of one machine.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct HpglDialect {
    /// Maximum length of one instruction in bytes.
    pub chunk: usize,
    /// Text before everything else, such as escape sequences for a handshake.
    #[serde(default)]
    pub preamble: String,
    /// Text after everything else, such as a command that ejects the sheet.
    #[serde(default)]
    pub postamble: String,
    /// Write arcs as `AA`.
    #[serde(default)]
    pub arcs: bool,
    /// Write lines packed, as `PE` of HP-GL/2.
    #[serde(default)]
    pub packed: bool,
    /// The pen's force (`FS`), if the machine has it.
    pub force: Option<u32>,
    /// The pen's acceleration (`AS`) in g, if the machine has it.
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
