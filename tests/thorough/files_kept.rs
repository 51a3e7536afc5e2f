//! No input is destroyed: no output may be an input or another output, however its path is spelled.
#![cfg(feature = "cli")]

use crate::common;

use assert_cmd::Command;
use common::{png_of_light, sample};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use tempfile::TempDir;

fn drypoint(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    command.current_dir(folder);
    command
}

/// A photograph, its mask, links to both, a drawing, a profile and a machine's file.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("photo.png"), png_of_light(48, 64, |x, y| f64::from(x + y) / 112.0)).unwrap();
    fs::write(at("mask.png"), png_of_light(48, 64, |x, _| if x > 10 { 1.0 } else { 0.0 })).unwrap();
    fs::write(at("depth.png"), png_of_light(48, 64, |x, _| f64::from(x) / 48.0)).unwrap();
    fs::write(at("style.toml"), "pitch = \"2mm\"\n").unwrap();
    fs::write(at("pens.toml"), "[1]\nwidth = \"0.3mm\"\n").unwrap();
    symlink("photo.png", at("link.svg")).unwrap();
    fs::hard_link(at("photo.png"), at("hard.svg")).unwrap();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='50mm' height='50mm' viewBox='0 0 50 50'><path d='M5 5H45' stroke='red'/><path d='M5 9H45' stroke='blue'/></svg>";
    fs::write(at("drawing.svg"), svg).unwrap();
    let profile = drypoint(folder.path()).args(["profiles", "grbl-servo"]).output().unwrap().stdout;
    fs::write(at("machine.toml"), profile).unwrap();
    let made = ["plot", "drawing.svg", "-o", "drawing.gcode", "--profile", "grbl-servo", "--pens", "pens.toml"];
    assert!(drypoint(folder.path()).args(made).output().unwrap().status.success());
    fs::create_dir(at("stages")).unwrap();
    fs::write(at("stages/01-tone.png"), sample("chelsea.png")).unwrap();
    folder
}

fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for folder in [folder.to_owned(), folder.join("stages")] {
        let files_here = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
        files.extend(files_here.map(|path| (path.display().to_string(), fs::read(&path).unwrap())));
    }
    files.sort();
    files
}

#[test]
fn no_output_is_an_input_or_another_output() {
    let folder = folder();
    let before = contents(folder.path());
    let svg = ["--format", "svg"];
    let draw = |arguments: &[&'static str]| [&["draw", "photo.png"], arguments].concat();
    let machine = ["-o", "out.gcode", "--profile", "grbl-servo"];
    let cases: Vec<(Vec<&str>, [&str; 2])> = vec![
        (draw(&["-o", "photo.png", svg[0], svg[1]]), ["photo.png", "photo.png"]),
        (draw(&["-o", "./photo.png", svg[0], svg[1]]), ["./photo.png", "photo.png"]),
        (draw(&["-o", "link.svg"]), ["link.svg", "photo.png"]),
        (draw(&["-o", "hard.svg"]), ["hard.svg", "photo.png"]),
        (draw(&["--mask", "subject=mask.png", "-o", "mask.png", svg[0], svg[1]]), ["mask.png", "mask.png"]),
        (draw(&["--style", "engrave", "--depth", "depth.png", "-o", "depth.png", svg[0], svg[1]]), ["depth.png", "depth.png"]),
        (draw(&["--params", "style.toml", "-o", "style.toml", svg[0], svg[1]]), ["style.toml", "style.toml"]),
        (draw(&["--profile", "./machine.toml", "-o", "machine.toml", "--format", "gcode"]), ["machine.toml", "./machine.toml"]),
        (draw(&[&machine[..], &["--pens", "pens.toml", "--preview", "pens.toml"]].concat()), ["pens.toml", "pens.toml"]),
        (draw(&[&machine[..], &["--preview", "photo.png"]].concat()), ["photo.png", "photo.png"]),
        (draw(&[&machine[..], &["--preview", "link.svg"]].concat()), ["link.svg", "photo.png"]),
        (draw(&[&machine[..], &["--preview", "./out.gcode"]].concat()), ["out.gcode", "./out.gcode"]),
        (draw(&[&machine[..], &["--preview", "stages/../out.gcode"]].concat()), ["out.gcode", "stages/../out.gcode"]),
        (vec!["plot", "drawing.svg", "-o", "drawing.svg"], ["drawing.svg", "drawing.svg"]),
        (vec!["plot", "drawing.svg", "-o", "x.svg", "--preview", "./drawing.svg"], ["./drawing.svg", "drawing.svg"]),
        (vec!["plot", "drawing.svg", "-o", "x.svg", "--preview", "./x.svg", "--profile", "axidraw-v3"], ["x.svg", "./x.svg"]),
        (vec!["plot", "drawing.svg", "-o", "same.svg", "--preview", "./same.svg"], ["same.svg", "./same.svg"]),
        (
            vec!["calibrate", "--profile", "machine.toml", "-o", "./machine.toml", "--format", "gcode"],
            ["./machine.toml", "machine.toml"],
        ),
        (vec!["resume", "drawing.gcode", "--path", "1", "-o", "./drawing.gcode"], ["./drawing.gcode", "drawing.gcode"]),
        (vec!["stages", "stages/01-tone.png", "-o", "stages", "--pitch", "2"], ["01-", "stages/01-tone.png"]),
    ];
    for (arguments, named) in cases {
        let output = drypoint(folder.path()).args(&arguments).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(named.iter().all(|name| message.contains(name)), "{arguments:?}: {message}");
        assert!(contents(folder.path()) == before, "{arguments:?} changed a file: {message}");
    }
}

#[test]
fn stdin_is_an_input_too() {
    let folder = folder();
    let before = contents(folder.path());
    let photo = fs::File::open(folder.path().join("photo.png")).unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let command = command.current_dir(folder.path()).args(["draw", "-", "-o", "photo.png", "--format", "svg"]).stdin(photo);
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(contents(folder.path()) == before);
}

#[test]
fn layers_of_one_name_are_not_written_over_one_another() {
    let folder = folder();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' width='50mm' height='50mm' viewBox='0 0 50 50'>\
        <g inkscape:groupmode='layer' inkscape:label='1 ink'><path d='M5 5H45' stroke='red'/></g>\
        <g inkscape:groupmode='layer' inkscape:label='2 ink'><path d='M5 9H45' stroke='red'/></g></svg>";
    fs::write(folder.path().join("twice.svg"), svg).unwrap();
    let arguments = ["plot", "twice.svg", "-o", "{layer}.gcode", "--profile", "grbl-servo"];
    let output = drypoint(folder.path()).args(arguments).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(folder.path().join("ink.gcode").exists() && folder.path().join("ink-2.gcode").exists());
}

#[test]
fn other_links_are_followed_and_devices_take_everything() {
    let folder = folder();
    symlink("new.svg", folder.path().join("other.svg")).unwrap();
    let run = |arguments: &[&str]| drypoint(folder.path()).args(arguments).output().unwrap();
    assert!(run(&["draw", "photo.png", "-o", "other.svg", "-q"]).status.success());
    assert!(folder.path().join("other.svg").is_symlink() && folder.path().join("new.svg").is_file());
    let both = run(&[
        "draw",
        "photo.png",
        "-o",
        "/dev/null",
        "--format",
        "gcode",
        "--profile",
        "grbl-servo",
        "--preview",
        "/dev/null",
        "-q",
    ]);
    assert!(both.status.success(), "{both:?}");
}
