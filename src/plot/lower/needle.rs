//! A long thin shape as a line with a width.

use super::dash::Sample;
use crate::geometry::{BezPath, Point, Rect, Region, Vec2, half_plane, polygon_area, polyline_length, resample};

/// Size, in nibs, of the pieces into which a net is cut; each piece gets its own threads' ink. With 2, most are less than half a
/// touch; with 16, the ink of a whole net is laid where its threads are widest.
const PIECE: f64 = 4.0;

/// A shape's ink in square millimetres: its first ring's area less those of the others, which have the opposite orientation.
pub(super) fn ink_of(shape: &[Vec<Point>]) -> f64 {
    shape.iter().map(|ring| polygon_area(ring)).sum::<f64>().abs()
}

/// A shape cut into pieces of a few nibs.
pub(super) fn pieces(shape: Vec<Vec<Point>>, nib: f64) -> Vec<Vec<Vec<Point>>> {
    let mut done = Vec::new();
    let mut left = vec![shape];
    while let Some(shape) = left.pop() {
        let all = shape.iter().flatten();
        let bounds = all.map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b)).unwrap_or_default();
        if bounds.width().max(bounds.height()) <= PIECE * nib {
            done.push(shape);
            continue;
        }
        let across = if bounds.width() > bounds.height() { Vec2::new(1.0, 0.0) } else { Vec2::new(0.0, 1.0) };
        left.extend(
            [across, -across].map(|normal| cut(&shape, bounds.center(), normal)).into_iter().filter(|half| !half.is_empty()),
        );
    }
    done
}

/// The part of a shape behind the line through `at`, on the side opposite to the normal.
fn cut(shape: &[Vec<Point>], at: Point, normal: Vec2) -> Vec<Vec<Point>> {
    let half = |ring: &Vec<Point>| {
        let mut out = Vec::new();
        half_plane(ring, at, normal, &mut out);
        out
    };
    shape.iter().map(half).filter(|ring| ring.len() > 2).collect()
}

/// The centre line of a shape's first ring between its two tips, with widths that add up to the shape's ink. Where that line lies
/// outside the shape, the width is 0.
///
/// The tips are the two vertices farthest apart. They cut the border into two sides; points at the same share of each side's
/// length are taken as opposite.
pub(super) fn needle(shape: &[Vec<Point>], nib: f64) -> Vec<Sample> {
    let Some(polygon) = shape.first() else { return Vec::new() };
    let Some((a, b)) = tips(polygon) else { return Vec::new() };
    let count = polygon.len();
    let side = |from: usize, to: usize| -> Vec<Point> {
        (0..=(to + count - from) % count).map(|k| polygon[(from + k) % count]).collect()
    };
    let (left, mut right) = (side(a, b), side(b, a));
    right.reverse();
    let length = 0.5 * (polyline_length(&left) + polyline_length(&right));
    let steps = (length / (0.25 * nib)).ceil().clamp(2.0, 1e6);
    let even = |side: &[Point]| resample(side, polyline_length(side) / steps);
    let pairs: Vec<(Point, Point)> = even(&left).into_iter().zip(even(&right)).collect();
    let middle: Vec<Point> = pairs.iter().map(|(p, q)| p.midpoint(*q)).collect();
    let across: Vec<f64> = pairs.iter().map(|(p, q)| p.distance(*q)).collect();
    let ink: f64 = (1..middle.len()).map(|i| middle[i].distance(middle[i - 1]) * 0.5 * (across[i] + across[i - 1])).sum();
    let scale = if ink > 0.0 { ink_of(shape) / ink } else { 0.0 };
    let inside = Region::new(&outline(shape), 0.01);
    let width = |at: Point, across: f64| if inside.contains(at) { across * scale } else { 0.0 };
    middle.into_iter().zip(across).map(|(at, across)| Sample { at, width: width(at, across) }).collect()
}

fn outline(shape: &[Vec<Point>]) -> BezPath {
    let mut path = BezPath::new();
    for ring in shape {
        ring.iter().enumerate().for_each(|(i, p)| if i == 0 { path.move_to(*p) } else { path.line_to(*p) });
        path.close_path();
    }
    path
}

/// Two vertices about as far apart as any: the one farthest from the first vertex, and the one farthest from that.
fn tips(polygon: &[Point]) -> Option<(usize, usize)> {
    let farthest = |from: usize| {
        (0..polygon.len())
            .max_by(|&i, &j| polygon[i].distance_squared(polygon[from]).total_cmp(&polygon[j].distance_squared(polygon[from])))
    };
    let a = farthest(0)?;
    let b = farthest(a)?;
    (a != b).then_some((a, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    #[test]
    fn a_bent_strip_is_its_middle_line() {
        let arc = |radius: f64, k: i32| {
            let angle = f64::from(k) * 0.05;
            Point::new(radius * angle.cosine(), radius * angle.sine())
        };
        let strip: Vec<Point> = (0..=30).map(|k| arc(10.1, k)).chain((0..=30).rev().map(|k| arc(9.9, k))).collect();
        let line = needle(&[strip], 0.3);
        let length: f64 = line.windows(2).map(|w| w[0].at.distance(w[1].at)).sum();
        assert!((length - 15.0).abs() < 0.3, "{length}");
        let inner = &line[3..line.len() - 3];
        assert!(inner.iter().all(|s| (s.at.to_vec2().hypot() - 10.0).abs() < 0.08 && (s.width - 0.2).abs() < 0.06));
        assert!(needle(&[vec![Point::ORIGIN]], 0.3).is_empty());
    }
    #[test]
    fn a_shape_with_holes_is_cut_into_pieces_with_its_ink() {
        let square = |x0: f64, x1: f64| vec![Point::new(x0, x0), Point::new(x1, x0), Point::new(x1, x1), Point::new(x0, x1)];
        let mut hole = square(1.0, 9.0);
        hole.reverse();
        let frame = vec![square(0.0, 10.0), hole];
        let cut = pieces(frame.clone(), 0.5);
        assert!(cut.len() > 10, "{}", cut.len());
        assert!((cut.iter().map(|piece| ink_of(piece)).sum::<f64>() - ink_of(&frame)).abs() < 1e-9);
        assert_eq!(pieces(vec![square(0.0, 2.0)], 0.5).len(), 1);
    }
}
