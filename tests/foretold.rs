//! Time, marks and ink are estimated before the work is done: about right, and without doing it.
#![cfg(feature = "cli")]

mod common;

use assert_cmd::Command;
use common::sample;
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::Stdio;
use std::time::Duration;
use tempfile::TempDir;

const PENS: &str = "[a]\ncolour = \"black\"\nslot = 1\n[b]\ncolour = \"red\"\nslot = 2\n[c]\ncolour = \"blue\"\nslot = 3\n";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("face.jpg"), sample("astronaut.jpg")).unwrap();
    fs::write(folder.path().join("pens.toml"), PENS).unwrap();
    folder
}

/// Status, standard output as JSON if it parses, and the message.
fn run(folder: &TempDir, arguments: &[&str]) -> (Option<i32>, Value, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let output = command.current_dir(folder.path()).args(arguments).timeout(Duration::from_mins(5)).output().unwrap();
    let json = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    (output.status.code(), json, String::from_utf8(output.stderr).unwrap())
}

fn marks(report: &Value) -> f64 {
    let count = |layer: &Value| ["dots", "strokes", "areas"].iter().filter_map(|kind| layer[kind].as_f64()).sum::<f64>();
    report["layers"].as_array().unwrap().iter().map(count).sum()
}

#[test]
fn an_estimate_is_near_what_is_drawn() {
    let folder = folder();
    for (style, more) in [
        ("hedcut", &[][..]),
        ("grid", &[]),
        ("engrave", &["--size", "150x150mm"]),
        ("charcoal", &[]),
        ("glass", &["--set", "colors=mono"]),
    ] {
        let asked = ["draw", "face.jpg", "--style", style, "--margin", "15", "--profile", "axidraw-v3-a3", "--order", "fast"];
        let asked = [&asked[..], &["-o", "out.svg", "--json"], more].concat();
        let (_, told, message) = run(&folder, &[&asked[..], &["--dry-run"]].concat());
        assert!(!folder.path().join("out.svg").exists());
        let share = told["estimate"]["share_drawn"].as_f64().expect(&message);
        assert!(share < 0.6, "{style} draws {share} of it");
        let (_, found, message) = run(&folder, &asked);
        fs::remove_file(folder.path().join("out.svg")).expect(&message);
        let ratio = |what: &dyn Fn(&Value) -> f64| what(&told) / what(&found);
        let seconds = ratio(&|report| report["total"]["seconds"].as_f64().unwrap());
        let ink = ratio(&|report| report["total"]["pen_down_mm"].as_f64().unwrap());
        let marks = ratio(&marks);
        println!(
            "{style}: told of found: {seconds:.2} of the time, {ink:.2} of the line, {marks:.2} of the marks, from {share:.3}"
        );
        // Charcoal's few lines among many stamps are told worst.
        assert!((0.75..1.35).contains(&seconds) && (0.7..1.45).contains(&ink), "{style}: {seconds} {ink}");
        // Without a face the regions of an engraving end at the borders of the parts that are drawn, and its marks with them.
        let most = if style == "engrave" && !cfg!(feature = "see") { 1.6 } else { 1.45 };
        assert!((0.7..most).contains(&marks), "{style}: {marks}");
    }
}

#[test]
fn glass_on_pens_is_told_without_being_cut() {
    let folder = folder();
    let asked = ["draw", "face.jpg", "--style", "glass", "--page", "a3", "--pens", "pens.toml", "--profile", "axidraw-v3-a3"];
    let (status, told, message) = run(&folder, &[&asked[..], &["-o", "out.svg", "--dry-run", "--json"]].concat());
    assert_eq!(status, Some(0), "{message}");
    assert!(told["total"]["seconds"].as_f64().unwrap() > 20.0 * 3600.0, "{told}");
    assert!(told["estimate"]["share_drawn"].as_f64().unwrap() < 0.02, "{told}");
    assert!(message.contains("this plot will take about"), "{message}");
}

#[test]
fn a_huge_drawing_is_told_from_little_of_it() {
    let folder = folder();
    // Without a face an engraving takes more memory.
    let engraved = if cfg!(feature = "see") { "a1" } else { "a3" };
    for (style, page) in [("hedcut", "a1"), ("grid", "a1"), ("engrave", engraved), ("charcoal", "a3"), ("glass", "a1")] {
        let (status, told, message) =
            run(&folder, &["draw", "face.jpg", "--style", style, "--page", page, "--dry-run", "--json", "-o", "out.svg"]);
        assert_eq!(status, Some(0), "{style}: {message}");
        assert!(told["estimate"]["share_drawn"].as_f64().unwrap() < 0.1, "{style}: {told}");
        assert!(told["estimate"]["memory_bytes"].as_f64().unwrap() > 1e8, "{style}: {told}");
    }
}

#[test]
fn a_long_plot_is_warned_of_before_it_is_drawn() {
    let folder = folder();
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_drypoint"))
        .current_dir(folder.path())
        .args(["draw", "face.jpg", "--page", "a3", "--pitch", "0.4mm", "--profile", "axidraw-v3-a3", "-o", "out.svg"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let first = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap).find(|line| line.contains("warning"));
    // The drawing itself takes most of a minute; do not wait for it.
    let is_running = child.try_wait().unwrap().is_none();
    child.kill().unwrap();
    child.wait().unwrap();
    let first = first.unwrap();
    assert!(is_running && first.contains("this plot will take about") && first.contains("--pitch"), "{first}");
    assert!(!folder.path().join("out.svg").exists());
}

#[test]
fn where_no_pitch_helps_a_size_on_the_same_sheet_does() {
    let folder = folder();
    let asked = ["draw", "face.jpg", "--page", "a4", "--pitch", "5mm", "--pen", "0.3mm", "--speed", "2"];
    let asked = [&asked[..], &["--profile", "axidraw-v3", "-o", "out.svg", "--dry-run"]].concat();
    let (_, _, message) = run(&folder, &asked);
    let advice = message.lines().find(|line| line.contains("warning")).expect(&message);
    assert!(advice.contains("--size ") && advice.contains("--page a4"), "{advice}");
    let after = |option: &str| advice.split_once(option).unwrap().1.split(' ').next().unwrap();
    let (size, pitch) = (after("--size "), after("--pitch "));
    let smaller: Vec<&str> = asked.iter().map(|word| if *word == "5mm" { pitch } else { *word }).collect();
    let (_, told, message) = run(&folder, &[&smaller[..], &["--size", size, "--json"]].concat());
    let hours = told["total"]["seconds"].as_f64().expect(&message) / 3600.0;
    println!("{advice}: {hours:.2} h");
    assert!((1.4..2.6).contains(&hours), "{advice}: {hours} h");
    let (status, _, message) = run(&folder, &[&asked[..], &["--max-time", "30min"]].concat());
    assert!(status == Some(1) && message.contains("--size ") && message.contains("--page a4"), "{message}");
}

#[test]
fn what_a_refusal_advises_fits_the_sheet() {
    let folder = folder();
    let asked = ["draw", "face.jpg", "--pitch", "3mm", "--profile", "hp7475a", "-o", "out.hpgl", "--order", "fast"];
    let on_sheet = [&asked[..], &["--page", "a4", "--margin", "0", "--fit", "cover", "--size"]].concat();
    let (status, _, message) = run(&folder, &[&on_sheet[..], &["210x297mm"]].concat());
    assert_eq!(status, Some(1), "{message}");
    let advised = message.split_once("with --size ").expect(&message).1.split_once(',').expect(&message).0;
    let (status, _, message) = run(&folder, &[&on_sheet[..], &[advised]].concat());
    assert_eq!(status, Some(0), "{advised}: {message}");
}

#[test]
fn the_plot_of_an_svg_is_told_from_windows_of_it() {
    let folder = folder();
    let drawn = run(&folder, &["draw", "face.jpg", "--style", "glass", "--size", "40x40mm", "--margin", "5", "-o", "paint.svg"]);
    assert_eq!(drawn.0, Some(0), "{}", drawn.2);
    for (more, most) in [(&["--occlude"][..], 0.5), (&["--ink-model", "lines"], 1.01)] {
        let asked = ["plot", "paint.svg", "--pens", "pens.toml", "--profile", "axidraw-v3", "-o", "out.svg", "--order", "fast"];
        let asked = [&asked[..], &["--json"], more].concat();
        let (_, told, message) = run(&folder, &[&asked[..], &["--dry-run"]].concat());
        assert!(!folder.path().join("out.svg").exists());
        let share = told["estimate"]["share_plotted"].as_f64().expect(&message);
        let (_, found, message) = run(&folder, &asked);
        fs::remove_file(folder.path().join("out.svg")).expect(&message);
        let ratio = |key: &str| told["total"][key].as_f64().unwrap() / found["total"][key].as_f64().unwrap();
        println!("{more:?}: {:.2} of the time, {:.2} of the line, from {share:.2}", ratio("seconds"), ratio("pen_down_mm"));
        assert!(share <= most, "{more:?}: {share}");
        assert!((0.75..1.35).contains(&ratio("seconds")) && (0.7..1.4).contains(&ratio("pen_down_mm")), "{more:?}: {told}");
    }
}

#[test]
fn an_empty_part_of_the_box_is_told_once() {
    let folder = folder();
    let told = |more: &[&str]| {
        let (status, _, message) = run(&folder, &[&["draw", "face.jpg", "--pitch", "2mm", "-o", "out.svg"][..], more].concat());
        assert_eq!(status, Some(0), "{message}");
        message.matches("--fit cover fills the box").count()
    };
    assert_eq!(told(&["--size", "38x50mm"]), 1);
    assert_eq!(told(&["--size", "38x50mm", "-q"]), 0);
    assert_eq!(told(&["--size", "38x50mm", "--fit", "cover"]), 0);
    assert_eq!(told(&["--size", "38x39mm"]), 0);
    assert_eq!(told(&["--page", "a6"]), 0);
}
