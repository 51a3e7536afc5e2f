//! Several pens on flat patches: their marks together have no pattern that is coarser than the marks.
#![cfg(feature = "cli")]

use crate::microscope::{FINE, Inked};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Command;

const PENS: [(&str, &str); 3] = [("yellow", "#f4dc2c"), ("cyan", "#1b9fd0"), ("magenta", "#bf3a8f")];
/// Patches that need all three.
const PATCHES: [[u8; 3]; 3] = [[205, 200, 212], [190, 175, 170], [150, 150, 150]];
const SIDE: usize = 44;
const PITCH: f64 = 0.6;
/// Pixels per millimetre of the pattern, and its part whose spectrum is taken, in millimetres.
const COARSE: usize = 5;
const PART: usize = 16;
/// Twice as coarse as the marks is a pattern of its own: cycles per millimetre.
const FINEST: f64 = 0.5 / PITCH;

fn drawn(folder: &Path, colour: [u8; 3], style: &str) -> Vec<Inked> {
    image::RgbImage::from_pixel(120, 120, image::Rgb(colour)).save(folder.join("flat.png")).unwrap();
    let (size, pitch) = (format!("{SIDE}x{SIDE}mm"), PITCH.to_string());
    let how = ["draw", "flat.png", "-o", "{layer}.svg", "--colours", "pens.toml", "--size", &size, "--pitch", &pitch];
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let output = command.current_dir(folder).args(how).args(["--sight=none", "-q", "--style", style]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    PENS.map(|(name, ink)| Inked::of_svg(&fs::read_to_string(folder.join(format!("{name}.svg"))).unwrap(), ink)).into()
}

/// The share of each coarse pixel under any ink.
fn union(layers: &[Inked]) -> Vec<f64> {
    let (side, wide) = (FINE / COARSE, SIDE * COARSE);
    let bare = |x: usize, y: usize| layers.iter().map(|layer| 1.0 - f64::from(layer.cover(x, y))).product::<f64>();
    let pixel = |i: usize| {
        let fine = (0..side * side).map(|k| bare(i % wide * side + k % side, i / wide * side + k / side));
        1.0 - fine.sum::<f64>() / (side * side) as f64
    };
    (0..wide * wide).map(pixel).collect()
}

/// Adds the power of a part of the pattern at each pair of whole frequencies, columns from 0, rows from `-most`.
fn add_spectrum(pattern: &[f64], (left, top): (usize, usize), most: usize, power: &mut [f64]) {
    let (n, wide) = (PART * COARSE, SIDE * COARSE);
    let window = |i: usize| 0.5 - 0.5 * (TAU * (i as f64 + 0.5) / n as f64).cos();
    let at = |x: usize, y: usize| pattern[(top + y) * wide + left + x];
    let mean = (0..n * n).map(|i| at(i % n, i / n)).sum::<f64>() / (n * n) as f64;
    let turn = |k: f64, i: usize| (TAU * k * i as f64 / n as f64).sin_cos();
    for fx in 0..=most {
        let row = |y: usize| {
            (0..n).fold((0.0, 0.0), |(re, im), x| {
                let (value, (sin, cos)) = ((at(x, y) - mean) * window(x) * window(y), turn(fx as f64, x));
                (re + value * cos, im - value * sin)
            })
        };
        let rows: Vec<(f64, f64)> = (0..n).map(row).collect();
        for j in 0..=2 * most {
            let fy = j as f64 - most as f64;
            let (re, im) = rows.iter().enumerate().fold((0.0, 0.0), |(re, im), (y, (a, b))| {
                let (sin, cos) = turn(fy, y);
                (re + a * cos + b * sin, im + b * cos - a * sin)
            });
            power[fx * (2 * most + 1) + j] += re * re + im * im;
        }
    }
}

/// The highest amplitude in units of the noise, which is the median around its frequency.
fn highest_peak(power: &[f64], noise: &[f64], most: usize) -> f64 {
    let radius = |i: usize| {
        let (fx, fy) = ((i / (2 * most + 1)) as f64, (i % (2 * most + 1)) as f64 - most as f64);
        fx.hypot(fy)
    };
    let is_pattern = |i: &usize| (2.5..=most as f64).contains(&radius(*i));
    let peak = |i: usize| {
        let around = (0..power.len()).filter(|j| is_pattern(j) && (radius(*j) - radius(i)).abs() < 1.5);
        let mut around: Vec<f64> = around.map(|j| noise[j]).collect();
        around.sort_by(f64::total_cmp);
        (power[i] / around[around.len() / 2]).sqrt()
    };
    (0..power.len()).filter(is_pattern).map(peak).fold(0.0, f64::max)
}

#[test]
fn pens_together_make_no_moire() {
    let folder = tempfile::tempdir().unwrap();
    let pens = PENS.map(|(name, ink)| format!("[{name}]\ncolour = \"{ink}\"\nwidth = 0.3\n")).concat();
    fs::write(folder.path().join("pens.toml"), pens).unwrap();
    let most = (FINEST * PART as f64) as usize;
    for colour in PATCHES {
        let mut dots = None;
        for style in ["hedcut", "grid", "engrave"] {
            let pattern = union(&drawn(folder.path(), colour, style));
            let mut power = vec![0.0; (most + 1) * (2 * most + 1)];
            let (border, step) = (2 * COARSE, PART * COARSE / 2);
            for i in 0..16 {
                add_spectrum(&pattern, (border + i % 4 * step, border + i / 4 * step), most, &mut power);
            }
            // Straight lines alone have no noise; a picture in dots has what nobody minds.
            let noise = dots.get_or_insert_with(|| power.clone());
            let peak = highest_peak(&power, noise, most);
            println!("{style} {colour:?}: highest peak {peak:.2} times the noise");
            assert!(peak <= 3.0, "{style} {colour:?}: {peak}");
        }
    }
}
