//! One ring along the border and lines back and forth inside it.

use super::super::Toolpath;
use super::room::Room;
use crate::geometry::{OffsetOutline, Point};
use crate::interrupt::Interrupt;

/// Distance of the lines' ends from the border ring's centre line, in pitches: the nib's round end then reaches under the ring.
const TUCK: f64 = 0.55;

/// Fills an outline with its border rings (closed lines) and lines along its longer extent, one pitch apart, joined back and
/// forth where they are adjacent and `room` allows the step. None if the inside holds no line; incomplete once the interrupt is
/// raised.
pub(super) fn hatching(
    insets: &OffsetOutline,
    border: &[Vec<Point>],
    room: &Room,
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
    // Lines along the longer extent need fewer turns.
    let is_wide = x.1 - x.0 >= y.1 - y.0;
    let turned = |p: Point| if is_wide { p } else { Point::new(p.y, p.x) };
    let rings: Vec<Vec<Point>> = inside.iter().map(|ring| ring.iter().map(|p| turned(*p)).collect()).collect();
    let (low, high) = if is_wide { y } else { x };
    let count = ((high - low) / pitch).ceil().max(1.0);
    let step = (high - low) / count;
    let heights: Vec<f64> = (0..count as usize).map(|k| low + (k as f64 + 0.5) * step).collect();
    let rows = spans(&rings, &heights).into_iter().take_while(|_| !interrupt.is_raised());
    let mut paths: Vec<Toolpath> = border.iter().filter_map(|ring| Toolpath::new(ring.clone())).collect();
    let lines = back_and_forth(rows, 2.5 * pitch, |a, b| room.allows_step(turned(a), turned(b)));
    paths.extend(lines.into_iter().filter_map(|line| Toolpath::new(line.into_iter().map(turned).collect())));
    // Islands between two rows, as in the meshes of a net.
    let islands = inside.iter().zip(&rings).filter(|(_, ring)| lies_between(ring, &heights));
    paths.extend(islands.filter_map(|(ring, _)| Toolpath::new([&ring[..], &ring[..1]].concat())));
    Some(paths)
}

/// True if no row crosses the ring. Rows ascend.
fn lies_between(ring: &[Point], rows: &[f64]) -> bool {
    let (low, high) = ring.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.y), high.max(p.y)));
    let next = rows.partition_point(|y| *y < low);
    rows.get(next).is_none_or(|y| *y > high)
}

/// The spans of each row inside the rings, by the even-odd rule (the rings of one level do not cross). Rows ascend.
fn spans(rings: &[Vec<Point>], rows: &[f64]) -> Vec<Vec<[Point; 2]>> {
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); rows.len()];
    for (a, b) in rings.iter().flat_map(|ring| (0..ring.len()).map(move |i| (ring[i], ring[(i + 1) % ring.len()]))) {
        let (low, high) = (a.y.min(b.y), a.y.max(b.y));
        let first = rows.partition_point(|y| *y < low);
        for (y, crossings) in rows[first..].iter().zip(&mut crossings[first..]).take_while(|(y, _)| **y < high) {
            crossings.push(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        }
    }
    let spans = |(crossings, &y): (Vec<f64>, &f64)| {
        let mut crossings = crossings;
        crossings.sort_unstable_by(f64::total_cmp);
        crossings.chunks_exact(2).map(|pair| [Point::new(pair[0], y), Point::new(pair[1], y)]).collect()
    };
    crossings.into_iter().zip(rows).map(spans).collect()
}

/// Joins spans of successive rows, each from left to right, to few lines: a span continues a line that ends within `reach` of one
/// of its ends.
fn back_and_forth(
    rows: impl Iterator<Item = Vec<[Point; 2]>>,
    reach: f64,
    joins: impl Fn(Point, Point) -> bool,
) -> Vec<Vec<Point>> {
    let mut done: Vec<Vec<Point>> = Vec::new();
    let mut open: Vec<Vec<Point>> = Vec::new();
    for row in rows {
        let mut next: Vec<Vec<Point>> = Vec::new();
        let end_of = |line: &Vec<Point>| line[line.len() - 1];
        open.sort_by(|a, b| end_of(a).x.total_cmp(&end_of(b).x));
        let places: Vec<Point> = open.iter().map(end_of).collect();
        for [left, right] in row {
            let nearer = |i: usize| if places[i].distance(left) <= places[i].distance(right) { left } else { right };
            let near = |i: usize| places[i].distance(nearer(i));
            let beside = |x: f64| places.partition_point(|p| p.x < x - reach)..places.partition_point(|p| p.x <= x + reach);
            let ends = beside(left.x).chain(beside(right.x)).filter(|&i| !open[i].is_empty() && joins(places[i], nearer(i)));
            let best = ends.min_by(|&a, &b| near(a).total_cmp(&near(b)));
            match best.filter(|&i| near(i) <= reach) {
                Some(i) => {
                    let mut line = std::mem::take(&mut open[i]);
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
    done.retain(|line| !line.is_empty());
    done
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::BezPath;

    #[test]
    fn a_square_is_its_border_and_one_line_back_and_forth() {
        let insets = OffsetOutline::new(&BezPath::from_svg("M0,0 H10 V10 H0 Z").unwrap(), 0.01);
        let border = insets.rings(0.25);
        let room = Room::new(&insets.grown(-0.25), 0.5);
        let closed: Vec<Vec<Point>> = border.iter().map(|ring| [&ring[..], &ring[..1]].concat()).collect();
        let paths = hatching(&insets, &closed, &room, 0.5, 0.45, &Interrupt::never()).unwrap();
        assert_eq!(paths.len(), 2);
        let length: f64 = paths.iter().map(Toolpath::length).sum();
        assert!((200.0..250.0).contains(&length), "{length}");
        assert!(hatching(&insets, &border, &room, 12.0, 10.0, &Interrupt::never()).is_none());
    }

    #[test]
    fn an_island_that_no_row_crosses_is_a_ring() {
        // Rows at 4.574 and 5.426 pass above and below what is left of the small square, 4.845 to 5.155.
        let insets = OffsetOutline::new(&BezPath::from_svg("M0,0 H40 V10 H0 Z M50,4.1 H51.8 V5.9 H50 Z").unwrap(), 0.01);
        let border: Vec<Vec<Point>> = insets.rings(0.25).iter().map(|ring| [&ring[..], &ring[..1]].concat()).collect();
        let room = Room::new(&insets.grown(-0.25), 0.5);
        let paths = hatching(&insets, &border, &room, 0.5, 0.9, &Interrupt::never()).unwrap();
        let inside = |path: &&Toolpath| path.points().iter().all(|p| p.x > 50.5);
        assert_eq!(paths.iter().filter(inside).count(), 1);
    }
}
