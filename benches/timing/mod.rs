//! The command in a process of its own, timed, and its figures beside what was promised.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

/// Runs the command with the given arguments: wall seconds, and peak megabytes through `/usr/bin/time` if there is one.
pub fn timed(arguments: impl FnOnce(&mut Command)) -> (f64, Option<f64>) {
    let timer = Path::new("/usr/bin/time");
    let mut command = if timer.exists() {
        let mut command = Command::new(timer);
        command.args(["-f", "%M", env!("CARGO_BIN_EXE_drypoint")]);
        command
    } else {
        Command::new(env!("CARGO_BIN_EXE_drypoint"))
    };
    arguments(&mut command);
    let started = Instant::now();
    let output = command.output().expect("the command starts");
    let seconds = started.elapsed().as_secs_f64();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let memory = String::from_utf8_lossy(&output.stderr).trim().parse::<f64>().ok().map(|kilobytes| kilobytes / 1024.0);
    (seconds, memory)
}

/// A figure, and whether a promise is kept.
pub fn line(what: &str, figure: f64, promise: &str, is_kept: bool) {
    println!("{what:34} {figure:8.2}   {promise}: {}", if is_kept { "kept" } else { "MISSED" });
}
