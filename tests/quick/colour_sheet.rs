//! The colour sheet as a user meets it: drawn, photographed, read, and drawn with.
#![cfg(feature = "cli")]

use crate::common::sample;
use crate::photographed::{Chance, Light, photographed};
use drypoint::colour::Lab;
use std::fs;
use std::path::Path;
use std::process::Command;

const PENS: &str = "# My pens.\n[black]\ncolour = \"#26262a\" # the cap\nwidth = \"0.4mm\"\nslot = 3\n\n\
    [yellow]\ncolour = \"#f0d428\"\nslot = 1\nspeed = 30\n\n[blue]\nlab = [50, -10, -40] # by eye\nslot = 2\n";
/// What the pens truly are on the paper.
const TRUE: [(&str, [u8; 3]); 3] = [("yellow", [0xe8, 0xc0, 0x30]), ("blue", [0x20, 0x74, 0xa8]), ("black", [0x34, 0x30, 0x38])];
const SCALE: f64 = 8.0;

fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_drypoint")).current_dir(folder).args(arguments).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

fn done(folder: &Path, arguments: &[&str]) -> String {
    let (status, said) = run(folder, arguments);
    assert_eq!(status, Some(0), "{arguments:?}: {said}");
    said
}

fn with_pens(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pens.toml"), text).unwrap();
    folder
}

fn linear(v: u8) -> f64 {
    let v = f64::from(v) / 255.0;
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// The ink of an SVG on white.
fn rendered(svg: &str) -> Light {
    let tree = resvg::usvg::Tree::from_str(svg, &resvg::usvg::Options::default()).unwrap();
    let scale = (SCALE * 25.4 / 96.0) as f32;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * scale) as u32);
    let mut pixmap = resvg::tiny_skia::Pixmap::new(width, height).unwrap();
    pixmap.fill(resvg::tiny_skia::Color::WHITE);
    resvg::render(&tree, resvg::tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    let pixels = pixmap.pixels().iter().map(|p| [p.red(), p.green(), p.blue()].map(|v| linear(v) as f32)).collect();
    Light { width: width as usize, height: height as usize, pixels }
}

/// The sheet of the pens as they truly are, photographed.
fn photograph(folder: &Path) {
    let colours: String = TRUE
        .map(|(name, [r, g, b])| {
            let width = if name == "black" { "width = 0.4\n" } else { "" };
            format!("[{name}]\ncolour = \"#{r:02x}{g:02x}{b:02x}\"\n{width}")
        })
        .concat();
    fs::write(folder.join("true.toml"), colours).unwrap();
    done(folder, &["calibrate", "--colours", "true.toml", "-o", "true.svg", "--page", "a5", "-q"]);
    let sheet = rendered(&fs::read_to_string(folder.join("true.svg")).unwrap());
    photographed(&sheet, 0.7, &mut Chance::new(7)).save(folder.join("photo.png")).unwrap();
}

#[test]
fn pens_are_measured_and_drawn_with() {
    let folder = with_pens(PENS);
    let folder = folder.path();
    photograph(folder);
    let said = done(folder, &["calibrate", "--colours", "pens.toml", "--read", "photo.png", "-o", "measured.toml"]);
    println!("{said}");
    assert!(said.contains("1 yellow") && said.contains("--colours measured.toml") && !said.contains("warning"), "{said}");
    let text = fs::read_to_string(folder.join("measured.toml")).unwrap();
    let read: toml::Table = toml::from_str(&text).unwrap();
    for (name, colour) in TRUE {
        let lab: Vec<f64> = read[name]["lab"].as_array().unwrap().iter().map(|v| v.as_float().unwrap()).collect();
        let off = Lab { l: lab[0], a: lab[1], b: lab[2] }.difference(Lab::from_rgb(colour.map(linear)));
        println!("{name}: {lab:?}, {off:.2} off");
        assert!(off <= 2.0, "{name}: {lab:?}, {off} off");
    }
    // What lies over another pen is darker than either.
    let (upper, lower) = read.iter().find_map(|(_, pen)| Some((pen, pen.get("over")?.as_table()?.iter().next()?))).unwrap();
    let light = |lab: &toml::Value| lab[0].as_float().unwrap();
    println!("over {}: {} where it is {} itself", lower.0, lower.1, upper["lab"]);
    assert!(light(lower.1) <= light(&upper["lab"]) + 1.0 && light(lower.1) <= light(&read[lower.0]["lab"]) + 1.0, "{text}");
    let over_all: Vec<&toml::Value> = read.values().filter_map(|pen| pen.get("over_all")).collect();
    assert!(over_all.len() == 1 && light(over_all[0]) <= light(&upper["lab"]) + 1.0, "{text}");
    // All else is as it was.
    let kept = |text: &str| {
        text.lines().filter(|line| !line.starts_with("lab") && !line.starts_with("over")).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(kept(&text), kept(PENS));
    assert!(text.contains("] # by eye"), "{text}");
    fs::write(folder.join("cat.png"), sample("chelsea.png")).unwrap();
    done(folder, &["draw", "cat.png", "-o", "cat.svg", "--colours", "measured.toml", "--size", "40x30mm", "--sight=none"]);
    assert_eq!(fs::read_to_string(folder.join("pens.toml")).unwrap(), PENS);
    // An overprint that was measured counts, and one with a pen that is not there is told.
    let drawn = |name: &str, text: &str| {
        fs::write(folder.join("other.toml"), text).unwrap();
        run(folder, &["draw", "cat.png", "-o", name, "--colours", "other.toml", "--size", "40x30mm", "--sight=none", "-q"])
    };
    let alone = text.lines().filter(|line| !line.starts_with("over")).collect::<Vec<_>>().join("\n") + "\n";
    assert_eq!(drawn("alone.svg", &alone).0, Some(0));
    let marks = |name: &str| fs::read_to_string(folder.join(name)).unwrap().split_once("<g").unwrap().1.len();
    assert_ne!(marks("alone.svg"), marks("cat.svg"));
    let paler: String = text
        .lines()
        .map(|line| if line.starts_with("over_all") { "over_all = [60, 0, 0]" } else { line }.to_owned() + "\n")
        .collect();
    assert_eq!(drawn("paler.svg", &paler).0, Some(0));
    assert_ne!(marks("paler.svg"), marks("cat.svg"));
    let (status, said) = drawn("none.svg", &format!("{alone}over = {{ nobody = [1, 2, 3] }}\n"));
    assert!(status == Some(1) && said.contains("a colour over 'nobody', which is no pen of this file"), "{said}");
}

#[test]
fn sheets_are_drawn_for_print_and_for_machines_light_pens_first() {
    let folder = with_pens(PENS);
    let folder = folder.path();
    for more in [
        &["-o", "sheet.svg"][..],
        &["-o", "sheet.pdf"],
        &["-o", "sheet.gcode", "--profile", "grbl-servo", "--preview", "preview.svg"],
        &["-o", "sheet.hpgl", "--profile", "hp7475a"],
        &["-o", "{layer}.gcode", "--profile", "grbl-servo"],
    ] {
        let said = done(folder, &[&["calibrate", "--colours", "pens.toml"], more].concat());
        assert!(said.contains("1 yellow, 2 blue, 3 black") && said.contains("--read PHOTO"), "{said}");
    }
    for file in ["sheet.pdf", "sheet.gcode", "sheet.hpgl", "yellow.gcode", "blue.gcode", "black.gcode"] {
        assert!(fs::metadata(folder.join(file)).unwrap().len() > 1000, "{file}");
    }
    for file in ["sheet.svg", "preview.svg"] {
        let svg = fs::read_to_string(folder.join(file)).unwrap();
        let places = ["yellow", "blue", "black"].map(|name| svg.find(name).unwrap());
        assert!(places.is_sorted(), "{file}: {places:?}");
    }
    let dry = done(folder, &["calibrate", "--colours", "pens.toml", "-o", "dry.svg", "--dry-run"]);
    assert!(dry.contains("3 black") && !folder.join("dry.svg").exists());
}

#[test]
fn dark_pens_in_early_slots_are_told() {
    let folder = with_pens("[black]\ncolour = \"#222\"\nslot = 1\n[yellow]\ncolour = \"#f0d428\"\nslot = 2\n");
    let said = done(folder.path(), &["calibrate", "--colours", "pens.toml", "-o", "a.gcode", "--profile", "grbl-servo"]);
    assert!(said.contains("black (slot 1) is drawn before yellow (slot 2)") && said.contains("yellow, black"), "{said}");
}

#[test]
fn bad_pens_are_told_with_what_to_do() {
    let dark = "[black]\ncolour = \"#222\"\n";
    for (text, status, told) in [
        (format!("{dark}[ink]\ncolour = \"#232323\"\n"), 0, "ink and black have nearly the same colour"),
        ("[pink]\ncolour = \"#ffc8d4\"\n".to_owned(), 1, "no pen is dark enough on this paper"),
        ("[red]\ncolour = \"#e04040\"\n".to_owned(), 0, "no pen is dark"),
        (format!("{dark}[white]\ncolour = \"#fefefe\"\n"), 1, "white can hardly be seen on this paper"),
        (format!("{dark}[glow]\nlab = [100, -90, 60]\n"), 1, "glow cannot have this colour: nothing reflects so much light"),
        (format!("{dark}[sun]\nlab = [100, 20, 20]\n"), 1, "sun cannot have this colour on this paper"),
        (format!("{dark}[bare]\nwidth = 0.3\n"), 1, "[bare] needs its colour on this paper"),
        (format!("{dark}slot = 1\n[red]\ncolour = \"red\"\nslot = 1\n"), 1, "both in slot 1; give each pen a slot of its own"),
        (format!("{dark}width = 9\n"), 1, "take a larger page"),
        (String::new(), 1, "there are no pens"),
    ] {
        let folder = with_pens(&text);
        let (code, said) = run(folder.path(), &["calibrate", "--colours", "pens.toml", "-o", "sheet.svg", "-q"]);
        assert!(code == Some(status) && said.contains(told) && said.lines().count() == 1, "{text:?}: {code:?} {said}");
        assert_eq!(folder.path().join("sheet.svg").exists(), status == 0, "{text:?}");
    }
}

#[test]
fn what_cannot_be_read_is_told_and_nothing_is_overwritten() {
    let folder = with_pens(PENS);
    let folder = folder.path();
    photograph(folder);
    fs::write(folder.join("cat.png"), sample("chelsea.png")).unwrap();
    fs::write(folder.join("two.toml"), "[red]\ncolour = \"red\"\n[black]\ncolour = \"#222\"\n").unwrap();
    let pens = fs::read(folder.join("pens.toml")).unwrap();
    let picture = fs::read(folder.join("photo.png")).unwrap();
    let read =
        |pens: &str, picture: &str, output: &str| run(folder, &["calibrate", "--colours", pens, "--read", picture, "-o", output]);
    for (pens, picture, output, status, told) in [
        ("pens.toml", "cat.png", "out.toml", 1, "cat.png shows no colour sheet; photograph it from above"),
        ("pens.toml", "none.png", "out.toml", 1, "none.png does not exist"),
        ("two.toml", "photo.png", "out.toml", 1, "photo.png shows a sheet of 3 pens, but 2 are given"),
        ("pens.toml", "photo.png", "pens.toml", 2, "pens.toml would overwrite the input pens.toml"),
        ("pens.toml", "photo.png", "photo.png", 2, "photo.png would overwrite the input photo.png"),
    ] {
        let (code, said) = read(pens, picture, output);
        assert!(code == Some(status) && said.contains(told) && said.lines().count() == 1, "{pens} {picture} {output}: {said}");
    }
    assert!(!folder.join("out.toml").exists());
    assert_eq!((pens, picture), (fs::read(folder.join("pens.toml")).unwrap(), fs::read(folder.join("photo.png")).unwrap()));
    assert_eq!(run(folder, &["calibrate", "--read", "photo.png", "-o", "out.toml"]).0, Some(2));
    assert_eq!(run(folder, &["calibrate", "-o", "out.gcode"]).0, Some(2));
}

#[test]
fn pens_that_were_swapped_are_told() {
    let folder = with_pens(PENS);
    let folder = folder.path();
    photograph(folder);
    // The light pen is blue here and the darker one yellow; on the sheet it is the other way round.
    let other = "[sky]\ncolour = \"#90d8ff\"\n[brown]\ncolour = \"#907020\"\n[black]\ncolour = \"#222\"\nwidth = 0.4\n";
    fs::write(folder.join("other.toml"), other).unwrap();
    let said = done(folder, &["calibrate", "--colours", "other.toml", "--read", "photo.png", "-o", "-", "-q"]);
    assert!(said.contains("were the pens swapped") && said.contains("sky") && said.contains("brown"), "{said}");
}
