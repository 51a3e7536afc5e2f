//! Charcoal's measurements: `cargo bench --bench charcoal`.
//!
//! The Hough filter compared with a plain implementation on one thread, with the thesis's printed form and with a structure
//! tensor of the same window; then whole sketches.

use drypoint::field::{HoughFilter, HoughForm, OrientationField};
use drypoint::raster::{Raster, gaussian_blur, paper_texture};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::PI;
use std::process::Command;
use std::time::Instant;

const RADIUS: usize = 10;
const ANGLES: usize = 36;

fn main() {
    speed();
    accuracy();
    sketches();
}

/// 600 x 800 pixels of lines, a tenth of them marked, as in hair.
fn speed() {
    let (width, height) = (600, 800);
    let noise = paper_texture(width, height, 6.0, 1);
    let lines = Raster::from_fn(width, height, |x, y| u8::from((x + y / 2) % 9 == 0 || noise.get(x, y) > 0.97));
    let region = Raster::filled(width, height, 1_u8);
    let filter = HoughFilter::new(HoughForm::Round, RADIUS, ANGLES);
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        (0..3)
            .map(|_| {
                let started = Instant::now();
                let field = pool.install(|| filter.orientations(&lines, &region));
                assert_eq!(field.doubled().width(), width);
                started.elapsed().as_secs_f64()
            })
            .fold(f64::INFINITY, f64::min)
    };
    let (two, one) = (with_threads(2), with_threads(1));
    // Every eighth row, times eight: the plain implementation is slow.
    let started = Instant::now();
    let mut differing = 0;
    let mut strength = 0.0;
    for y in (0..height).step_by(8) {
        for x in 0..width {
            let counts = plain_counts(&lines, x, y);
            strength += plain_response(&counts);
            if (x * 7 + y) % 1009 == 0 {
                differing += usize::from(sums_by_angle(&filter.counts(&lines, x, y)) != sums_by_angle(&flat(&counts)));
            }
        }
    }
    let plain = 8.0 * started.elapsed().as_secs_f64();
    assert!(strength > 0.0);
    println!("Hough filter, 600 x 800, 2 threads      {two:7.2} s   at most 1 s: {}", kept(two <= 1.0));
    println!("  on one thread                         {one:7.2} s");
    println!("  written plainly on one thread         {plain:7.2} s");
    println!("  faster than plain, 2 threads          {:7.1} x   at least 4: {}", plain / two, kept(plain / two >= 4.0));
    println!("  faster than plain, 1 thread           {:7.1} x", plain / one);
    println!("  windows whose counts differ           {differing:7}     none: {}", kept(differing == 0));
}

fn kept(is_kept: bool) -> &'static str {
    if is_kept { "kept" } else { "MISSED" }
}

/// Counts by angle and page-anchored rho, computed from the definition.
fn plain_counts(lines: &Raster<u8>, x: usize, y: usize) -> Vec<std::collections::BTreeMap<i32, u16>> {
    let reach = RADIUS as isize;
    let mut counts = vec![std::collections::BTreeMap::new(); ANGLES];
    for dy in -reach..=reach {
        for dx in -reach..=reach {
            let (px, py) = (x as isize + dx, y as isize + dy);
            let is_near = ((dx * dx + dy * dy) as f64) < (RADIUS as f64 + 0.5).powi(2);
            if is_near && lines.contains(px, py) && lines.get(px as usize, py as usize) != 0 {
                for (angle, counts) in counts.iter_mut().enumerate() {
                    let theta = -0.5 * PI + PI * angle as f64 / ANGLES as f64;
                    let fixed = |v: f64| (v * 16384.0).round() as i32;
                    let rho = (px as i32 * fixed(theta.cos()) + py as i32 * fixed(theta.sin())) >> 14;
                    *counts.entry(rho).or_insert(0) += 1;
                }
            }
        }
    }
    counts
}

/// The excess over the expected counts, the top twentieth, squared.
fn plain_response(counts: &[std::collections::BTreeMap<i32, u16>]) -> f64 {
    let points: f64 = counts[0].values().map(|c| f64::from(*c)).sum();
    let share = points / (PI * (RADIUS as f64 + 0.5));
    let mut excess: Vec<f64> = counts.iter().flat_map(|c| c.values()).map(|c| (f64::from(*c) - share).max(0.0)).collect();
    excess.sort_by(f64::total_cmp);
    excess.iter().rev().take(ANGLES * 25 / 20).map(|e| e * e).sum()
}

fn flat(counts: &[std::collections::BTreeMap<i32, u16>]) -> Vec<Vec<u16>> {
    counts.iter().map(|c| c.values().copied().collect()).collect()
}

/// The counts of each angle without the empty cells.
fn sums_by_angle<C: Cells + ?Sized>(counts: &C) -> Vec<Vec<u16>> {
    counts.by_angle()
}

trait Cells {
    fn by_angle(&self) -> Vec<Vec<u16>>;
}

impl Cells for Vec<u16> {
    fn by_angle(&self) -> Vec<Vec<u16>> {
        self.chunks(self.len() / ANGLES).map(|angle| angle.iter().copied().filter(|c| *c != 0).collect()).collect()
    }
}

impl Cells for Vec<Vec<u16>> {
    fn by_angle(&self) -> Vec<Vec<u16>> {
        self.clone()
    }
}

/// Mean error in degrees after smoothing at sigma = 15 px, over angles and spacings.
fn accuracy() {
    let size = 100;
    let region = Raster::filled(size, size, 1_u8);
    println!("mean error in degrees       spacing   round  thesis  tensor");
    for flipped in [0.0, 0.2] {
        for spacing in [5.0, 8.0, 11.0] {
            let mut errors = [0.0; 3];
            for step in 0..36_u64 {
                let degrees = step as f64 * 5.0;
                let lines = line_drawing(size, degrees, spacing, flipped, step);
                let round = HoughFilter::new(HoughForm::Round, RADIUS, ANGLES).orientations(&lines, &region);
                let thesis = HoughFilter::new(HoughForm::Thesis, RADIUS, ANGLES).orientations(&lines, &region).squared();
                for (error, field) in errors.iter_mut().zip([round, thesis, structure_tensor(&lines)]) {
                    *error += mean_error(&field.smoothed(15.0), degrees) / 36.0;
                }
            }
            println!(
                "  {:3.0} % flipped              {spacing:5.0}   {:5.2}   {:5.2}   {:5.2}",
                100.0 * flipped,
                errors[0],
                errors[1],
                errors[2]
            );
        }
    }
}

fn line_drawing(size: usize, degrees: f64, spacing: f64, flipped: f64, seed: u64) -> Raster<u8> {
    let normal = (degrees + 90.0).to_radians();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let pixels = (0..size * size).map(|i| {
        let offset = ((i % size) as f64 * normal.cos() + (i / size) as f64 * normal.sin()).rem_euclid(spacing);
        u8::from(offset < 1.0) ^ u8::from(random.random_range(0.0..1.0) < flipped)
    });
    Raster::from_vec(size, size, pixels.collect())
}

fn mean_error(field: &OrientationField, degrees: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (x, y) in (30..70).step_by(4).flat_map(|y| (30..70).step_by(4).map(move |x| (x, y))) {
        let found = field.angle(f64::from(x) + 0.5, f64::from(y) + 0.5).map_or(0.0, f64::to_degrees);
        let off = (found - degrees).rem_euclid(180.0);
        sum += off.min(180.0 - off);
        count += 1.0;
    }
    sum / count
}

/// The gradient's orientation, rotated to run along the lines, averaged over the same window.
fn structure_tensor(lines: &Raster<u8>) -> OrientationField {
    let grey = gaussian_blur(&lines.map(f32::from), 1.0);
    let doubled = Raster::from_fn(grey.width(), grey.height(), |x, y| {
        let at = |dx: isize, dy: isize| grey.clamped(x as isize + dx, y as isize + dy);
        let (gx, gy) = (at(1, 0) - at(-1, 0), at(0, 1) - at(0, -1));
        [gy * gy - gx * gx, -2.0 * gx * gy]
    });
    OrientationField::new(doubled).smoothed(RADIUS as f32 / 2.0)
}

/// Whole commands on the samples, with two threads.
fn sketches() {
    let folder = tempfile::tempdir().expect("a folder for the outputs");
    let samples = concat!(env!("CARGO_MANIFEST_DIR"), "/samples/");
    for name in ["astronaut-cutout.png", "grace-hopper.jpg", "bust-dark.png", "chelsea.png"] {
        let started = Instant::now();
        let status = Command::new(env!("CARGO_BIN_EXE_drypoint"))
            .arg("draw")
            .arg(format!("{samples}{name}"))
            .args(["--style", "charcoal", "-q", "--threads", "2", "-o"])
            .arg(folder.path().join("out.svg"))
            .stderr(std::process::Stdio::null())
            .status()
            .expect("the command starts");
        println!("{name:24} {:6.2} s{}", started.elapsed().as_secs_f64(), if status.success() { "" } else { "  FAILED" });
    }
}
