//! `--colours`: a photograph in the pens of a box.
#![cfg(feature = "cli")]

use crate::common::sample;
use image::{ImageBuffer, Rgb};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const CMYK: &str = "[black]\ncolour = \"#1c1c1e\"\n[cyan]\ncolour = \"#0095d0\"\n[magenta]\ncolour = \"#d4127c\"\n[yellow]\ncolour = \"#ffe01a\"\n";

fn draw(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    command.current_dir(folder).arg("draw").args(arguments).args(["--sight=none", "-q"]).output().unwrap()
}

fn drawn(folder: &Path, arguments: &[&str]) {
    let output = draw(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

fn with_pens(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pens.toml"), text).unwrap();
    folder
}

/// Pictures of one colour, 40 x 40 mm.
fn flat(folder: &Path, colour: [u8; 3]) {
    ImageBuffer::from_pixel(100, 100, Rgb(colour)).save(folder.join("flat.png")).unwrap();
}

/// The marks of each layer: x, y, radius.
fn dots(folder: &Path, file: &str) -> Vec<(String, Vec<[f64; 3]>)> {
    let drawing: Value = serde_json::from_slice(&fs::read(folder.join(file)).unwrap()).unwrap();
    let of = |layer: &Value| (layer["name"].as_str().unwrap().to_owned(), serde_json::from_value(layer["dots"].clone()).unwrap());
    drawing["layers"].as_array().unwrap().iter().map(of).collect()
}

/// Variation of the distance to the nearest dot, away from the border.
fn variation(dots: &[[f64; 3]]) -> f64 {
    let inside = dots.iter().filter(|[x, y, _]| (5.0..35.0).contains(x) && (5.0..35.0).contains(y));
    let nearest = |a: &[f64; 3]| {
        let others = dots.iter().filter(|b| *b != a);
        others.map(|b| (a[0] - b[0]).hypot(a[1] - b[1])).fold(f64::INFINITY, f64::min)
    };
    let distances: Vec<f64> = inside.map(nearest).collect();
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    (distances.iter().map(|d| (d - mean) * (d - mean)).sum::<f64>() / distances.len() as f64).sqrt() / mean
}

#[test]
fn dots_of_each_pen_and_of_all_are_even() {
    // Three pens, on patches where they find room beside one another.
    let folder = with_pens(CMYK.split_once("[cyan]").map(|(_, rest)| format!("[cyan]{rest}")).unwrap().as_str());
    for colour in [[205, 200, 212], [225, 210, 205], [215, 215, 200]] {
        flat(folder.path(), colour);
        drawn(folder.path(), &["flat.png", "-o", "flat.json", "--colours", "pens.toml", "--size", "40x40mm"]);
        let layers = dots(folder.path(), "flat.json");
        let all: Vec<[f64; 3]> = layers.iter().flat_map(|(_, dots)| dots.clone()).collect();
        assert!(layers.len() == 3, "{colour:?} needs three pens");
        assert!(variation(&all) <= 0.2, "{colour:?}: all {}", variation(&all));
        for (name, own) in layers.iter().filter(|(_, own)| own.len() * 20 > all.len()) {
            println!("{colour:?} {name}: {} of {}, variation {:.3}", own.len(), all.len(), variation(own));
            assert!(variation(own) <= 0.2, "{colour:?} {name}: {}", variation(own));
        }
    }
}

#[test]
fn light_pens_come_first_and_the_paper_is_kept() {
    let folder = with_pens(&format!("{CMYK}[white]\ncolour = \"white\"\nopaque = true\nslot = 5\n"));
    fs::write(folder.path().join("cat.png"), sample("chelsea.png")).unwrap();
    drawn(folder.path(), &["cat.png", "-o", "cat.svg", "--colours", "pens.toml", "--paper", "#c9b28f", "--size", "40x30mm"]);
    let svg = fs::read_to_string(folder.path().join("cat.svg")).unwrap();
    let places: Vec<usize> =
        ["yellow", "cyan", "black", "white"].iter().map(|name| svg.find(&format!(" {name}\"")).unwrap_or(0)).collect();
    assert!(places.is_sorted() && places[0] > 0, "{places:?}");
    assert!(svg.contains("fill=\"#c9b28f\"") && svg.contains("mix-blend-mode:multiply"));
    let white = svg.lines().flat_map(|line| line.split('<')).find(|tag| tag.contains(" white\"")).unwrap();
    assert!(!white.contains("multiply"), "white ink covers the paper: {white}");
}

#[test]
fn pens_without_a_slot_take_a_free_one_and_measured_colours_are_shown() {
    let text =
        "[black]\ncolour = \"#222\"\n[yellow]\ncolour = \"#f0d428\"\nslot = 3\n[red]\ncolour = \"red\"\nlab = [50, 60, 40]\n";
    let folder = with_pens(text);
    flat(folder.path(), [170, 120, 90]);
    drawn(folder.path(), &["flat.png", "-o", "flat.svg", "--colours", "pens.toml", "--size", "30x30mm"]);
    let svg = fs::read_to_string(folder.path().join("flat.svg")).unwrap();
    for label in ["3 yellow", "1 red", "2 black"] {
        assert!(svg.contains(&format!("\"{label}\"")), "{label}");
    }
    assert!(svg.contains("#d93d36") && !svg.contains("#ff0000"), "{:?}", svg.find("fill=\"#").map(|at| &svg[at..at + 15]));
}

/// Ten pens, of which a forest needs few.
const BOX: [(&str, &str); 10] = [
    ("black", "#1c1c1e"),
    ("grey", "#8a8a8c"),
    ("yellow", "#f3d83a"),
    ("orange", "#ee8c36"),
    ("red", "#d33b33"),
    ("pink", "#e78ab4"),
    ("purple", "#6a3f8f"),
    ("blue", "#2957a8"),
    ("green", "#3f9b4b"),
    ("brown", "#8a5a35"),
];

#[test]
fn the_pens_that_suit_the_picture_are_chosen_from_a_full_box() {
    let folder = with_pens(&BOX.map(|(name, colour)| format!("[{name}]\ncolour = \"{colour}\"\n")).concat());
    let forest = ImageBuffer::from_fn(120, 90, |x, y| match (x / 20 + y / 15) % 6 {
        0 => Rgb([14_u8, 22, 14]),
        1 => Rgb([40, 70, 38]),
        2 => Rgb([70, 140, 70]),
        3 => Rgb([150, 190, 120]),
        4 => Rgb([200, 210, 120]),
        _ => Rgb([250, 250, 245]),
    });
    forest.save(folder.path().join("forest.png")).unwrap();
    let how = ["forest.png", "-o", "forest.svg", "--colours", "pens.toml", "--size", "40x30mm"];
    let output = draw(folder.path(), &how);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(1) && said.contains("10 pens are too many") && said.contains("--choose 4"), "{said}");
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let output =
        command.current_dir(folder.path()).arg("draw").args(how).args(["--choose", "3", "--sight=none"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("3 of 10 pens chosen: black, green, yellow"), "{said}");
    let svg = fs::read_to_string(folder.path().join("forest.svg")).unwrap();
    assert_eq!(svg.matches("mix-blend-mode").count(), 3);
}

#[test]
fn the_preview_shows_pens_that_miss_each_other() {
    let folder = with_pens(CMYK);
    flat(folder.path(), [170, 120, 90]);
    let how = [
        "flat.png",
        "-o",
        "flat.gcode",
        "--colours",
        "pens.toml",
        "--size",
        "20x20mm",
        "--margin",
        "2mm",
        "--profile",
        "grbl-servo",
    ];
    drawn(folder.path(), &[&how[..], &["--preview", "paper.svg", "--preview-registration", "0.3mm"]].concat());
    let preview = fs::read_to_string(folder.path().join("paper.svg")).unwrap();
    assert!(preview.matches("mix-blend-mode:multiply").count() > 2 && !preview.contains("travel"));
    let output = draw(folder.path(), &[&how[..], &["--preview", "paper.svg", "--preview-registration", "5mm"]].concat());
    assert!(output.status.code() == Some(2) && String::from_utf8_lossy(&output.stderr).contains("from 0 to 2 mm"));
}

#[test]
fn a_duotone_has_a_plate_for_each_ink() {
    let folder = with_pens("[warm]\ncolour = \"#e2583e\"\nink = \"spot:Warm Red\"\n[black]\ncolour = \"#1c1c1e\"\nink = \"k\"\n");
    flat(folder.path(), [170, 90, 60]);
    drawn(folder.path(), &["flat.png", "-o", "flat.pdf", "--colours", "pens.toml", "--size", "30x30mm"]);
    let pdf = fs::read(folder.path().join("flat.pdf")).unwrap();
    let pdf = String::from_utf8_lossy(&pdf);
    assert!(pdf.contains("/Separation /Warm#20Red /DeviceRGB") && !pdf.contains("/Multiply /"), "{}", pdf.len());
    drawn(folder.path(), &["flat.png", "-o", "flat.svg", "--colours", "pens.toml", "--size", "30x30mm"]);
    assert!(fs::read_to_string(folder.path().join("flat.svg")).unwrap().contains("#e2583e"));
}

#[test]
fn pens_that_cannot_serve_are_told() {
    for (text, told) in [
        ("[a]\ncolour = \"#102030\"\n[b]\ncolour = \"#112031\"\n", "look alike"),
        ("[a]\nwidth = 0.3\n", "[a] needs its colour on this paper"),
        ("[a]\ncolour = \"#fefefe\"\n", "can hardly be seen"),
        ("[a]\nlab = [120, 0, 0]\n", "lab takes three numbers"),
        ("", "there are no pens"),
    ] {
        let folder = with_pens(text);
        flat(folder.path(), [128, 128, 128]);
        let output = draw(folder.path(), &["flat.png", "-o", "flat.svg", "--colours", "pens.toml"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(1) && said.contains(told) && said.lines().count() == 1, "{text:?}: {said}");
        assert!(!folder.path().join("flat.svg").exists());
    }
    let folder = with_pens("[pink]\ncolour = \"#ffb0c0\"\n");
    flat(folder.path(), [128, 128, 128]);
    let output = draw(folder.path(), &["flat.png", "-o", "flat.svg", "--colours", "pens.toml"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && said.contains("no pen is dark"), "{said}");
}

#[test]
fn a_look_over_pens_drawn_later_is_told() {
    let light = "[light]\ncolour = \"#ffcc00\"\nover_all = [50, 1, 1]\nover = { dark = [20, 0, 0] }\n";
    let folder = with_pens(&format!("{light}[mid]\ncolour = \"#cc3344\"\n[dark]\ncolour = \"#101020\"\n"));
    flat(folder.path(), [180, 150, 120]);
    let output = draw(folder.path(), &["flat.png", "-o", "flat.svg", "--colours", "pens.toml", "--size", "20x20mm"]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    assert!(told.contains("[light] is drawn before [dark], so its colour over 'dark' is not used"), "{told}");
    assert!(told.contains("over_all of [light] is not used, as [dark] is drawn last; give it there"), "{told}");
    assert!(!told.contains("has no effect here"), "{told}");
}
