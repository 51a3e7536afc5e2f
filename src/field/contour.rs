//! Contour lines of a raster at sub-pixel accuracy (marching squares).

use super::curve::Curve;
use crate::geometry::Point;
use crate::raster::Raster;
use std::collections::HashMap;

/// The lines along which the raster, bilinear between pixel centres, equals `level`; greater values on their left (seen with y up; on
/// the right with y down). Open lines end at the raster's border.
pub fn contours(raster: &Raster<f32>, level: f32) -> Vec<Curve> {
    let mut next: HashMap<EdgeKey, (EdgeKey, Point)> = HashMap::new();
    let mut starts: Vec<EdgeKey> = Vec::new();
    for y in 0..raster.height().saturating_sub(1) {
        for x in 0..raster.width().saturating_sub(1) {
            for (from, to) in cell_segments(raster, x, y, level) {
                next.insert(from, (to, crossing(raster, from, level)));
                starts.push(from);
            }
        }
    }
    chain(raster, &starts, next, level)
}

/// A side between two neighbouring pixel centres: the first pixel and whether it runs down (or right).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
struct EdgeKey {
    x: u32,
    y: u32,
    down: bool,
}

/// The point where the level is crossed on a side.
fn crossing(raster: &Raster<f32>, side: EdgeKey, level: f32) -> Point {
    let (x, y) = (side.x as usize, side.y as usize);
    let a = raster.get(x, y);
    let b = if side.down { raster.get(x, y + 1) } else { raster.get(x + 1, y) };
    let t = f64::from((level - a) / (b - a)).clamp(0.0, 1.0);
    let (dx, dy) = if side.down { (0.0, t) } else { (t, 0.0) };
    Point::new(x as f64 + 0.5 + dx, y as f64 + 0.5 + dy)
}

/// The one or two pieces of contour in the square whose upper left corner is the centre of pixel `(x, y)`.
///
/// ```text
///   0 --top-- 1     bit i of the case is set where corner i is above the level;
///   |         |     each piece runs with the corners above on its right (y down)
///  left     right
///   |         |
///   3 -bottom- 2
/// ```
fn cell_segments(raster: &Raster<f32>, x: usize, y: usize, level: f32) -> impl Iterator<Item = (EdgeKey, EdgeKey)> + use<> {
    let corners = [raster.get(x, y), raster.get(x + 1, y), raster.get(x + 1, y + 1), raster.get(x, y + 1)];
    let case = corners.iter().enumerate().fold(0, |case, (i, &v)| case | (usize::from(v > level) << i));
    let (x, y) = (x as u32, y as u32);
    let top = EdgeKey { x, y, down: false };
    let bottom = EdgeKey { x, y: y + 1, down: false };
    let left = EdgeKey { x, y, down: true };
    let right = EdgeKey { x: x + 1, y, down: true };
    let centre_above = corners.iter().sum::<f32>() / 4.0 > level;
    let pieces: [Option<(EdgeKey, EdgeKey)>; 2] = match case {
        1 => [Some((left, top)), None],
        2 => [Some((top, right)), None],
        3 => [Some((left, right)), None],
        4 => [Some((right, bottom)), None],
        5 if centre_above => [Some((right, top)), Some((left, bottom))],
        5 => [Some((left, top)), Some((right, bottom))],
        6 => [Some((top, bottom)), None],
        7 => [Some((left, bottom)), None],
        8 => [Some((bottom, left)), None],
        9 => [Some((bottom, top)), None],
        10 if centre_above => [Some((top, left)), Some((bottom, right))],
        10 => [Some((top, right)), Some((bottom, left))],
        11 => [Some((bottom, right)), None],
        12 => [Some((right, left)), None],
        13 => [Some((right, top)), None],
        14 => [Some((top, left)), None],
        _ => [None, None],
    };
    pieces.into_iter().flatten()
}

/// Follows the pieces from side to side: first lines that begin at the border, then loops.
fn chain(raster: &Raster<f32>, starts: &[EdgeKey], mut next: HashMap<EdgeKey, (EdgeKey, Point)>, level: f32) -> Vec<Curve> {
    let entered: std::collections::HashSet<EdgeKey> = next.values().map(|(to, _)| *to).collect();
    let mut curves = Vec::new();
    let (at_border, inside): (Vec<EdgeKey>, Vec<EdgeKey>) = starts.iter().partition(|side| !entered.contains(side));
    for start in at_border.into_iter().chain(inside) {
        let mut points = Vec::new();
        let mut side = start;
        while let Some((to, point)) = next.remove(&side) {
            points.push(point);
            side = to;
        }
        if points.is_empty() {
            continue;
        }
        let closed = side == start;
        if !closed {
            points.push(crossing(raster, side, level));
        }
        curves.push(Curve { points, closed });
    }
    curves
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    #[test]
    fn a_cone_gives_a_circle() {
        let cone = Raster::from_fn(80, 80, |x, y| (x as f32 + 0.5 - 40.2).hypotenuse(y as f32 + 0.5 - 39.7));
        let lines = contours(&cone, 25.0);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].closed);
        for p in &lines[0].points {
            assert!((p.distance(Point::new(40.2, 39.7)) - 25.0).abs() < 0.02);
        }
    }

    #[test]
    fn a_slope_gives_one_open_line_and_a_saddle_two() {
        let slope = Raster::from_fn(30, 20, |x, _| x as f32);
        let lines = contours(&slope, 10.3);
        assert_eq!(lines.len(), 1);
        assert!(!lines[0].closed && lines[0].points.len() == 20);
        let saddle = Raster::from_fn(20, 20, |x, y| (x as f32 - 9.5) * (y as f32 - 9.5));
        assert_eq!(contours(&saddle, 0.5).len(), 2);
    }
}
