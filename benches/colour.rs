//! The cost of colour, compared with the guarantees: `cargo bench --bench colour`.
//!
//! Separation of a photograph of 12 megapixels into four and eight pens, the table of colours included; the choice of four pens of
//! twenty-four; and whole drawings in four pens against the same command with one, in processes of their own.

use drypoint::colour::{ColourPen, Paper, PenSet, Separator, Settings, choose, drawing_order, known_pens};
use drypoint::raster::Raster;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

const INKS: [&str; 8] = ["#f4dc2c", "#1b9fd0", "#bf3a8f", "#38373a", "#ee8c36", "#3f9b4b", "#2957a8", "#8a5a35"];

fn main() {
    let photograph = photograph(4000, 3000);
    for count in [4, 8] {
        let seconds = best_of(3, || separate(&photograph, count));
        line(&format!("12 megapixels into {count} pens, s"), seconds, "at most 1.0 s", seconds <= 1.0);
    }
    let pens: Vec<ColourPen> =
        known_pens().iter().take(24).map(|pen| ColourPen::new(pen.name.clone(), pen.width_mm, pen.colour)).collect();
    let seconds = best_of(3, || {
        let small = self::photograph(256, 192);
        choose(&pens, Paper::WHITE, &Settings::default(), &small, 4).expect("four of them serve");
    });
    println!("four of {} pens chosen, s {seconds:21.2}", pens.len());
    let folder = tempfile::tempdir().expect("a folder for the outputs");
    for style in ["hedcut", "grid", "engrave", "charcoal"] {
        let [one, four] = [1, 4].map(|count| drawing(folder.path(), style, count));
        line(&format!("{style} in four pens, times one"), four / one, "at most 1.8", four / one <= 1.8);
    }
}

fn pen_set(count: usize) -> PenSet {
    let pens: Vec<ColourPen> =
        INKS[..count].iter().map(|ink| ColourPen::new(*ink, 0.3, ink.parse().expect("it is a colour"))).collect();
    let order = drawing_order(&pens);
    PenSet::new(order.into_iter().map(|pen| pens[pen].clone()).collect(), Paper::WHITE, Vec::new()).expect("they serve")
}

fn separate(photograph: &Raster<[f32; 3]>, count: usize) {
    let separator = Separator::new(&pen_set(count), &Settings::default()).expect("they serve");
    assert_eq!(separator.separate(photograph).coverages.len(), count);
}

/// The raccoon enlarged, as linear light.
fn photograph(width: u32, height: u32) -> Raster<[f32; 3]> {
    let sample = concat!(env!("CARGO_MANIFEST_DIR"), "/samples/raccoon.jpg");
    let picture = image::open(sample).expect("the sample is sound").to_rgb8();
    let large = image::imageops::resize(&picture, width, height, image::imageops::FilterType::Triangle);
    let light = |v: u8| {
        let v = f32::from(v) / 255.0;
        if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    };
    Raster::from_vec(width as usize, height as usize, large.pixels().map(|pixel| pixel.0.map(light)).collect())
}

/// Wall seconds of the command with the first pens, the last of them black.
fn drawing(folder: &Path, style: &str, count: usize) -> f64 {
    let pens = INKS[4 - count..4].iter().enumerate().map(|(i, ink)| format!("[pen{i}]\ncolour = \"{ink}\"\nwidth = 0.3\n"));
    std::fs::write(folder.join("pens.toml"), pens.collect::<Vec<_>>().concat()).expect("the folder can be written");
    best_of(3, || {
        let sample = concat!(env!("CARGO_MANIFEST_DIR"), "/samples/raccoon.jpg");
        let status = Command::new(env!("CARGO_BIN_EXE_drypoint"))
            .current_dir(folder)
            .args(["draw", sample, "-o", "out.svg", "--colours", "pens.toml", "--size", "120x90mm", "-q", "--style", style])
            .status();
        assert!(status.expect("the command runs").success());
    })
}

fn best_of(runs: usize, mut work: impl FnMut()) -> f64 {
    let mut once = || {
        let started = Instant::now();
        work();
        started.elapsed().as_secs_f64()
    };
    (0..runs).map(|_| once()).fold(f64::INFINITY, f64::min)
}

fn line(what: &str, value: f64, promise: &str, is_kept: bool) {
    println!("{what:34} {value:8.2}   {promise}{}", if is_kept { "" } else { "   NOT KEPT" });
}
