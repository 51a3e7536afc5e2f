//! Curves over one axis that keep their order and a minimum distance.
//!
//! A curve is given by its heights at even steps, with straight lines between them. "Above another by at least a gap, measured in
//! any direction" is a set of linear conditions on the heights, so the mean of two families that keep the gap keeps it too.

/// Steps per gap.
const STEPS: usize = 4;
/// Radius, in gaps, of the disc whose polygon through the steps still contains the disc of the gap.
const CLEARANCE_RADIUS: f64 = 1.05;

/// A minimum distance between curves, and the step at which they must be sampled to keep it exactly.
#[derive(Clone, Debug)]
pub struct Gap {
    /// The minimum distance.
    pub distance: f64,
    /// The step between heights: a quarter of the distance.
    pub step: f64,
    /// Minimum rise of the next curve above a height, by the number of steps to the side.
    clearance: [f64; STEPS + 2],
}

impl Gap {
    /// A gap of this distance, above 0.
    pub fn new(distance: f64) -> Self {
        let step = distance / STEPS as f64;
        let mut clearance = [0.0; STEPS + 2];
        for (j, rise) in clearance.iter_mut().enumerate().take(STEPS + 1) {
            *rise = ((CLEARANCE_RADIUS * distance).powi(2) - (j as f64 * step).powi(2)).sqrt();
        }
        Self { distance, step, clearance }
    }

    /// Number of steps to the side within which another curve can come closer than the distance.
    pub const fn reach(&self) -> usize {
        self.clearance.len() - 1
    }

    /// Raises a curve until it lies above `lower` by the gap.
    pub fn raise(&self, curve: &mut [f64], lower: &[f64]) {
        for (j, &rise) in self.clearance.iter().enumerate().take(curve.len()) {
            let end = curve.len() - j;
            curve[j..].iter_mut().zip(&lower[..end]).for_each(|(c, &l)| *c = c.max(l + rise));
            curve[..end].iter_mut().zip(&lower[j..]).for_each(|(c, &l)| *c = c.max(l + rise));
        }
    }

    /// Lowers a curve until it lies below `upper` by the gap.
    pub fn sink(&self, curve: &mut [f64], upper: &[f64]) {
        for (j, &rise) in self.clearance.iter().enumerate().take(curve.len()) {
            let end = curve.len() - j;
            curve[j..].iter_mut().zip(&upper[..end]).for_each(|(c, &l)| *c = c.min(l - rise));
            curve[..end].iter_mut().zip(&upper[j..]).for_each(|(c, &l)| *c = c.min(l - rise));
        }
    }

    /// Moves the curves (lowest first) so that each keeps the gap to the next. The result is the mean of pushing all up from the
    /// lowest and all down from the highest, so a curve moves only where another is too close.
    #[must_use]
    pub fn keep(&self, wanted: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let (raised, sunk) = rayon::join(
            || {
                let mut raised = wanted.to_vec();
                for k in 1..raised.len() {
                    let (lower, upper) = raised.split_at_mut(k);
                    self.raise(&mut upper[0], &lower[k - 1]);
                }
                raised
            },
            || {
                let mut sunk = wanted.to_vec();
                for k in (1..sunk.len()).rev() {
                    let (lower, upper) = sunk.split_at_mut(k);
                    self.sink(&mut lower[k - 1], &upper[0]);
                }
                sunk
            },
        );
        let mean = |(mut a, b): (Vec<f64>, Vec<f64>)| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a = 0.5 * (*a + b));
            a
        };
        raised.into_iter().zip(sunk).map(mean).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;
    use crate::geometry::{Point, distance_to_segment};

    /// Minimum distance of two polylines that do not cross.
    fn distance(a: &[Point], b: &[Point]) -> f64 {
        let one = |a: &[Point], b: &[Point]| {
            let to_line = |p: &Point| b.windows(2).map(|s| distance_to_segment(*p, s[0], s[1])).fold(f64::INFINITY, f64::min);
            a.iter().map(to_line).fold(f64::INFINITY, f64::min)
        };
        one(a, b).min(one(b, a))
    }

    #[test]
    fn noise_is_pushed_apart_and_what_is_apart_stays() {
        let gap = Gap::new(0.4);
        let noise = |i: usize, k: usize| ((i * 7919 + k * 104_729) % 1000) as f64 / 250.0;
        let wanted: Vec<Vec<f64>> = (0..12).map(|k| (0..60).map(|i| k as f64 + noise(i, k)).collect()).collect();
        let kept = gap.keep(&wanted);
        let points = |line: &Vec<f64>| -> Vec<Point> {
            line.iter().enumerate().map(|(i, h)| Point::new(i as f64 * gap.step, *h)).collect()
        };
        for pair in kept.windows(2) {
            assert!(pair[0].iter().zip(&pair[1]).all(|(a, b)| a < b));
            let apart = distance(&points(&pair[0]), &points(&pair[1]));
            assert!(apart >= 0.4, "{apart}");
        }
        let calm: Vec<Vec<f64>> = (0..5).map(|k| (0..50).map(|i| f64::from(k) + (f64::from(i) * 0.1).sine()).collect()).collect();
        assert_eq!(gap.keep(&calm), calm);
    }
}
