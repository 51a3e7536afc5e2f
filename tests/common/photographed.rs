//! A photograph of a sheet as a hand-held camera takes it: from aslant, in uneven coloured light, unsharp, noisy.
#![allow(dead_code)]

use image::{Rgb, RgbImage};
use rayon::prelude::*;

/// Random numbers that are the same everywhere.
pub struct Chance(u64);

impl Chance {
    pub fn new(seed: u64) -> Self {
        let mut chance = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d);
        for _ in 0..8 {
            chance.next();
        }
        chance
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.between(0.0, count as f64) as usize).min(count - 1)
    }

    fn normal(&mut self) -> f64 {
        let (radius, angle) = (self.between(1e-12, 1.0), self.between(0.0, std::f64::consts::TAU));
        (-2.0 * radius.ln()).sqrt() * angle.cos()
    }
}

/// Linear light, row by row.
#[derive(Clone)]
pub struct Light {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<[f32; 3]>,
}

impl Light {
    /// Between pixels' centres; `None` outside.
    fn at(&self, x: f64, y: f64) -> Option<[f32; 3]> {
        let (x, y) = (x - 0.5, y - 0.5);
        if x < 0.0 || y < 0.0 || x >= (self.width - 1) as f64 || y >= (self.height - 1) as f64 {
            return None;
        }
        let (column, row, tx, ty) = (x as usize, y as usize, x.fract() as f32, y.fract() as f32);
        let pixel = |dx: usize, dy: usize| self.pixels[(row + dy) * self.width + column + dx];
        let [a, b, c, d] = [pixel(0, 0), pixel(1, 0), pixel(0, 1), pixel(1, 1)];
        Some(std::array::from_fn(|i| {
            let (top, bottom) = (a[i] + (b[i] - a[i]) * tx, c[i] + (d[i] - c[i]) * tx);
            top + (bottom - top) * ty
        }))
    }

    pub fn blurred(self, sigma: f64) -> Self {
        let reach = (3.0 * sigma).ceil() as isize;
        let weights: Vec<f32> = (-reach..=reach).map(|i| (-0.5 * (i as f64 / sigma).powi(2)).exp() as f32).collect();
        let sum: f32 = weights.iter().sum();
        let (width, height) = (self.width as isize, self.height as isize);
        let pass = |from: &[[f32; 3]], dx: isize, dy: isize| -> Vec<[f32; 3]> {
            let of = |i: usize| {
                let (x, y) = (i as isize % width, i as isize / width);
                let mut light = [0.0; 3];
                for (weight, k) in weights.iter().zip(-reach..) {
                    let (x, y) = ((x + k * dx).clamp(0, width - 1), (y + k * dy).clamp(0, height - 1));
                    let v = from[(y * width + x) as usize];
                    (0..3).for_each(|c| light[c] += weight * v[c] / sum);
                }
                light
            };
            (0..from.len()).into_par_iter().map(of).collect()
        };
        let pixels = pass(&pass(&self.pixels, 1, 0), 0, 1);
        Self { pixels, ..self }
    }
}

/// How much worse than a scan a photograph is: 0 is as good as one, 1 as bad as a careful person's telephone takes it.
pub fn photographed(sheet: &Light, harm: f64, chance: &mut Chance) -> RgbImage {
    let side = (1.12 * sheet.width as f64, 1.12 * sheet.height as f64);
    let (width, height) = (side.0 as usize, side.1 as usize);
    let back = camera(sheet, (width, height), harm, chance);
    let table = [0; 3].map(|_: i32| chance.between(0.05, 0.5) as f32);
    let cast = [0; 3].map(|_: i32| 1.0 + harm * chance.between(-0.12, 0.12));
    let exposure = chance.between(0.62, 0.86) / (1.0 + 0.12 * harm);
    let (slope, vignette) = ([0; 2].map(|_: i32| harm * chance.between(-0.12, 0.12)), harm * chance.between(0.0, 0.3));
    let seen = |i: usize| {
        let (x, y) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let w = back[2][0] * x + back[2][1] * y + back[2][2];
        let place = [0, 1].map(|row| (back[row][0] * x + back[row][1] * y + back[row][2]) / w);
        let light = sheet.at(place[0], place[1]).unwrap_or(table);
        let (u, v) = (2.0 * x / width as f64 - 1.0, 2.0 * y / height as f64 - 1.0);
        let even = exposure * (1.0 + slope[0] * u + slope[1] * v) * (1.0 - 0.5 * vignette * (u * u + v * v));
        [0, 1, 2].map(|c| light[c] * (even * cast[c]) as f32)
    };
    let pixels = (0..width * height).into_par_iter().map(seen).collect();
    let light = Light { width, height, pixels }.blurred(0.5 + harm * chance.between(0.2, 1.0));
    let noise = harm * chance.between(0.003, 0.02);
    RgbImage::from_fn(width as u32, height as u32, |x, y| {
        let light = light.pixels[y as usize * width + x as usize];
        Rgb(light.map(|v| encoded(f64::from(v) + noise * (f64::from(v).max(0.0) + 0.02).sqrt() * chance.normal())))
    })
}

fn encoded(v: f64) -> u8 {
    let v = v.clamp(0.0, 1.0);
    let v = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (255.0 * v).round() as u8
}

type Matrix = [[f64; 3]; 3];

/// From the picture's pixels to the sheet's: a camera above the sheet, aslant and turned.
fn camera(sheet: &Light, (width, height): (usize, usize), harm: f64, chance: &mut Chance) -> Matrix {
    let [tilt, pan, roll] = [0.2, 0.2, 0.12].map(|most| harm * chance.between(-most, most));
    let focal = 1.3 * height as f64;
    let distance = focal * (1.0 + 0.06 * harm + harm * chance.between(0.0, 0.1));
    let (sin, cos) = (f64::sin, f64::cos);
    let turn = product(
        [[cos(roll), -sin(roll), 0.0], [sin(roll), cos(roll), 0.0], [0.0, 0.0, 1.0]],
        product(
            [[1.0, 0.0, 0.0], [0.0, cos(tilt), -sin(tilt)], [0.0, sin(tilt), cos(tilt)]],
            [[cos(pan), 0.0, sin(pan)], [0.0, 1.0, 0.0], [-sin(pan), 0.0, cos(pan)]],
        ),
    );
    let plane = [0, 1, 2].map(|row| [turn[row][0], turn[row][1], if row == 2 { distance } else { 0.0 }]);
    let centred = [[1.0, 0.0, -0.5 * sheet.width as f64], [0.0, 1.0, -0.5 * sheet.height as f64], [0.0, 0.0, 1.0]];
    let lens = [[focal, 0.0, 0.5 * width as f64], [0.0, focal, 0.5 * height as f64], [0.0, 0.0, 1.0]];
    inverse(product(lens, product(plane, centred)))
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn inverse(m: Matrix) -> Matrix {
    let cofactor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| cofactor(j, i) / determinant))
}
