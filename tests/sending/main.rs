//! Sending to machines, modelled: GRBL 1.1 behind a pseudo-terminal, faster than in life, with stalls, kills and pulled cables.
//!
//! `DRYPOINT_MANY=1` runs the full numbers; otherwise a twentieth of each.
#![cfg(all(feature = "drive", feature = "cli", unix))]

#[path = "../grbl/mod.rs"]
mod grbl;

mod axidraw;
mod continuing;
mod machine;
mod plotter;
mod printer;
mod steering;
mod streaming;
