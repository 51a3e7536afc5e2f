//! Sending to machines, modelled: GRBL 1.1 behind a pseudo-terminal, faster than in life, with stalls, kills and pulled cables.
//!
//! `DRYPOINT_MANY=1` runs the full numbers; otherwise a twentieth of each.
#![cfg(all(feature = "drive", feature = "cli", unix))]

#[path = "../grbl/mod.rs"]
mod grbl;

mod axidraw;
mod by_hand;
mod clock;
mod continuing;
mod machine;
mod plotter;
mod printer;
mod steering;
mod streaming;

/// A machine to try by hand, ten times faster than in life, for ten minutes:
/// `cargo test --release --test sending machine_to_try -- --ignored --nocapture`.
#[test]
#[ignore = "it waits for somebody to try it"]
fn machine_to_try() {
    let machine = machine::Machine::at_pace(10.0);
    println!("drypoint send FILE.gcode --port {}", machine.port());
    std::thread::sleep(std::time::Duration::from_mins(10));
}
