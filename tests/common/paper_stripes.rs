//! The stripe update of Son et al. 2011, section 5.2, as printed: the reference for tests and benches.
#![allow(dead_code)]

use drypoint::geometry::Point;
use drypoint::raster::Raster;

/// Rounds of the update on distances 0 to `d / 2`, for stripes across `normal` (unit vectors), window radius `r`, one thread.
pub fn paper_stripes(start: &Raster<f32>, normal: &Raster<[f32; 2]>, d: usize, r: isize, rounds: u32) -> Raster<f32> {
    let (width, height) = (start.width(), start.height());
    let mut now = start.clone();
    for _ in 0..rounds {
        let mut next = now.clone();
        for y in 0..height {
            for x in 0..width {
                next.set(x, y, updated(&now, normal.get(x, y), (x as f64 + 0.5, y as f64 + 0.5), d, r));
            }
        }
        now = next;
    }
    now
}

fn updated(now: &Raster<f32>, [nx, ny]: [f32; 2], (px, py): (f64, f64), d: usize, r: isize) -> f32 {
    let (nx, ny) = (f64::from(nx), f64::from(ny));
    // The mean of each row of the window, along the stripes.
    let w: Vec<f64> = (-r..=r)
        .map(|i| {
            let row = |j: isize| {
                let (a, b) = (i as f64, j as f64);
                f64::from(now.sample(px + a * nx - b * ny, py + a * ny + b * nx))
            };
            (-r..=r).map(row).sum::<f64>() / (2 * r + 1) as f64
        })
        .collect();
    best_fit(&w, d, r)
}

/// The folded distance `S(x)` at the shift `x` whose template is nearest to the window's rows (equation 2).
fn best_fit(w: &[f64], d: usize, r: isize) -> f32 {
    let side = d as f64;
    let mut best = (f64::INFINITY, 0.0);
    for m in 0..2 * d {
        let first = 0.5 * m as f64;
        let template = |i: isize| {
            let u = (i as f64 + first).rem_euclid(side);
            if u < 0.5 * side { (u, 1.0) } else { (side - u, -1.0) }
        };
        let slope: f64 = (-r..=r)
            .zip(w)
            .map(|(i, w)| {
                let (a, s) = template(i);
                s * (w - a)
            })
            .sum();
        let shift = (slope / w.len() as f64).clamp(0.0, 0.5);
        let error: f64 = (-r..=r)
            .zip(w)
            .map(|(i, w)| {
                let (a, s) = template(i);
                (a + s * shift - w).powi(2)
            })
            .sum();
        if error < best.0 {
            best = (error, first + shift);
        }
    }
    let x = best.1.rem_euclid(side);
    x.min(side - x) as f32
}

/// Minima of both distances: the local minima of `t0^2 + t1^2`, at the centroid of the values near 0 around them.
pub fn paper_dots(along: &Raster<f32>, across: &Raster<f32>, d: f64) -> Vec<Point> {
    let distance = along.zip_map(across, f32::hypot);
    let mut dots = Vec::new();
    for y in 0..distance.height() as isize {
        for x in 0..distance.width() as isize {
            let here = distance.clamped(x, y);
            let is_least = (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| (dx, dy))).all(|(dx, dy)| {
                let there = distance.clamped(x + dx, y + dy);
                (dx, dy) == (0, 0) || here < there || (here == there && (dy, dx) > (0, 0))
            });
            if is_least && f64::from(here) < 0.3 * d {
                dots.push(centre_of_weight(&distance, x, y, 0.5 * d));
            }
        }
    }
    dots
}

fn centre_of_weight(distance: &Raster<f32>, x: isize, y: isize, reach: f64) -> Point {
    let (mut sum, mut total) = ((0.0, 0.0), 0.0);
    for dy in -2..=2 {
        for dx in -2..=2 {
            let weight = (reach - f64::from(distance.clamped(x + dx, y + dy))).max(0.0);
            sum = (sum.0 + weight * (x + dx) as f64, sum.1 + weight * (y + dy) as f64);
            total += weight;
        }
    }
    Point::new(sum.0 / total + 0.5, sum.1 / total + 0.5)
}
