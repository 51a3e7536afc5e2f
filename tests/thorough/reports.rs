//! What is reported about a drawing is true: roles of masks, crops, warnings, names of files, plurals.
#![cfg(feature = "cli")]

use crate::common;

use common::png_of_light;
use drypoint::source::MaskRole;
use drypoint::style::STYLES;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_drypoint")).current_dir(folder).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A folder with a photograph of 48 x 64 px.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let photo = png_of_light(48, 64, |x, y| f64::from(x + y) / 112.0);
    fs::write(folder.path().join("photo.png"), photo).unwrap();
    folder
}

/// A help page or manual without line breaks and escaped hyphens.
fn unwrapped(page: &str) -> String {
    page.replace("\\-", "-").replace("\\(aq", "'").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn help_manual_and_lists_name_every_role_that_a_style_takes() {
    let folder = folder();
    let out = |arguments: &[&str]| text(&run(folder.path(), arguments).stdout);
    let pages = [out(&["draw", "--help"]), out(&["draw", "-h"]), out(&["stages", "--help"]), out(&["man"])];
    for style in STYLES {
        let roles: Vec<(&str, MaskRole)> = MaskRole::ALL
            .into_iter()
            .filter(|(_, role)| {
                let of_tone = drypoint::tone::ROLES.contains(role) || *role == MaskRole::Highlights;
                style.masks().contains(role) || of_tone
            })
            .collect();
        let names: Vec<&str> = roles.iter().map(|(name, _)| *name).collect();
        for page in &pages {
            let words = format!("{} takes {}", style.name(), names.join(", "));
            assert!(unwrapped(page).contains(&words), "{words}: {page}");
        }
        let list = out(&["styles", style.name()]);
        let value: serde_json::Value = serde_json::from_str(&out(&["styles", style.name(), "--json"])).unwrap();
        let told = value["masks"].as_array().unwrap();
        assert_eq!(told.len(), roles.len());
        for ((name, role), told) in roles.iter().zip(told) {
            assert!(list.contains(&format!("\n    {name}: {}\n", role.meaning())), "{name}: {list}");
            assert_eq!((told["role"].as_str(), told["meaning"].as_str()), (Some(*name), Some(role.meaning())));
        }
    }
    assert!(unwrapped(&pages[0]).contains("--mask face=face.png"), "an example");
}

#[test]
fn a_role_of_other_styles_is_refused_with_those() {
    let folder = folder();
    for (role, words) in [
        (
            "face=photo.png",
            "--mask face: hedcut takes subject, detail, hair, clothing, facial-hair, headwear, edges, isophotes, directions, highlights; face is for charcoal",
        ),
        ("scribbles=photo.png", "scribbles is for engrave"),
        (
            "nose=photo.png",
            "--mask nose: hedcut takes subject, detail, hair, clothing, facial-hair, headwear, edges, isophotes, directions, highlights",
        ),
        ("hair", "write it as ROLE=FILE"),
    ] {
        let output = run(folder.path(), &["draw", "photo.png", "-o", "o.svg", "--mask", role]);
        assert!(output.status.code() == Some(2) && text(&output.stderr).contains(words), "{role}: {output:?}");
    }
}

#[test]
fn a_mask_for_the_tone_of_faces_that_has_none_is_told() {
    let folder = folder();
    let output = run(folder.path(), &["draw", "photo.png", "-o", "o.svg", "--style", "grid", "--mask", "hair=photo.png"]);
    assert!(output.status.success() && text(&output.stderr).contains("--mask hair changes nothing"), "{output:?}");
}

#[test]
fn a_crop_beyond_the_picture_is_refused_with_the_one_that_lies_in_it() {
    let folder = folder();
    for (crop, inside) in [
        ("10,10,60,20", Some("10,10,38,20")),
        ("-5,0,20,20", Some("0,0,15,20")),
        ("0,50%,100%,51%", Some("0,32,48,32")),
        ("0,0,48,64.5", Some("0,0,48,64")),
        ("0,0,48,64", None),
        ("33.3%,0,66.7%,100%", None),
    ] {
        let draw = |crop: &str| run(folder.path(), &["draw", "photo.png", "-q", "-o", "o.svg", "--crop", crop]);
        let output = draw(crop);
        let Some(inside) = inside else {
            assert!(output.status.success(), "{crop}: {output:?}");
            continue;
        };
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{crop}: {message}");
        assert!(message.contains("photo.png, which is 48 x 64 px") && message.contains(&format!("--crop {inside}")), "{message}");
        assert!(draw(inside).status.success(), "{inside}");
    }
}

#[test]
fn warnings_stand_in_the_json_as_on_stderr() {
    let folder = folder();
    fs::write(folder.path().join("grey.png"), png_of_light(48, 64, |x, _| 0.2 + 0.5 * f64::from(x) / 48.0)).unwrap();
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"800mm\" height=\"900mm\" viewBox=\"0 0 800 900\">\
               <path stroke=\"#000\" d=\"M10 10h100\"/><text x=\"10\" y=\"20\">a</text></svg>";
    fs::write(folder.path().join("text.svg"), svg).unwrap();
    for (arguments, words) in [
        (&["draw", "grey.png", "--style", "charcoal", "-o", "o.svg"][..], "no face was found"),
        (&["draw", "photo.png", "-o", "o.svg", "--dry-run"], ""),
        (&["plot", "text.svg", "-o", "o.svg", "--dry-run"], "left out or drawn otherwise: 1 text"),
        (&["plot", "text.svg", "-o", "o.svg"], "left out or drawn otherwise: 1 text"),
        (&["inspect", "text.svg"], "left out or read otherwise: 1 text"),
        (&["inspect", "text.svg", "--profile", "hp7475a"], "larger than every sheet"),
        (&["draw", "photo.png", "-o", "o.svg"], ""),
    ] {
        let output = run(folder.path(), &[arguments, &["--json"]].concat());
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let told: Vec<&str> = value["warnings"].as_array().unwrap().iter().map(|one| one.as_str().unwrap()).collect();
        let stderr = text(&output.stderr);
        let said: Vec<&str> = stderr.lines().filter_map(|line| line.strip_prefix("drypoint: warning: ")).collect();
        assert_eq!(told, said, "{arguments:?}");
        assert!(words.is_empty() == told.is_empty() && told.join("\n").contains(words), "{arguments:?}: {told:?}");
    }
}

#[test]
fn the_summary_names_the_files_of_the_layers() {
    let folder = folder();
    let square = |x: u32, y: u32| if (12..36).contains(&x) && (16..48).contains(&y) { 0.02 } else { 0.6 };
    fs::write(folder.path().join("square.png"), png_of_light(48, 64, square)).unwrap();
    let draw =
        |arguments: &[&str]| run(folder.path(), &[&["draw", "square.png", "--page", "a6", "--pitch", "1.2"], arguments].concat());
    let said = |arguments: &[&str]| text(&draw(arguments).stderr);
    let printed = said(&["-o", "x-{layer}.svg"]);
    assert!(printed.contains("x-dots.svg, x-outline.svg: 105.0 x 148.0 mm"), "{printed}");
    let machine = ["-o", "x-{layer}.gcode", "--profile", "grbl-servo"];
    let plotted = said(&machine);
    assert!(plotted.contains("\nx-dots.gcode: ") && plotted.contains("\nx-outline.gcode: "), "{plotted}");
    let both: serde_json::Value = serde_json::from_slice(&draw(&[&machine[..], &["--json"]].concat()).stdout).unwrap();
    assert_eq!(both["files"], serde_json::json!(["x-dots.gcode", "x-outline.gcode"]));
    let pens = both["pens"].as_array().unwrap();
    let sum: f64 = pens.iter().map(|pen| pen["seconds"].as_f64().unwrap()).sum();
    assert!(pens.len() == 2 && (sum - both["total"]["seconds"].as_f64().unwrap()).abs() < 1e-6, "{both}");
}

#[test]
fn one_path_is_not_paths() {
    let folder = folder();
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100mm\" height=\"80mm\" viewBox=\"0 0 100 80\">\
               <path stroke=\"#000\" fill=\"none\" d=\"M10 10h50\"/><path stroke=\"#000\" fill=\"none\" d=\"M10 10h50\"/>\
               <path fill=\"#000\" d=\"M20 20h5v5z\"/></svg>";
    fs::write(folder.path().join("one.svg"), svg).unwrap();
    let output = run(folder.path(), &["plot", "one.svg", "-o", "o.gcode", "--profile", "grbl-servo", "--ink-model", "lines"]);
    let said = text(&output.stderr);
    assert!(
        said.contains("1 pen, 1 path, ") && said.contains("1 lift (before ordering") && said.contains(", 2 lifts)"),
        "{said}"
    );
    assert!(said.contains("1 path repeating an earlier one left out") && said.contains("otherwise: 1 fill\n"), "{said}");
}

#[test]
fn a_file_for_the_other_command_is_told_so() {
    let folder = folder();
    fs::write(folder.path().join("one.svg"), "<svg xmlns=\"http://www.w3.org/2000/svg\"/>").unwrap();
    for (arguments, words) in [
        (["draw", "one.svg", "-o", "o.svg"], "an SVG is plotted with `drypoint plot`"),
        (["plot", "photo.png", "-o", "o.svg"], "a photograph is drawn with `drypoint draw`"),
    ] {
        let output = run(folder.path(), &arguments);
        assert!(output.status.code() == Some(1) && text(&output.stderr).contains(words), "{output:?}");
    }
}
