//! One ring along the border and lines back and forth inside it.

use super::super::Toolpath;
use crate::geometry::{Insets, Point};
use crate::interrupt::Interrupt;

/// Distance of the lines' ends from the border ring's middle, in pitches: the nib's round end then reaches under the ring.
const TUCK: f64 = 0.55;

/// A filled outline as its border rings (closed lines) and lines along its longer extent, a pitch apart, joined back and forth where they
/// lie side by side. None where the inside holds no line; some of the lines once the interrupt is raised.
pub(super) fn hatching(
    insets: &Insets,
    border: &[Vec<Point>],
    nib: f64,
    pitch: f64,
    interrupt: &Interrupt,
) -> Option<Vec<Toolpath>> {
    let inside = insets.rings(0.5 * nib + TUCK * pitch);
    let points = || inside.iter().flatten();
    let extent = |of: fn(&Point) -> f64| {
        points().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (x, y) = (extent(|p| p.x), extent(|p| p.y));
    if inside.is_empty() || !(x.1 - x.0).is_finite() {
        return None;
    }
    // Lines along the longer extent: fewer turns.
    let is_wide = x.1 - x.0 >= y.1 - y.0;
    let turned = |p: Point| if is_wide { p } else { Point::new(p.y, p.x) };
    let rings: Vec<Vec<Point>> = inside.iter().map(|ring| ring.iter().map(|p| turned(*p)).collect()).collect();
    let (low, high) = if is_wide { y } else { x };
    let count = ((high - low) / pitch).ceil().max(1.0);
    let step = (high - low) / count;
    let heights: Vec<f64> = (0..count as usize).map(|k| low + (k as f64 + 0.5) * step).collect();
    let rows = heights.iter().take_while(|_| !interrupt.is_raised()).map(|y| spans(&rings, *y));
    let mut paths: Vec<Toolpath> = border.iter().map(|ring| Toolpath::new(ring.clone())).collect();
    paths.extend(back_and_forth(rows, 2.5 * pitch).into_iter().map(|line| {
        let points = line.into_iter().map(turned).collect();
        Toolpath::new(points)
    }));
    // Islands between two rows, as in the meshes of a net.
    let islands = inside.iter().zip(&rings).filter(|(_, ring)| lies_between(ring, &heights));
    paths.extend(islands.map(|(ring, _)| Toolpath::new([&ring[..], &ring[..1]].concat())));
    Some(paths)
}

/// Whether no row crosses a ring; rows from the lowest.
fn lies_between(ring: &[Point], rows: &[f64]) -> bool {
    let (low, high) = ring.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.y), high.max(p.y)));
    let next = rows.partition_point(|y| *y < low);
    rows.get(next).is_none_or(|y| *y > high)
}

/// Where a row lies inside the rings, by the even-odd rule (the rings of one level do not cross).
fn spans(rings: &[Vec<Point>], y: f64) -> Vec<[Point; 2]> {
    let mut crossings: Vec<f64> = Vec::new();
    for ring in rings {
        for i in 0..ring.len() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            if (a.y <= y) != (b.y <= y) {
                crossings.push(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
            }
        }
    }
    crossings.sort_by(f64::total_cmp);
    crossings.chunks_exact(2).map(|pair| [Point::new(pair[0], y), Point::new(pair[1], y)]).collect()
}

/// Spans of successive rows as few lines: each row's span continues a line whose end is within reach of one of its own.
fn back_and_forth(rows: impl Iterator<Item = Vec<[Point; 2]>>, reach: f64) -> Vec<Vec<Point>> {
    let mut done: Vec<Vec<Point>> = Vec::new();
    let mut open: Vec<Vec<Point>> = Vec::new();
    for row in rows {
        let mut next: Vec<Vec<Point>> = Vec::new();
        for [left, right] in row {
            let end_of = |line: &Vec<Point>| line[line.len() - 1];
            let near = |line: &Vec<Point>| end_of(line).distance(left).min(end_of(line).distance(right));
            let best = (0..open.len()).min_by(|&a, &b| near(&open[a]).total_cmp(&near(&open[b])));
            match best.filter(|&i| near(&open[i]) <= reach) {
                Some(i) => {
                    let mut line = open.swap_remove(i);
                    let is_left = end_of(&line).distance(left) <= end_of(&line).distance(right);
                    line.extend(if is_left { [left, right] } else { [right, left] });
                    next.push(line);
                }
                None => next.push(vec![left, right]),
            }
        }
        done.append(&mut open);
        open = next;
    }
    done.append(&mut open);
    done
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::BezPath;

    #[test]
    fn a_square_is_its_border_and_one_line_back_and_forth() {
        let insets = Insets::new(&BezPath::from_svg("M0,0 H10 V10 H0 Z").unwrap(), 0.01);
        let border = insets.rings(0.25);
        let closed: Vec<Vec<Point>> = border.iter().map(|ring| [&ring[..], &ring[..1]].concat()).collect();
        let paths = hatching(&insets, &closed, 0.5, 0.45, &Interrupt::never()).unwrap();
        assert_eq!(paths.len(), 2);
        let length: f64 = paths.iter().map(Toolpath::length).sum();
        assert!((200.0..250.0).contains(&length), "{length}");
        assert!(hatching(&insets, &border, 12.0, 10.0, &Interrupt::never()).is_none());
    }

    #[test]
    fn an_island_that_no_row_crosses_is_a_ring() {
        // Rows at 4.574 and 5.426 pass above and below what is left of the small square, 4.845 to 5.155.
        let insets = Insets::new(&BezPath::from_svg("M0,0 H40 V10 H0 Z M50,4.1 H51.8 V5.9 H50 Z").unwrap(), 0.01);
        let border: Vec<Vec<Point>> = insets.rings(0.25).iter().map(|ring| [&ring[..], &ring[..1]].concat()).collect();
        let paths = hatching(&insets, &border, 0.5, 0.9, &Interrupt::never()).unwrap();
        let inside = |path: &&Toolpath| path.points.iter().all(|p| p.x > 50.5);
        assert_eq!(paths.iter().filter(inside).count(), 1);
    }
}
