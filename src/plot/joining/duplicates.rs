//! Drops repeated paths, so that no line is drawn twice.

use std::collections::HashMap;

use kurbo::{Point, Rect};

use crate::interrupt::Interrupt;
use crate::plot::Toolpath;

/// Maximum vertices of a closed path tried as the counterpart of another path's start. More than a few coincide only in a path
/// that runs round in place.
const MOST_STARTS: usize = 16;

/// Drops each path that repeats an earlier one: with as many vertices, each at most `tolerance` millimetres from its counterpart
/// in position and height, in either direction; a closed path may begin at any vertex. A path in a group is never dropped, nor
/// does it cause another to be dropped. Of repeated touches the longest rest is kept. O(number of vertices), as long as few paths
/// with equally many vertices share the centre of their bounds without being the same. Once the interrupt is raised, the rest is
/// left out.
pub fn drop_duplicates(paths: Vec<Toolpath>, tolerance: f64, interrupt: &Interrupt) -> Vec<Toolpath> {
    let mut kept: Vec<Toolpath> = Vec::with_capacity(paths.len());
    let mut by_middle: HashMap<(usize, i64, i64), Vec<usize>> = HashMap::new();
    for path in paths.into_iter().take_while(|_| !interrupt.is_raised()) {
        if path.group.is_some() {
            kept.push(path);
            continue;
        }
        // The centre of the bounds is the same in both directions and moves no farther than the vertices: two equal paths lie in
        // the same cell or in adjacent ones.
        let (x, y) = cell(bounds(path.points()).center(), tolerance);
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x.saturating_add(dx), y.saturating_add(dy))));
        let mut candidates = around.filter_map(|(x, y)| by_middle.get(&(path.points().len(), x, y))).flatten();
        if let Some(&earlier) = candidates.find(|&&other| interrupt.is_raised() || is_same(&path, &kept[other], tolerance)) {
            kept[earlier].dwell_seconds = kept[earlier].dwell_seconds.max(path.dwell_seconds);
        } else {
            by_middle.entry((path.points().len(), x, y)).or_default().push(kept.len());
            kept.push(path);
        }
    }
    kept
}

fn is_same(a: &Toolpath, b: &Toolpath, tolerance: f64) -> bool {
    let count = a.points().len();
    if count != b.points().len() || a.heights().is_some() != b.heights().is_some() {
        return false;
    }
    let close = |i: usize, j: usize| a.points()[i].distance(b.points()[j]) <= tolerance && is_level(a, b, i, j, tolerance);
    if (0..count).all(|i| close(i, i)) || (0..count).all(|i| close(i, count - 1 - i)) {
        return true;
    }
    if !a.is_closed() || !b.is_closed() {
        return false;
    }
    // The closing vertex is the first one again.
    let around = count - 1;
    let starts = (0..around).filter(|&j| close(0, j)).take(MOST_STARTS);
    starts.into_iter().any(|start| {
        (0..around).all(|i| close(i, (start + i) % around)) || (0..around).all(|i| close(i, (start + around - i) % around))
    })
}

fn is_level(a: &Toolpath, b: &Toolpath, i: usize, j: usize, tolerance: f64) -> bool {
    match (a.heights(), b.heights()) {
        (Some(a), Some(b)) => (a[i] - b[j]).abs() <= tolerance,
        _ => true,
    }
}

fn bounds(points: &[Point]) -> Rect {
    let around = |p: Point| Rect::from_points(p, p);
    points.iter().map(|&p| around(p)).reduce(|all, p| all.union(p)).unwrap_or_default()
}

/// The cell of a grid with the tolerance as its size.
fn cell(p: Point, tolerance: f64) -> (i64, i64) {
    let size = tolerance.max(1e-9);
    ((p.x / size).floor() as i64, (p.y / size).floor() as i64)
}
