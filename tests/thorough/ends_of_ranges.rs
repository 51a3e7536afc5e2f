//! Every parameter of every style can be set to either end of its range.
#![cfg(feature = "cli")]

use crate::common;

use assert_cmd::Command;
use common::sample;
use drypoint::style::{Kind, STYLES};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Time limit of one drawing; on an idle machine the slowest takes a quarter of a minute, but this one may be busy.
const MOST: Duration = Duration::from_mins(4);
/// Drawings made at the same time.
const MOST_WORKERS: usize = 2;

/// Every parameter with each value to try: both ends, or all words, or places.
fn values() -> Vec<(&'static str, &'static str, String)> {
    let of = |kind: &Kind| match *kind {
        Kind::Choice(words) => words.iter().map(|word| (*word).to_owned()).collect(),
        Kind::Places { .. } => vec![String::new(), "0,0; 100,100".to_owned()],
        _ => kind.ends().unwrap().map(|end| end.to_string()).to_vec(),
    };
    let parameters = STYLES.iter().flat_map(|style| style.parameters().iter().map(|parameter| (style.name(), parameter)));
    parameters
        .flat_map(|(style, parameter)| of(&parameter.kind).into_iter().map(move |value| (style, parameter.name, value)))
        .collect()
}

/// The fault of a drawing at an end, if any; "nothing to draw" is no fault.
fn fault(folder: &tempfile::TempDir, style: &str, name: &str, value: &str) -> Option<String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    command.current_dir(folder.path()).timeout(MOST).args([
        "draw",
        "face.jpg",
        "--size",
        "12x14mm",
        "--fit",
        "cover",
        "-q",
        "--tone",
        "lightness",
    ]);
    command.args(["--style", style, "--set", &format!("{name}={value}"), "-o", "/dev/null", "--format", "svg", "--threads", "1"]);
    if cfg!(feature = "see") {
        command.args(["--sight", "sight"]);
    }
    let output = command.output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    match output.status.code() {
        Some(0) => None,
        Some(1) if message.contains("there is nothing to draw") => None,
        status => Some(format!("{style} {name}={value}: {status:?} {message}")),
    }
}

#[test]
fn both_ends_of_every_parameter_are_drawn() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("face.jpg"), sample("astronaut.jpg")).unwrap();
    if cfg!(feature = "see") {
        // Analysed once for all drawings.
        let mut see = Command::new(env!("CARGO_BIN_EXE_drypoint"));
        see.current_dir(folder.path()).args(["see", "face.jpg", "-o", "sight", "-q"]).assert().success();
    }
    let values = values();
    assert!(values.len() > 200, "{} values", values.len());
    let (next, faults, slowest) = (AtomicUsize::new(0), Mutex::new(Vec::new()), Mutex::new((Duration::ZERO, String::new())));
    std::thread::scope(|scope| {
        for _ in 0..MOST_WORKERS {
            scope.spawn(|| {
                while let Some((style, name, value)) = values.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let begun = Instant::now();
                    let found = fault(&folder, style, name, value);
                    faults.lock().unwrap().extend(found);
                    let mut slowest = slowest.lock().unwrap();
                    if begun.elapsed() > slowest.0 {
                        *slowest = (begun.elapsed(), format!("{style} {name}={value}"));
                    }
                }
            });
        }
    });
    println!("{} drawings, the slowest {:?}", values.len(), slowest.lock().unwrap());
    assert!(faults.lock().unwrap().is_empty(), "{}", faults.lock().unwrap().join("\n"));
}
