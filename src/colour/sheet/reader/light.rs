//! The light on the sheet, from bare paper: a smooth field in each channel.

use super::picture::Probe;
use super::solve::solved;
use super::view::View;
use crate::colour::sheet::grid::{COLUMNS, Cell, Patch, ROWS};
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect, Vec2};

/// Degree of the polynomial, in the logarithm of light, and its number of terms.
const DEGREE: usize = 4;
const TERMS: usize = (DEGREE + 1) * (DEGREE + 2) / 2;
/// Rounds in which outliers lose weight, and the number of deviations at which it is halved.
const ROUNDS: usize = 8;
const OUTLIERS: f64 = 2.0;
/// Stiffness of the terms: without evidence they stay 0.
const STIFF: f64 = 1e-4;
/// Samples along each side of a spot of paper.
const SAMPLES: usize = 16;
/// Half the width and height of a spot between two patches, in cells.
const GAP: [f64; 2] = [0.035, 0.25];
/// Reach in cells of what paper nearby says beyond the polynomial, and the number of spots that its own weight equals.
const NEAR: f64 = 0.9;
const INERTIA: f64 = 1.0;

/// Bare paper at a place of the sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub at: Point,
    /// Mean linear light.
    pub light: [f64; 3],
    /// Standard deviation of a single sample, relative, and what it leaves in the mean.
    pub noise: f64,
    error: f64,
    /// Share of samples in which a channel is clipped.
    pub clipped: f64,
    weight: f64,
}

/// The light of bare paper everywhere on the sheet.
#[derive(Clone, Debug)]
pub(super) struct Light {
    terms: [Vec<f64>; 3],
    /// What the polynomial leaves: places, logarithms, weights.
    rests: Vec<(Point, [f64; 3], f64)>,
    /// Robust deviation of the spots from the polynomial beyond their noise, relative.
    pub residual: f64,
}

/// Bare paper in cells and in the gaps between patches.
pub(super) fn spots(view: &View, probe: &Probe<'_>, cells: &[Cell]) -> Vec<Spot> {
    let mut areas: Vec<(Rect, f64)> = Vec::new();
    for cell in cells.iter().filter(|cell| cell.patch == Patch::Paper) {
        let window = cell.window();
        let quarter = |dx: f64, dy: f64| Rect::from_center_size(window.center() + 0.125 * Vec2::new(dx, dy), (0.25, 0.25));
        areas.extend([(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(dx, dy)| (quarter(dx, dy), 1.0)));
    }
    let gaps = (1..ROWS - 1).flat_map(|y| (1..COLUMNS).map(move |x| Point::new(x as f64, y as f64 + 0.5)));
    areas.extend(gaps.map(|p| (Rect::from_center_size(p, (2.0 * GAP[0], 2.0 * GAP[1])), 0.5)));
    areas.into_iter().map(|(area, weight)| spot(view, probe, area, weight)).collect()
}

fn spot(view: &View, probe: &Probe<'_>, area: Rect, weight: f64) -> Spot {
    let at = |i: usize| (i as f64 + 0.5) / SAMPLES as f64;
    let places = (0..SAMPLES * SAMPLES)
        .map(|k| view.at(Point::new(area.x0 + at(k % SAMPLES) * area.width(), area.y0 + at(k / SAMPLES) * area.height())));
    let (mut sum, mut squares, mut clipped) = ([0.0; 3], 0.0, 0.0);
    for p in places {
        let light = probe.at(p).map(f64::from);
        sum = std::array::from_fn(|c| sum[c] + light[c]);
        squares += light[1] * light[1];
        clipped += f64::from(u8::from(probe.is_clipped(p)));
    }
    let count = (SAMPLES * SAMPLES) as f64;
    let light = sum.map(|v| (v / count).max(1e-6));
    let noise = (squares / count - light[1] * light[1]).max(0.0).sqrt() / light[1];
    let pixels = (area.area() * view.scale(area.center()).powi(2)).max(1.0);
    Spot { at: area.center(), light, noise, error: noise / pixels.sqrt(), clipped: clipped / count, weight }
}

impl Light {
    /// Fits the field to spots of paper.
    pub(super) fn fitted(spots: &[Spot]) -> Option<Self> {
        let mut weights: Vec<f64> = spots.iter().map(|spot| spot.weight).collect();
        let mut light = Self { terms: [const { Vec::new() }; 3], rests: Vec::new(), residual: 0.0 };
        for _ in 0..ROUNDS {
            light.terms = [polynomial(spots, &weights, 0)?, polynomial(spots, &weights, 1)?, polynomial(spots, &weights, 2)?];
            let rests: Vec<f64> = spots.iter().map(|spot| largest(light.rest(spot))).collect();
            let mut sorted = rests.clone();
            sorted.sort_unstable_by(f64::total_cmp);
            light.residual = 1.4826 * sorted.get(sorted.len() / 2)?;
            let scale = OUTLIERS * light.residual.max(1e-3);
            weights = spots.iter().zip(rests).map(|(spot, rest)| spot.weight / (1.0 + (rest / scale).powi(2))).collect();
        }
        let mut errors: Vec<f64> = spots.iter().map(|spot| spot.error).collect();
        errors.sort_unstable_by(f64::total_cmp);
        // The largest of three channels lies off by about twice a channel's deviation.
        light.residual = (light.residual.powi(2) - (2.0 * errors[errors.len() / 2]).powi(2)).max(0.0).sqrt();
        light.rests = spots.iter().zip(weights).map(|(spot, weight)| (spot.at, light.rest(spot), weight)).collect();
        Some(light)
    }

    /// Light of bare paper at a point of the sheet.
    pub(super) fn at(&self, p: Point) -> [f64; 3] {
        let basis = basis(p);
        let (mut sum, mut whole) = ([0.0; 3], INERTIA);
        for (at, rest, weight) in &self.rests {
            let near = weight * (-0.5 * (at.distance(p) / NEAR).powi(2)).exponential();
            whole += near;
            sum = std::array::from_fn(|c| sum[c] + near * rest[c]);
        }
        std::array::from_fn(|c| (dot(&self.terms[c], &basis) + sum[c] / whole).exponential())
    }

    /// Logarithm of a spot's light over the polynomial.
    fn rest(&self, spot: &Spot) -> [f64; 3] {
        let basis = basis(spot.at);
        std::array::from_fn(|c| spot.light[c].logarithm() - dot(&self.terms[c], &basis))
    }

    /// Brightest light over darkest, over the corners and the middle of the sheet.
    pub(super) fn fall_off(&self) -> f64 {
        let (wide, high) = (COLUMNS as f64, ROWS as f64);
        let places = (0..9).map(|k| Point::new(0.5 * f64::from(k % 3) * wide, 0.5 * f64::from(k / 3) * high));
        let (least, most) = places.fold((f64::INFINITY, 0.0_f64), |(least, most), p| {
            let light = self.at(p)[1];
            (least.min(light), most.max(light))
        });
        1.0 - least / most.max(1e-9)
    }
}

fn largest(rest: [f64; 3]) -> f64 {
    rest.into_iter().fold(0.0, |most, v| most.max(v.abs()))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The polynomial's terms at a point, each from -1 to 1.
fn basis(p: Point) -> [f64; TERMS] {
    let (u, v) = (2.0 * p.x / COLUMNS as f64 - 1.0, 2.0 * p.y / ROWS as f64 - 1.0);
    let mut basis = [0.0; TERMS];
    let powers = (0..=DEGREE).flat_map(|degree| (0..=degree).map(move |j| (degree - j, j)));
    for (term, (i, j)) in basis.iter_mut().zip(powers) {
        *term = u.powi(i as i32) * v.powi(j as i32);
    }
    basis
}

fn polynomial(spots: &[Spot], weights: &[f64], channel: usize) -> Option<Vec<f64>> {
    let (mut left, mut right) = (vec![vec![0.0; TERMS]; TERMS], vec![0.0; TERMS]);
    for (spot, weight) in spots.iter().zip(weights) {
        let (basis, value) = (basis(spot.at), spot.light[channel].logarithm());
        for i in 0..TERMS {
            right[i] += weight * basis[i] * value;
            (0..TERMS).for_each(|j| left[i][j] += weight * basis[i] * basis[j]);
        }
    }
    (1..TERMS).for_each(|i| left[i][i] += STIFF * spots.len() as f64);
    solved(left, right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_found_below_ink_that_strayed_onto_paper() {
        let truth = |p: Point| [0.8, 0.7, 0.5].map(|v: f64| v * (-0.04 * p.x - 0.002 * p.y * p.y).exponential());
        let spots: Vec<Spot> = (0..160)
            .map(|i| {
                let at = Point::new(f64::from(i % 10) + 0.5, 0.8 * f64::from(i / 10) + 0.9);
                let ink = if i % 23 == 5 { 0.6 } else { 1.0 };
                Spot { at, light: truth(at).map(|v| v * ink), noise: 0.01, error: 0.001, clipped: 0.0, weight: 1.0 }
            })
            .collect();
        let light = Light::fitted(&spots).unwrap();
        for p in [Point::new(0.5, 1.5), Point::new(5.2, 7.1), Point::new(9.0, 12.0)] {
            assert!((0..3).all(|c| (light.at(p)[c] / truth(p)[c] - 1.0).abs() < 0.01), "{p:?} {:?} {:?}", light.at(p), truth(p));
        }
        assert!(light.residual < 0.01, "{}", light.residual);
        assert!(Light::fitted(&[]).is_none());
    }
}
