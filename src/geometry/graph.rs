//! Fits a swelling stroke to a curve over one axis: few cubics, within a tolerance.

use super::spline::{Knot, least_squares};

/// Rounds of halving: enough to reduce pieces of a few millimetres to single steps.
const ROUNDS: usize = 9;
/// Positions in a piece at which its width is checked.
const WIDTH_PLACES: [f64; 3] = [0.25, 0.5, 0.75];

/// A curve over one axis, given by heights at even steps with straight lines between them.
#[derive(Clone, Copy, Debug)]
pub struct Graph<'a> {
    /// Position of the first height.
    pub first: f64,
    /// Distance between heights.
    pub step: f64,
    /// The heights.
    pub heights: &'a [f64],
}

/// An end of a cubic piece: position, height, slopes before and after, width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GraphNode {
    /// Position along the axis.
    pub at: f64,
    /// Height of the curve.
    pub height: f64,
    /// Slope at the end of the piece before.
    pub slope_before: f64,
    /// Slope at the start of the piece after.
    pub slope_after: f64,
    /// Full width of the stroke.
    pub width: f64,
}

/// Tolerances of a fit, in the curve's own unit.
#[derive(Clone, Copy, Debug)]
pub struct FitTolerance {
    /// Maximum difference in height.
    pub height: f64,
    /// Maximum difference in width.
    pub width: f64,
    /// Maximum length of a piece.
    pub piece: f64,
}

impl Graph<'_> {
    /// The height at a position; beyond the ends, that of the end.
    pub fn height(&self, at: f64) -> f64 {
        let x = ((at - self.first) / self.step).clamp(0.0, (self.heights.len() - 1) as f64);
        let i = (x as usize).min(self.heights.len().saturating_sub(2));
        let t = x - i as f64;
        self.heights[i] * (1.0 - t) + self.heights[(i + 1).min(self.heights.len() - 1)] * t
    }

    /// The slope at a position, over one step on either side.
    pub fn slope(&self, at: f64) -> f64 {
        let end = self.first + (self.heights.len() - 1) as f64 * self.step;
        let (a, b) = ((at - self.step).max(self.first), (at + self.step).min(end));
        if b > a { (self.height(b) - self.height(a)) / (b - a) } else { 0.0 }
    }

    /// The nodes of a stroke over `places` (ascending, at least two) and as many more as the tolerance requires, with `width` as
    /// a function of position: the smooth piecewise cubic nearest to the curve, with pieces halved where it is outside the
    /// tolerance. Where even the shortest pieces exceed it because of noise, the stroke follows the curve in straight lines.
    pub fn fit(&self, places: &[f64], width: impl Fn(f64) -> f64, tolerance: FitTolerance) -> Vec<GraphNode> {
        let mut at = Vec::with_capacity(4 * places.len());
        at.push(places[0]);
        for pair in places.windows(2).filter(|pair| pair[1] > pair[0]) {
            let pieces = ((pair[1] - pair[0]) / tolerance.piece).ceil().max(1.0) as usize;
            at.extend((1..=pieces).map(|i| pair[0] + (pair[1] - pair[0]) * i as f64 / pieces as f64));
        }
        let mut knots = self.knots(&at);
        for _ in 0..ROUNDS {
            let refined = self.refined(&knots, &width, tolerance);
            if refined.len() == knots.len() {
                break;
            }
            knots = self.knots(&refined);
        }
        self.nodes(&knots, &width, tolerance.height)
    }

    /// The nearest smooth curve with knots at these positions.
    fn knots(&self, at: &[f64]) -> Vec<Knot> {
        let knots: Vec<Knot> = at.iter().map(|&at| Knot { at, height: self.height(at), slope: self.slope(at) }).collect();
        least_squares(&knots, |place| self.height(place), self.step)
    }

    /// The positions of the knots, and one more in each piece that is outside the tolerance of height or width.
    fn refined(&self, knots: &[Knot], width: &impl Fn(f64) -> f64, tolerance: FitTolerance) -> Vec<f64> {
        let at: Vec<f64> = knots.iter().map(|knot| knot.at).collect();
        let widths: Vec<f64> = at.iter().map(|&u| width(u)).collect();
        let slopes = monotone_slopes(&at, &widths);
        let swelling = |i: usize| Knot { at: at[i], height: widths[i], slope: slopes[i] };
        let mut refined = Vec::with_capacity(2 * at.len());
        for i in 0..at.len() - 1 {
            refined.push(at[i]);
            let length = at[i + 1] - at[i];
            if !self.is_near(knots[i], knots[i + 1], tolerance.height) {
                refined.extend(self.corner_between(at[i], at[i + 1]));
            } else if length > 2.0 * self.step {
                let cubic = Cubic::new(swelling(i), swelling(i + 1));
                // The outline interpolates widths the same way.
                let is_near = |t: f64| (cubic.at(t * length) - width(at[i] + t * length)).abs() <= tolerance.width;
                refined.extend((!WIDTH_PLACES.into_iter().all(is_near)).then_some(at[i] + 0.5 * length));
            }
        }
        refined.push(at[at.len() - 1]);
        refined
    }

    /// The position of the given height nearest to the middle of a piece, if one lies inside.
    fn corner_between(&self, from: f64, to: f64) -> Option<f64> {
        let margin = 1e-6 * self.step;
        let index = ((0.5 * (from + to) - self.first) / self.step).round();
        [index, index - 1.0, index + 1.0]
            .into_iter()
            .map(|i| self.first + i * self.step)
            .find(|place| *place > from + margin && *place < to - margin)
    }

    /// True if a cubic piece lies within the tolerance of the curve everywhere, in height.
    fn is_near(&self, from: Knot, to: Knot, tolerance: f64) -> bool {
        let cubic = Cubic::new(from, to);
        let length = to.at - from.at;
        let is_far = |t: f64| (cubic.at(t * length) - self.height(from.at + t * length)).abs() > tolerance;
        if [0.5, 0.2, 0.8].into_iter().any(is_far) {
            return false;
        }
        // Over a straight step of the curve, the cubic leaves its chord by at most an eighth of its bend times the step squared.
        let slack = 0.125 * self.step * self.step;
        let mut before: (f64, f64) = (0.0, 0.0);
        self.corners(from.at, to.at).all(|(place, height)| {
            let x = place - from.at;
            let here = ((cubic.at(x) - height).abs(), cubic.bend(x).abs());
            let off = here.0.max(before.0) + slack * here.1.max(before.1);
            before = here;
            off <= tolerance
        })
    }

    /// The curve's corners from one position to another, both included, each with its height.
    fn corners(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
        let margin = 1e-6 * self.step;
        let first = ((from + margin - self.first) / self.step).ceil().max(0.0) as usize;
        let last = ((to - margin - self.first) / self.step).floor().max(0.0) as usize;
        let inner = (first..=last.min(self.heights.len() - 1)).map(|i| (self.first + i as f64 * self.step, self.heights[i]));
        std::iter::once((from, self.height(from))).chain(inner).chain(std::iter::once((to, self.height(to))))
    }

    /// The nodes; pieces outside the tolerance run straight from corner to corner.
    fn nodes(&self, knots: &[Knot], width: &impl Fn(f64) -> f64, tolerance: f64) -> Vec<GraphNode> {
        let near: Vec<bool> = knots.windows(2).map(|pair| self.is_near(pair[0], pair[1], tolerance)).collect();
        // A knot with no good piece beside it may be far off, so it gets the curve's height.
        let is_sound = |i: usize| near[i.saturating_sub(1)] || near[i.min(near.len() - 1)];
        let sound = |i: usize| if is_sound(i) { knots[i] } else { Knot { height: self.height(knots[i].at), ..knots[i] } };
        let node =
            |k: Knot| GraphNode { at: k.at, height: k.height, slope_before: k.slope, slope_after: k.slope, width: width(k.at) };
        let mut nodes: Vec<GraphNode> = vec![node(sound(0))];
        for (i, &near) in near.iter().enumerate() {
            let (from, to) = (sound(i), sound(i + 1));
            if near {
                nodes.push(node(to));
                continue;
            }
            let inner = self.corners(from.at, to.at).filter(|(at, _)| *at > from.at && *at < to.at);
            let corners = inner.map(|(at, height)| Knot { at, height, slope: 0.0 }).chain(std::iter::once(to));
            for next in corners {
                let before = nodes.len() - 1;
                let secant = (next.height - nodes[before].height) / (next.at - nodes[before].at);
                nodes[before].slope_after = secant;
                nodes.push(GraphNode { slope_before: secant, ..node(next) });
            }
        }
        nodes
    }
}

/// Coefficients of the cubic between two knots, by powers of the distance from the first.
struct Cubic([f64; 4]);

impl Cubic {
    fn new(from: Knot, to: Knot) -> Self {
        let length = to.at - from.at;
        let secant = (to.height - from.height) / length;
        let second = (3.0 * secant - 2.0 * from.slope - to.slope) / length;
        let third = (from.slope + to.slope - 2.0 * secant) / (length * length);
        Self([from.height, from.slope, second, third])
    }

    fn at(&self, x: f64) -> f64 {
        let [a, b, c, d] = self.0;
        a + x * (b + x * (c + x * d))
    }

    /// The second derivative.
    fn bend(&self, x: f64) -> f64 {
        2.0 * self.0[2] + 6.0 * self.0[3] * x
    }
}

/// Slopes by the harmonic mean of the neighbouring secants, 0 at a peak (Fritsch and Butland 1984), the same as in outlines.
fn monotone_slopes(at: &[f64], values: &[f64]) -> Vec<f64> {
    let secant = |i: usize| (values[i + 1] - values[i]) / (at[i + 1] - at[i]);
    let last = at.len() - 1;
    (0..=last)
        .map(|i| {
            let (before, after) = (secant(i.saturating_sub(1)), secant(i.min(last - 1)));
            if before * after > 0.0 { 2.0 * before * after / (before + after) } else { 0.0 }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    fn piece(pair: &[GraphNode]) -> Cubic {
        let knot = |node: &GraphNode, slope| Knot { at: node.at, height: node.height, slope };
        Cubic::new(knot(&pair[0], pair[0].slope_after), knot(&pair[1], pair[1].slope_before))
    }

    const FINE: FitTolerance = FitTolerance { height: 0.005, width: 0.01, piece: 8.0 };

    #[test]
    fn a_wave_takes_few_pieces_and_stays_near() {
        let wave = |u: f64| (u / 4.0).sine() * 2.0;
        let heights: Vec<f64> = (0..1001).map(|i| wave(f64::from(i) * 0.04)).collect();
        let graph = Graph { first: 0.0, step: 0.04, heights: &heights };
        let nodes = graph.fit(&[0.0, 40.0], |u| 0.3 + 0.2 * (u / 5.0).cosine(), FINE);
        assert!(nodes.len() <= 18, "{}", nodes.len());
        for pair in nodes.windows(2) {
            let cubic = piece(pair);
            for i in 0..10 {
                let at = pair[0].at + (pair[1].at - pair[0].at) * f64::from(i) / 10.0;
                assert!((cubic.at(at - pair[0].at) - wave(at)).abs() < 0.0055);
            }
        }
    }

    #[test]
    fn noise_is_followed_without_bulges() {
        let heights: Vec<f64> = (0..200).map(|i| f64::from(i * 7919 % 13) * 0.1).collect();
        let graph = Graph { first: 0.0, step: 0.1, heights: &heights };
        for pair in graph.fit(&[0.0, 19.9], |_| 0.1, FINE).windows(2) {
            let cubic = piece(pair);
            for i in 0..=10 {
                let at = pair[0].at + (pair[1].at - pair[0].at) * f64::from(i) / 10.0;
                assert!((cubic.at(at - pair[0].at) - graph.height(at)).abs() <= FINE.height + 1e-9, "at {at}");
            }
        }
    }
}
