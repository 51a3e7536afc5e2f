//! Ctrl-C, SIGTERM and SIGHUP end the program soon, wherever it is, and leave nothing behind; SIGKILL corrupts no file; and a
//! closed stderr does no harm.
#![cfg(feature = "cli")]

mod common;

use common::sample;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The guarantee is one second; the rest allows for busy machines.
const SOON: Duration = Duration::from_millis(2500);

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("photo.png"), sample("chelsea.png")).unwrap();
    folder
}

fn start(folder: &Path, arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    command.current_dir(folder).args(arguments).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

fn send(signal: &str, child: &Child) {
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
}

/// Starts a command, sends a signal after a while, and returns the exit status and the time until the end; `None` if it finished
/// before.
fn stopped(folder: &Path, arguments: &[&str], signal: &str, after: Duration) -> Option<(Option<i32>, Duration)> {
    let mut child = start(folder, arguments);
    // Waiting for a child closes its stdin, which would end its reading.
    let _stdin = child.stdin.take();
    std::thread::sleep(after);
    if child.try_wait().unwrap().is_some() {
        return None;
    }
    send(signal, &child);
    let sent = Instant::now();
    let status = child.wait().unwrap();
    Some((status.code(), sent.elapsed()))
}

fn assert_nothing_new(folder: &Path, before: usize, what: &str) {
    let found: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(found.len(), before, "{what} left {found:?}");
}

/// A hatching of many lines, slow to read, to order and to write.
fn long_drawing(lines: usize) -> String {
    let paths = (0..lines)
        .map(|i| {
            let (x, y) = (200.0 * (i as f64 * 0.754_877_666).fract(), 200.0 * (i as f64 * 0.569_840_291).fract());
            format!("M{x:.3} {y:.3}l2 1")
        })
        .collect::<Vec<_>>()
        .concat();
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='210mm' height='210mm' viewBox='0 0 210 210'><path d='{paths}' fill='none' stroke='black'/></svg>"
    )
}

#[test]
fn each_signal_stops_every_long_command_soon() {
    let folder = folder();
    fs::write(folder.path().join("long.svg"), long_drawing(300_000)).unwrap();
    assert!(Command::new("mkfifo").arg(folder.path().join("fifo")).status().unwrap().success());
    let before = fs::read_dir(folder.path()).unwrap().count();
    let commands: [&[&str]; 8] = [
        &["draw", "photo.png", "-o", "o.svg", "--page", "a3", "--pitch", "0.4", "-q"],
        &["draw", "photo.png", "-o", "o.svg", "--page", "a3", "--style", "grid", "--pitch", "0.4", "-q"],
        &["draw", "photo.png", "-o", "o.svg", "--page", "a3", "--style", "engrave", "--pitch", "0.4", "-q"],
        &["draw", "photo.png", "-o", "o.svg", "--page", "a3", "--style", "charcoal", "-q"],
        &["draw", "photo.png", "-o", "o.svg", "--page", "a3", "--style", "glass", "-q"],
        &["plot", "long.svg", "-o", "o.gcode", "--profile", "grbl-servo", "-q"],
        &["draw", "-", "-o", "o.svg"],
        &["draw", "fifo", "-o", "o.svg"],
    ];
    for (i, arguments) in commands.iter().enumerate() {
        for (k, (signal, status)) in [("-INT", 130), ("-TERM", 143), ("-HUP", 143)].into_iter().enumerate() {
            let after = Duration::from_millis(300 + 700 * ((i + k) % 3) as u64);
            let Some((code, took)) = stopped(folder.path(), arguments, signal, after) else { continue };
            assert_eq!(code, Some(status), "{arguments:?} {signal}");
            assert!(took < SOON, "{arguments:?} {signal} after {after:?} took {took:?}");
            assert_nothing_new(folder.path(), before, &format!("{arguments:?} {signal}"));
        }
    }
}

#[test]
fn a_signal_while_a_file_is_written_leaves_no_temporary_one() {
    let folder = folder();
    let mut seen = 0;
    let arguments = ["draw", "photo.png", "-o", "o.svg", "--style", "glass", "--page", "a5", "--set", "detail=1", "-q"];
    for signal in ["-TERM", "-INT", "-HUP"] {
        let mut child = start(folder.path(), &arguments);
        let begun =
            || fs::read_dir(folder.path()).unwrap().any(|e| e.unwrap().file_name().to_string_lossy().starts_with(".drypoint-"));
        while child.try_wait().unwrap().is_none() && !begun() {
            std::thread::sleep(Duration::from_millis(1));
        }
        if child.try_wait().unwrap().is_none() {
            seen += 1;
            send(signal, &child);
            // A second signal at once must leave nothing behind either.
            let _ = Command::new("kill").args([signal, &child.id().to_string()]).stderr(Stdio::null()).status();
        }
        child.wait().unwrap();
        let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert!(left.iter().all(|name| !name.to_string_lossy().starts_with(".drypoint-")), "{signal} left {left:?}");
    }
    assert!(seen > 0, "the writing was never met");
}

#[test]
fn a_kill_at_any_of_fifty_moments_leaves_the_old_file_or_the_new_one() {
    let folder = folder();
    let arguments = ["draw", "photo.png", "-o", "o.svg", "--size", "40x40mm", "-q"];
    let started = Instant::now();
    assert!(start(folder.path(), &arguments).wait().unwrap().success());
    let whole = started.elapsed();
    let new = fs::read(folder.path().join("o.svg")).unwrap();
    for moment in 0..50 {
        fs::write(folder.path().join("o.svg"), b"old").unwrap();
        let mut child = start(folder.path(), &arguments);
        std::thread::sleep(whole.mul_f64(f64::from(moment) / 45.0));
        let _ = child.kill();
        child.wait().unwrap();
        let found = fs::read(folder.path().join("o.svg")).unwrap();
        assert!(found == b"old" || found == new, "at moment {moment} of 50: {} bytes", found.len());
    }
}

#[test]
fn an_ignored_signal_stays_ignored() {
    let folder = folder();
    let line = format!("trap '' HUP; exec {} draw photo.png -o o.svg --page a4 -q", env!("CARGO_BIN_EXE_drypoint"));
    let mut child = Command::new("sh").current_dir(folder.path()).args(["-c", &line]).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(200));
    send("-HUP", &child);
    assert!(child.wait().unwrap().success());
    assert!(folder.path().join("o.svg").is_file());
}

#[test]
fn nobody_needs_to_listen_to_stderr() {
    let folder = folder();
    for (ending, stderr) in [("full", "2>/dev/full"), ("closed", "2>&-")] {
        let run = |rest: &str| {
            let line = format!("{} {rest} {stderr}", env!("CARGO_BIN_EXE_drypoint"));
            Command::new("sh").current_dir(folder.path()).args(["-c", &line]).status().unwrap().code()
        };
        let size = "--size 30x30mm --pitch 1";
        assert_eq!(run(&format!("draw photo.png -o o.svg {size}")), Some(0), "{ending}");
        let warns = "--profile grbl-servo --preview p.svg --max-time 1h";
        assert_eq!(run(&format!("draw photo.png -o o.gcode {size} {warns}")), Some(0), "{ending}");
        assert_eq!(run("plot o.svg -o o2.svg --duplicates drop"), Some(0), "{ending}");
        assert_eq!(run(&format!("stages photo.png -o stages {size}")), Some(0), "{ending}");
        assert_eq!(run("calibrate --profile grbl-servo -o sheet.gcode"), Some(0), "{ending}");
        assert_eq!(run("resume o.gcode --path 2 -o rest.gcode"), Some(0), "{ending}");
        assert_eq!(run("draw missing.png -o o.svg"), Some(1), "{ending}");
        assert_eq!(run("draw photo.png -o o.bmp"), Some(2), "{ending}");
    }
}
