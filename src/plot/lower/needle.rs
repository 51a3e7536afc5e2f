//! A long thin polygon as a line with a width.

use super::dash::Sample;
use crate::geometry::{Point, polygon_area, polyline_length, resample};

/// The middle line of a polygon between its two tips, with widths whose ink is the polygon's area.
///
/// The tips are the two vertices farthest apart; the border between them is cut into two sides, and points at the same share of either
/// side's length are taken as opposite.
pub(super) fn needle(polygon: &[Point], nib: f64) -> Vec<Sample> {
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
    let scale = if ink > 0.0 { polygon_area(polygon).abs() / ink } else { 0.0 };
    middle.into_iter().zip(across).map(|(at, across)| Sample { at, width: across * scale }).collect()
}

/// Two vertices about as far apart as any: the farthest from the first vertex, and the farthest from that.
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

    #[test]
    fn a_bent_strip_is_its_middle_line() {
        let arc = |radius: f64, k: i32| {
            let angle = f64::from(k) * 0.05;
            Point::new(radius * angle.cos(), radius * angle.sin())
        };
        let strip: Vec<Point> = (0..=30).map(|k| arc(10.1, k)).chain((0..=30).rev().map(|k| arc(9.9, k))).collect();
        let line = needle(&strip, 0.3);
        let length: f64 = line.windows(2).map(|w| w[0].at.distance(w[1].at)).sum();
        assert!((length - 15.0).abs() < 0.3, "{length}");
        let inner = &line[3..line.len() - 3];
        assert!(inner.iter().all(|s| (s.at.to_vec2().hypot() - 10.0).abs() < 0.08 && (s.width - 0.2).abs() < 0.06));
        assert!(needle(&[Point::ORIGIN], 0.3).is_empty());
    }
}
