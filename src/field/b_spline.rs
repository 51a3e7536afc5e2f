//! Multi-level B-splines through scattered data (Lee, Wolberg and Shin 1997), for the three components of a tensor at once.

use crate::geometry::Point;
use crate::parallel::shares;

/// A measured value of three components at a place, with a weight relative to its neighbours' (above 0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Datum {
    /// Where, in pixels.
    pub position: Point,
    /// The measured value.
    pub value: [f32; 3],
    /// Its weight.
    pub weight: f32,
}

/// A surface of uniform cubic B-splines; control point `(i, j)` lies at `((i - 1) cell, (j - 1) cell)`.
#[derive(Clone, Debug)]
pub struct BSpline {
    cell: f64,
    columns: usize,
    rows: usize,
    control: Vec<[f32; 3]>,
}

/// Data whose residuals one thread computes at once.
const SHARE: usize = 1024;

/// Fits a surface over `width` x `height` pixels: first a lattice of one cell, then lattices with cells half as large on the residuals,
/// down to cells no smaller than `finest` pixels; finally all are merged into one lattice. Cost is linear in the data for each level.
pub fn multilevel_b_spline(data: &[Datum], width: f64, height: f64, finest: f64) -> BSpline {
    let mut residual = data.to_vec();
    let mut surface: Option<BSpline> = None;
    let mut cell = width.max(height).max(1.0);
    loop {
        let level = BSpline::fitted(&residual, width, height, cell);
        shares(&mut residual, SHARE, &|_, part| {
            for datum in part {
                let fitted = level.at(datum.position);
                (0..3).for_each(|c| datum.value[c] -= fitted[c]);
            }
        });
        let sum = match surface {
            None => level,
            Some(coarse) => coarse.refined(&level),
        };
        cell *= 0.5;
        if cell < finest {
            return sum;
        }
        surface = Some(sum);
    }
}

/// The four cubic basis functions at `t`, 0 to 1.
fn basis(t: f64) -> [f32; 4] {
    let (s, t2, t3) = (1.0 - t, t * t, t * t * t);
    [s * s * s / 6.0, (3.0 * t3 - 6.0 * t2 + 4.0) / 6.0, (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0) / 6.0, t3 / 6.0].map(|b| b as f32)
}

impl BSpline {
    fn empty(width: f64, height: f64, cell: f64) -> Self {
        let count = |length: f64| (length / cell).ceil().max(1.0) as usize + 3;
        let (columns, rows) = (count(width), count(height));
        Self { cell, columns, rows, control: vec![[0.0; 3]; columns * rows] }
    }

    /// One level: each control point is the mean of the values its data require, weighted by the squares of their influence.
    fn fitted(data: &[Datum], width: f64, height: f64, cell: f64) -> Self {
        let mut surface = Self::empty(width, height, cell);
        let mut weights = vec![0.0_f32; surface.control.len()];
        for datum in data {
            let (i, j, across, down) = surface.place(datum.position);
            let squares = |b: &[f32; 4]| b.iter().map(|v| v * v).sum::<f32>();
            let total = squares(&across) * squares(&down);
            for (l, b) in down.iter().enumerate() {
                for (k, a) in across.iter().enumerate() {
                    let (w, index) = (a * b, (j + l) * surface.columns + i + k);
                    let squared = datum.weight * w * w;
                    weights[index] += squared;
                    let share = squared * w / total;
                    (0..3).for_each(|c| surface.control[index][c] += share * datum.value[c]);
                }
            }
        }
        for (control, weight) in surface.control.iter_mut().zip(weights) {
            if weight > 0.0 {
                control.iter_mut().for_each(|c| *c /= weight);
            }
        }
        surface
    }

    /// The first control point with influence at a place, and the basis in both directions.
    fn place(&self, p: Point) -> (usize, usize, [f32; 4], [f32; 4]) {
        let along = |v: f64, count: usize| {
            let t = (v / self.cell).clamp(0.0, (count - 3) as f64);
            let i = (t as usize).min(count - 4);
            (i, basis(t - i as f64))
        };
        let ((i, across), (j, down)) = (along(p.x, self.columns), along(p.y, self.rows));
        (i, j, across, down)
    }

    /// The surface at a place in pixels; places beyond the border are clamped to it.
    pub fn at(&self, p: Point) -> [f32; 3] {
        let (i, j, across, down) = self.place(p);
        let mut sum = [0.0_f32; 3];
        for (l, b) in down.iter().enumerate() {
            let row = &self.control[(j + l) * self.columns + i..][..4];
            for (a, control) in across.iter().zip(row) {
                let w = a * b;
                (0..3).for_each(|c| sum[c] += w * control[c]);
            }
        }
        sum
    }

    /// This surface on the finer lattice, plus that lattice's own. Knots are halved: a new control point on an old one takes 1, 6, 1
    /// eighths, one between two takes halves.
    fn refined(&self, finer: &Self) -> Self {
        let mut out = finer.clone();
        let taps = |index: usize, count: usize| {
            // New control point `index` stands at (index - 1) / 2 old cells.
            let place = index as isize - 1;
            let base = place.div_euclid(2) + 1;
            let clamp = |v: isize| v.clamp(0, count as isize - 1) as usize;
            if place.rem_euclid(2) == 0 {
                [(clamp(base - 1), 0.125_f32), (clamp(base), 0.75), (clamp(base + 1), 0.125)]
            } else {
                [(clamp(base), 0.5), (clamp(base + 1), 0.5), (0, 0.0)]
            }
        };
        shares(&mut out.control, finer.columns, &|j, row| {
            for (i, control) in row.iter_mut().enumerate() {
                for (y, b) in taps(j, self.rows) {
                    for (x, a) in taps(i, self.columns) {
                        let coarse = self.control[y * self.columns + x];
                        (0..3).for_each(|c| control[c] += a * b * coarse[c]);
                    }
                }
            }
        });
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    fn wavy(p: Point) -> [f32; 3] {
        [(p.x / 17.0).sine() as f32, (p.y / 23.0).cosine() as f32, 0.3]
    }

    #[test]
    fn it_meets_its_data_and_keeps_a_constant() {
        let data: Vec<Datum> = (0..60)
            .map(|i| Point::new(f64::from(i * 37 % 100) + 0.5, f64::from(i * 61 % 80) + 0.5))
            .map(|position| Datum { position, value: wavy(position), weight: 1.0 })
            .collect();
        let surface = multilevel_b_spline(&data, 100.0, 80.0, 1.0);
        for datum in &data {
            let found = surface.at(datum.position);
            assert!((found[0] - datum.value[0]).abs() < 0.02 && (found[1] - datum.value[1]).abs() < 0.02, "{found:?} {datum:?}");
        }
        for p in [Point::new(3.0, 70.0), Point::new(50.0, 40.0), Point::new(99.0, 1.0)] {
            assert!((surface.at(p)[2] - 0.3).abs() < 0.05, "{:?}", surface.at(p));
        }
    }

    /// Refining changes the lattice, not the surface.
    #[test]
    fn a_refined_surface_is_the_same() {
        let data: Vec<Datum> = (0..12)
            .map(|i| Point::new(f64::from(i * 37 % 64), f64::from(i * 29 % 64)))
            .map(|position| Datum { position, value: wavy(position), weight: 1.0 })
            .collect();
        let coarse = BSpline::fitted(&data, 64.0, 64.0, 16.0);
        let finer = coarse.refined(&BSpline::empty(64.0, 64.0, 8.0));
        for i in 0..64 {
            let p = Point::new(f64::from(i), f64::from(i * 13 % 64));
            let (a, b) = (coarse.at(p), finer.at(p));
            assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-4), "{a:?} {b:?} at {p:?}");
        }
    }
}
