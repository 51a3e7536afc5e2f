//! A swelling stroke along a curve over one axis, with as few cubics as a tolerance allows.

/// A curve over one axis, given by heights at even steps and straight between them.
#[derive(Clone, Copy, Debug)]
pub struct Graph<'a> {
    /// Where the first height stands.
    pub first: f64,
    /// Distance of heights.
    pub step: f64,
    /// The heights.
    pub heights: &'a [f64],
}

/// The end of a cubic piece: place, height, slope of the curve before and after it, width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GraphNode {
    /// Place along the axis.
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

/// How exactly a stroke is fitted, in the curve's own unit.
#[derive(Clone, Copy, Debug)]
pub struct FitTolerance {
    /// Greatest distance in height.
    pub height: f64,
    /// Greatest difference in width.
    pub width: f64,
    /// Greatest length of a piece.
    pub piece: f64,
}

impl Graph<'_> {
    /// The height at a place; beyond the ends that of the end.
    pub fn height(&self, at: f64) -> f64 {
        let x = ((at - self.first) / self.step).clamp(0.0, (self.heights.len() - 1) as f64);
        let i = (x as usize).min(self.heights.len().saturating_sub(2));
        let t = x - i as f64;
        self.heights[i] * (1.0 - t) + self.heights[(i + 1).min(self.heights.len() - 1)] * t
    }

    /// The slope at a place, over a step on either side.
    pub fn slope(&self, at: f64) -> f64 {
        let end = self.first + (self.heights.len() - 1) as f64 * self.step;
        let (a, b) = ((at - self.step).max(self.first), (at + self.step).min(end));
        if b > a { (self.height(b) - self.height(a)) / (b - a) } else { 0.0 }
    }

    /// The nodes of a stroke that passes through `places` (ascending, at least two) and as many more as the tolerance asks
    /// for, its width given at every place.
    pub fn fit(&self, places: &[f64], width: impl Fn(f64) -> f64, tolerance: FitTolerance) -> Vec<GraphNode> {
        let mut at = Vec::with_capacity(4 * places.len());
        at.push(places[0]);
        for pair in places.windows(2).filter(|pair| pair[1] > pair[0]) {
            let pieces = ((pair[1] - pair[0]) / tolerance.piece).ceil().max(1.0) as usize;
            for i in 1..=pieces {
                let from = at[at.len() - 1];
                self.split(from, pair[0] + (pair[1] - pair[0]) * i as f64 / pieces as f64, tolerance.height, &mut at);
            }
        }
        self.split_for_width(&mut at, &width, tolerance.width);
        // A piece that was halved has slopes of its own.
        let mut fitted = vec![at[0]];
        at.windows(2).for_each(|pair| self.split(pair[0], pair[1], tolerance.height, &mut fitted));
        let at = fitted;
        self.nodes(&at, &width, tolerance.height)
    }

    /// Appends the ends of pieces from `from` (already there) to `to`; a piece is near to the curve or holds none of its corners.
    fn split(&self, from: f64, to: f64, tolerance: f64, at: &mut Vec<f64>) {
        match self.corner_between(from, to) {
            Some(middle) if !self.is_near(from, to, tolerance) => {
                self.split(from, middle, tolerance, at);
                self.split(middle, to, tolerance, at);
            }
            _ => at.push(to),
        }
    }

    /// The given height nearest to the middle of a piece, if one lies inside.
    fn corner_between(&self, from: f64, to: f64) -> Option<f64> {
        let margin = 1e-6 * self.step;
        let index = ((0.5 * (from + to) - self.first) / self.step).round();
        [index, index - 1.0, index + 1.0]
            .into_iter()
            .map(|i| self.first + i * self.step)
            .find(|place| *place > from + margin && *place < to - margin)
    }

    /// Whether the cubic over a piece passes near each of the curve's corners in it, and near a few places between.
    fn is_near(&self, from: f64, to: f64, tolerance: f64) -> bool {
        let piece = (from, self.height(from), self.slope(from), to, self.height(to), self.slope(to));
        let is_near = |place: f64| (hermite(piece, place) - self.height(place)).abs() <= tolerance;
        let first = ((from - self.first) / self.step).ceil();
        let last = ((to - self.first) / self.step).floor();
        let corners = (last - first + 1.0).max(0.0) as usize;
        (1..4).all(|i| is_near(from + (to - from) * 0.25 * f64::from(i)))
            && (0..corners).all(|i| is_near(self.first + (first + i as f64) * self.step))
    }

    /// Halves pieces until the width, as the outline of a stroke will interpolate it, is near to the one wanted.
    fn split_for_width(&self, at: &mut Vec<f64>, width: &impl Fn(f64) -> f64, tolerance: f64) {
        for _ in 0..6 {
            let widths: Vec<f64> = at.iter().map(|&u| width(u)).collect();
            let slopes = monotone_slopes(at, &widths);
            let mut refined = Vec::with_capacity(2 * at.len());
            for i in 0..at.len() - 1 {
                refined.push(at[i]);
                let piece = (at[i], widths[i], slopes[i], at[i + 1], widths[i + 1], slopes[i + 1]);
                let is_near = [0.25, 0.5, 0.75].iter().all(|t| {
                    let place = at[i] + (at[i + 1] - at[i]) * t;
                    (hermite(piece, place) - width(place)).abs() <= tolerance
                });
                if !is_near && at[i + 1] - at[i] > 2.0 * self.step {
                    refined.push(0.5 * (at[i] + at[i + 1]));
                }
            }
            refined.push(at[at.len() - 1]);
            if refined.len() == at.len() {
                return;
            }
            *at = refined;
        }
    }

    fn nodes(&self, at: &[f64], width: &impl Fn(f64) -> f64, tolerance: f64) -> Vec<GraphNode> {
        let mut nodes: Vec<GraphNode> = at
            .iter()
            .map(|&at| {
                let slope = self.slope(at);
                GraphNode { at, height: self.height(at), slope_before: slope, slope_after: slope, width: width(at) }
            })
            .collect();
        for i in 1..nodes.len() {
            let (a, b) = (nodes[i - 1], nodes[i]);
            if !self.is_near(a.at, b.at, tolerance) {
                // Noise finer than the steps: straight, so that nothing bulges into a neighbour.
                let secant = (b.height - a.height) / (b.at - a.at);
                nodes[i - 1].slope_after = secant;
                nodes[i].slope_before = secant;
            }
        }
        nodes
    }
}

/// The cubic between two ends (place, height, slope each).
fn hermite((u0, h0, s0, u1, h1, s1): (f64, f64, f64, f64, f64, f64), at: f64) -> f64 {
    let length = u1 - u0;
    let t = (at - u0) / length;
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * h0 + (t3 - 2.0 * t2 + t) * length * s0 + (3.0 * t2 - 2.0 * t3) * h1 + (t3 - t2) * length * s1
}

/// Slopes by the harmonic mean of the neighbours' secants, 0 at a peak (Fritsch and Butland 1984), as outlines use them.
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

    const FINE: FitTolerance = FitTolerance { height: 0.005, width: 0.01, piece: 2.0 };

    #[test]
    fn a_wave_takes_few_pieces_and_stays_near() {
        let wave = |u: f64| (u / 4.0).sin() * 2.0;
        let heights: Vec<f64> = (0..1001).map(|i| wave(f64::from(i) * 0.04)).collect();
        let graph = Graph { first: 0.0, step: 0.04, heights: &heights };
        let nodes = graph.fit(&[0.0, 40.0], |u| 0.3 + 0.2 * (u / 5.0).cos(), FINE);
        assert!(nodes.len() <= 25, "{}", nodes.len());
        for pair in nodes.windows(2) {
            let piece = (pair[0].at, pair[0].height, pair[0].slope_after, pair[1].at, pair[1].height, pair[1].slope_before);
            for i in 0..10 {
                let at = pair[0].at + (pair[1].at - pair[0].at) * f64::from(i) / 10.0;
                assert!((hermite(piece, at) - wave(at)).abs() < 0.006);
            }
        }
    }

    #[test]
    fn noise_is_followed_without_bulges() {
        let heights: Vec<f64> = (0..200).map(|i| f64::from(i * 7919 % 13) * 0.1).collect();
        let graph = Graph { first: 0.0, step: 0.1, heights: &heights };
        for pair in graph.fit(&[0.0, 19.9], |_| 0.1, FINE).windows(2) {
            let piece = (pair[0].at, pair[0].height, pair[0].slope_after, pair[1].at, pair[1].height, pair[1].slope_before);
            for i in 0..=10 {
                let at = pair[0].at + (pair[1].at - pair[0].at) * f64::from(i) / 10.0;
                assert!((hermite(piece, at) - graph.height(at)).abs() < 0.02 + 1e-9, "at {at}");
            }
        }
    }
}
