//! Least-squares fit of a smooth piecewise cubic to a curve over one axis.

/// A knot of a piecewise cubic over one axis: position, height and slope.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Knot {
    pub at: f64,
    pub height: f64,
    pub slope: f64,
}

/// Maximum number of sample positions per piece, evenly spread: more cost time and make no visible difference.
const PLACES: usize = 12;
/// Weight of a knot's values before the fit; it only matters where there are too few samples.
const PRIOR: f64 = 1e-3;
/// Weight that pins the heights of the two ends.
const PINNED: f64 = 1e6;

/// A 2 x 2 matrix, row by row.
type Block = [f64; 4];

/// The cubics between `knots` (ascending, at least two), with one slope at each, that are nearest to `height` at a few positions
/// in each piece. `resolved` is the distance over which `height` is straight. The ends keep their heights. Time is linear in the
/// knots.
pub(crate) fn least_squares(knots: &[Knot], height: impl Fn(f64) -> f64, resolved: f64) -> Vec<Knot> {
    let last = knots.len() - 1;
    let length = |i: usize| knots[i + 1].at - knots[i].at;
    let mut diagonal: Vec<Block> = vec![[0.0; 4]; knots.len()];
    let mut beside: Vec<Block> = vec![[0.0; 4]; last];
    let mut right: Vec<[f64; 2]> = vec![[0.0; 2]; knots.len()];
    for (i, knot) in knots.iter().enumerate() {
        let weight = if i == 0 || i == last { PINNED } else { PRIOR };
        let by_slope = PRIOR * length(i.saturating_sub(1)).min(length(i.min(last - 1))).powi(2);
        diagonal[i] = [weight, 0.0, 0.0, by_slope];
        right[i] = [weight * knot.height, by_slope * knot.slope];
    }
    for i in 0..last {
        let places = ((length(i) / resolved).ceil() as usize).clamp(3, PLACES);
        for place in 0..places {
            let t = (place as f64 + 0.5) / places as f64;
            let wanted = height(knots[i].at + t * length(i));
            let (a, b) = basis(t, length(i));
            for (block, side, base) in [(i, i, a), (i + 1, i + 1, b)] {
                add(&mut diagonal[block], base, base);
                right[side][0] += base[0] * wanted;
                right[side][1] += base[1] * wanted;
            }
            add(&mut beside[i], a, b);
        }
    }
    let solved = solve(diagonal, &beside, right);
    knots.iter().zip(solved).map(|(knot, [height, slope])| Knot { at: knot.at, height, slope }).collect()
}

/// The Hermite basis at `t` of a piece: for height and slope at its start, then at its end.
fn basis(t: f64, length: f64) -> ([f64; 2], [f64; 2]) {
    let (t2, t3) = (t * t, t * t * t);
    ([2.0 * t3 - 3.0 * t2 + 1.0, (t3 - 2.0 * t2 + t) * length], [3.0 * t2 - 2.0 * t3, (t3 - t2) * length])
}

fn add(block: &mut Block, a: [f64; 2], b: [f64; 2]) {
    block.iter_mut().zip([a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]]).for_each(|(v, w)| *v += w);
}

/// Solves a symmetric block-tridiagonal system with blocks on the `diagonal` and `beside` it (row i, column i + 1).
fn solve(mut diagonal: Vec<Block>, beside: &[Block], mut right: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    for i in 1..diagonal.len() {
        let [a, b, c, d] = beside[i - 1];
        let inverse = inverse(diagonal[i - 1]);
        // The transpose of the block beside the diagonal, times the inverse.
        let lower = product([a, c, b, d], inverse);
        let taken = product(lower, beside[i - 1]);
        diagonal[i].iter_mut().zip(taken).for_each(|(v, w)| *v -= w);
        let moved = times(lower, right[i - 1]);
        right[i] = [right[i][0] - moved[0], right[i][1] - moved[1]];
    }
    let last = diagonal.len() - 1;
    right[last] = times(inverse(diagonal[last]), right[last]);
    for i in (0..last).rev() {
        let known = times(beside[i], right[i + 1]);
        right[i] = times(inverse(diagonal[i]), [right[i][0] - known[0], right[i][1] - known[1]]);
    }
    right
}

fn inverse([a, b, c, d]: Block) -> Block {
    let scale = 1.0 / (a * d - b * c);
    [d * scale, -b * scale, -c * scale, a * scale]
}

fn product([a, b, c, d]: Block, [e, f, g, h]: Block) -> Block {
    [a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h]
}

fn times([a, b, c, d]: Block, [x, y]: [f64; 2]) -> [f64; 2] {
    [a * x + b * y, c * x + d * y]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_found_again_from_poor_slopes() {
        let cubic = |u: f64| 1.0 + 0.5 * u - 0.3 * u * u + 0.04 * u * u * u;
        let slope = |u: f64| 0.5 - 0.6 * u + 0.12 * u * u;
        let knots: Vec<Knot> =
            [0.0, 1.0, 4.0, 5.0, 9.0].map(|at| Knot { at, height: cubic(at), slope: slope(at) + 0.1 }).to_vec();
        for knot in least_squares(&knots, cubic, 0.1) {
            assert!((knot.height - cubic(knot.at)).abs() < 1e-3 && (knot.slope - slope(knot.at)).abs() < 4e-3, "{knot:?}");
        }
    }
}
