//! Paths of many segments and many crossings are plotted, or refused before the work, within two gigabytes.
#![cfg(feature = "cli")]
#![cfg(target_os = "linux")]

use std::fmt::Write;
use std::process::{Command, Output};

/// Limit of the program's address space in kilobytes.
const MEMORY: u32 = 2 << 20;

/// Deterministic pseudo-random numbers from 0 to 1.
struct Places(u64);

impl Places {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn path(points: impl Iterator<Item = [f64; 2]>) -> String {
    let mut text = String::from("M");
    points.for_each(|[x, y]| write!(text, "{x:.3},{y:.3} ").unwrap());
    text
}

/// A walk of half a million short steps on a sheet of 200 mm.
fn walk() -> String {
    let mut places = Places(7);
    let mut at = [100.0_f64, 100.0];
    path((0..500_000).map(|_| {
        let (sin, cos) = (std::f64::consts::TAU * places.next()).sin_cos();
        at = [(at[0] + 0.3 * cos).clamp(1.0, 199.0), (at[1] + 0.3 * sin).clamp(1.0, 199.0)];
        at
    }))
}

/// A wavy ring of half a million vertices that does not cross itself.
fn ring() -> String {
    path((0..500_000).map(|i| {
        let angle = f64::from(i) * std::f64::consts::TAU / 500_000.0;
        let radius = 90.0 + 5.0 * (700.0 * angle).sin();
        [100.0 + radius * angle.cos(), 100.0 + radius * angle.sin()]
    }))
}

/// 20,000 random vertices: tens of millions of crossings.
fn polygon() -> String {
    let mut places = Places(3);
    path((0..20_000).map(|_| [200.0 * places.next(), 200.0 * places.next()]))
}

fn plotted(name: &str, path: &str, attributes: &str, options: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("path.svg");
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='200mm' height='200mm' viewBox='0 0 200 200'><path d='{path}' {attributes}/></svg>"
    );
    std::fs::write(&file, svg).unwrap();
    let started = std::time::Instant::now();
    let output = Command::new("sh")
        .args(["-c", &format!("ulimit -v {MEMORY}; exec \"$@\""), "sh", env!("CARGO_BIN_EXE_drypoint"), "plot"])
        .arg(&file)
        .args(["--ink-model", "ink", "--occlude", "--order", "fast", "-o"])
        .arg(folder.path().join("out.svg"))
        .args(options)
        .output()
        .unwrap();
    println!("{name}: {:.1} s, {}", started.elapsed().as_secs_f64(), String::from_utf8_lossy(&output.stderr));
    output
}

fn is_done(output: &Output) {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

fn is_refused(output: &Output, with: &[&str]) {
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    with.iter().for_each(|text| assert!(message.contains(text), "{text} is not in: {message}"));
}

#[test]
fn half_a_million_segments_are_plotted() {
    is_done(&plotted("a line", &walk(), "fill='none' stroke='#000' stroke-width='.3'", &[]));
    is_done(&plotted("a fill", &(ring() + "Z"), "fill='#000'", &[]));
    is_done(&plotted("a wide line", &ring(), "fill='none' stroke='#000' stroke-width='2'", &[]));
}

#[test]
fn half_a_million_segments_that_cover_one_another_are_done_or_refused() {
    for (name, path, attributes) in [
        ("a tangled fill", walk() + "Z", "fill='#000'"),
        ("a tangled wide line", walk(), "fill='none' stroke='#000' stroke-width='3'"),
        ("both", walk() + "Z", "fill='#f00' stroke='#000' stroke-width='.5'"),
    ] {
        let output = plotted(name, &path, attributes, &[]);
        if !output.status.success() {
            is_refused(&output, &["about", "at most", "--ink-model lines"]);
        }
    }
}

#[test]
fn a_polygon_of_tens_of_millions_of_crossings_is_refused_with_their_number() {
    let even_odd = plotted("even-odd", &(polygon() + "Z"), "fill='#000' fill-rule='evenodd'", &[]);
    is_refused(&even_odd, &["crossings of outlines", "limit is 12 million", "--most-work"]);
    let nonzero = plotted("nonzero", &(polygon() + "Z"), "fill='#000'", &[]);
    is_refused(&nonzero, &["cross or overlap about", "at most 2000000", "--ink-model lines"]);
}

#[test]
fn ninety_kilometres_of_line_are_refused_with_their_length() {
    let zigzag = path((0..500_000).map(|i| [0.5 + 0.0004 * f64::from(i), 10.0 + 180.0 * f64::from(i % 2)]));
    is_refused(
        &plotted("a zigzag", &zigzag, "fill='none' stroke='#000' stroke-width='.3'", &[]),
        &["90000 m", "at most", "--pen"],
    );
}
