//! Clipping of lines to a region given as a raster.

use crate::geometry::{Point, resample};
use crate::raster::Raster;

/// Bisection steps at a border, to a thousandth of a pixel.
const BISECTIONS: usize = 9;

/// The pieces of a polyline inside the region (at least 0.5, bilinear), in order; nothing outside the raster is inside. The line is
/// sampled every half pixel.
pub fn pieces_inside(points: &[Point], region: &Raster<f32>) -> Vec<Vec<Point>> {
    let is_inside = |p: Point| {
        (0.0..=region.width() as f64).contains(&p.x)
            && (0.0..=region.height() as f64).contains(&p.y)
            && region.sample(p.x, p.y) >= 0.5
    };
    let border = |inside: Point, outside: Point| {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if is_inside(inside.lerp(outside, middle)) { low = middle } else { high = middle }
        }
        inside.lerp(outside, low)
    };
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    let mut before: Option<(Point, bool)> = None;
    for p in resample(points, 0.5) {
        let inside = is_inside(p);
        match before {
            Some((last, true)) if !inside => pieces.last_mut().into_iter().for_each(|piece| piece.push(border(last, p))),
            Some((last, false)) if inside => pieces.push(vec![border(p, last), p]),
            None if inside => pieces.push(vec![p]),
            _ if inside => pieces.last_mut().into_iter().for_each(|piece| piece.push(p)),
            _ => {}
        }
        before = Some((p, inside));
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_across_a_slit_region_is_cut_at_its_borders() {
        let region = Raster::from_fn(40, 20, |x, _| f32::from(u8::from((5..15).contains(&x) || (25..35).contains(&x))));
        let pieces = pieces_inside(&[Point::new(-3.0, 10.0), Point::new(45.0, 10.0)], &region);
        assert_eq!(pieces.len(), 2);
        for (piece, (from, to)) in pieces.iter().zip([(5.0, 15.0), (25.0, 35.0)]) {
            assert!((piece[0].x - from).abs() < 0.01 && (piece[piece.len() - 1].x - to).abs() < 0.01, "{piece:?}");
        }
    }
}
