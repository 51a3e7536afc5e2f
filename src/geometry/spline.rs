//! Least-squares fit of a smooth piecewise cubic to a curve over one axis.

use std::sync::LazyLock;

/// A knot of a piecewise cubic over one axis: position, height and slope.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Knot {
    pub at: f64,
    pub height: f64,
    pub slope: f64,
}

/// Maximum number of sample positions per piece, evenly spread: more cost time and make no visible difference.
const PLACES: usize = 12;
const LEAST_PLACES: usize = 3;
/// Weight of a knot's values before the fit; it only matters where there are too few samples.
const PRIOR: f64 = 1e-3;
/// Weight that pins the heights of the two ends.
const PINNED: f64 = 1e6;

/// By the number of places, from `LEAST_PLACES` to `PLACES`.
static BASES: LazyLock<Vec<Basis>> = LazyLock::new(|| (LEAST_PLACES..=PLACES).map(Basis::new).collect());

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
        let places = ((length(i) / resolved).ceil() as usize).clamp(LEAST_PLACES, PLACES);
        let (basis, length) = (&BASES[places - LEAST_PLACES], length(i));
        for (block, of) in [(&mut diagonal[i], (0, 0)), (&mut beside[i], (0, 1))] {
            add(block, basis.products(of, length));
        }
        add(&mut diagonal[i + 1], basis.products((1, 1), length));
        let mut sums = [[0.0; 2]; 2];
        for ([a, b], t) in &basis.places {
            let wanted = height(knots[i].at + t * length);
            sums = [
                [sums[0][0] + a[0] * wanted, sums[0][1] + a[1] * wanted],
                [sums[1][0] + b[0] * wanted, sums[1][1] + b[1] * wanted],
            ];
        }
        for (side, sum) in sums.into_iter().enumerate() {
            right[i + side][0] += sum[0];
            right[i + side][1] += sum[1] * length;
        }
    }
    let solved = solve(diagonal, &beside, right);
    knots.iter().zip(solved).map(|(knot, [height, slope])| Knot { at: knot.at, height, slope }).collect()
}

/// The Hermite basis at the places of a piece of length 1, and the sums of its products over them: they are the same for all pieces with as
/// many places, up to powers of the length.
struct Basis {
    /// For height and slope at the start, then at the end; and the place, 0 to 1.
    places: Vec<([[f64; 2]; 2], f64)>,
    /// Start by start, start by end, end by end.
    sums: [Block; 3],
}

impl Basis {
    fn new(count: usize) -> Self {
        let of = |place: usize| {
            let t = (place as f64 + 0.5) / count as f64;
            let (t2, t3) = (t * t, t * t * t);
            ([[2.0 * t3 - 3.0 * t2 + 1.0, t3 - 2.0 * t2 + t], [3.0 * t2 - 2.0 * t3, t3 - t2]], t)
        };
        let places: Vec<([[f64; 2]; 2], f64)> = (0..count).map(of).collect();
        let mut sums = [[0.0; 4]; 3];
        for ([a, b], _) in &places {
            for (sum, (a, b)) in sums.iter_mut().zip([(a, a), (a, b), (b, b)]) {
                add(sum, [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]]);
            }
        }
        Self { places, sums }
    }

    /// The sums of the products of two ends of a piece of this length.
    fn products(&self, (a, b): (usize, usize), length: f64) -> Block {
        let [heights, right, left, slopes] = self.sums[a + b];
        [heights, right * length, left * length, slopes * length * length]
    }
}

fn add(block: &mut Block, more: Block) {
    block.iter_mut().zip(more).for_each(|(v, w)| *v += w);
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
