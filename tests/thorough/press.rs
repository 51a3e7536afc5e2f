//! For the press: PDF as other programs read it, and ink compensated for its change in print.
#![cfg(feature = "cli")]

mod tone;

use crate::common;

use common::{Sheet, WEDGE_MM, dots, mean_in, rendered, sample, skip, svg_of, wedge, wedge_patches};
use drypoint::drawing::{Area, Colour, Dot, Drawing, Ends, Ink, Layer, Mark, Mixing, Page, Stroke, Width};
use drypoint::geometry::{BezPath, Point, blob};
use drypoint::press::Press;
use drypoint::raster::Raster;
use drypoint::source::{MaskRole, ToneTarget};
use drypoint::write::{SvgHead, write_pdf};
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;
use tempfile::TempDir;

const DPI: f64 = 300.0;

/// Runs a program; if it is not installed, reports the check as skipped.
fn run(program: &str, arguments: &[&str]) -> Option<Output> {
    let output = Command::new(program).args(arguments).output();
    if output.is_err() {
        skip(&format!("{program} is not installed"));
    }
    output.ok()
}

fn words(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn pdf_of(drawing: &Drawing) -> Vec<u8> {
    let head = SvgHead { title: "Größe & Ink".into(), description: "a test".into(), recipe: "{\"seed\":1}".into() };
    let mut bytes = Vec::new();
    write_pdf(drawing, &head, None, &mut bytes).unwrap();
    bytes
}

fn file(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A hedcut of Grace Hopper, 90 mm wide, as in the README: dots, lines, and darks with holes.
fn hedcut() -> Arc<Drawing> {
    let (photo, mask) = (sample("grace-hopper.jpg"), sample("grace-hopper-subject.png"));
    let masks: &[(MaskRole, &[u8])] = &[(MaskRole::Subject, &mask)];
    Sheet { masks, ..Sheet::new(&photo, (90.0, 105.47)) }.drawn_once()
}

/// Every kind of mark: round and flat lines, swelling and closed ones, blobs, areas with holes, white on black.
fn every_mark() -> Drawing {
    let curve = |text: &str| BezPath::from_svg(text).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut layer = Layer::new("all", 2);
    for i in 0..20 {
        let x = 4.0 + 4.0 * f64::from(i);
        let centre = Point::new(x, 5.0);
        let outline = Box::new(blob(centre, 1.2, 0.8, &mut random));
        layer.marks.push(Mark::Dot(Dot { outline: Some(outline), ..Dot::circle(centre, 1.2) }));
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(x, 9.0), 0.08 * f64::from(i + 1))));
        let swell = curve(&format!("M{x},12 C{},15 {},18 {x},22", x + 3.0, x - 3.0));
        layer.marks.push(Mark::Stroke(Stroke::swelling(swell, vec![0.1 * f64::from(i % 5), 1.0]).unwrap()));
        let line = curve(&format!("M{x},25 L{},29 L{x},33", x + 2.0));
        let ends = if i % 2 == 0 { Ends::Round } else { Ends::Flat };
        layer.marks.push(Mark::Stroke(Stroke::even(line, 0.05 * f64::from(i + 1)).with_ends(ends)));
    }
    layer.marks.push(Mark::Stroke(Stroke::even(curve("M5,38 L15,38 L10,45 Z"), 0.7)));
    layer.marks.push(Mark::Area(Area { outline: curve("M20,36 H40 V46 H20 Z M25,38 V44 H35 V38 Z"), colour: None }));
    let white = Some(Colour::WHITE);
    layer.marks.push(Mark::Dot(Dot { colour: white, ..Dot::circle(Point::new(22.0, 41.0), 1.5) }));
    layer.marks.push(Mark::Area(Area {
        outline: curve("M50,36 Q60,36 60,46 T70,46 L50,46 Z"),
        colour: Some(Colour { r: 128, g: 128, b: 128 }),
    }));
    Drawing { page: Page::new(86.0, 50.0), layers: vec![layer] }
}

/// A PGM as the white fraction of each pixel.
fn read_pgm(bytes: &[u8]) -> Raster<f32> {
    let mut fields = bytes.splitn(4, u8::is_ascii_whitespace);
    assert_eq!(fields.next(), Some(&b"P5"[..]));
    let mut number = || std::str::from_utf8(fields.next().unwrap()).unwrap().parse::<usize>().unwrap();
    let (width, height) = (number(), number());
    let pixels = bytes[bytes.len() - width * height..].iter().map(|&b| f32::from(b) / 255.0).collect();
    Raster::from_vec(width, height, pixels)
}

/// Fraction of pixels whose grey differs by at most `within` of the range: the programs smooth edges differently, but at a
/// quarter a border that is off by half a pixel (0.04 mm) shows.
fn agreement(a: &Raster<f32>, b: &Raster<f32>, within: f32) -> f64 {
    let (width, height) = (a.width().min(b.width()), a.height().min(b.height()));
    assert!(a.width() - width <= 1 && b.width() - width <= 1 && a.height() - height <= 1 && b.height() - height <= 1);
    let alike =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|&(x, y)| (a.get(x, y) - b.get(x, y)).abs() <= within);
    alike.count() as f64 / (width * height) as f64
}

fn ink(raster: &Raster<f32>) -> f64 {
    raster.pixels().iter().map(|white| 1.0 - f64::from(*white)).sum()
}

/// Means of blocks of `n` by `n` pixels; white where a block extends beyond the edge.
fn averaged(fine: &Raster<f32>, n: usize) -> Raster<f32> {
    let at = |x: usize, y: usize| if x < fine.width() && y < fine.height() { fine.get(x, y) } else { 1.0 };
    let block = |x: usize, y: usize| (0..n * n).map(|i| at(n * x + i % n, n * y + i / n)).sum::<f32>() / (n * n) as f32;
    let (width, height) = (fine.width().div_ceil(n), fine.height().div_ceil(n));
    Raster::from_vec(width, height, (0..width * height).map(|i| block(i % width, i / width)).collect())
}

/// The PDF at 300 dpi by pdftoppm, each pixel the mean of 4 by 4 samples; `None` if the program is missing.
///
/// Splash, its renderer, raises the coverage of a smoothed border to the power of 1.5, which at 300 dpi is at most 0.15 of the
/// range and 2.5 % of a hedcut's ink; with finer sampling the affected border is a quarter as wide.
fn by_pdftoppm(pdf: &Path, samples: usize) -> Option<Raster<f32>> {
    let out = pdf.with_extension("");
    let dpi = (DPI as usize * samples).to_string();
    run("pdftoppm", &["-r", &dpi, "-gray", "-singlefile", text(pdf), text(&out)])?;
    Some(averaged(&read_pgm(&std::fs::read(out.with_extension("pgm")).unwrap()), samples))
}

/// Every sample as a hedcut 60 mm wide, Grace Hopper as in the README, and each kind of mark.
fn drawings() -> Vec<(&'static str, Arc<Drawing>)> {
    let names =
        ["astronaut.jpg", "chelsea.png", "coffee.png", "raccoon.jpg", "bust-light.png", "bust-brown.png", "bust-dark.png"];
    let sixty_wide = |name| {
        let photo = sample(name);
        let picture = image::load_from_memory(&photo).unwrap();
        Sheet::new(&photo, (60.0, 60.0 * f64::from(picture.height()) / f64::from(picture.width()))).drawn_once()
    };
    let mut drawings: Vec<(&str, Arc<Drawing>)> = names.iter().map(|name| (*name, sixty_wide(name))).collect();
    drawings.extend([("grace-hopper.jpg", hedcut()), ("every mark", Arc::new(every_mark()))]);
    drawings
}

#[test]
fn poppler_shows_what_resvg_shows_of_the_svg() {
    drawings().into_par_iter().for_each(|(name, drawing)| {
        let folder = tempfile::tempdir().unwrap();
        let pdf = file(&folder, "a.pdf", &pdf_of(&drawing));
        let out = folder.path().join("a");
        let shown = rendered(&svg_of(&drawing), DPI / 25.4);
        let Some(printed) = by_pdftoppm(&pdf, 4) else { return };
        let raw = by_pdftoppm(&pdf, 1).unwrap();
        let alike = agreement(&printed, &shown, 0.25);
        println!(
            "{name}: pdftoppm agrees in {:.4} % of pixels within a quarter of the range; with one sample a pixel in {:.3} %, within half \
             of the range in {:.3} %",
            100.0 * alike,
            100.0 * agreement(&raw, &shown, 0.25),
            100.0 * agreement(&raw, &shown, 0.5)
        );
        assert!(alike >= 0.995 && agreement(&raw, &shown, 0.5) >= 0.995, "{name}");
        // Two programs that paint coverage unchanged and use the same library: they allow the ink to be weighed (resvg's own
        // smoothing loses 0.4 %).
        let svg = file(&folder, "a.svg", svg_of(&drawing).as_bytes());
        let shown = folder.path().join("shown.png");
        if run("pdftocairo", &["-r", "300", "-gray", "-png", "-singlefile", text(&pdf), text(&out)]).is_none()
            || run("rsvg-convert", &["-d", "300", "-p", "300", "-b", "white", "-o", text(&shown), text(&svg)]).is_none()
        {
            return;
        }
        let (printed, shown) = (read_png(&folder.path().join("a.png")), read_png(&shown));
        let (alike, ratio) = (agreement(&printed, &shown, 0.25), ink(&printed) / ink(&shown));
        println!("{name}: pdftocairo agrees in {:.3} % of pixels, {ratio:.5} of the ink", 100.0 * alike);
        assert!(alike >= 0.995 && (ratio - 1.0).abs() < 1e-3);
    });
}

fn read_png(path: &Path) -> Raster<f32> {
    let page = image::open(path).unwrap().to_luma8();
    let white = page.pixels().map(|p| f32::from(p.0[0]) / 255.0).collect();
    Raster::from_vec(page.width() as usize, page.height() as usize, white)
}

#[test]
fn the_pdf_is_sound_and_has_neither_fonts_nor_colour_plates() {
    let folder = tempfile::tempdir().unwrap();
    for (name, drawing) in [("hedcut", hedcut()), ("marks", Arc::new(every_mark()))] {
        let pdf = file(&folder, &format!("{name}.pdf"), &pdf_of(&drawing));
        if let Some(output) = run("qpdf", &["--check", text(&pdf)]) {
            assert!(
                output.status.success() && words(&output).contains("No syntax or stream encoding errors"),
                "{}",
                words(&output)
            );
        }
        if let Some(output) = run("pdffonts", &[text(&pdf)]) {
            assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 2, "only the table's head: {}", words(&output));
        }
        let Some(output) = run("qpdf", &["--qdf", "--object-streams=disable", text(&pdf), "-"]) else { return };
        let plain = String::from_utf8_lossy(&output.stdout).into_owned();
        let operators: Vec<&str> = plain.split_whitespace().collect();
        assert!(operators.contains(&"g") && operators.contains(&"f"), "{name}");
        for colour in ["rg", "RG", "k", "K", "cs", "CS", "sc", "scn", "/DeviceRGB", "/DeviceCMYK", "Do", "BT"] {
            assert!(!operators.contains(&colour), "{name} has {colour}");
        }
    }
}

#[test]
fn the_page_has_its_size_in_millimetres_and_layers_have_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let mut drawing = every_mark();
    drawing.page = Page::new(210.0, 297.0);
    drawing.layers.push(Layer { ink: Ink::Spot { name: "Blå 7".into(), shown: Colour::BLACK }, ..Layer::new("größer", 3) });
    let pdf = file(&folder, "a.pdf", &pdf_of(&drawing));
    let Some(output) = run("pdfinfo", &["-box", text(&pdf)]) else { return };
    for line in ["MediaBox:            0.00     0.00   595.28   841.89", "TrimBox:             0.00     0.00   595.28   841.89"] {
        assert!(words(&output).contains(line), "{}", words(&output));
    }
    assert!(words(&output).contains("Größe & Ink"), "{}", words(&output));
    let Some(output) = run("qpdf", &["--json", text(&pdf)]) else { return };
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let all = json.to_string();
    assert!(all.contains("\"u:2 all\"") && all.contains("\"u:3 größer\""), "{all}");
}

#[test]
fn ink_on_ink_overprints_and_opaque_ink_knocks_out() {
    let folder = tempfile::tempdir().unwrap();
    let mut drawing = every_mark();
    drawing.layers[0].ink = Ink::Spot { name: "PANTONE 286 C".into(), shown: Colour::BLACK };
    drawing.layers.push(Layer {
        mixing: Mixing::Paint,
        ink: Ink::Colour(Colour { r: 200, g: 0, b: 0 }),
        ..every_mark().layers[0].clone()
    });
    let pdf = file(&folder, "a.pdf", &pdf_of(&drawing));
    let Some(output) = run("qpdf", &["--qdf", text(&pdf), "-"]) else { return };
    let plain = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(plain.contains("/O gs /S0 cs 1 scn /S0 CS 1 SCN") && plain.contains("/K gs .7843 0 0 rg"));
}

#[test]
fn a_hundred_thousand_dots_are_a_small_file() {
    let mut layer = Layer::new("dots", 1);
    for i in 0..100_000 {
        let (x, y) = (f64::from(i % 400), f64::from(i / 400));
        // As irregular as a style's dots.
        let wave = |a: f64, b: f64| (a * x + b * y * y).sin();
        let centre = Point::new(5.0 + 0.5 * x + 0.1 * wave(1.7, 2.3), 5.0 + 0.5 * y + 0.1 * wave(2.9, 1.1));
        layer.marks.push(Mark::Dot(Dot::circle(centre, 0.15 + 0.07 * wave(0.7, 0.3))));
    }
    let drawing = Drawing { page: Page::new(210.0, 140.0), layers: vec![layer] };
    let started = std::time::Instant::now();
    let pdf = pdf_of(&drawing);
    println!("{} bytes in {:.2} s, SVG {} bytes", pdf.len(), started.elapsed().as_secs_f64(), svg_of(&drawing).len());
    assert!(pdf.len() < 1_500_000, "{}", pdf.len());
    assert!(started.elapsed().as_secs_f64() < 5.0);
    let again = pdf_of(&drawing);
    assert!(pdf == again, "the same drawing, the same bytes");
}

#[test]
fn the_command_line_draws_for_the_press() {
    let folder = tempfile::tempdir().unwrap();
    let photo = file(&folder, "cat.png", &sample("chelsea.png"));
    let draw = |name: &str, more: &[&str], date: Option<&str>| {
        let out = folder.path().join(name);
        let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
        command.args(["draw", text(&photo), "-q", "--pitch", "1.2", "-o", text(&out)]).args(more).env_remove("SOURCE_DATE_EPOCH");
        if let Some(date) = date {
            command.env("SOURCE_DATE_EPOCH", date);
        }
        let output = command.output().unwrap();
        (output.status.code(), words(&output), std::fs::read(out).unwrap_or_default())
    };
    let (code, _, plain) = draw("a.pdf", &[], None);
    assert!(code == Some(0) && plain.starts_with(b"%PDF-1.7"));
    assert!(!String::from_utf8_lossy(&plain).contains("CreationDate"));
    assert!(draw("b.pdf", &["--threads", "1"], None).2 == plain, "the same bytes on one thread");
    let dated = draw("c.pdf", &[], Some("951827696")).2;
    assert!(String::from_utf8_lossy(&dated).contains("2000-02-29T12:34:56Z"));
    assert_eq!(draw("d.pdf", &[], Some("yesterday")).0, Some(2));
    let (code, _, pressed) = draw("e.pdf", &["--dot-gain", "0.26", "--dot-gain-screen", "40", "--min-mark", "0.2"], None);
    assert!(code == Some(0) && pressed != plain);
    assert!(String::from_utf8_lossy(&pressed).contains("\"min_mark_mm\":0.2"));
    for refused in [&["--dot-gain", "0.7"][..], &["--min-mark", "-1"], &["--profile", "hp7475a"], &["--dot-gain-screen", "0"]] {
        let (code, words, _) = draw("f.pdf", refused, None);
        assert_eq!(code, Some(2), "{refused:?}: {words}");
    }
}

/// `DRYPOINT_VNU` names the Nu checker's jar, since no system has a standard place for it.
#[test]
fn the_nu_checker_finds_no_error_in_svg() {
    let Ok(jar) = std::env::var("DRYPOINT_VNU") else {
        skip("DRYPOINT_VNU does not name the Nu checker's vnu.jar");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let photo = file(&folder, "cat.png", &sample("chelsea.png"));
    let mut arguments = vec!["-Xss64m", "-jar", &jar, "--svg", "--errors-only"];
    let names: Vec<PathBuf> = ["print.svg", "paths.svg", "marks.svg"].iter().map(|name| folder.path().join(name)).collect();
    for (name, more) in names.iter().zip([&["--set", "blob=0.5"][..], &["--profile", "hp7475a"]]) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
        command.args(["draw", text(&photo), "-q", "--pitch", "1.2", "-o", text(name)]).args(more);
        assert!(command.status().unwrap().success());
    }
    std::fs::write(&names[2], svg_of(&every_mark())).unwrap();
    arguments.extend(names.iter().map(|name| text(name)));
    let Some(output) = run("java", &arguments) else { return };
    assert!(output.status.success(), "{}", words(&output));
}
