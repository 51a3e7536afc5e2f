//! Crossings of two families of stripes on one lattice: the structure grid's points (Son et al. 2011, section 5.1).

use super::stripes::{CellPhases, StripeLattice};
use super::voronoi::{Sites, cell_polygon};
use crate::geometry::{Point, Rect};
use crate::parallel::collected;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// A length in pixels that depends on the place.
pub type LocalLength<'a> = &'a (dyn Fn(Point) -> f64 + Sync);

/// The points where both phases are 0, no two nearer than `least` pixels (at the later one's place).
///
/// Within each cell both phases are bilinear; each pair of whole cycles in the cell's range is solved by Newton's method.
///
/// # Panics
/// If the lattices differ in size.
pub fn crossings(along: &StripeLattice, across: &StripeLattice, least: LocalLength<'_>) -> Vec<Point> {
    assert_eq!(along.phase.width(), across.phase.width(), "both families stand on one lattice");
    let (columns, rows) = (along.phase.width().saturating_sub(1), along.phase.height().saturating_sub(1));
    let by_row: Vec<Vec<Point>> = collected(rows, &|j| {
        let mut found = Vec::new();
        for i in 0..columns {
            let origin = along.position(i, j);
            in_cell(&CellPhases::new(along, i, j), &CellPhases::new(across, i, j), |u, v| {
                found.push(Point::new(origin.x + u * along.step, origin.y + v * along.step));
            });
        }
        found
    });
    apart(Vec::new(), &by_row.concat(), least)
}

/// Places for extra points with no other within `reach` pixels (at most `farthest`): rows that end leave holes. They lie at corners of
/// Voronoi cells, which are farthest from all points.
pub fn holes(points: &[Point], field: Rect, reach: LocalLength<'_>, farthest: f64) -> Vec<Point> {
    if points.is_empty() {
        return Vec::new();
    }
    let sites = Sites::new(points, field.x1, field.y1, farthest);
    let corners: Vec<Vec<(f64, Point)>> = collected(points.len(), &|i| {
        let cell = cell_polygon(&sites, i, field, 2.0 * farthest);
        cell.into_iter().map(|p| (p.distance(points[i]) / reach(p), p)).filter(|(away, _)| *away > 1.0).collect()
    });
    let mut corners = corners.concat();
    // The widest holes first, so that one point fills each.
    corners.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.x.total_cmp(&b.1.x)).then(a.1.y.total_cmp(&b.1.y)));
    let candidates: Vec<Point> = corners.into_iter().map(|(_, p)| p).collect();
    apart(points.to_vec(), &candidates, reach).split_off(points.len())
}

/// Tolerance for crossings outside a cell, so that none on a border is lost; duplicates are dropped later.
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

/// The kept points, and those of the others that are at least `least` from all points before them.
fn apart(kept: Vec<Point>, others: &[Point], least: LocalLength<'_>) -> Vec<Point> {
    let side = others.iter().map(|p| least(*p)).fold(f64::MIN_POSITIVE, f64::max);
    let cell = |p: &Point| ((p.x / side).floor() as i64, (p.y / side).floor() as i64);
    let mut by_cell: HashMap<(i64, i64), Vec<Point>> = HashMap::new();
    for p in &kept {
        by_cell.entry(cell(p)).or_default().push(*p);
    }
    let mut out = kept;
    for p in others {
        let (cx, cy) = cell(p);
        let near = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (cx + dx, cy + dy)));
        let least = least(*p);
        let is_free = near.filter_map(|c| by_cell.get(&c)).flatten().all(|q| q.distance(*p) >= least);
        if is_free {
            by_cell.entry((cx, cy)).or_default().push(*p);
            out.push(*p);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_point_s_hole_is_found_and_nothing_else() {
        let all: Vec<Point> =
            (0..100).map(|i| Point::new(f64::from(i % 10) * 6.0 + 3.0, f64::from(i / 10) * 6.0 + 3.0)).collect();
        let field = Rect::new(0.0, 0.0, 60.0, 60.0);
        assert!(holes(&all, field, &|_| 5.7, 5.7).is_empty());
        let without: Vec<Point> = all.iter().copied().filter(|p| p.distance(all[44]) > 1.0).collect();
        let found = holes(&without, field, &|_| 5.7, 5.7);
        assert_eq!(found.len(), 1);
        assert!(found[0].distance(all[44]) < 0.5);
    }
}
