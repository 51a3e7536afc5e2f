//! Flat colours in four pens: each layer is rendered alone, inks are multiplied, and their mean light is the colour asked for.
#![cfg(feature = "cli")]

use image::{ImageBuffer, Rgb};
use std::fs;
use std::path::Path;
use std::process::Command;

const CMYK: &str = "[black]\ncolour = \"#1c1c1e\"\n[cyan]\ncolour = \"#0095d0\"\n[magenta]\ncolour = \"#d4127c\"\n[yellow]\ncolour = \"#ffe01a\"\n";

/// Coarse enough that light which spreads in the paper, which the separation reckons with and which is not simulated, counts little.
const PITCH: &str = "0.5mm";

fn drawn(folder: &Path, arguments: &[&str]) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let output = command.current_dir(folder).arg("draw").args(arguments).args(["--sight=none", "-q"]).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// A picture of one colour, 40 x 40 mm.
fn flat(folder: &Path, colour: [u8; 3]) {
    ImageBuffer::from_pixel(100, 100, Rgb(colour)).save(folder.join("flat.png")).unwrap();
}

fn linear(v: f64) -> f64 {
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

fn lab(rgb: [f64; 3]) -> [f64; 3] {
    let [r, g, b] = rgb;
    let xyz = [
        (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505,
        0.2126 * r + 0.7152 * g + 0.0722 * b,
        (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089,
    ];
    let [x, y, z] = xyz.map(|t: f64| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// A sheet on white in linear light, 20 pixels per millimetre.
fn rendered(svg: &str) -> Vec<[f64; 3]> {
    let tree = resvg::usvg::Tree::from_str(svg, &resvg::usvg::Options::default()).unwrap();
    let scale = (20.0 * 25.4 / 96.0) as f32;
    let side = (tree.size().width() * scale).round() as u32;
    let mut pixmap = resvg::tiny_skia::Pixmap::new(side, side).unwrap();
    pixmap.fill(resvg::tiny_skia::Color::WHITE);
    resvg::render(&tree, resvg::tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    let light: Vec<f64> = (0..=255).map(|v| linear(f64::from(v) / 255.0)).collect();
    pixmap.pixels().iter().map(|p| [p.red(), p.green(), p.blue()].map(|v| light[usize::from(v)])).collect()
}

/// Mean light of a flat colour as its layers print it: each rendered alone, inks multiplied.
fn seen(folder: &Path, colour: [u8; 3], style: &str) -> [f64; 3] {
    flat(folder, colour);
    for old in
        fs::read_dir(folder).unwrap().map(Result::unwrap).filter(|file| file.path().extension().is_some_and(|e| e == "svg"))
    {
        fs::remove_file(old.path()).unwrap();
    }
    let fixed = ["flat.png", "-o", "{layer}.svg", "--colours", "pens.toml", "--size", "40x40mm", "--pitch", PITCH];
    drawn(folder, &[&fixed[..], &["--style", style]].concat());
    let mut light: Option<Vec<[f64; 3]>> = None;
    for file in
        fs::read_dir(folder).unwrap().map(|file| file.unwrap().path()).filter(|path| path.extension().is_some_and(|e| e == "svg"))
    {
        let picture = rendered(&fs::read_to_string(file).unwrap());
        let layer = picture.into_iter();
        light = Some(match light {
            None => layer.collect(),
            Some(below) => below.iter().zip(layer).map(|(a, b)| [a[0] * b[0], a[1] * b[1], a[2] * b[2]]).collect(),
        });
    }
    let light = light.unwrap();
    // Away from the border.
    let side = (light.len() as f64).sqrt() as usize;
    let inner: Vec<&[f64; 3]> = light
        .iter()
        .enumerate()
        .filter(|(i, _)| (100..side - 100).contains(&(i % side)) && (100..side - 100).contains(&(i / side)))
        .map(|(_, l)| l)
        .collect();
    [0, 1, 2].map(|i| inner.iter().map(|l| l[i]).sum::<f64>() / inner.len() as f64)
}

#[test]
fn flat_colours_are_met_in_three_styles() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pens.toml"), CMYK).unwrap();
    for style in ["hedcut", "grid", "engrave"] {
        for colour in [[190, 150, 130], [120, 150, 110], [150, 150, 150], [225, 205, 190]] {
            let got = lab(seen(folder.path(), colour, style));
            let want = lab(colour.map(|v| linear(f64::from(v) / 255.0)));
            let difference = (0..3).map(|i| (got[i] - want[i]).powi(2)).sum::<f64>().sqrt();
            println!("{style} {colour:?}: {got:.1?} for {want:.1?}, {difference:.1}");
            // Without that light this is a little lighter.
            assert!(difference < 10.0, "{style} {colour:?}: {got:?} for {want:?}");
        }
    }
}
