//! SVGs of other programs: each file of `tests/data/foreign` is drawn as it looks, and what is not drawn is counted.
#![cfg(feature = "cli")]

use crate::common;
use crate::machine_file;

use assert_cmd::Command;
use common::rendered;
use drypoint::drawing::Drawing;
use drypoint::field::nearest_seed;
use drypoint::interrupt::Interrupt;
use drypoint::plot::{Hides, InkModel, Nibs, Plot, Toolpath, lower, occluded};
use drypoint::raster::Raster;
use drypoint::read::{Imported, read_svg};
use machine_file::picture;
use std::fmt::Write as _;
use std::path::PathBuf;

/// A file, its layers (`pen name strokes/fills`), millimetres under `lines`, whether fills leave ink under `ink`, and what is
/// counted as not drawn.
type Expected = (&'static str, &'static str, f64, bool, &'static str);

const FILES: &[Expected] = &[
    ("white-background.svg", "1 #000000 1/0", 80.0, false, "1 white fill"),
    ("near-white.svg", "1 #000000 1/0", 80.0, false, "3 white fill, 1 white stroke"),
    ("dark-background.svg", "1 #202020 0/1; 2 #ff0000 1/0", 80.0, true, ""),
    ("gradients.svg", "1 #000000 1/0", 50.0, false, "2 gradient fill, 1 gradient stroke"),
    ("patterns.svg", "1 #000000 1/0", 50.0, false, "1 pattern fill"),
    ("dashes.svg", "1 #000000 36/0", 50.0 + 50.0 + 50.0 + 50.0 + 50.0, false, ""),
    ("dotted.svg", "1 #000000 8/0", 0.0, false, ""),
    ("dashes-stretched.svg", "1 #000000 5/0", 40.0 + 40.0 - 10.0, false, ""),
    ("clip-circle.svg", "1 #000000 1/0", 40.0, false, ""),
    ("clip-two-shapes.svg", "1 #000000 2/0", 40.0, false, ""),
    ("clip-even-odd.svg", "1 #000000 2/0", 40.0, false, ""),
    ("clip-bounding-box.svg", "1 #000000 2/0", 80.0, false, ""),
    ("clip-transform.svg", "1 #000000 1/0", 15.0, false, ""),
    ("clip-nested.svg", "1 #000000 1/0", 20.0, false, ""),
    (
        "masks-and-filters.svg",
        "1 #000000 2/0",
        180.0,
        false,
        "1 filter (its group is drawn plain), 1 mask (its group is drawn whole)",
    ),
    ("text.svg", "1 #000000 1/0", 50.0, false, "4 text"),
    ("text-hidden-by-css.svg", "1 #000000 1/0", 50.0, false, "1 text"),
    ("images.svg", "1 #000000 1/0", 50.0, false, "3 image"),
    ("nested-transforms.svg", "1 #000000 3/0", 40.0 + 30.0 + 10.0 * std::f64::consts::SQRT_2, false, ""),
    ("nested-svg.svg", "1 #000000 3/0", 20.0 + 40.0 + 20.0, false, ""),
    ("units-inch.svg", "1 #000000 1/0", 76.2, false, ""),
    ("units-point.svg", "1 #000000 1/0", 25.4, false, ""),
    ("units-pixel.svg", "1 #000000 2/0", 25.4 * 2.0, false, ""),
    ("size-percent.svg", "1 #000000 1/0", 25.4, false, ""),
    ("size-none.svg", "1 #000000 2/0", 76.2, false, ""),
    ("empty.svg", "", 0.0, false, ""),
    ("uses-and-symbols.svg", "1 #000000 3/0", 10.0 + 20.0 + 20.0, false, "1 use of another file, 1 use of nothing"),
    ("styles.svg", "1 #ff0000 2/0; 2 #0000ff 1/0; 3 #00ff00 1/0", 20.0 + 30.0 + 40.0 + 10.0, false, ""),
    ("inherited-fill.svg", "1 #000000 1/1", 160.0, true, ""),
    ("hidden.svg", "1 #000000 1/0", 10.0, false, "1 invisible group, 1 transparent fill, 1 transparent stroke"),
    ("translucent.svg", "1 #000000 1/1", 30.0, true, "2 translucent paint (drawn solid)"),
    ("fixed-width.svg", "1 #000000 1/0", 80.0, false, ""),
    ("markers.svg", "1 #000000 1/2", 80.0, true, ""),
    ("dots.svg", "1 #000000 5/0", 0.0, false, ""),
    (
        "shapes.svg",
        "1 #000000 8/0",
        60.0 + 20.0
            + 10.0 * std::f64::consts::PI
            + 40.0 * std::f64::consts::PI
            + 40.0
            + 40.0
            + 20.0 * std::f64::consts::SQRT_2
            + 20.0
            + 10.0 * std::f64::consts::PI,
        false,
        "",
    ),
    ("even-odd.svg", "1 #000000 0/4", 0.0, true, ""),
    ("inkscape.svg", "2 Outline 2/0; 1 red 1/0", 80.0, false, ""),
    ("axidraw-labels.svg", "2 pencil 1/0; 5 pen 1/0", 50.0, false, "1 pen height (+H)"),
    ("vpype.svg", "1 layer 1 2/0; 2 layer 2 1/0", 40.0 + 50.0 + 40.0, false, ""),
    ("illustrator.svg", "1 #e30613 1/0", 60.0, false, "1 white fill"),
    ("far-away.svg", "1 #000000 1/0", 50.0, false, "2 path beyond 100 m"),
    ("byte-order-mark.svg", "1 #000000 1/0", 80.0, false, ""),
    ("utf-16.svg", "1 #000000 1/0", 80.0, false, ""),
    ("latin-1.svg", "1 #000000 1/0", 80.0, false, ""),
    ("packed.svgz", "1 #000000 1/0", 80.0, false, ""),
    ("covered.svg", "1 #000000 2/0; 2 #ff0000 0/1", 160.0, true, "2 white fill, 1 white stroke"),
    ("scripts.svg", "1 #000000 1/0", 80.0, false, "1 foreignObject, 1 script"),
];

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/foreign").join(name)
}

fn read(name: &str) -> Imported {
    read_svg(&std::fs::read(path(name)).unwrap()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn plot(drawing: &Drawing, model: InkModel) -> Plot {
    lower(drawing, model, &Nibs::all(0.5), 0.01, &Interrupt::never()).unwrap()
}

fn drawn(plot: &Plot) -> f64 {
    plot.pens.iter().flat_map(|pen| &pen.paths).map(Toolpath::length).sum()
}

fn layers(imported: &Imported) -> String {
    let mut text = String::new();
    for layer in &imported.layers {
        let [dots, strokes, areas] = layer.counts();
        let between = if text.is_empty() { "" } else { "; " };
        write!(text, "{between}{} {} {strokes}/{}", layer.layer.pen, layer.layer.name, dots + areas).unwrap();
    }
    text
}

#[test]
fn each_file_is_drawn_as_it_looks_or_counted() {
    let mut wrong = String::new();
    for &(name, expected, mm, has_fills, dropped) in FILES {
        let imported = read(name);
        let drawing = imported.drawing();
        let lines = plot(&drawing, InkModel::Lines);
        let marks: usize = imported.layers.iter().map(|layer| layer.layer.marks.len()).sum();
        let named = imported.painting.iter().filter(|painted| matches!(painted, drypoint::drawing::Painted::Mark { .. })).count();
        if layers(&imported) != expected || imported.dropped.summary() != dropped || marks != named {
            writeln!(wrong, "{name}: {} | {} | {marks} {named}", layers(&imported), imported.dropped.summary()).unwrap();
        }
        if (drawn(&lines) - mm).abs() > 0.1 {
            writeln!(wrong, "{name}: {} mm, not {mm}", drawn(&lines)).unwrap();
        }
        // Nothing is hatched unexpectedly: under `ink`, strokes up to the nib's width stay strokes.
        let ink = drawn(&plot(&drawing, InkModel::Ink));
        let are_thin = ![
            "nested-transforms.svg",
            "uses-and-symbols.svg",
            "size-none.svg",
            "dashes-stretched.svg",
            "nested-svg.svg",
            "styles.svg",
            "inkscape.svg",
        ]
        .contains(&name);
        if has_fills && ink < mm + 1.0 || !has_fills && are_thin && ink > mm + 1.0 {
            writeln!(wrong, "{name}: {ink} mm under ink, {mm} mm of strokes").unwrap();
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
    let files = std::fs::read_dir(path("")).unwrap().count();
    assert_eq!(files, FILES.len(), "every file is in the table");
}

const PIXELS_PER_MM: f64 = 20.0;

/// The fraction of the first picture's ink within 0.15 mm of the second's.
fn near(ink: &Raster<u8>, other: &Raster<u8>) -> f64 {
    let Some(nearest) = nearest_seed(other) else { return 0.0 };
    let (mut all, mut close) = (0.0, 0.0);
    for y in 0..ink.height() {
        for x in (0..ink.width()).filter(|&x| ink.get(x, y) != 0) {
            let seed = nearest.get(x, y) as usize;
            let (dx, dy) = ((seed % ink.width()) as f64 - x as f64, (seed / ink.width()) as f64 - y as f64);
            all += 1.0;
            close += f64::from(u8::from(dx.hypot(dy) <= 0.15 * PIXELS_PER_MM));
        }
    }
    close / all
}

/// Files with strokes half a millimetre wide, whose tool paths must look like them.
#[test]
fn the_tool_paths_look_like_the_file() {
    for name in [
        "white-background",
        "clip-circle",
        "clip-two-shapes",
        "clip-even-odd",
        "clip-bounding-box",
        "clip-transform",
        "clip-nested",
        "dashes",
        "shapes",
        "dots",
        "dotted",
        "hidden",
        "byte-order-mark",
    ] {
        let svg = std::fs::read_to_string(path(&format!("{name}.svg"))).unwrap();
        let lines = plot(&read(&format!("{name}.svg")).drawing(), InkModel::Lines);
        let ours = picture(&lines);
        let ink = |svg: &str| rendered(svg, PIXELS_PER_MM).map(|white| u8::from(white < 0.5));
        let (theirs, ours) = (ink(svg.trim_start_matches('\u{feff}')), ink(&ours));
        let (drawn, added) = (near(&theirs, &ours), near(&ours, &theirs));
        println!("{name}: {drawn:.4} of its ink is drawn, {added:.4} of ours is its");
        assert!(drawn >= 0.99, "{name}: {drawn}");
        // The pen's round ends extend past the file's flat ones.
        assert!(added >= if name.starts_with("dash") { 0.97 } else { 0.99 }, "{name}: {added}");
    }
}

#[test]
fn even_odd_fills_keep_their_holes() {
    let imported = read("even-odd.svg");
    let areas: Vec<f64> = imported
        .drawing()
        .marks()
        .map(|mark| if let drypoint::drawing::Mark::Area(area) = mark { kurbo::Shape::area(&area.outline).abs() } else { 0.0 })
        .collect();
    assert!((areas[0] - 1200.0).abs() < 0.1, "{areas:?}");
    // Ink of the first file's frame: its hole stays white.
    let ink = plot(&imported.drawing(), InkModel::Ink);
    let in_hole =
        ink.pens[0].paths.iter().flat_map(Toolpath::points).filter(|p| p.x > 20.5 && p.x < 39.5 && p.y > 20.5 && p.y < 39.5);
    assert_eq!(in_hole.count(), 0);
}

#[test]
fn a_width_that_stays_is_in_pixels() {
    let imported = read("fixed-width.svg");
    let drawing = imported.drawing();
    let Some(drypoint::drawing::Mark::Stroke(stroke)) = drawing.marks().next() else { panic!() };
    assert!((stroke.widest() - 2.0 * 25.4 / 96.0).abs() < 1e-3, "{}", stroke.widest());
}

#[test]
fn what_is_covered_can_be_left_out() {
    let imported = read("covered.svg");
    let seen = |hides, model| {
        drawn(&plot(&occluded(&imported.drawing(), &imported.painting, hides, &Interrupt::never()).unwrap(), model))
    };
    // The disc hides 40 mm of one line; the rectangle 20 mm and the white stroke 10 mm of the other; translucent shapes hide
    // nothing.
    let lines = seen(Hides::AllLines, InkModel::Lines);
    assert!((lines - 90.0).abs() < 0.1, "{lines}");
    let strokes: f64 =
        occluded(&imported.drawing(), &imported.painting, Hides::OtherColours, &Interrupt::never()).unwrap().layers[0]
            .marks
            .iter()
            .map(|mark| if let drypoint::drawing::Mark::Stroke(stroke) = mark { stroke.length() } else { 0.0 })
            .sum();
    assert!((strokes - 90.0).abs() < 0.1, "{strokes}");
}

#[test]
fn what_is_no_svg_is_refused_in_words() {
    for (bytes, words) in [
        (&b"\x1f\x8b\x08 not gzip"[..], ".svgz"),
        (b"\xff\x00\xff", "neither UTF-8 nor UTF-16"),
        (b"", "is not an SVG"),
        (b"<html/>", "cannot be used"),
    ] {
        assert!(read_svg(bytes).unwrap_err().to_string().contains(words), "{words}: {}", read_svg(bytes).unwrap_err());
    }
    let deep = format!("<svg xmlns='http://www.w3.org/2000/svg'>{}{}</svg>", "<g>".repeat(50_000), "</g>".repeat(50_000));
    assert!(read_svg(deep.as_bytes()).unwrap_err().to_string().contains("nested"));
}

/// Runs `drypoint plot` on a file of the corpus; returns success, messages and report.
fn command(name: &str, arguments: &[&str]) -> (bool, String, serde_json::Value) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.svg");
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let output = command.arg("plot").arg(path(name)).arg("-o").arg(&out).arg("--json").args(arguments).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    (output.status.success(), said, serde_json::from_slice(&output.stdout).unwrap_or_default())
}

#[test]
fn the_command_lists_and_counts_what_it_drops() {
    let (done, said, report) = command("text.svg", &["--quiet"]);
    assert!(done && said.contains("warning: left out or drawn otherwise: 4 text"), "{said}");
    assert_eq!(report["dropped"]["text"], 4);
    let (done, said, report) = command("inherited-fill.svg", &[]);
    assert!(done && said.contains("1 fill"), "{said}");
    assert_eq!(report["dropped"]["fills"], 1);
    let (done, said, _) = command("empty.svg", &[]);
    assert!(!done && said.contains("there is nothing to draw"), "{said}");
}

#[test]
fn a_white_background_is_not_inked_and_hidden_parts_can_be_left_out() {
    let length = |name: &str, arguments: &[&str]| {
        let (done, said, report) = command(name, arguments);
        assert!(done, "{said}");
        report["total"]["pen_down_mm"].as_f64().unwrap_or_else(|| report["pen_down_mm"].as_f64().unwrap())
    };
    let inked = length("white-background.svg", &["--ink-model", "ink", "--pen", "0.5"]);
    assert!((inked - 80.0).abs() < 1.0, "{inked}");
    assert!((length("covered.svg", &[]) - 160.0).abs() < 0.1);
    assert!((length("covered.svg", &["--occlude"]) - 90.0).abs() < 0.1);
    // Hidden and `%` layers, and text in them, are neither drawn nor counted.
    assert!((length("inkscape.svg", &[]) - 80.0).abs() < 0.1);
    assert!((length("inkscape.svg", &["--layers", "red"]) - 40.0).abs() < 0.1);
}

#[test]
fn labels_order_pauses_speed_and_delay() {
    let imported = read("axidraw-labels.svg");
    let handling = imported.layers[0].layer.handling;
    assert_eq!((handling.pauses, handling.speed_percent, handling.delay_seconds), (true, Some(40.0), 0.1));
    let (done, said, _) = command("axidraw-labels.svg", &[]);
    assert!(done && said.contains("1 pen height (+H)"), "{said}");
}

#[test]
fn thousands_of_colours_are_read_in_time_and_drawn_with_the_pens_there_are() {
    let mut svg = "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' viewBox='0 0 100 100'>".to_owned();
    for i in 0..3000 {
        write!(svg, "<path d='M{} {}h1' stroke='#{:06x}'/>", 10 + i % 80, 10 + i / 80, i * 5000).unwrap();
    }
    svg += "</svg>";
    assert_eq!(read_svg(svg.as_bytes()).unwrap().layers.len(), 3000);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("many.svg"), svg).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let arguments = ["plot", "many.svg", "-o", "out.hpgl", "--profile", "hp7475a"];
    let output = command.current_dir(folder.path()).args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("3000 colours on the 6 pens of hp7475a"), "{said}");
    assert!(folder.path().join("out.hpgl").exists());
}
