//! Contour lines of a raster at sub-pixel accuracy (marching squares).

use super::curve::Curve;
use crate::geometry::Point;
use crate::parallel::collected;
use crate::raster::Raster;

/// The lines along which the raster, bilinear between pixel centres, equals `level`; greater values on their left (seen with y up; on
/// the right with y down). Open lines end at the raster's border.
pub fn contours(raster: &Raster<f32>, level: f32) -> Vec<Curve> {
    let (width, height) = (raster.width(), raster.height());
    let of_row = |y: usize| row_segments(raster, y, level);
    let rows: Vec<Vec<(Side, Side)>> = collected(height.saturating_sub(1), &of_row);
    let mut sides = Sides { width, next: vec![NONE; 2 * width * height], is_entered: vec![false; 2 * width * height] };
    for (from, to) in rows.iter().flatten() {
        let (from, to) = (sides.number(*from), sides.number(*to));
        sides.next[from] = to as u32;
        sides.is_entered[to] = true;
    }
    chain(raster, &rows, sides, level)
}

/// A side between two neighbouring pixel centres: the first pixel and whether it runs down (or right).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Side {
    x: u32,
    y: u32,
    down: bool,
}

/// The number of no side.
const NONE: u32 = u32::MAX;

/// The sides of all squares, numbered.
struct Sides {
    width: usize,
    /// For each side the one to which a piece of contour leads from it.
    next: Vec<u32>,
    /// Whether a piece leads to the side.
    is_entered: Vec<bool>,
}

impl Sides {
    fn number(&self, side: Side) -> usize {
        2 * (side.y as usize * self.width + side.x as usize) + usize::from(side.down)
    }

    fn side(&self, number: usize) -> Side {
        let pixel = number / 2;
        Side { x: (pixel % self.width) as u32, y: (pixel / self.width) as u32, down: number % 2 == 1 }
    }
}

/// The point where the level is crossed on a side.
fn crossing(raster: &Raster<f32>, side: Side, level: f32) -> Point {
    let (x, y) = (side.x as usize, side.y as usize);
    let a = raster.get(x, y);
    let b = if side.down { raster.get(x, y + 1) } else { raster.get(x + 1, y) };
    let t = f64::from((level - a) / (b - a)).clamp(0.0, 1.0);
    let (dx, dy) = if side.down { (0.0, t) } else { (t, 0.0) };
    Point::new(x as f64 + 0.5 + dx, y as f64 + 0.5 + dy)
}

/// The pieces of contour in the squares between two rows. Most squares have none, and are passed over at once.
fn row_segments(raster: &Raster<f32>, y: usize, level: f32) -> Vec<(Side, Side)> {
    let mut pieces = Vec::new();
    for (x, (upper, lower)) in raster.row(y).windows(2).zip(raster.row(y + 1).windows(2)).enumerate() {
        let is_above = upper[0] > level;
        if is_above != (upper[1] > level) || is_above != (lower[0] > level) || is_above != (lower[1] > level) {
            pieces.extend(cell_segments(raster, x, y, level));
        }
    }
    pieces
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
fn cell_segments(raster: &Raster<f32>, x: usize, y: usize, level: f32) -> impl Iterator<Item = (Side, Side)> + use<> {
    let corners = [raster.get(x, y), raster.get(x + 1, y), raster.get(x + 1, y + 1), raster.get(x, y + 1)];
    let case = corners.iter().enumerate().fold(0, |case, (i, &v)| case | (usize::from(v > level) << i));
    let (x, y) = (x as u32, y as u32);
    let top = Side { x, y, down: false };
    let bottom = Side { x, y: y + 1, down: false };
    let left = Side { x, y, down: true };
    let right = Side { x: x + 1, y, down: true };
    let centre_above = corners.iter().sum::<f32>() / 4.0 > level;
    let pieces: [Option<(Side, Side)>; 2] = match case {
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
fn chain(raster: &Raster<f32>, rows: &[Vec<(Side, Side)>], mut sides: Sides, level: f32) -> Vec<Curve> {
    let mut curves = Vec::new();
    let (at_border, inside): (Vec<Side>, Vec<Side>) =
        rows.iter().flatten().map(|(from, _)| *from).partition(|side| !sides.is_entered[sides.number(*side)]);
    for start in at_border.into_iter().chain(inside) {
        let start = sides.number(start);
        let mut points = Vec::new();
        let mut number = start;
        while sides.next[number] != NONE {
            points.push(crossing(raster, sides.side(number), level));
            number = std::mem::replace(&mut sides.next[number], NONE) as usize;
        }
        if points.is_empty() {
            continue;
        }
        let closed = number == start;
        if !closed {
            points.push(crossing(raster, sides.side(number), level));
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
