//! Scenes, presets, `redo`, regions, sheets and drawings for pages, on the command line.
#![cfg(feature = "cli")]

use crate::common;

use assert_cmd::Command;
use common::{mean_in, png_of_light, rendered, sample};
use drypoint::drawing::{Drawing, Mark};
use drypoint::geometry::Rect;
use image::{GrayImage, Luma};
use std::fs;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

/// Pixels per millimetre of a rendering.
const FINE: f64 = 40.0;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    command.current_dir(folder).env("XDG_CONFIG_HOME", folder.join("config")).args(arguments).output().unwrap()
}

fn runs(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments:?}: {said}");
    String::from_utf8(output.stdout).unwrap() + &said
}

/// The message of a command that fails with this status.
fn fails(folder: &Path, status: i32, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {said}");
    assert_eq!(said.lines().count(), 1, "one message: {said}");
    said
}

/// A portrait and what was seen in it.
fn with_portrait() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("face.jpg"), sample("astronaut.jpg")).unwrap();
    if cfg!(feature = "see") {
        runs(folder.path(), &["see", "face.jpg", "-o", "sight", "-q"]);
    }
    folder
}

/// A grey slope, 300 x 200 pixels, and a mask of a disc in its middle.
fn with_slope() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("slope.png"), png_of_light(300, 200, |x, _| 0.15 + 0.5 * f64::from(x) / 300.0)).unwrap();
    let disc = GrayImage::from_fn(300, 200, |x, y| {
        Luma([if (f64::from(x) - 150.0).hypot(f64::from(y) - 100.0) < 60.0 { 255 } else { 0 }])
    });
    disc.save(folder.path().join("disc.png")).unwrap();
    folder
}

fn file(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap()
}

/// What a detection that is not compiled in takes no folder for.
const SIGHT: &[&str] = if cfg!(feature = "see") { &["--sight", "sight"] } else { &[] };

#[test]
fn a_scene_is_its_command_line_and_is_drawn_again_in_every_style() {
    let folder = with_portrait();
    for style in ["hedcut", "grid", "engrave", "charcoal", "glass"] {
        let options = [&["--style", style, "--size", "24x24mm", "--gamma", "1.1", "--mirror"], SIGHT].concat();
        runs(folder.path(), &[&["draw", "face.jpg", "-q", "-o", "a.svg", "--save-scene", "short.toml"], &options[..]].concat());
        runs(folder.path(), &[&["scene", "face.jpg", "-q", "-o", "full.toml"], &options[..]].concat());
        for scene in ["short.toml", "full.toml"] {
            runs(folder.path(), &["draw", scene, "-q", "-o", "b.svg"]);
            assert!(file(&folder, "a.svg") == file(&folder, "b.svg"), "{style} {scene}");
        }
        runs(folder.path(), &["redo", "a.svg", "-q"]);
        assert!(file(&folder, "a.svg") == file(&folder, "a-redone.svg"), "{style} redone");
    }
    runs(folder.path(), &["redo", "a.svg", "-q", "-o", "c.pdf", "--size", "20x20mm"]);
    runs(folder.path(), &["redo", "c.pdf", "-q", "-o", "d.pdf"]);
    assert!(file(&folder, "c.pdf") == file(&folder, "d.pdf"));
}

/// Some presets ask for the head, or for no background.
#[test]
#[cfg(feature = "see")]
fn a_preset_is_its_scene() {
    let folder = with_portrait();
    let listed = runs(folder.path(), &["presets"]);
    let presets: Vec<&str> = listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    for wanted in
        ["wsj-column", "wsj-large", "book", "banknote", "charcoal-loose", "poster", "pen-0.1", "pen-0.5-one-hour", "scraperboard"]
    {
        assert!(presets.contains(&wanted), "{wanted}: {listed}");
    }
    for preset in presets {
        assert!(runs(folder.path(), &["presets", preset]).contains("purpose = "));
        let options = [&["--preset", preset, "--size", "36x40mm", "--pitch", "0.8mm"], SIGHT].concat();
        runs(folder.path(), &[&["draw", "face.jpg", "-q", "-o", "a.svg"], &options[..]].concat());
        runs(folder.path(), &[&["scene", "face.jpg", "-q", "-o", "full.toml"], &options[..]].concat());
        runs(folder.path(), &["draw", "full.toml", "-q", "-o", "b.svg"]);
        assert!(file(&folder, "a.svg") == file(&folder, "b.svg"), "{preset}");
    }
}

#[test]
fn one_s_own_presets_and_parameter_files_hold_any_option() {
    let folder = with_slope();
    let presets = folder.path().join("config/drypoint/presets");
    fs::create_dir_all(&presets).unwrap();
    fs::write(
        presets.join("mine.toml"),
        "purpose = \"my own\"\nstyle = \"grid\"\npen = 0.2\nsize = \"30x20mm\"\n[set]\npitch = 1\n",
    )
    .unwrap();
    assert!(runs(folder.path(), &["presets"]).contains("my own"));
    let plain = ["draw", "slope.png", "--sight", "none", "-q"];
    runs(folder.path(), &[&plain[..], &["-o", "a.svg", "--preset", "mine"]].concat());
    let same = ["-o", "b.svg", "--style", "grid", "--pen", "0.2", "--size", "30x20mm", "--pitch", "1"];
    runs(folder.path(), &[&plain[..], &same].concat());
    assert!(file(&folder, "a.svg") == file(&folder, "b.svg"));
    fs::write(folder.path().join("p.toml"), "blob = 0.5\nsize = \"30x20mm\"\nmirror = true\npitch = 1\n").unwrap();
    runs(folder.path(), &[&plain[..], &["-o", "c.svg", "--style", "grid", "--params", "p.toml"]].concat());
    let same = ["-o", "d.svg", "--style", "grid", "--mirror", "--size", "30x20mm", "--set", "blob=0.5", "--pitch", "1"];
    runs(folder.path(), &[&plain[..], &same].concat());
    assert!(file(&folder, "c.svg") == file(&folder, "d.svg"));
}

#[test]
fn a_fault_in_a_scene_names_file_line_and_remedy() {
    let folder = with_slope();
    let square = GrayImage::from_pixel(50, 50, Luma([255]));
    square.save(folder.path().join("square.png")).unwrap();
    let told = |status: i32, text: &str| {
        fs::write(folder.path().join("s.toml"), format!("photograph = \"slope.png\"\nsight = \"none\"\n{text}\n")).unwrap();
        fails(folder.path(), status, &["draw", "s.toml", "-o", "x.svg", "-q"])
    };
    for (status, text, expected) in [
        (1, "stlye = \"grid\"", "s.toml, line 3: there is no key 'stlye'; did you mean style?"),
        (1, "[mask]\nsubject = \"none.png\"", "s.toml, line 4: none.png does not exist"),
        (1, "[mask]\nsubject = \"square.png\"", "s.toml, line 4: square.png"),
        (1, "[[region]]\nmask = \"square.png\"", "square.png"),
        (1, "[[region]]\nmask = \"disc.png\"\nstile = \"grid\"", "s.toml, line 3: region"),
        (
            1,
            "[[region]]\nmask = \"disc.png\"\n[[region]]\nmask = \"disc.png\"",
            "s.toml, line 5: this region has the mask disc.png",
        ),
        (1, "[set]\nptich = 1", "s.toml, line 4: 'ptich' is not a parameter of hedcut"),
        (1, "margin = ", "s.toml, line 3"),
    ] {
        let message = told(status, text);
        assert!(message.contains(expected), "{text}: {message}");
    }
    assert!(!folder.path().join("x.svg").exists());
    fs::write(folder.path().join("empty.toml"), "style = \"grid\"\n").unwrap();
    assert!(fails(folder.path(), 1, &["draw", "empty.toml", "-o", "x.svg"]).contains("photograph is missing"));
    assert!(fails(folder.path(), 2, &["draw", "slope.png", "-o", "x.svg", "--preset", "wsj"]).contains("there is no preset"));
}

#[test]
fn what_has_changed_is_not_drawn_again() {
    let folder = with_slope();
    let options = ["--sight", "none", "--size", "30x20mm", "--mask", "subject=disc.png", "-q", "-o", "a.svg"];
    runs(folder.path(), &[&["draw", "slope.png"], &options[..]].concat());
    let elsewhere = tempfile::tempdir().unwrap();
    fs::copy(folder.path().join("a.svg"), elsewhere.path().join("a.svg")).unwrap();
    assert!(fails(elsewhere.path(), 1, &["redo", "a.svg", "-q"]).contains("its photograph, slope.png, is neither beside it"));
    fs::write(folder.path().join("disc.png"), file(&folder, "slope.png")).unwrap();
    assert!(fails(folder.path(), 1, &["redo", "a.svg", "-q"]).contains("is not the mask subject of a.svg: its sha256 was"));
    runs(folder.path(), &["plot", "a.svg", "-q", "-o", "p.svg"]);
    assert!(fails(folder.path(), 1, &["redo", "p.svg", "-q"]).contains("cannot be drawn again"));
}

/// Mean white of a drawing in small squares along the disc's border, less that of the squares just outside and inside.
#[test]
fn borders_of_regions_have_neither_seams_nor_doubled_ink() {
    let folder = with_slope();
    let plain = ["draw", "slope.png", "--sight", "none", "--size", "60x40mm", "--pitch", "0.6", "-q"];
    let slope = |x: f64| {
        let light: f64 = 0.15 + 0.5 * x / 60.0;
        (1.16 * light.cbrt() - 0.16).clamp(0.0, 1.0)
    };
    for (style, rest) in [("grid", "hedcut"), ("hedcut", "engrave"), ("engrave", "grid")] {
        for border in ["", ", fade = 2"] {
            let region = format!("mask = \"disc.png\", style = \"{style}\", set = {{ pitch = 0.6 }}{border}");
            runs(folder.path(), &[&plain[..], &["--style", rest, "--region", &region, "-o", "a.svg"]].concat());
            let white = rendered(&String::from_utf8(file(&folder, "a.svg")).unwrap(), FINE);
            // Tiles of 2.4 mm along the border, two pitches to each side of it.
            let mut worst = (0.0_f64, 0.0);
            let mut sum = 0.0;
            for i in 0..24 {
                let angle = f64::from(i) * std::f64::consts::TAU / 24.0;
                let (x, y) = (30.0 + 12.0 * angle.cos(), 20.0 + 12.0 * angle.sin());
                let tile = Rect::new(x - 1.2, y - 1.2, x + 1.2, y + 1.2);
                let error = mean_in(&white, tile, FINE) - slope(x);
                sum += error / 24.0;
                if error.abs() > worst.0.abs() {
                    worst = (error, angle);
                }
            }
            println!("{style} in {rest}{border}: mean {sum:.3}, worst {:.3} at {:.2}", worst.0, worst.1);
            assert!(sum.abs() < 0.05 && worst.0.abs() < 0.12, "{style} in {rest}{border}: {sum} {worst:?}");
        }
    }
}

/// Ink that both sides of a border draw, as a share of the band of two pitches to each side, and the widest strip without ink along
/// the border, both on a tone dark enough to have no gaps of its own.
#[test]
fn borders_of_regions_are_drawn_once_and_without_white_strips() {
    let folder = with_slope();
    let dark = png_of_light(300, 200, |_, _| 0.10);
    fs::write(folder.path().join("dark.png"), dark).unwrap();
    let plain = ["draw", "dark.png", "--sight", "none", "--size", "60x40mm", "--pitch", "0.6", "-q", "-o", "a.svg"];
    for (style, rest) in [("grid", "hedcut"), ("hedcut", "engrave"), ("engrave", "grid"), ("charcoal", "hedcut")] {
        let region = format!("mask = \"disc.png\", style = \"{style}\", name = \"disc\", set = {{ pitch = 0.6 }}");
        runs(folder.path(), &[&plain[..], &["--style", rest, "--region", &region]].concat());
        let drawing = drypoint::read::read_svg(&file(&folder, "a.svg")).unwrap().drawing();
        let of_side = |is_disc: bool| {
            let layers = drawing.layers.iter().filter(|layer| layer.name.contains("disc-") == is_disc).cloned().collect();
            rendered(&common::svg_of(&Drawing { page: drawing.page, layers }), FINE)
        };
        let sides = [of_side(true), of_side(false)];
        let from_border = |x: usize, y: usize| (x as f64 / FINE - 30.0).hypot(y as f64 / FINE - 20.0) - 12.0;
        let (mut band, mut doubled) = (0_u32, 0_u32);
        for (x, y) in (0..sides[0].height()).flat_map(|y| (0..sides[0].width()).map(move |x| (x, y))) {
            if from_border(x, y).abs() < 1.2 {
                band += 1;
                doubled += u32::from(sides.iter().all(|side| side.get(x, y) < 0.5));
            }
        }
        // The widest disc without ink whose middle lies within half a pitch of the border.
        let is_white = |x: f64, y: f64| sides.iter().all(|side| side.get((x * FINE) as usize, (y * FINE) as usize) > 0.5);
        let white_about = |x: f64, y: f64| {
            let is_bare = |r: &u32| {
                (0..24).all(|k| {
                    let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 24.0).sin_cos();
                    is_white(x + f64::from(*r) / FINE * cos, y + f64::from(*r) / FINE * sin)
                })
            };
            2.0 * (0..60).take_while(is_bare).count() as f64 / FINE
        };
        let places = (0..720)
            .flat_map(|i| (-3..=3).map(move |k| (f64::from(i) * std::f64::consts::TAU / 720.0, 12.0 + 0.1 * f64::from(k))));
        let widest = places.map(|(angle, r)| white_about(30.0 + r * angle.cos(), 20.0 + r * angle.sin())).fold(0.0, f64::max);
        let share = f64::from(doubled) / f64::from(band);
        println!("{style} in {rest}: doubled {share:.4}, widest white {widest:.2} mm");
        assert!(share <= 0.005 && widest <= 0.6, "{style} in {rest}: doubled {share:.4}, white {widest:.2}");
    }
}

/// With `flow="inside"` a region's marks are the same whatever lies beside it (a millimetre off, beyond the pixels that its border mixes).
#[test]
fn a_region_that_flows_inside_does_not_see_beyond_its_border() {
    let folder = with_slope();
    let beside = |light: f64| {
        png_of_light(300, 200, move |x, y| {
            let [dx, dy] = [f64::from(x) - 149.5, f64::from(y) - 99.5];
            if dx.hypot(dy) < 66.0 { 0.15 + 0.5 * (0.05 * dx).sin().powi(2) } else { light }
        })
    };
    fs::write(folder.path().join("dark.png"), beside(0.02)).unwrap();
    fs::write(folder.path().join("light.png"), beside(0.8)).unwrap();
    for style in ["hedcut", "grid"] {
        let marks = |photo: &str, flow: &str| -> Vec<Mark> {
            let region =
                format!("mask = \"disc.png\", style = \"{style}\", name = \"disc\", flow = \"{flow}\", set = {{ pitch = 0.8 }}");
            let plain = ["draw", photo, "--sight", "none", "--tone", "lightness", "--size", "60x40mm", "-q", "-o", "a.svg"];
            runs(folder.path(), &[&plain[..], &["--style", "hedcut", "--pitch", "1.2", "--region", &region]].concat());
            let drawing = drypoint::read::read_svg(&file(&folder, "a.svg")).unwrap().drawing();
            let of_disc = drawing.layers.into_iter().filter(|layer| layer.name.contains("disc-"));
            of_disc.flat_map(|layer| layer.marks).collect()
        };
        let inside = marks("dark.png", "inside");
        assert!(inside.len() > 100 && inside == marks("light.png", "inside"), "{style}: {} marks", inside.len());
        assert!(marks("dark.png", "across") != marks("light.png", "across"), "{style}");
    }
}

#[test]
fn a_mask_may_be_an_svg_of_shapes() {
    let folder = with_slope();
    let shapes = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 300 200"><circle cx="150" cy="100" r="60"/></svg>"#;
    fs::write(folder.path().join("disc.svg"), shapes).unwrap();
    let plain = ["draw", "slope.png", "--sight", "none", "--size", "60x40mm", "--pitch", "0.6", "-q"];
    let region = "mask = \"disc.svg\", style = \"grid\", name = \"disc\", set = { pitch = 0.6 }";
    runs(folder.path(), &[&plain[..], &["--region", region, "-o", "b.svg"]].concat());
    let drawing = drypoint::read::read_svg(&file(&folder, "b.svg")).unwrap().drawing();
    let layers = drawing.layers.into_iter().filter(|layer| layer.name.contains("disc-")).collect();
    let disc = Drawing { page: drawing.page, layers }.bounding_box().unwrap();
    for (found, wanted) in [(disc.x0, 18.0), (disc.x1, 42.0), (disc.y0, 8.0), (disc.y1, 32.0)] {
        assert!((found - wanted).abs() < 0.4, "{disc:?}");
    }
    runs(folder.path(), &["redo", "b.svg", "-q"]);
    assert!(file(&folder, "b.svg") == file(&folder, "b-redone.svg"));
    fs::write(folder.path().join("disc.svg"), shapes.replace("300 200", "300 300")).unwrap();
    let region = ["--region", "mask = \"disc.svg\", style = \"grid\""];
    assert!(fails(folder.path(), 1, &[&plain[..], &region[..], &["-o", "c.svg"]].concat()).contains("disc.svg"));
}

#[test]
fn regions_have_their_pens_inks_and_names() {
    let folder = with_slope();
    let region = "mask = \"disc.png\", style = \"grid\", pen = 3, ink = \"navy\", name = \"middle\", gap = 1";
    let options = ["--sight", "none", "--size", "30x20mm", "-q", "-o", "a.svg", "--ink", "#123456", "--region", region];
    runs(folder.path(), &[&["draw", "slope.png", "--save-scene", "s.toml"], &options[..]].concat());
    let svg = String::from_utf8(file(&folder, "a.svg")).unwrap();
    assert!(svg.contains("inkscape:label=\"3 middle-"), "{}", &svg[..2000]);
    assert!(svg.contains("#000080") && svg.contains("#123456"));
    let scene = fs::read_to_string(folder.path().join("s.toml")).unwrap();
    assert!(scene.contains("[[region]]") && scene.contains("name = \"middle\""), "{scene}");
    runs(folder.path(), &["draw", "s.toml", "-q", "-o", "b.svg"]);
    assert!(file(&folder, "a.svg") == file(&folder, "b.svg"));
    runs(folder.path(), &["redo", "a.svg", "-q"]);
    assert!(file(&folder, "a.svg") == file(&folder, "a-redone.svg"));
}

#[test]
fn a_sheet_holds_scenes_and_drawings_with_one_layer_for_each_pen() {
    let folder = with_slope();
    let options = ["--sight", "none", "--style", "grid", "--pitch", "1", "--size", "60x40mm", "-q"];
    runs(folder.path(), &[&["draw", "slope.png", "-o", "a.svg", "--save-scene", "a.toml"], &options[..]].concat());
    let sheet = ["sheet", "a.toml", "a.svg", "-q", "--page", "a4", "--grid", "2x2"];
    runs(folder.path(), &[&sheet[..], &["-o", "s.svg", "--copies", "2", "--crop-marks"]].concat());
    let svg = String::from_utf8(file(&folder, "s.svg")).unwrap();
    let labels: Vec<&str> = svg.split("inkscape:label=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    assert!(labels.iter().filter(|label| label.starts_with('1')).count() >= 2 && svg.contains("crop marks"), "{labels:?}");
    let white = rendered(&svg, 5.0);
    for (x, y) in [(57.0, 75.0), (152.0, 75.0), (57.0, 222.0), (152.0, 222.0)] {
        assert!(mean_in(&white, Rect::new(x - 10.0, y - 10.0, x + 10.0, y + 10.0), 5.0) < 0.9, "{x} {y}");
    }
    let plot = runs(folder.path(), &["sheet", "a.svg", "a.svg", "--page", "a4", "-o", "s.gcode", "--profile", "grbl-servo"]);
    assert!(plot.contains("2 drawings on"), "{plot}");
    let many = fails(folder.path(), 2, &["sheet", "a.svg", "--copies", "5", "--grid", "2x2", "-o", "x.svg"]);
    assert!(many.contains("5 drawings are more than the 4 cells") && many.contains("--grid"), "{many}");
}

/// The sizes are those of portraits.
#[test]
#[cfg(feature = "see")]
fn drawings_for_pages_are_small_tight_and_never_clash() {
    let folder = with_portrait();
    let options = [&["draw", "face.jpg", "-q"], SIGHT].concat();
    for (size, most, most_zipped) in [("90x120mm", 600_000, 240_000), ("38x50mm", 250_000, 84_000)] {
        runs(folder.path(), &[&options[..], &["--size", size, "-o", "e.svg", "--embed"]].concat());
        runs(folder.path(), &[&options[..], &["--size", size, "-o", "a.svgz", "--embed"]].concat());
        let [embedded, zipped] = ["e.svg", "a.svgz"].map(|name| file(&folder, name).len());
        println!("{size}: {embedded} bytes, zipped {zipped}");
        assert!(embedded <= most && zipped <= most_zipped, "{size}: {embedded} {zipped}");
    }
    runs(folder.path(), &["plot", "a.svgz", "-q", "-o", "p.svg"]);
    runs(folder.path(), &["redo", "e.svg", "-q"]);
    assert!(file(&folder, "e-redone.svg") == file(&folder, "e.svg"));
    runs(folder.path(), &["redo", "e.svg", "-q", "-o", "e.pdf"]);
    let embedded = String::from_utf8(file(&folder, "e.svg")).unwrap();
    assert!(embedded.contains("fill=\"currentColor\"") && embedded.contains("role=\"img\"") && embedded.contains("<title"));
    runs(folder.path(), &[&options[..], &["--size", "38x50mm", "--seed", "1", "-o", "f.svg", "--embed"]].concat());
    let other = String::from_utf8(file(&folder, "f.svg")).unwrap();
    let ids = |svg: &str| -> Vec<String> {
        svg.split(" id=\"").skip(1).map(|rest| rest.split('"').next().unwrap().to_owned()).collect()
    };
    let (mine, others) = (ids(&embedded), ids(&other));
    assert!(mine.len() > 2 && mine.iter().all(|id| !others.contains(id)), "{mine:?} {others:?}");
    assert!(fails(folder.path(), 2, &["draw", "face.jpg", "--embed", "-o", "a.pdf"]).contains("--embed is for SVG"));
}

/// An embedded drawing has the ink of the sheet's, with white holes in the darks and with blobs.
#[test]
fn an_embedded_drawing_has_the_ink_of_the_sheet() {
    let folder = with_slope();
    fs::write(folder.path().join("ramp.png"), png_of_light(300, 100, |x, _| 0.02 + 0.4 * f64::from(x) / 300.0)).unwrap();
    for set in ["blob=0", "blob=0.6"] {
        let plain =
            ["draw", "ramp.png", "--sight", "none", "--tone", "linear", "--size", "30x10mm", "--pitch", "0.6", "--set", set];
        let ink = |more: &[&str]| {
            runs(folder.path(), &[&plain[..], &["-q"], more].concat());
            let svg = String::from_utf8(file(&folder, "a.svg")).unwrap().replace("currentColor", "#000");
            let tree = usvg::Tree::from_str(&svg, &usvg::Options::default()).unwrap();
            // The box of the ink in millimetres, of 96 pixels an inch.
            let size = tree.size();
            let mut pixels = resvg::tiny_skia::Pixmap::new(20 * size.width() as u32, 20 * size.height() as u32).unwrap();
            resvg::render(&tree, resvg::tiny_skia::Transform::from_scale(20.0, 20.0), &mut pixels.as_mut());
            pixels.pixels().iter().map(|p| f64::from(p.alpha()) / 255.0).sum::<f64>()
        };
        let [sheet, embedded] = [ink(&["-o", "a.svg"]), ink(&["-o", "a.svg", "--embed"])];
        println!("{set}: {embedded:.0} of {sheet:.0}");
        assert!((embedded / sheet - 1.0).abs() < 0.01, "{set}: {embedded} of {sheet}");
    }
}
