//! What users wait for, compared with the guarantees: `cargo bench --bench limits`.
//!
//! Whole commands in their own processes, with their peak memory (from `wait4` through `/usr/bin/time` if available, else
//! unknown), and ratios within one run, so that a busy machine does not decide.

mod timing;

use drypoint::drawing::{Colour, Handling, Page};
use drypoint::geometry::Point;
use drypoint::interrupt::Interrupt;
use drypoint::plot::{PenPaths, Plot, Profile, Toolpath, clock, mount};
use image::{ImageFormat, RgbImage};
use std::path::{Path, PathBuf};
use std::time::Instant;
use timing::{line, timed};

fn main() {
    let folder = tempfile::tempdir().expect("a folder for the outputs");
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/astronaut.jpg");
    let large = large_photograph(folder.path(), &sample);
    let draw = |photo: &Path, extra: &[&str]| best_of(3, photo, folder.path(), extra);

    let (seconds, memory) = draw(&sample, &["--size", "90x120mm", "--pitch", "0.6mm"]);
    line("astronaut, 90 x 90 mm at 0.6 mm", seconds, "at most 2 s", seconds <= 2.0);
    if let Some(memory) = memory {
        line("  its peak memory, MB", memory, "at most 300 MB", memory <= 300.0);
    }
    let (large_seconds, _) = draw(&large, &["--size", "90x120mm", "--pitch", "0.6mm"]);
    line("  more for 24 megapixels", large_seconds - seconds, "at most 1.5 s", large_seconds - seconds <= 1.5);
    let (small, _) = draw(&sample, &["--size", "180x180mm", "--pitch", "0.6mm"]);
    let ratio = small / seconds;
    line("  4 x the area costs times", ratio, "at most 4.5", ratio <= 4.5);
    let told = clock_seconds(100_000);
    line("the time of 100,000 paths told", told, "at most 0.5 s", told <= 0.5);
    let growth = told / clock_seconds(10_000);
    line("  10 x the paths cost times", growth, "at most 15", growth <= 15.0);
}

/// Seconds to estimate the time of many waves of 20 points each on a machine with GRBL.
fn clock_seconds(count: usize) -> f64 {
    let servo = Profile::built_in("grbl-servo").expect("it is built in");
    let wave = |i: usize| {
        let (x, y) = (200.0 * (i as f64 * 0.754_877_666).fract(), 200.0 * (i as f64 * 0.569_840_291).fract());
        Toolpath::new((0..20).map(f64::from).map(|k| Point::new(x + 0.1 * k, y + 0.1 * (0.7 * k).sin())).collect())
    };
    let pen = PenPaths {
        number: 1,
        name: "waves".to_owned(),
        colour: Colour::BLACK,
        nib: 0.3,
        handling: Handling::default(),
        paths: (0..count).filter_map(wave).collect(),
    };
    let plot = Plot { page: Page::new(250.0, 250.0), pens: vec![pen] };
    let mounting = mount(&servo, &plot.page).expect("the page fits");
    let once = || {
        let started = Instant::now();
        assert!(clock(&plot, &servo, &mounting, &Interrupt::never()).expect("nobody stops it")[0].total() > 0.0);
        started.elapsed().as_secs_f64()
    };
    (0..3).map(|_| once()).fold(f64::INFINITY, f64::min)
}

/// The sample enlarged to 4900 x 4900 pixels, as JPEG.
fn large_photograph(folder: &Path, sample: &Path) -> PathBuf {
    let picture: RgbImage = image::open(sample).expect("the sample is sound").to_rgb8();
    let large = image::imageops::resize(&picture, 4900, 4900, image::imageops::FilterType::Triangle);
    let path = folder.join("large.jpg");
    large.save_with_format(&path, ImageFormat::Jpeg).expect("the folder can be written");
    path
}

/// The best of several runs: wall seconds, and peak megabytes if known.
fn best_of(runs: usize, photo: &Path, folder: &Path, extra: &[&str]) -> (f64, Option<f64>) {
    (0..runs).map(|_| run(photo, folder, extra)).min_by(|a, b| a.0.total_cmp(&b.0)).expect("at least one run")
}

fn run(photo: &Path, folder: &Path, extra: &[&str]) -> (f64, Option<f64>) {
    timed(|command| {
        command.arg("draw").arg(photo).args(["-q", "--threads", "2", "-o"]).arg(folder.join("out.svg")).args(extra);
    })
}
