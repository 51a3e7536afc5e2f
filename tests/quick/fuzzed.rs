//! The fuzzer's seeds and findings go through the same functions that the fuzzer calls: `fuzz/seeds` and `tests/data/fuzz`, one
//! folder per target.
#![cfg(feature = "cli")]

use crate::checks;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Time limit per input, in seconds. The fuzzer reports what takes 20; a busy machine without optimisation gets more.
const LONGEST: u64 = 120;
/// Maximum size of a kept input, in bytes; findings are minimised first.
const LARGEST: u64 = 100_000;
/// Memory limit of the whole test in kB, the same as the fuzzer's.
const MOST_MEMORY: u64 = 2_000_000;

fn inputs(target: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [root.join("fuzz/seeds").join(target), root.join("tests/data/fuzz").join(target)];
    let files = |folder: &PathBuf| std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()).collect();
    let mut all: Vec<PathBuf> = folders.iter().flat_map::<Vec<_>, _>(files).collect();
    all.sort();
    assert!(!all.is_empty(), "no input for {target}");
    all
}

/// Runs each input within its time limit; on a panic the last line printed names the input.
fn replay(target: &str, check: fn(&[u8])) {
    for path in inputs(target) {
        println!("{}", path.display());
        let bytes = std::fs::read(&path).unwrap();
        assert!(bytes.len() as u64 <= LARGEST, "{} bytes", bytes.len());
        let (done, is_done) = channel();
        let work = std::thread::spawn(move || {
            check(&bytes);
            let _ = done.send(());
        });
        match is_done.recv_timeout(Duration::from_secs(LONGEST)) {
            Err(RecvTimeoutError::Timeout) => panic!("{} takes more than {LONGEST} s", path.display()),
            _ => assert!(work.join().is_ok(), "{} fails", path.display()),
        }
    }
    if let Some(most) = most_memory() {
        assert!(most <= MOST_MEMORY, "{target} took {most} kB");
    }
}

/// Peak memory of this process so far, in kB, if the system reports it.
fn most_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?.trim().trim_end_matches(" kB").parse().ok()
}

#[test]
fn photographs() {
    replay("photograph", checks::photograph::check);
}

#[test]
fn svgs() {
    replay("svg", checks::svg::check);
}

#[test]
fn hpgl() {
    replay("hpgl", checks::hpgl::check);
}

#[test]
fn gcode() {
    replay("gcode", checks::gcode::check);
}

#[test]
fn profiles() {
    replay("profile", checks::profile::check);
}

#[test]
fn pens() {
    replay("pens", checks::pens::check);
}

#[test]
fn drawings() {
    replay("drawing", checks::drawing::check);
}
