//! The cost of detection, compared with the guarantees: `cargo bench --bench see`.
//!
//! Detection alone on a photograph of 12 megapixels. Then the whole command in its own processes, with and without detection: peak memory
//! (through `/usr/bin/time` if available, else unknown) and wall seconds, in which it also makes a tone for the face and draws hair, skin and
//! clothing in three ways.

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
    let bytes = std::fs::read(&photo).expect("it was written");
    let photograph = Photograph::decode(&bytes, Limits::default()).expect("it is sound");
    let seeing = alone(&photograph);
    line("seeing 12 megapixels, s", seeing, "at most 0.7 s", seeing <= 0.7);
    let (seen, seen_memory) = best_of(5, &photo, folder.path(), &[]);
    let (unseen, unseen_memory) = best_of(5, &photo, folder.path(), &["--sight", "none"]);
    if let Some((seen, unseen)) = seen_memory.zip(unseen_memory) {
        line("  and MB more", seen - unseen, "at most 150 MB", seen - unseen <= 150.0);
    }
    println!("the whole command, s more           {:8.2} s", seen - unseen);
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
fn best_of(runs: usize, photo: &Path, folder: &Path, options: &[&str]) -> (f64, Option<f64>) {
    (0..runs).map(|_| run(photo, folder, options)).min_by(|a, b| a.0.total_cmp(&b.0)).expect("at least one run")
}

/// Draws few marks.
fn run(photo: &Path, folder: &Path, options: &[&str]) -> (f64, Option<f64>) {
    timed(|command| {
        command.arg("draw").arg(photo).args(["-q", "--threads", "2", "--size", "30x30mm"]);
        command.args(options).arg("-o").arg(folder.join("out.svg"));
    })
}
