//! The cost of detection, compared with the guarantees: `cargo bench --bench see`.
//!
//! The whole command in its own processes, with and without detection, on a photograph of 12 megapixels: wall seconds and peak
//! memory (through `/usr/bin/time` if available, else unknown). Then detection alone.

mod timing;

use drypoint::interrupt::Interrupt;
use drypoint::see::look;
use drypoint::source::{Limits, Photograph};
use image::{ImageFormat, RgbImage};
use std::path::{Path, PathBuf};
use std::time::Instant;
use timing::{line, timed};

fn main() {
    let folder = tempfile::tempdir().expect("a folder for the outputs");
    let photo = large_photograph(folder.path());
    let (auto, auto_memory) = best_of(5, &photo, folder.path(), "auto");
    let (keep, keep_memory) = best_of(5, &photo, folder.path(), "keep");
    line("seeing 12 megapixels, s more", auto - keep, "at most 0.7 s", auto - keep <= 0.7);
    if let Some((auto, keep)) = auto_memory.zip(keep_memory) {
        line("  and MB more", auto - keep, "at most 150 MB", auto - keep <= 150.0);
    }
    let bytes = std::fs::read(&photo).expect("it was written");
    let photograph = Photograph::decode(&bytes, Limits::default()).expect("it is sound");
    println!("the look alone                     {:8.2} s", alone(&photograph));
    let none = Photograph::decode(&nobody(folder.path()), Limits::default()).expect("it is sound");
    println!("where there is nobody              {:8.2} s", alone(&none));
}

fn alone(photograph: &Photograph) -> f64 {
    let once = || {
        let started = Instant::now();
        look(photograph, &Interrupt::never()).expect("it can be looked at");
        started.elapsed().as_secs_f64()
    };
    (0..3).map(|_| once()).fold(f64::INFINITY, f64::min)
}

/// The astronaut enlarged to 3464 x 3464 pixels, as JPEG.
fn large_photograph(folder: &Path) -> PathBuf {
    let sample = concat!(env!("CARGO_MANIFEST_DIR"), "/samples/astronaut.jpg");
    let picture: RgbImage = image::open(sample).expect("the sample is sound").to_rgb8();
    let large = image::imageops::resize(&picture, 3464, 3464, image::imageops::FilterType::Triangle);
    let path = folder.join("large.jpg");
    large.save_with_format(&path, ImageFormat::Jpeg).expect("the folder can be written");
    path
}

/// A raccoon of 12 megapixels.
fn nobody(folder: &Path) -> Vec<u8> {
    let sample = concat!(env!("CARGO_MANIFEST_DIR"), "/samples/raccoon.jpg");
    let picture: RgbImage = image::open(sample).expect("the sample is sound").to_rgb8();
    let large = image::imageops::resize(&picture, 4000, 3000, image::imageops::FilterType::Triangle);
    let path = folder.join("nobody.jpg");
    large.save_with_format(&path, ImageFormat::Jpeg).expect("the folder can be written");
    std::fs::read(path).expect("it was written")
}

/// The best of several runs: wall seconds, and peak megabytes if known.
fn best_of(runs: usize, photo: &Path, folder: &Path, background: &str) -> (f64, Option<f64>) {
    (0..runs).map(|_| run(photo, folder, background)).min_by(|a, b| a.0.total_cmp(&b.0)).expect("at least one run")
}

/// Draws with a given or a detected subject: the marks are few either way, so that the difference is the detection.
fn run(photo: &Path, folder: &Path, background: &str) -> (f64, Option<f64>) {
    timed(|command| {
        command.arg("draw").arg(photo).args(["-q", "--threads", "2", "--size", "30x30mm", "--background", background, "-o"]);
        command.arg(folder.join("out.svg"));
    })
}
