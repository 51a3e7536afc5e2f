//! Mixtures of Gaussians over colour and texture, fitted deterministically to samples.

use super::plate::Feature;
use crate::elementary::Elementary as _;

/// Most samples that a mixture is fitted to: more give no visible change.
const MOST_SAMPLES: usize = 4000;
/// Most components of a mixture.
const MOST_PARTS: usize = 6;
/// Fewest samples per component.
const LEAST_EACH: usize = 12;
/// Rounds of k-means; later ones move no mean by more than one unit.
const ROUNDS: usize = 10;
/// A new centre starts at the sample at this quantile of the distance to the nearest centre; the farthest samples are outliers.
const FAR: f64 = 0.9;
/// Added to every variance: a flat jacket must not be distinguished from its own shade.
const LEAST_VARIANCE: f64 = 12.0;
/// Up to this number of samples the covariance is replaced by `UNKNOWN_VARIANCE`.
const LEAST_FOR_SPREAD: usize = 6;
const UNKNOWN_VARIANCE: f64 = 50.0;

type Matrix = [[f64; 4]; 4];

/// One Gaussian.
#[derive(Clone, Debug)]
pub(super) struct Gaussian {
    mean: Feature,
    /// The inverse of the covariance's lower Cholesky factor.
    whitening: [[f32; 4]; 4],
    /// Half the logarithm of the covariance's determinant.
    half_log_determinant: f32,
}

impl Gaussian {
    pub(super) fn new(mean: Feature, covariance: Matrix) -> Self {
        let factor = cholesky(covariance);
        let half_log_determinant = (0..4).map(|i| factor[i][i].logarithm()).sum::<f64>() as f32;
        Self { mean, whitening: inverse_of_lower(factor).map(|row| row.map(|v| v as f32)), half_log_determinant }
    }

    /// The squared Mahalanobis distance.
    #[inline]
    pub(super) fn distance(&self, f: Feature) -> f32 {
        let d = [f[0] - self.mean[0], f[1] - self.mean[1], f[2] - self.mean[2], f[3] - self.mean[3]];
        let mut sum = 0.0;
        for (i, row) in self.whitening.iter().enumerate() {
            let along: f32 = row[..=i].iter().zip(&d).map(|(w, d)| w * d).sum();
            sum += along * along;
        }
        sum
    }

    pub(super) const fn mean(&self) -> Feature {
        self.mean
    }

    pub(super) const fn half_log_determinant(&self) -> f32 {
        self.half_log_determinant
    }
}

/// A mixture: components with the logarithms of their weights.
#[derive(Clone, Debug)]
pub(super) struct Mixture(Vec<(f32, Gaussian)>);

impl Mixture {
    /// A mixture of at most `count` Gaussians; `None` without samples.
    pub(super) fn fitted(samples: &[Feature], count: usize) -> Option<Self> {
        let step = samples.len().div_ceil(MOST_SAMPLES).max(1);
        let samples: Vec<Feature> = samples.iter().step_by(step).copied().collect();
        let count = count.min(samples.len() / LEAST_EACH).clamp(1, MOST_PARTS);
        let (middles, nearest) = k_means(&samples, count)?;
        let total = samples.len() as f32;
        let parts = middles.iter().enumerate().filter_map(|(j, &middle)| {
            let own: Vec<Feature> = samples.iter().zip(&nearest).filter(|(_, n)| **n == j).map(|(s, _)| *s).collect();
            let mut spread =
                if own.len() > LEAST_FOR_SPREAD { covariance(&own, middle) } else { diagonal([UNKNOWN_VARIANCE; 4]) };
            add_diagonal(&mut spread, [LEAST_VARIANCE; 4]);
            (!own.is_empty()).then(|| ((own.len() as f32 / total).logarithm(), Gaussian::new(middle, spread)))
        });
        Some(Self(parts.collect()))
    }

    /// The logarithm of the density, without the constant of four-dimensional Gaussians.
    #[inline]
    pub(super) fn log_density(&self, f: Feature) -> f32 {
        let mut logs = [f32::NEG_INFINITY; MOST_PARTS];
        for (log, (share, part)) in logs.iter_mut().zip(&self.0) {
            *log = share - part.half_log_determinant - 0.5 * part.distance(f);
        }
        log_sum(&logs[..self.0.len()])
    }

    pub(super) fn parts(&self) -> impl Iterator<Item = &Gaussian> {
        self.0.iter().map(|(_, part)| part)
    }
}

/// The logarithm of a sum of exponentials.
#[inline]
pub(super) fn log_sum(logs: &[f32]) -> f32 {
    let greatest = logs.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    if greatest == f32::NEG_INFINITY {
        greatest
    } else {
        greatest + logs.iter().map(|v| (v - greatest).exponential()).sum::<f32>().logarithm()
    }
}

/// Centres and, for each sample, the index of the nearest.
fn k_means(samples: &[Feature], count: usize) -> Option<(Vec<Feature>, Vec<usize>)> {
    let mut middles = vec![mean(samples)?];
    while middles.len() < count {
        let mut order: Vec<(f32, usize)> =
            samples.iter().enumerate().map(|(i, s)| (square(*s, middles[nearest(&middles, *s)]), i)).collect();
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        middles.push(samples[order[((samples.len() - 1) as f64 * FAR) as usize].1]);
    }
    let mut own = vec![0; samples.len()];
    for _ in 0..ROUNDS {
        own.iter_mut().zip(samples).for_each(|(own, s)| *own = nearest(&middles, *s));
        for (j, middle) in middles.iter_mut().enumerate() {
            let of_it: Vec<Feature> = samples.iter().zip(&own).filter(|(_, own)| **own == j).map(|(s, _)| *s).collect();
            *middle = mean(&of_it).unwrap_or(*middle);
        }
    }
    own.iter_mut().zip(samples).for_each(|(own, s)| *own = nearest(&middles, *s));
    Some((middles, own))
}

fn nearest(middles: &[Feature], f: Feature) -> usize {
    let best = middles.iter().enumerate().map(|(j, m)| (square(f, *m), j)).min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or(0, |(_, j)| j)
}

pub(super) fn square(a: Feature, b: Feature) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

pub(super) fn mean(samples: &[Feature]) -> Option<Feature> {
    let sum = samples.iter().fold([0.0_f64; 4], |sum, s| [0, 1, 2, 3].map(|k| sum[k] + f64::from(s[k])));
    (!samples.is_empty()).then(|| sum.map(|v| (v / samples.len() as f64) as f32))
}

pub(super) fn covariance(samples: &[Feature], mean: Feature) -> Matrix {
    let mut sum = [[0.0; 4]; 4];
    for s in samples {
        let d = [0, 1, 2, 3].map(|k| f64::from(s[k] - mean[k]));
        for (row, di) in sum.iter_mut().zip(d) {
            row.iter_mut().zip(d).for_each(|(cell, dj)| *cell += di * dj);
        }
    }
    let count = samples.len().saturating_sub(1).max(1) as f64;
    sum.map(|row| row.map(|v| v / count))
}

fn diagonal(values: [f64; 4]) -> Matrix {
    let mut matrix = [[0.0; 4]; 4];
    add_diagonal(&mut matrix, values);
    matrix
}

pub(super) fn add_diagonal(matrix: &mut Matrix, values: [f64; 4]) {
    for (i, value) in values.into_iter().enumerate() {
        matrix[i][i] += value;
    }
}

/// The lower Cholesky factor of a positive definite matrix.
fn cholesky(matrix: Matrix) -> Matrix {
    let mut lower = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            lower[i][j] = if i == j { (matrix[i][i] - sum).max(1e-6).sqrt() } else { (matrix[i][j] - sum) / lower[j][j] };
        }
    }
    lower
}

fn inverse_of_lower(lower: Matrix) -> Matrix {
    let mut inverse = [[0.0; 4]; 4];
    for j in 0..4 {
        inverse[j][j] = 1.0 / lower[j][j];
        for i in j + 1..4 {
            let sum: f64 = (j..i).map(|k| lower[i][k] * inverse[k][j]).sum();
            inverse[i][j] = -sum / lower[i][i];
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_heaps_are_told_apart() {
        let heap = |middle: f32| (0..200).map(move |i| [middle + (i % 7) as f32, (i % 5) as f32, (i % 3) as f32, 0.0]);
        let samples: Vec<Feature> = heap(0.0).chain(heap(100.0)).collect();
        let mixture = Mixture::fitted(&samples, 2).unwrap();
        let (near, between) = (mixture.log_density([3.0, 2.0, 1.0, 0.0]), mixture.log_density([50.0, 2.0, 1.0, 0.0]));
        assert!(near > between + 20.0, "{near} {between}");
        assert!(Mixture::fitted(&[], 3).is_none());
    }

    #[test]
    fn distances_are_in_standard_deviations() {
        let gaussian =
            Gaussian::new([1.0; 4], [[4.0, 1.0, 0.0, 0.0], [1.0, 4.0, 0.0, 0.0], [0.0, 0.0, 9.0, 0.0], [0.0, 0.0, 0.0, 1.0]]);
        assert!((gaussian.distance([1.0, 1.0, 4.0, 1.0]) - 1.0).abs() < 1e-5);
        assert!((gaussian.distance([3.0, 1.0, 1.0, 1.0]) - 4.0 * 4.0 / 15.0).abs() < 1e-5);
        assert!((gaussian.half_log_determinant() - 0.5 * 135.0_f32.logarithm()).abs() < 1e-5);
    }
}
