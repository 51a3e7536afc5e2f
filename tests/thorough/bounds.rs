//! Nibs, tolerances and scales have ranges; what would not fit into memory is refused before work begins, and the message says
//! what would fit.
#![cfg(feature = "cli")]

use crate::common;

use assert_cmd::Command;
use common::{png_of_light, sample};
use drypoint::geometry::Rect;
use drypoint::style::{Settings, find};
use std::fs;
use std::time::Duration;
use tempfile::TempDir;

/// A folder with a photograph and a drawing of one curve in it.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    put("photo.png", &png_of_light(48, 64, |x, y| f64::from(x + y) / 112.0));
    put("face.jpg", &sample("astronaut.jpg"));
    put("curve.svg", br#"<svg xmlns="http://www.w3.org/2000/svg" width="50mm" height="50mm" viewBox="0 0 50 50"><path d="M5,5 C40,5 40,45 45,45" stroke="black" fill="none"/></svg>"#);
    folder
}

/// Exit status and message of a command, which is killed if it does far more than it should.
fn run(folder: &TempDir, arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let output = command.current_dir(folder.path()).args(arguments).timeout(Duration::from_mins(4)).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn nibs_tolerances_and_scales_out_of_range_are_refused_with_the_range() {
    let folder = folder();
    for (option, values, range) in [
        ("--tolerance", ["1e-300", "1e-9mm", "0", "2mm", "1e300"], "0.001 to 1 mm"),
        ("--pen", ["1e-300", "1e-9mm", "0", "21mm", "1e300"], "0.01 to 20 mm"),
        ("--scale", ["1e-300", "1e-9", "0", "1001", "1e300"], "0.001 to 1000"),
    ] {
        for value in values {
            let (status, message) = run(&folder, &["plot", "curve.svg", option, value, "-o", "out.svg"]);
            assert!(status == Some(2) && message.contains(range), "plot {option} {value}: {message}");
            if option != "--scale" {
                let (status, message) = run(&folder, &["draw", "photo.png", option, value, "-o", "out.svg"]);
                assert!(status == Some(2) && message.contains(range), "draw {option} {value}: {message}");
            }
        }
        let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
        let help = String::from_utf8(command.args(["plot", "--help"]).output().unwrap().stdout).unwrap();
        let words: Vec<&str> = help.split_whitespace().collect();
        assert!(words.join(" ").contains(range), "the help says {range}");
    }
    for (arguments, status) in [
        (["--tolerance", "0.001mm", "--pen", "0.01mm"], Some(0)),
        (["--tolerance", "1mm", "--pen", "20mm"], Some(0)),
        (["--scale", "0.001", "--pen", "0.3mm"], Some(0)),
        (["--scale", "1000", "--pen", "0.3mm"], Some(0)),
    ] {
        let (found, message) = run(&folder, &[&["plot", "curve.svg", "-o", "out.svg"][..], &arguments].concat());
        assert_eq!(found, status, "{arguments:?}: {message}");
    }
}

#[test]
fn ink_that_no_plotter_draws_is_refused_before_it_is_laid_out() {
    let folder = folder();
    let dot = |i: usize| format!("<circle cx=\"{}\" cy=\"{}\" r=\"0.3\"/>", i % 63, i / 63);
    let dots = (0..4000).map(dot).collect::<Vec<_>>().concat();
    let svg =
        format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"64mm\" height=\"64mm\" viewBox=\"0 0 64 64\">{dots}</svg>");
    fs::write(folder.path().join("dots.svg"), svg).unwrap();
    for more in [&[][..], &["--dry-run"]] {
        let asked = ["plot", "dots.svg", "--ink-model", "ink", "--scale", "1000", "-o", "out.svg"];
        let (status, message) = run(&folder, &[&asked[..], more].concat());
        assert!(status == Some(1) && message.contains("km of line") && message.contains("--pen"), "{message}");
    }
}

#[test]
fn widths_of_pens_have_the_same_range() {
    let folder = folder();
    for (width, is_refused) in
        [("\"1e-9mm\"", true), ("1e-300", true), ("20.5", true), ("100", true), ("0.01", false), ("\"20mm\"", false)]
    {
        fs::write(folder.path().join("pens.toml"), format!("[1]\nwidth = {width}\n")).unwrap();
        let (status, message) = run(&folder, &["plot", "curve.svg", "--pens", "pens.toml", "-o", "out.svg"]);
        assert_eq!(status == Some(1), is_refused, "{width}: {message}");
        assert!(!is_refused || message.contains("[1] width takes a length from 0.01 to 20 mm"), "{width}: {message}");
    }
}

#[test]
fn a_drawing_beyond_four_gigabytes_is_refused_and_the_advice_fits() {
    let folder = folder();
    for (style, pitch) in [("hedcut", "0.2"), ("grid", "0.2"), ("engrave", "0.2"), ("charcoal", "0.3"), ("glass", "0.2")] {
        let asked = ["draw", "face.jpg", "--style", style, "-o", "out.svg"];
        let large: &[&str] = &["--size", "900x900mm", "--pitch", pitch];
        let (status, message) = run(&folder, &[&asked[..], large].concat());
        assert_eq!(status, Some(1), "{style}: {message}");
        assert!(message.contains("GB of memory") && message.contains("at most 4.0 GB"), "{style}: {message}");
        let after = |option: &str| {
            message.split_once(option).map(|(_, rest)| rest.trim().split([' ', ',']).next().unwrap().trim().to_owned())
        };
        let size = after("--size").expect(&message);
        let mut ways = vec![vec!["--size".to_owned(), size, "--pitch".to_owned(), pitch.to_owned()]];
        if let Some(larger) = after("--pitch") {
            ways.push(["--size", "900x900mm", "--pitch", &larger].map(str::to_owned).to_vec());
        }
        for way in ways {
            let way: Vec<&str> = way.iter().map(String::as_str).collect();
            let (status, message) = run(&folder, &[&asked[..], &way, &["--dry-run"]].concat());
            assert_eq!(status, Some(0), "{style} {way:?}: {message}");
        }
    }
    assert!(!folder.path().join("out.svg").exists());
}

#[test]
fn a_strip_is_not_blown_up_beyond_bounds() {
    let charcoal = find("charcoal").unwrap();
    let settings = Settings::resolve("charcoal", charcoal.parameters(), &[]).unwrap();
    let pixels = |width: f64, height: f64| {
        let picture = Rect::new(0.0, 0.0, width, height);
        picture.area() * charcoal.resolution(&settings, &[], picture).powi(2)
    };
    assert!((pixels(90.0, 120.0) / (600.0 * 800.0) - 1.0).abs() < 0.01, "portraits as before");
    assert!(pixels(2.5, 120.0) < 750_000.0 && pixels(1000.0, 1.0) < 750_000.0);
}
