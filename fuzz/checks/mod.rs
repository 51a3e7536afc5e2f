//! What must hold for any bytes whatever: one function for each fuzz target, which panics where it does not. The fuzzer and
//! `tests/quick/fuzzed.rs` call the same ones.

#![allow(clippy::missing_panics_doc, missing_docs)]

pub mod drawing;
pub mod gcode;
pub mod hpgl;
mod invented;
mod machine;
pub mod pens;
pub mod photograph;
pub mod profile;
mod refusal;
pub mod svg;

use drypoint::plot::StopPlace as Stop;

/// Millions of steps that a file may take to be read here: a sixth of the usual, so that many files go through.
const STEPS: f64 = 2.0;

/// A place of each kind, told by the file's own bytes.
fn stops(bytes: &[u8]) -> [Stop; 3] {
    let at = bytes.iter().fold(bytes.len(), |at, byte| at.wrapping_mul(31).wrapping_add(usize::from(*byte)));
    [Stop::Line(at % 8), Stop::Byte(at % (bytes.len() + 2)), Stop::Path(at % 5)]
}
