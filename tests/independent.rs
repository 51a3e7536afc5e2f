//! Programs that others wrote read what drypoint writes.

mod common;

use common::{sample, skip};
use std::process::Command;

/// Runs a program, or says that the check is skipped where it is not installed.
fn run(program: &str, arguments: &[&str]) -> Option<String> {
    let Ok(output) = Command::new(program).args(arguments).output() else {
        skip(&format!("{program} is not installed"));
        return None;
    };
    Some(format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr)))
}

#[test]
fn hp2xx_ignores_no_command_and_meets_nothing_unexpected() {
    let folder = tempfile::tempdir().unwrap();
    let (hpgl, svg) = (folder.path().join("a.hpgl"), folder.path().join("a.svg"));
    let photo = folder.path().join("cat.png");
    std::fs::write(&photo, sample("chelsea.png")).unwrap();
    let status = Command::new(env!("CARGO_BIN_EXE_drypoint"))
        .args(["draw", photo.to_str().unwrap(), "-q", "--profile", "hp7475a", "--pitch", "1.2", "-o", hpgl.to_str().unwrap()])
        .status()
        .unwrap();
    assert!(status.success());
    let Some(words) = run("hp2xx", &["-t", "-m", "svg", "-f", svg.to_str().unwrap(), hpgl.to_str().unwrap()]) else { return };
    assert!(words.contains("HPGL command(s) ignored: 0"), "{words}");
    assert!(words.contains("Unexpected event(s):  0"), "{words}");
    // 1/40 mm a unit there, 0.02488 mm here: hp2xx shows everything half a percent larger.
    assert!(svg.exists());
}
