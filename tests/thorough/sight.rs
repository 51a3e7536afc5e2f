//! `see`, `draw --sight` and `--background` on the command line.
#![cfg(feature = "cli")]

use crate::common;

use assert_cmd::Command;
use common::{png_of_light, sample};
use image::{DynamicImage, GrayImage, ImageFormat, Luma};
#[cfg(feature = "see")]
use serde_json::Value;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::Output;
use tempfile::TempDir;

/// A small hedcut, fast to draw.
const SMALL: [&str; 4] = ["--size", "30x30mm", "--pitch", "0.8mm"];

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_drypoint")).current_dir(folder).args(arguments).output().unwrap()
}

fn runs(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments:?}: {said}");
    said
}

/// The drawing for some options, and the messages.
fn drawn(folder: &Path, photo: &str, options: &[&str]) -> (String, String) {
    let said = runs(folder, &[&["draw", photo, "-o", "out.svg"], &SMALL[..], options].concat());
    (without_options(&fs::read_to_string(folder.join("out.svg")).unwrap()), said)
}

/// A drawing whose recipe does not say with which options it was asked for, which may differ for the same drawing.
fn without_options(svg: &str) -> String {
    let (before, rest) = svg.split_once("\"options\":{").unwrap();
    let mut depth = 1;
    let end = rest.find(|c| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        depth == 0
    });
    format!("{before}{}", rest[end.unwrap()..].strip_prefix("},").unwrap())
}

/// Marks of a drawing, without its recipe.
fn marks(svg: &str) -> &str {
    svg.split("</metadata>").nth(1).unwrap()
}

fn sample_path(name: &str) -> String {
    format!("{}/samples/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn grey_png(path: &Path, width: u32, height: u32, value: impl Fn(u32, u32) -> u8) {
    let mut bytes = Cursor::new(Vec::new());
    let picture = GrayImage::from_fn(width, height, |x, y| Luma([value(x, y)]));
    DynamicImage::ImageLuma8(picture).write_to(&mut bytes, ImageFormat::Png).unwrap();
    fs::write(path, bytes.into_inner()).unwrap();
}

/// A gradient as photograph, 60 x 80 pixels.
fn slope(folder: &Path) -> PathBuf {
    let path = folder.join("slope.png");
    fs::write(&path, png_of_light(60, 80, |x, _| 0.1 + 0.4 * f64::from(x) / 60.0)).unwrap();
    path
}

#[test]
fn masks_of_another_size_are_scaled() {
    let folder = folder();
    slope(folder.path());
    let left = |width: u32| move |x: u32, _: u32| if 2 * x < width { 255 } else { 0 };
    grey_png(&folder.path().join("same.png"), 60, 80, left(60));
    grey_png(&folder.path().join("small.png"), 30, 40, left(30));
    grey_png(&folder.path().join("large.png"), 240, 320, left(240));
    grey_png(&folder.path().join("other.png"), 60, 60, left(60));
    let share = |mask: &str| {
        let (svg, _) = drawn(folder.path(), "slope.png", &["--mask", &format!("subject={mask}"), "--json"]);
        marks(&svg).len() as f64
    };
    let same = share("same.png");
    for mask in ["small.png", "large.png"] {
        let other = share(mask);
        assert!((other / same - 1.0).abs() < 0.1, "{mask}: {other} to {same}");
    }
    let refused = run(folder.path(), &["draw", "slope.png", "--mask", "subject=other.png", "-o", "no.svg"]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(1));
    assert!(said.contains("60 x 60 px, but the photograph is 60 x 80 px") && said.contains("proportions"), "{said}");
    // Depth and scribbles are handled the same way.
    grey_png(&folder.path().join("depth.png"), 30, 40, |x, y| (5 * x + y) as u8);
    grey_png(&folder.path().join("scribbles.png"), 120, 160, |x, y| if y < 20 { 200 } else { u8::from(x < 20 && y > 99) * 90 });
    let engraved = ["--style", "engrave", "--depth", "depth.png", "--mask", "scribbles=scribbles.png"];
    drawn(folder.path(), "slope.png", &engraved);
}

#[test]
fn a_folder_of_masks_is_used_role_by_role_and_a_painted_one_wins() {
    let folder = folder();
    slope(folder.path());
    let seen = folder.path().join("seen");
    fs::create_dir(&seen).unwrap();
    let empty = run(folder.path(), &["draw", "slope.png", "--sight", "seen", "-o", "no.svg"]);
    assert_eq!(empty.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&empty.stderr).contains("drypoint see PHOTO -o seen"), "{empty:?}");
    grey_png(&seen.join("subject.png"), 120, 160, |x, _| if x < 60 { 255 } else { 0 });
    grey_png(&folder.path().join("right.png"), 60, 80, |x, _| if x < 30 { 0 } else { 255 });
    let (by_folder, _) = drawn(folder.path(), "slope.png", &["--sight", "seen"]);
    let (by_mask, _) = drawn(folder.path(), "slope.png", &["--mask", "subject=seen/subject.png"]);
    assert_eq!(by_folder, by_mask);
    let (painted, _) = drawn(folder.path(), "slope.png", &["--sight", "seen", "--mask", "subject=right.png"]);
    let (alone, _) = drawn(folder.path(), "slope.png", &["--mask", "subject=right.png"]);
    assert_eq!(painted, alone);
    let (kept, _) = drawn(folder.path(), "slope.png", &["--sight", "seen", "--background", "keep"]);
    let (whole, _) = drawn(folder.path(), "slope.png", &["--background", "keep"]);
    assert_eq!(kept, whole);
    assert_ne!(marks(&kept), marks(&by_folder));
    // The folder's pictures are inputs.
    let over = run(folder.path(), &["draw", "slope.png", "--sight", "seen", "-o", "seen/subject.png", "--format", "svg"]);
    assert_eq!(over.status.code(), Some(2), "{over:?}");
}

#[cfg(feature = "see")]
#[test]
fn see_writes_what_was_found_in_the_photographs_own_size() {
    let folder = folder();
    fs::write(folder.path().join("photo.jpg"), sample("grace-hopper.jpg")).unwrap();
    let said = runs(folder.path(), &["see", "photo.jpg", "-o", "seen"]);
    assert!(said.contains("1 face found"), "{said}");
    let subject = image::open(folder.path().join("seen/subject.png")).unwrap().to_luma8();
    assert_eq!(subject.dimensions(), (512, 600));
    assert!(subject.get_pixel(260, 220).0[0] == 255 && subject.get_pixel(10, 10).0[0] == 0);
    assert_eq!(image::open(folder.path().join("seen/overlay.png")).unwrap().to_rgb8().dimensions(), (512, 600));
    let json: Value = serde_json::from_slice(&fs::read(folder.path().join("seen/sight.json")).unwrap()).unwrap();
    assert_eq!(json["photograph"]["width"], 512);
    assert_eq!(json["regions"]["subject"], "subject.png");
    assert_eq!(json["faces"].as_array().unwrap().len(), 1);
    let face = &json["faces"][0];
    assert_eq!(face["points"].as_array().unwrap().len(), 468);
    assert!(face["score"].as_f64().unwrap() >= 0.75);
    assert!((face["irises"]["right"]["centre"][0].as_f64().unwrap() - 220.8).abs() < 4.0, "{face}");
    let output = run(folder.path(), &["see", "photo.jpg", "--json"]);
    assert_eq!(serde_json::from_slice::<Value>(&output.stdout).unwrap(), json);
    assert!(output.stderr.is_empty());
    // Nobody in the next photograph: reported, and nothing of the last sight stays.
    fs::write(folder.path().join("cat.png"), sample("chelsea.png")).unwrap();
    let said = runs(folder.path(), &["see", "cat.png", "-o", "seen"]);
    assert!(said.contains("no face found"), "{said}");
    let left: Vec<_> = fs::read_dir(folder.path().join("seen")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["sight.json"]);
    let json: Value = serde_json::from_slice(&fs::read(folder.path().join("seen/sight.json")).unwrap()).unwrap();
    assert_eq!((&json["faces"], &json["regions"]), (&serde_json::json!([]), &serde_json::json!({})));
}

#[cfg(feature = "see")]
#[test]
fn a_photograph_is_not_written_over() {
    let folder = folder();
    fs::write(folder.path().join("subject.png"), sample("bust-light.png")).unwrap();
    let output = run(folder.path(), &["see", "subject.png", "-o", "."]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    for wrong in [&["see", "subject.png"][..], &["see", "subject.png", "-o", "-"]] {
        assert_eq!(run(folder.path(), wrong).status.code(), Some(2), "{wrong:?}");
    }
}

#[cfg(feature = "see")]
#[test]
fn portrait_styles_leave_the_background_out_where_a_face_is_found() {
    let folder = folder();
    let photo = sample_path("astronaut.jpg");
    for style in ["hedcut", "grid", "engrave"] {
        let (auto, said) = drawn(folder.path(), &photo, &["--style", style]);
        assert!(said.contains("background left out: 1 face found; --background keep draws it"), "{style}: {said}");
        let (keep, said) = drawn(folder.path(), &photo, &["--style", style, "--background", "keep"]);
        assert!(!said.contains("background"), "{said}");
        assert_ne!(marks(&auto), marks(&keep));
        let (none, _) = drawn(folder.path(), &photo, &["--style", style, "--background", "none"]);
        assert_eq!(auto, none);
    }
    let (auto, said) = drawn(folder.path(), &photo, &["--style", "glass"]);
    assert!(!said.contains("background"), "{said}");
    let (keep, _) = drawn(folder.path(), &photo, &["--style", "glass", "--background", "keep"]);
    assert_eq!(auto, keep);
    // A subject that is given is not detected.
    let mask = format!("subject={}", sample_path("grace-hopper-subject.png"));
    let (_, said) = drawn(folder.path(), &sample_path("grace-hopper.jpg"), &["--mask", &mask]);
    assert!(!said.contains("background"), "{said}");
    let (_, said) = drawn(folder.path(), &sample_path("astronaut-cutout.png"), &[]);
    assert!(!said.contains("background"), "{said}");
    assert!(!drawn(folder.path(), &photo, &["-q"]).1.contains("background"));
}

#[cfg(feature = "see")]
#[test]
fn without_a_face_everything_is_as_it_was() {
    let folder = folder();
    for name in ["chelsea.png", "raccoon.jpg", "coffee.png"] {
        let photo = sample_path(name);
        let (auto, said) = drawn(folder.path(), &photo, &[]);
        assert!(said.contains("background drawn: no face found; --mask subject=FILE leaves it out"), "{said}");
        assert_eq!(auto, drawn(folder.path(), &photo, &["--background", "keep"]).0, "{name}");
        let refused = run(folder.path(), &["draw", &photo, "--background", "none", "-o", "no.svg"]);
        let said = String::from_utf8(refused.stderr).unwrap();
        assert_eq!((refused.status.code(), said.lines().count()), (Some(1), 1), "{said}");
        assert!(said.contains("no face found") && said.contains("--mask subject=FILE"), "{said}");
    }
}

#[cfg(feature = "see")]
#[test]
fn what_was_written_draws_as_what_is_found() {
    let folder = folder();
    let photo = sample_path("bust-brown.png");
    runs(folder.path(), &["see", &photo, "-o", "seen"]);
    let (by_folder, _) = drawn(folder.path(), &photo, &["--sight", "seen"]);
    let (found, _) = drawn(folder.path(), &photo, &[]);
    assert_eq!(marks(&by_folder), marks(&found));
}

#[cfg(feature = "see")]
#[test]
fn the_bytes_do_not_depend_on_threads() {
    let folder = folder();
    let photo = sample_path("grace-hopper.jpg");
    let on = |threads: &str| {
        runs(folder.path(), &["see", &photo, "-o", "seen", "--threads", threads]);
        let files =
            ["sight.json", "subject.png", "overlay.png"].map(|name| fs::read(folder.path().join("seen").join(name)).unwrap());
        (files, drawn(folder.path(), &photo, &["--threads", threads]).0)
    };
    let one = on("1");
    assert!(one == on("2") && one == on("7"));
}

#[cfg(not(feature = "see"))]
#[test]
fn without_networks_it_says_what_is_missing() {
    let folder = folder();
    let photo = sample_path("astronaut.jpg");
    let (auto, said) = drawn(folder.path(), &photo, &[]);
    assert!(said.contains("without the networks that find faces (cargo feature `see`)"), "{said}");
    assert_eq!(auto, drawn(folder.path(), &photo, &["--background", "keep"]).0);
    let refused = run(folder.path(), &["see", &photo, "-o", "seen"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("cargo feature `see`"), "{refused:?}");
    assert!(!sample("astronaut.jpg").is_empty());
}

#[cfg(feature = "see")]
#[test]
fn without_a_face_nothing_of_sight_is_used() {
    let folder = folder();
    fs::write(folder.path().join("cat.png"), sample("chelsea.png")).unwrap();
    let (plain, said) = drawn(folder.path(), "cat.png", &[]);
    assert!(said.contains("no face found") && !said.contains("tone made"), "{said}");
    let (kept, _) = drawn(folder.path(), "cat.png", &["--background", "keep", "--tone", "lightness"]);
    let (unseen, _) = drawn(folder.path(), "cat.png", &["--sight", "none"]);
    assert_eq!((&plain, &plain), (&kept, &unseen));
    for (options, message) in [
        (["--crop", "head"], "no face is known"),
        (["--crop", "face"], "no face is known"),
        (["--tone", "portrait"], "--tone lightness needs none"),
    ] {
        let refused = run(folder.path(), &[&["draw", "cat.png", "-o", "no.svg"], &options[..]].concat());
        let said = String::from_utf8(refused.stderr).unwrap();
        assert!(refused.status.code() == Some(1) && said.contains(message), "{options:?}: {said}");
    }
}

#[cfg(feature = "see")]
#[test]
fn the_part_round_the_head_and_the_tone_are_found() {
    let folder = folder();
    fs::write(folder.path().join("photo.jpg"), sample("grace-hopper.jpg")).unwrap();
    let recipe = |svg: &str, key: &str| {
        let json = svg.split_once('{').unwrap().1.split("</metadata>").next().unwrap();
        let json = format!("{{{}", json.rsplit_once('}').unwrap().0) + "}";
        serde_json::from_str::<Value>(&json.replace("&quot;", "\"")).map_or(Value::Null, |recipe| recipe[key].clone())
    };
    let (head, said) = drawn(folder.path(), "photo.jpg", &["--crop", "head"]);
    assert!(said.contains("tone made for the face") && said.contains("background left out"), "{said}");
    let (face, _) = drawn(folder.path(), "photo.jpg", &["--crop", "face", "--tone", "portrait"]);
    let part =
        |svg: &str| -> Vec<f64> { recipe(svg, "crop_px").as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect() };
    let (head_part, face_part) = (part(&head), part(&face));
    // The eyes are 87 pixels apart, their middle at 264, 206; no border cuts the head with its cap.
    assert!(head_part[0] < 150.0 && head_part[0] + head_part[2] > 380.0 && head_part[1] < 20.0, "{head_part:?}");
    assert!(face_part[2] < 0.75 * head_part[2] && face_part[1] > head_part[1], "{face_part:?}");
    assert_eq!(recipe(&head, "tone"), "portrait");
    let (lightness, said) = drawn(folder.path(), "photo.jpg", &["--crop", "head", "--tone", "lightness"]);
    assert!(!said.contains("tone made"), "{said}");
    assert_ne!(marks(&lightness), marks(&head));
    let (half, _) = drawn(folder.path(), "photo.jpg", &["--crop", "head", "--tone-strength", "0.5"]);
    assert!(marks(&half) != marks(&head) && marks(&half) != marks(&lightness));
    // A small face at this pitch: reported, with the options that make it visible.
    let said = drawn(folder.path(), "photo.jpg", &[]).1;
    assert!(said.contains("too small for a pitch of 0.8 mm") && said.contains("--crop head"), "{said}");
}

#[cfg(feature = "see")]
#[test]
fn a_folder_that_was_written_draws_what_was_found() {
    let folder = folder();
    fs::write(folder.path().join("photo.jpg"), sample("grace-hopper.jpg")).unwrap();
    runs(folder.path(), &["see", "photo.jpg", "-o", "seen"]);
    for file in ["subject", "skin", "hair", "facial-hair", "headwear", "clothing", "detail", "depth", "overlay"] {
        assert!(folder.path().join(format!("seen/{file}.png")).exists(), "{file}");
    }
    let (by_folder, said) = drawn(folder.path(), "photo.jpg", &["--sight", "seen"]);
    assert!(said.contains("tone made for the face"), "{said}");
    let (found, _) = drawn(folder.path(), "photo.jpg", &[]);
    let (a, b) = (marks(&by_folder).len() as f64, marks(&found).len() as f64);
    assert!((a / b - 1.0).abs() < 0.05, "{a} bytes by the folder, {b} found");
    // A file that is no sight is refused by name.
    fs::write(folder.path().join("seen/sight.json"), "{}").unwrap();
    let refused = run(folder.path(), &["draw", "photo.jpg", "--sight", "seen", "-o", "no.svg"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("sight.json is no sight"), "{refused:?}");
}

#[cfg(feature = "see")]
#[test]
fn the_first_stages_are_what_was_seen() {
    let folder = folder();
    fs::write(folder.path().join("photo.jpg"), sample("grace-hopper.jpg")).unwrap();
    let stages = |name: &str, options: &[&str]| {
        runs(folder.path(), &[&["stages", "photo.jpg", "-o", name], &SMALL[..], options].concat());
        let entries = fs::read_dir(folder.path().join(name)).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    // The hedcut uses only some of them.
    let names = stages("found", &[]);
    assert_eq!(names[..3], ["01-subject.png", "02-skin.png", "03-hair.png"]);
    for role in ["headwear", "clothing", "detail", "faces", "depth"] {
        assert!(names.iter().any(|name| name.ends_with(&format!("-{role}.png"))), "{role}: {names:?}");
    }
    let place = |step: &str| names.iter().position(|name| name.contains(step)).unwrap();
    assert!(place("-depth.png") < place("-tone.png"), "{names:?}");
    // Painted masks replace detected ones.
    grey_png(&folder.path().join("left.png"), 128, 150, |x, _| if x < 64 { 255 } else { 0 });
    stages("painted", &["--mask", "subject=left.png"]);
    let painted = image::open(folder.path().join("painted/01-subject.png")).unwrap().to_luma8();
    assert_eq!((painted.get_pixel(10, 60).0, painted.get_pixel(100, 60).0), ([255], [0]));
    // Without a sight none of it is shown.
    assert_eq!(stages("unseen", &["--sight", "none"])[0], "01-tone.png");
}

/// Grace Hopper wears spectacles, an astronaut none; hers, of wire, are drawn as lines, and are left out by an edited file.
#[cfg(feature = "see")]
#[test]
fn spectacles_are_found_drawn_and_taken_out_again() {
    let folder = folder();
    let found = |sample: &str| -> Value {
        runs(folder.path(), &["see", &sample_path(sample), "-o", "sight"]);
        serde_json::from_str(&fs::read_to_string(folder.path().join("sight/sight.json")).unwrap()).unwrap()
    };
    assert_eq!(found("astronaut.jpg")["faces"][0]["spectacles"], Value::Null);
    let mut seen = found("grace-hopper.jpg");
    let spectacles = &seen["faces"][0]["spectacles"];
    for (side, iris) in ["right", "left"].into_iter().enumerate() {
        let centre = |axis: usize| seen["faces"][0]["irises"][iris]["centre"][axis].as_f64().unwrap();
        let rim: Vec<[f64; 2]> = serde_json::from_value(spectacles["rims"][side].clone()).unwrap();
        let across = rim.iter().map(|p| p[0]);
        assert!(
            across.clone().fold(f64::INFINITY, f64::min) < centre(0) && across.fold(0.0, f64::max) > centre(0),
            "around {iris}"
        );
    }
    let photo = sample_path("grace-hopper.jpg");
    for style in ["hedcut", "grid", "engrave", "charcoal"] {
        let options = ["--sight", "sight", "--style", style];
        let with = drawn(folder.path(), &photo, &options).0;
        let mut without = seen.clone();
        without["faces"][0]["spectacles"] = Value::Null;
        fs::write(folder.path().join("sight/sight.json"), without.to_string()).unwrap();
        assert_ne!(marks(&with), marks(&drawn(folder.path(), &photo, &options).0), "{style}");
        fs::write(folder.path().join("sight/sight.json"), seen.to_string()).unwrap();
    }
    seen["faces"][0]["spectacles"]["rims"][0] = serde_json::json!([[1.0, 2.0]]);
    fs::write(folder.path().join("sight/sight.json"), seen.to_string()).unwrap();
    let output = run(folder.path(), &["draw", &photo, "-o", "x.svg", "--sight", "sight", "--size", "30x30mm"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("rims of spectacles must have three points or more"));
}
