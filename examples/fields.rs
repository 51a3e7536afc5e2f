//! Writes the fields of the structure grid's paper as photographs to be drawn, with their steering lines:
//! `cargo run --release --example fields -- DIR` writes `circular.png`, `circular-edges.png`, `saddle.png` and `saddle-edges.png`.

use image::{GrayImage, Luma};
use std::path::Path;

const SIDE: u32 = 900;
/// Half the width of a steering line, and the spacing of the lines, in half sides of the picture.
const HALF_LINE: f64 = 0.004;
const RINGS: f64 = 0.1;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".to_owned());
    let write = |name: &str, grey: &dyn Fn(f64, f64) -> f64| {
        let at = |v: u32| 2.0 * (f64::from(v) + 0.5) / f64::from(SIDE) - 1.0;
        let pixel = |x: u32, y: u32| Luma([(255.0 * grey(at(x), at(y)).clamp(0.0, 1.0)).round() as u8]);
        GrayImage::from_fn(SIDE, SIDE, pixel).save(Path::new(&folder).join(name))
    };
    // A ball lit from the upper left on a light ground, so that every ring has all tones.
    write("circular.png", &|x, y| {
        let r = x.hypot(y);
        let ground = 0.92 - 0.25 * (r - 0.8).max(0.0);
        if r > 0.8 { ground } else { lit(x / 0.8, y / 0.8) }
    })?;
    write("circular-edges.png", &|x, y| {
        let r = x.hypot(y);
        let nearest = (r / RINGS).round().max(1.0) * RINGS;
        f64::from(u8::from((r - nearest).abs() < HALF_LINE))
    })?;
    // A ramp from corner to corner.
    write("saddle.png", &|x, y| 0.5 + 0.24 * (x + y))?;
    write("saddle-edges.png", &|x, y| {
        // The lines xy = c; their spacing grows with the slope of xy.
        let slope = x.hypot(y).max(0.02);
        let step = 2.0 * RINGS * RINGS;
        let away =
            [-16.0, -9.0, -4.0, -1.0, 0.0, 1.0, 4.0, 9.0, 16.0, 25.0, -25.0].map(|c: f64| (x * y - c * step).abs() / slope);
        f64::from(u8::from(away.into_iter().fold(f64::INFINITY, f64::min) < HALF_LINE))
    })?;
    Ok(())
}

/// Lambert's law on a ball, with some ambient light.
fn lit(x: f64, y: f64) -> f64 {
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    0.03 + 0.97 * (-0.5 * x - 0.55 * y + 0.67 * z).max(0.0)
}
