//! Estimates how often lines cross or cover one another, before anything is cut there. It samples all pairs evenly, so the cost
//! does not depend on how tangled they are.

use super::polyline::distance_to_segment;
use crate::parallel::collected;
use kurbo::Point;

/// Maximum number of lines for which every pair is tested: half a million pairs.
const FEW: usize = 1000;
/// Pairs sampled of more lines: some 50 ms. With half a million lines, a pair found stands for 30,000.
const SAMPLES: usize = 1 << 22;
/// Steps of a sequence that fills the unit square evenly: inverse powers of the root of x^3 = x + 1 (Roberts 2018, the R2
/// sequence).
const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];

/// A straight line with half its width, which is 0 for a border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WideSegment {
    /// Its start.
    pub from: Point,
    /// Its end.
    pub to: Point,
    /// Half its width in millimetres.
    pub half_width: f64,
}

/// Estimates how many pairs of lines cross or, if they have widths, overlap. Consecutive lines do not count. Exact for up to a
/// thousand lines; for more, the error is about a tenth if there are a hundred pairs or more among the four million sampled.
pub fn estimated_crossings(threads: &[WideSegment]) -> f64 {
    estimated_crossings_among(threads, |i, j| i.abs_diff(j) > 1)
}

/// [`estimated_crossings`] of the pairs of indices for which `counts` is true.
pub fn estimated_crossings_among(threads: &[WideSegment], counts: impl Fn(usize, usize) -> bool + Sync) -> f64 {
    let count = threads.len();
    let meets = |i: usize, j: usize| counts(i, j) && do_meet(&threads[i], &threads[j]);
    if count <= FEW {
        let behind = |i: usize| (i + 1..count).filter(move |&j| meets(i, j)).count();
        return (0..count).map(behind).sum::<usize>() as f64;
    }
    let at = |k: usize, step: f64| (((k as f64 * step).fract() * count as f64) as usize).min(count - 1);
    let found =
        collected(SAMPLES, &|k| meets(at(k + 1, STEPS[0]), at(k + 1, STEPS[1]))).into_iter().filter(|is_met| *is_met).count();
    found as f64 * (0.5 * count as f64 * count as f64) / SAMPLES as f64
}

fn do_meet(a: &WideSegment, b: &WideSegment) -> bool {
    let reach = a.half_width + b.half_width;
    let apart = |p: f64, q: f64, r: f64, s: f64| p.min(q) > r.max(s) + reach || r.min(s) > p.max(q) + reach;
    if apart(a.from.x, a.to.x, b.from.x, b.to.x) || apart(a.from.y, a.to.y, b.from.y, b.to.y) {
        return false;
    }
    do_cross(a, b)
        || (reach > 0.0
            && [
                distance_to_segment(a.from, b.from, b.to),
                distance_to_segment(a.to, b.from, b.to),
                distance_to_segment(b.from, a.from, a.to),
                distance_to_segment(b.to, a.from, a.to),
            ]
            .into_iter()
            .any(|distance| distance < reach))
}

/// True if each has its ends on opposite sides of the other.
fn do_cross(a: &WideSegment, b: &WideSegment) -> bool {
    let side = |line: &WideSegment, p: Point| (line.to - line.from).cross(p - line.from);
    side(a, b.from) * side(a, b.to) < 0.0 && side(b, a.from) * side(b, a.to) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn threads(points: &[Point], half_width: f64) -> Vec<WideSegment> {
        points.windows(2).map(|pair| WideSegment { from: pair[0], to: pair[1], half_width }).collect()
    }

    /// Pseudo-random points on a square of 200 mm.
    fn scattered(count: u32) -> Vec<Point> {
        let mut state = 1_u64;
        let mut share = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(|_| Point::new(200.0 * share(), 200.0 * share())).collect()
    }

    #[test]
    fn few_are_counted_and_many_estimated() {
        let star = [(0.0, 0.0), (4.0, 0.0), (0.0, 3.0), (2.0, -2.0), (4.0, 3.0), (0.0, 0.0)].map(Point::from);
        assert_eq!(estimated_crossings(&threads(&star, 0.0)), 5.0);
        // Two chords between random places cross with a chance of 0.23 (a square's, 25/108 for independent ends).
        let wild = estimated_crossings(&threads(&scattered(20_001), 0.0));
        assert!((wild / (25.0 / 108.0 * 2e8) - 1.0).abs() < 0.05, "{wild}");
    }

    #[test]
    fn lines_beside_one_another_do_not_cross_but_may_cover() {
        let zigzag: Vec<Point> = (0..50_000).map(|i| Point::new(0.004 * f64::from(i), f64::from(i % 2) * 180.0)).collect();
        assert_eq!(estimated_crossings(&threads(&zigzag, 0.0)), 0.0);
        // Each covers those up to 0.4 mm away on either side: about a hundred.
        let covered = estimated_crossings(&threads(&zigzag, 0.2));
        assert!((covered / (50_000.0 * 100.0) - 1.0).abs() < 0.3, "{covered}");
        assert_eq!(estimated_crossings_among(&threads(&zigzag, 0.2), |_, _| false), 0.0);
    }
}
