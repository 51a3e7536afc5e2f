//! Ink on paper as a microscope shows it, and what of that is seen from afar. It shares no code with the model of the separation:
//! each ink is a filter of fifteen bands of light, light spreads in the paper between going in and coming out, and far away everything
//! blurs.

use crate::photographed::Light;
use drypoint::colour::Lab;
use rayon::prelude::*;

/// Pixels per millimetre under the microscope.
pub const FINE: usize = 20;
/// Pixels per millimetre of what is seen from afar.
pub const COARSE: usize = 2;
/// How far light wanders in drawing paper, in mm.
const SPREAD: f64 = 0.06;

/// The part of each pixel that one layer of a drawing inks, 0 to 1.
pub struct Inked {
    width: usize,
    height: usize,
    cover: Vec<f32>,
}

impl Inked {
    /// Of a file with one layer, whose ink is `ink` (`#rrggbb`) in it.
    pub fn of_svg(svg: &str, ink: &str) -> Self {
        // As black on white, the encoded light is what the ink leaves of a pixel.
        let svg = svg.replace(ink, "#000000");
        let tree = resvg::usvg::Tree::from_str(&svg, &resvg::usvg::Options::default()).unwrap();
        let scale = FINE as f32 * 25.4 / 96.0;
        let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * scale).round() as u32);
        let mut pixmap = resvg::tiny_skia::Pixmap::new(width, height).unwrap();
        pixmap.fill(resvg::tiny_skia::Color::WHITE);
        resvg::render(&tree, resvg::tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
        let cover = pixmap.pixels().iter().map(|p| 1.0 - f32::from(p.green()) / 255.0).collect();
        Self { width: width as usize, height: height as usize, cover }
    }

    /// What of a pixel is inked, 0 to 1.
    pub fn cover(&self, x: usize, y: usize) -> f32 {
        self.cover[y * self.width + x]
    }

    /// Drawn `x`, `y` millimetres off.
    pub fn moved(&self, x: f64, y: f64) -> Self {
        let [dx, dy] = [x, y].map(|mm| (mm * FINE as f64).round() as isize);
        let (width, height) = (self.width as isize, self.height as isize);
        let from = |i: usize| {
            let (x, y) = (i as isize % width - dx, i as isize / width - dy);
            let is_on = (0..width).contains(&x) && (0..height).contains(&y);
            if is_on { self.cover[(y * width + x) as usize] } else { 0.0 }
        };
        Self { cover: (0..self.cover.len()).map(from).collect(), ..*self }
    }
}

/// White paper with layers of ink; each ink by the linear light that a full cover of it gives back.
pub fn printed(layers: &[(&Inked, [f64; 3])]) -> Light {
    let (width, height) = (layers[0].0.width, layers[0].0.height);
    // Light passes an ink twice, on the way in and on the way out.
    let once: Vec<[f64; BANDS]> = layers.iter().map(|(_, ink)| spectrum(*ink).map(f64::sqrt)).collect();
    let weights = weights();
    let mut seen = Light { width, height, pixels: vec![[0.0; 3]; width * height] };
    for three in (0..BANDS).step_by(3) {
        let filtered = |i: usize| {
            let mut light = [1.0; 3];
            for ((layer, _), ink) in layers.iter().zip(&once) {
                let cover = layer.cover[i];
                (0..3).for_each(|c| light[c] *= 1.0 - cover * (1.0 - ink[three + c] as f32));
            }
            light
        };
        let filter: Vec<[f32; 3]> = (0..width * height).into_par_iter().map(filtered).collect();
        let inside = Light { width, height, pixels: filter.clone() }.blurred(SPREAD * FINE as f64);
        for ((pixel, a), b) in seen.pixels.iter_mut().zip(&inside.pixels).zip(&filter) {
            for (c, band) in (0..3).zip(three..) {
                (0..3).for_each(|k| pixel[k] += weights[band][k] as f32 * a[c] * b[c]);
            }
        }
    }
    seen
}

/// Bands of 20 nm around 410, 430, ... 690 nm.
const BANDS: usize = 15;
/// Power of daylight (CIE D65) in them.
const DAYLIGHT: [f64; BANDS] =
    [91.49, 86.68, 117.01, 114.86, 108.81, 107.80, 107.69, 104.05, 96.33, 88.69, 89.60, 83.29, 80.03, 82.28, 69.72];
const D65: [f64; 3] = [0.950_47, 1.0, 1.088_83];
const XYZ_TO_RGB: [[f64; 3]; 3] =
    [[3.240_45, -1.537_14, -0.498_53], [-0.969_27, 1.876_01, 0.041_56], [0.055_64, -0.204_03, 1.057_23]];

/// The eye's responses x, y, z to a wave length in nm (Wyman, Sloan and Shirley 2013).
fn response(nm: f64) -> [f64; 3] {
    let lobe = |mean: f64, below: f64, above: f64| (-0.5 * ((nm - mean) / if nm < mean { below } else { above }).powi(2)).exp();
    [
        1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
        0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
        1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8),
    ]
}

/// What each band adds to linear sRGB; all together make white.
fn weights() -> [[f64; 3]; BANDS] {
    let seen: [[f64; 3]; BANDS] = std::array::from_fn(|i| response(410.0 + 20.0 * i as f64).map(|v| v * DAYLIGHT[i]));
    let sum = |k: usize| seen.iter().map(|v| v[k]).sum::<f64>();
    let sums = [sum(0), sum(1), sum(2)];
    seen.map(|v| {
        let xyz: [f64; 3] = std::array::from_fn(|k| v[k] / sums[k] * D65[k]);
        XYZ_TO_RGB.map(|row| (0..3).map(|k| row[k] * xyz[k]).sum())
    })
}

/// A smooth reflectance of a colour: a sigmoid of a parabola (Jakob and Hanika 2019), fitted by steps of Newton.
fn spectrum(rgb: [f64; 3]) -> [f64; BANDS] {
    let weights = weights();
    let of = |c: [f64; 3]| -> [f64; BANDS] {
        std::array::from_fn(|i| {
            let t = i as f64 / 7.0 - 1.0;
            let u = c[0] + c[1] * t + c[2] * t * t;
            0.5 + 0.5 * u / (1.0 + u * u).sqrt()
        })
    };
    let miss = |c: [f64; 3]| -> [f64; 3] {
        let light = of(c);
        std::array::from_fn(|k| (0..BANDS).map(|i| weights[i][k] * light[i]).sum::<f64>() - rgb[k])
    };
    let size = |m: [f64; 3]| m.iter().map(|v| v * v).sum::<f64>();
    let (mut best, mut damping) = ([0.0; 3], 1e-3);
    for _ in 0..300 {
        let now = miss(best);
        let slopes: [[f64; 3]; 3] = std::array::from_fn(|j| {
            let mut near = best;
            near[j] += 1e-5;
            let there = miss(near);
            std::array::from_fn(|k| (there[k] - now[k]) / 1e-5)
        });
        // Levenberg and Marquardt: (J J' + damping) step = -J miss.
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let normal: [[f64; 3]; 3] =
            std::array::from_fn(|i| std::array::from_fn(|j| dot(slopes[i], slopes[j]) + if i == j { damping } else { 0.0 }));
        let right: [f64; 3] = std::array::from_fn(|i| -dot(slopes[i], now));
        let step = solved(normal, right);
        let next: [f64; 3] = std::array::from_fn(|k| best[k] + step[k]);
        if size(miss(next)) < size(now) {
            (best, damping) = (next, 0.5 * damping);
        } else {
            damping *= 4.0;
        }
    }
    of(best)
}

/// Three equations, by Cramer's rule.
fn solved(m: [[f64; 3]; 3], right: [f64; 3]) -> [f64; 3] {
    let determinant = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = determinant(m);
    std::array::from_fn(|k| {
        let mut with = m;
        (0..3).for_each(|i| with[i][k] = right[i]);
        determinant(with) / whole
    })
}

#[test]
fn inks_have_their_colours_alone() {
    for ink in
        [[0.9, 0.72, 0.03], [0.01, 0.35, 0.63], [0.52, 0.04, 0.27], [0.04, 0.04, 0.045], [0.94, 0.14, 0.14], [1.0, 1.0, 1.0]]
    {
        let (light, weights) = (spectrum(ink), weights());
        for k in 0..3 {
            let seen: f64 = (0..BANDS).map(|i| weights[i][k] * light[i]).sum();
            assert!((seen - ink[k]).abs() < 0.01, "{ink:?}: {seen} for {}", ink[k]);
        }
    }
}

/// What of it is seen by an eye that blurs `sigma_mm`, in coarse pixels.
pub fn from_afar(light: &Light, pixels_per_mm: usize, sigma_mm: f64) -> Light {
    let side = pixels_per_mm / COARSE;
    let (width, height) = (light.width / side, light.height / side);
    let mean = |i: usize| {
        let mut sum = [0.0_f32; 3];
        for (x, y) in (0..side * side).map(|k| (i % width * side + k % side, i / width * side + k / side)) {
            let pixel = light.pixels[y * light.width + x];
            (0..3).for_each(|c| sum[c] += pixel[c] / (side * side) as f32);
        }
        sum
    };
    let pixels = (0..width * height).into_par_iter().map(mean).collect();
    Light { width, height, pixels }.blurred(sigma_mm * COARSE as f64)
}

/// CIEDE2000 between two pictures of one size, in the pixels that are at least `border_mm` inside and pass `is_in_gamut` in the second:
/// sorted.
pub fn differences(seen: &Light, wanted: &Light, border_mm: f64, is_in_gamut: impl Fn([f32; 3]) -> bool) -> Vec<f64> {
    let border = (border_mm * COARSE as f64) as usize;
    let (columns, rows) = (border..wanted.width - border, border..wanted.height - border);
    let places = (0..wanted.pixels.len()).filter(|i| columns.contains(&(i % wanted.width)) && rows.contains(&(i / wanted.width)));
    let places = places.filter(|i| is_in_gamut(wanted.pixels[*i]));
    let lab = |light: [f32; 3]| Lab::from_rgb(light.map(f64::from));
    let mut found: Vec<f64> = places.map(|i| lab(seen.pixels[i]).difference(lab(wanted.pixels[i]))).collect();
    found.sort_by(f64::total_cmp);
    found
}
