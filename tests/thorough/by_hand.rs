//! Lights and directions drawn by hand, in every style that takes them.
#![cfg(feature = "cli")]

use crate::common;

use assert_cmd::Command;
use common::{mean_in, png_of_light, rendered};
use drypoint::geometry::Rect;
use drypoint::raster::Raster;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Pixels per millimetre of the drawings that are measured.
const FINE: f64 = 20.0;
/// Side of the photograph in pixels, and of the drawing in millimetres.
const SIDE: u32 = 120;
const MM: f64 = 30.0;

/// A folder with a photograph in one grey.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("photo.png"), png_of_light(SIDE, SIDE, |_, _| 0.08)).unwrap();
    folder
}

fn mask(folder: &Path, name: &str, is_inside: impl Fn(f64, f64) -> bool) {
    let light = |x: u32, y: u32| f64::from(u8::from(is_inside(f64::from(x), f64::from(y))));
    fs::write(folder.join(name), png_of_light(SIDE, SIDE, light)).unwrap();
}

/// How dark the drawing is, 0 to 1.
fn drawn(folder: &Path, options: &[&str]) -> Raster<f32> {
    let common = ["draw", "photo.png", "-o", "out.svg", "--size", "30x30mm", "-q"];
    let output = Command::new(env!("CARGO_BIN_EXE_drypoint")).current_dir(folder).args(common).args(options).output().unwrap();
    assert!(output.status.success(), "{options:?}: {}", String::from_utf8_lossy(&output.stderr));
    rendered(&fs::read_to_string(folder.join("out.svg")).unwrap(), FINE).map(|light| 1.0 - light)
}

#[test]
fn paper_stays_open_in_painted_highlights() {
    let folder = folder();
    mask(folder.path(), "lights.png", |x, y| (x - 60.0).hypot(y - 60.0) < 30.0);
    mask(folder.path(), "cloth.png", |_, _| true);
    for style in ["hedcut", "grid", "engrave", "charcoal", "glass"] {
        let own = ["--style", style, "--pitch", "0.8mm", "--mask", "highlights=lights.png"];
        let cloth: &[&str] = if style == "charcoal" { &["--mask", "clothing=cloth.png"] } else { &[] };
        let ink = drawn(folder.path(), &[&own[..], cloth].concat());
        let middle = 0.5 * MM;
        let inside = mean_in(&ink, Rect::new(middle - 3.0, middle - 3.0, middle + 3.0, middle + 3.0), FINE);
        let outside = mean_in(&ink, Rect::new(2.0, 2.0, 5.0, MM - 2.0), FINE);
        // Strokes of paint reach over a border by their width.
        let most = if style == "glass" { 0.1 } else { 0.02 };
        assert!(inside < most && outside > 0.1, "{style}: {inside} inside, {outside} outside");
    }
}

/// The direction of a drawing's lines in degrees (y down) in a square around a place in millimetres, by the structure tensor.
fn direction(ink: &Raster<f32>, middle: (f64, f64), half: f64) -> f64 {
    let range = |v: f64| ((v - half) * FINE) as usize..((v + half) * FINE) as usize;
    let (mut cos, mut sin) = (0.0, 0.0);
    for y in range(middle.1) {
        for x in range(middle.0) {
            let dx = f64::from(ink.get(x + 1, y) - ink.get(x - 1, y));
            let dy = f64::from(ink.get(x, y + 1) - ink.get(x, y - 1));
            (cos, sin) = (cos + dx * dx - dy * dy, sin + 2.0 * dx * dy);
        }
    }
    (0.5 * sin.atan2(cos)).to_degrees() + 90.0
}

#[test]
fn marks_run_along_directions_drawn_by_hand() {
    let folder = folder();
    mask(folder.path(), "lines.png", |x, y| (x - y).abs() < 1.5 && (20.0..100.0).contains(&x));
    let hatches = ["--set", "size_max=0mm", "--set", "hatching=along", "--set", "lines=off"];
    let styles: [(&str, &[&str]); 3] =
        [("engrave", &["--set", "look=hatch"]), ("grid", &hatches), ("glass", &["--set", "colors=mono"])];
    for (style, options) in styles {
        let own = ["--style", style, "--pitch", "0.8mm", "--mask", "directions=lines.png"];
        let ink = drawn(folder.path(), &[&own[..], options].concat());
        let found = direction(&ink, (0.5 * MM, 0.5 * MM), 3.0);
        assert!((found - 45.0).abs() < 12.0 || (found - 225.0).abs() < 12.0, "{style}: {found} degrees");
    }
}
