//! HP-GL.

mod dialect;
mod read;
mod replay;
mod resume;
mod write;

pub use dialect::HpglDialect;
pub use read::HpglError;
pub(super) use resume::resume;

use super::{Language, MotionError, Orders, Refusal, Replayed, Speech, Strokes};
use crate::read::Budget;
use std::io;

/// Millimetres per second of one step of `VS`.
const SPEED_STEP: f64 = 10.0;

/// True if a text without leading blanks begins as HP-GL: with `IN`, after escape sequences for the interface at most.
pub(super) fn begins(text: &str) -> bool {
    let text = text.trim_start_matches(';');
    text.starts_with("IN") || text.starts_with('\u{1b}')
}

/// True for a line without comments that is an instruction of HP-GL, which ends in `;`; a block of G-code does not.
#[cfg(feature = "drive")]
pub(crate) fn is_instruction(line: &str) -> bool {
    line.ends_with(';')
}

impl Speech for HpglDialect {
    fn language(&self) -> Language {
        Language::Hpgl
    }

    fn check(&self) -> Result<(), Refusal> {
        self.check()
    }

    /// `VS` takes whole centimetres per second, up to the machine's limit.
    fn nearest_speed(&self, wanted: f64, limit: f64) -> f64 {
        (wanted.min(limit) / SPEED_STEP).floor().max(1.0) * SPEED_STEP
    }

    fn has_layer_handling(&self) -> bool {
        false
    }

    fn pen_takes_time(&self) -> bool {
        true
    }

    fn write(&self, orders: &Orders<'_>, out: &mut dyn io::Write) -> io::Result<()> {
        write::write(self, orders, out)
    }

    fn replay<'a>(&self, text: &'a str, rate: f64, per_mm: f64) -> Option<Vec<Replayed<'a>>> {
        Some(replay::replay(text, rate, per_mm))
    }

    fn read(&self, text: &str, _lightest: Option<f64>, budget: &mut Budget) -> Result<Strokes, MotionError> {
        Ok(read::read(text, budget)?)
    }
}
