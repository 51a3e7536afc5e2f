//! Exact Euclidean distances (Felzenszwalb and Huttenlocher 2012; Bruehl 2023, section 3.1.1), to pixels and to curves.

use super::curve::Curve;
use crate::geometry::{Point, Vec2, resample};
use crate::parallel::rows_with;
use crate::raster::Raster;

/// Pieces of a curve searched on either side of the one found: the nearest piece may be two pixels away from it.
const NEIGHBOURS: usize = 3;
/// No seed anywhere.
const NONE: u32 = u32::MAX;

/// For each pixel, the index of the nearest marked pixel (exact, by pixel centres); none if nothing is marked.
///
/// Two passes: the nearest in the column by two sweeps, then along each row the lower envelope of the parabolas
/// `(p - q)^2 + f(q)`, which carries the seed along. Linear in the pixels.
pub fn nearest_seed(marked: &Raster<u8>) -> Option<Raster<u32>> {
    if marked.pixels().iter().all(|&v| v == 0) {
        return None;
    }
    let rows = nearest_in_column(marked);
    let (width, height) = (marked.width(), marked.height());
    let mut out = Raster::filled(width, height, 0_u32);
    rows_with(out.pixels_mut(), width, &|| Envelope::new(width), &|envelope, y, out| envelope.scan(rows.row(y), y, width, out));
    Some(out)
}

/// The row of the nearest marked pixel in the same column.
fn nearest_in_column(marked: &Raster<u8>) -> Raster<u32> {
    let (width, height) = (marked.width(), marked.height());
    let mut rows = Raster::filled(width, height, NONE);
    let mut last = vec![NONE; width];
    for y in 0..height {
        let out = &mut rows.pixels_mut()[y * width..(y + 1) * width];
        for ((last, out), &mark) in last.iter_mut().zip(out).zip(marked.row(y)) {
            if mark != 0 {
                *last = y as u32;
            }
            *out = *last;
        }
    }
    last.fill(NONE);
    for y in (0..height).rev() {
        let out = &mut rows.pixels_mut()[y * width..(y + 1) * width];
        for ((last, out), &mark) in last.iter_mut().zip(out).zip(marked.row(y)) {
            if mark != 0 {
                *last = y as u32;
            }
            if *last != NONE && (*out == NONE || *last - (y as u32) < y as u32 - *out) {
                *out = *last;
            }
        }
    }
    rows
}

/// The lower envelope of one row: vertices of its parabolas and the borders between them.
struct Envelope {
    vertex: Vec<usize>,
    border: Vec<f64>,
}

impl Envelope {
    fn new(width: usize) -> Self {
        Self { vertex: vec![0; width], border: vec![0.0; width + 1] }
    }

    fn scan(&mut self, rows: &[u32], y: usize, width: usize, out: &mut [u32]) {
        let height_of = |q: usize| (f64::from(rows[q]) - y as f64).powi(2);
        // Where the parabolas rooted at r < q meet; the paper's formula with its missing bracket.
        let meet = |r: usize, q: usize| {
            ((height_of(q) + (q * q) as f64) - (height_of(r) + (r * r) as f64)) / (2.0 * (q as f64 - r as f64))
        };
        let mut count = 0;
        for q in (0..width).filter(|&q| rows[q] != NONE) {
            let mut from = f64::NEG_INFINITY;
            while count > 0 {
                from = meet(self.vertex[count - 1], q);
                if from > self.border[count - 1] {
                    break;
                }
                count -= 1;
                from = f64::NEG_INFINITY;
            }
            self.vertex[count] = q;
            self.border[count] = from;
            count += 1;
        }
        self.border[count] = f64::INFINITY;
        let mut k = 0;
        for (x, out) in out.iter_mut().enumerate() {
            while self.border[k + 1] < x as f64 {
                k += 1;
            }
            let q = self.vertex[k];
            *out = rows[q] * width as u32 + q as u32;
        }
    }
}

/// Distance of each pixel's centre to the nearest of some curves, and on which side of it the pixel lies.
#[derive(Clone, Debug)]
pub struct FeatureDistance {
    /// In pixels; exact for the curve's geometry, not for its rasterised pixels.
    pub distance: Raster<f32>,
    /// 1 to the left of the curve's direction (on a page with y down: where `tangent x offset` is positive), else -1.
    pub side: Raster<i8>,
}

/// Distances to curves at sub-pixel accuracy: an exact transform finds the nearest rasterised pixel, which gives the pieces of curve
/// that pass there. None if there is no curve.
pub fn distance_to_curves(curves: &[Curve], width: usize, height: usize) -> Option<FeatureDistance> {
    distance_within(curves, width, height, f64::INFINITY)
}

/// The same, exact up to a distance of `reach` pixels: farther away it is that of the nearest rasterised pixel, on no known side.
pub(crate) fn distance_within(curves: &[Curve], width: usize, height: usize, reach: f64) -> Option<FeatureDistance> {
    /// A curve lies less than this far from the pixels that it passes.
    const OFF: f64 = 2.0;
    let pieces: Vec<Piece> = curves.iter().flat_map(segments).collect();
    let drawn = draw(&pieces, width, height);
    let nearest = nearest_seed(&drawn.map(|piece| u8::from(piece != NONE)))?;
    let pairs = Raster::from_fn(width, height, |x, y| {
        let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
        let seed = nearest.get(x, y) as usize;
        let away = p.distance(Point::new((seed % width) as f64 + 0.5, (seed / width) as f64 + 0.5));
        if away > reach + OFF {
            return (away as f32, 1_i8);
        }
        let piece = drawn.pixels()[seed] as usize;
        let (squared, piece) = descend(&pieces, piece, p);
        (squared.sqrt() as f32, if pieces[piece].side(p) >= 0.0 { 1_i8 } else { -1 })
    });
    Some(FeatureDistance { distance: pairs.map(|p| p.0), side: pairs.map(|p| p.1) })
}

/// A piece of a curve.
#[derive(Clone, Copy, Debug)]
struct Piece {
    from: Point,
    way: Vec2,
    /// Of its length.
    square: f64,
}

impl Piece {
    fn new(from: Point, to: Point) -> Self {
        let way = to - from;
        Self { from, way, square: way.hypot2() }
    }

    /// Squared distance of a point.
    fn squared(&self, p: Point) -> f64 {
        let t = if self.square > 0.0 { ((p - self.from).dot(self.way) / self.square).clamp(0.0, 1.0) } else { 0.0 };
        p.distance_squared(self.from + self.way * t)
    }

    /// Positive to the left on a page with y down.
    fn side(&self, p: Point) -> f64 {
        self.way.cross(p - self.from)
    }
}

/// Squared distance and index of the nearest piece, found by descending along the curve from `piece`.
///
/// Near a curve's centre of curvature the transform, which only knows pixels, may start that far from the true nearest piece.
fn descend(pieces: &[Piece], piece: usize, p: Point) -> (f64, usize) {
    let mut centre = (pieces[piece].squared(p), piece);
    loop {
        let low = centre.1.saturating_sub(NEIGHBOURS);
        let around = &pieces[low..(centre.1 + NEIGHBOURS + 1).min(pieces.len())];
        let mut nearest = (f64::INFINITY, centre.1);
        for (i, piece) in around.iter().enumerate() {
            let squared = piece.squared(p);
            if squared < nearest.0 {
                nearest = (squared, low + i);
            }
        }
        if nearest.1 == centre.1 || nearest.0 >= centre.0 {
            return nearest;
        }
        centre = nearest;
    }
}

/// The curve in equal pieces about a pixel long, in order.
fn segments(curve: &Curve) -> Vec<Piece> {
    let mut points = curve.points.clone();
    if curve.closed
        && let Some(&first) = points.first()
    {
        points.push(first);
    }
    let mut pieces: Vec<Piece> = resample(&points, 1.0).windows(2).map(|w| Piece::new(w[0], w[1])).collect();
    if curve.closed {
        // Repeats the first pieces, so that the seam has neighbours on both sides.
        pieces.extend_from_within(..pieces.len().min(2 * NEIGHBOURS));
    }
    pieces
}

/// For each pixel that a piece passes, the index of the piece; later ones win.
fn draw(pieces: &[Piece], width: usize, height: usize) -> Raster<u32> {
    let mut drawn = Raster::filled(width, height, NONE);
    for (i, piece) in pieces.iter().enumerate() {
        for step in 0..=6 {
            let p = piece.from + piece.way * (f64::from(step) / 6.0);
            let x = p.x.clamp(0.0, width as f64 - 1.0) as usize;
            let y = p.y.clamp(0.0, height as f64 - 1.0) as usize;
            drawn.set(x, y, i as u32);
        }
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_nearest_seed_is_the_one_found_by_trying_all(
            width in 1_usize..24, height in 1_usize..24, marks in prop::collection::vec(0_usize..576, 1..20)
        ) {
            let mut marked = Raster::filled(width, height, 0_u8);
            for m in marks {
                marked.pixels_mut()[m % (width * height)] = 1;
            }
            let found = nearest_seed(&marked).unwrap();
            for y in 0..height {
                for x in 0..width {
                    let squared = |i: usize| (i % width).abs_diff(x).pow(2) + (i / width).abs_diff(y).pow(2);
                    let best = (0..width * height).filter(|&i| marked.pixels()[i] != 0).map(squared).min().unwrap();
                    prop_assert_eq!(squared(found.get(x, y) as usize), best);
                }
            }
        }
    }

    #[test]
    fn it_agrees_with_the_plain_search_on_a_larger_raster() {
        let marked = Raster::from_fn(97, 61, |x, y| u8::from((x * 31 + y * 57) % 43 == 0));
        let seeds: Vec<usize> = (0..marked.len()).filter(|&i| marked.pixels()[i] != 0).collect();
        let found = nearest_seed(&marked).unwrap();
        for (i, &seed) in found.pixels().iter().enumerate() {
            let squared = |seed: usize| (i % 97).abs_diff(seed % 97).pow(2) + (i / 97).abs_diff(seed / 97).pow(2);
            assert_eq!(Some(squared(seed as usize)), seeds.iter().map(|&seed| squared(seed)).min());
        }
    }

    #[test]
    fn distance_to_a_circle_is_sub_pixel() {
        let points =
            (0..200).map(|i| Point::new(50.3, 49.8) + unit_at(f64::from(i) * std::f64::consts::TAU / 200.0) * 20.0).collect();
        let field = distance_to_curves(&[Curve { points, closed: true }], 100, 100).unwrap();
        for y in 0..100 {
            for x in 0..100 {
                let r = Point::new(x as f64 + 0.5, y as f64 + 0.5).distance(Point::new(50.3, 49.8));
                assert!((f64::from(field.distance.get(x, y)) - (r - 20.0).abs()).abs() < 0.02);
                if (r - 20.0).abs() > 0.1 {
                    assert_eq!(field.side.get(x, y), if r < 20.0 { 1 } else { -1 });
                }
            }
        }
    }

    #[test]
    fn no_curve_no_distance() {
        assert!(distance_to_curves(&[], 10, 10).is_none());
    }
}
