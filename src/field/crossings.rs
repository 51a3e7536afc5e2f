//! Crossings of two families of stripes on one lattice: the structure grid's points (Son et al. 2011, section 5.1).

use super::stripes::{CellPhases, StripeLattice};
use crate::geometry::Point;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Where both phases are 0, no two nearer than `least` pixels.
///
/// Within each cell both phases are bilinear; each pair of whole cycles in the cell's range is sought by Newton's method.
///
/// # Panics
/// If the lattices differ in size.
pub fn crossings(along: &StripeLattice, across: &StripeLattice, least: f64) -> Vec<Point> {
    assert_eq!(along.phase.width(), across.phase.width(), "both families stand on one lattice");
    let (columns, rows) = (along.phase.width().saturating_sub(1), along.phase.height().saturating_sub(1));
    let by_row: Vec<Vec<Point>> = (0..rows)
        .into_par_iter()
        .map(|j| {
            let mut found = Vec::new();
            for i in 0..columns {
                let origin = along.position(i, j);
                in_cell(&CellPhases::new(along, i, j), &CellPhases::new(across, i, j), |u, v| {
                    found.push(Point::new(origin.x + u * along.step, origin.y + v * along.step));
                });
            }
            found
        })
        .collect();
    apart(&by_row.concat(), least)
}

/// How far outside a cell a crossing still counts, so that none on a border is lost; twins are dropped later.
const SLACK: f64 = 1e-6;

fn in_cell(a: &CellPhases, b: &CellPhases, mut found: impl FnMut(f64, f64)) {
    let levels = |cell: &CellPhases| {
        let (low, high) = cell.range();
        (low / TAU).ceil() as i64..=(high / TAU).floor() as i64
    };
    for m in levels(a) {
        for n in levels(b) {
            if let Some((u, v)) = solve(a, b, m as f64 * TAU, n as f64 * TAU) {
                found(u, v);
            }
        }
    }
}

fn solve(a: &CellPhases, b: &CellPhases, first: f64, second: f64) -> Option<(f64, f64)> {
    let (mut u, mut v) = (0.5, 0.5);
    for _ in 0..12 {
        let ((pa, au, av), (pb, bu, bv)) = (a.at(u, v), b.at(u, v));
        let (ea, eb) = (first - pa, second - pb);
        let determinant = au * bv - av * bu;
        if determinant.abs() < 1e-9 {
            return None;
        }
        let (du, dv) = ((ea * bv - av * eb) / determinant, (au * eb - ea * bu) / determinant);
        (u, v) = (u + du, v + dv);
        if u.abs() > 4.0 || v.abs() > 4.0 {
            return None;
        }
        if du.abs().max(dv.abs()) < 1e-9 {
            break;
        }
    }
    let inside = -SLACK..=1.0 + SLACK;
    (inside.contains(&u) && inside.contains(&v)).then_some((u, v))
}

/// Drops points nearer than `least` to one that came before.
fn apart(points: &[Point], least: f64) -> Vec<Point> {
    use std::collections::HashMap;
    let cell = |p: &Point| ((p.x / least).floor() as i64, (p.y / least).floor() as i64);
    let mut kept: HashMap<(i64, i64), Vec<Point>> = HashMap::new();
    let mut out = Vec::new();
    for p in points {
        let (cx, cy) = cell(p);
        let near = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (cx + dx, cy + dy)));
        let is_free = near.filter_map(|c| kept.get(&c)).flatten().all(|q| q.distance(*p) >= least);
        if is_free {
            kept.entry((cx, cy)).or_default().push(*p);
            out.push(*p);
        }
    }
    out
}
