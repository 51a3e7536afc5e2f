//! Local Laplacian filtering (Paris, Hasinoff and Kautz 2011) by a few samples of the remapping (Aubry et al. 2014): changes
//! contrast at chosen scales without halos.

use super::{Raster, doubled, halved};
use crate::elementary::Elementary as _;
use std::ops::Range;

/// Remapping of the contrasts of one level: `d`, a value's distance from the local mean, becomes `sigma (d / sigma)^alpha` below
/// `sigma`; beyond it the slope is `beta`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remapping {
    /// Below 1 raises fine contrast, above 1 lowers it.
    pub alpha: f32,
    /// Limit of fine contrast, in the raster's units.
    pub sigma: f32,
    /// Below 1 lowers large contrast.
    pub beta: f32,
}

impl Remapping {
    fn of(self, value: f32, mean: f32) -> f32 {
        let d = value - mean;
        let size = d.abs();
        let mapped = if size < self.sigma {
            self.sigma * (size.max(1e-6) / self.sigma).power(self.alpha)
        } else {
            self.sigma + self.beta * (size - self.sigma)
        };
        mean + mapped.copysign(d)
    }
}

/// The raster (values 0 to 1) with the contrast of a range of levels of its pyramid remapped; level 0 is the finest, and other levels
/// are unchanged. The remapping is sampled at `samples` means, at least two; 14 show no bands.
pub fn local_laplacian(raster: &Raster<f32>, levels: Range<usize>, remapping: Remapping, samples: usize) -> Raster<f32> {
    if levels.is_empty() {
        return raster.clone();
    }
    if levels.start > 0 {
        let coarse = halved(raster);
        let remapped = local_laplacian(&coarse, levels.start - 1..levels.end - 1, remapping, samples);
        let change = doubled(&remapped.zip_map(&coarse, |new, old| new - old), raster.width(), raster.height());
        return raster.zip_map(&change, |v, change| v + change);
    }
    let mut means = vec![raster.clone()];
    for _ in levels.clone() {
        means.push(halved(&means[means.len() - 1]));
    }
    let mut details: Vec<Raster<f32>> = means[..levels.end].iter().map(|level| level.map(|_| 0.0)).collect();
    let step = 1.0 / (samples.max(2) - 1) as f32;
    for sample in 0..samples.max(2) {
        let mean = sample as f32 * step;
        let mut finer = raster.map(|v| remapping.of(v, mean));
        for (level, sum) in details.iter_mut().enumerate() {
            let coarser = halved(&finer);
            let smooth = doubled(&coarser, finer.width(), finer.height());
            let detail = finer.zip_map(&smooth, |v, smooth| v - smooth);
            let weighed = means[level].zip_map(&detail, |v, detail| (1.0 - (v - mean).abs() / step).max(0.0) * detail);
            sum.pixels_mut().iter_mut().zip(weighed.pixels()).for_each(|(sum, v)| *sum += v);
            finer = coarser;
        }
    }
    details.iter().rev().fold(means[levels.end].clone(), |coarse, detail| {
        doubled(&coarse, detail.width(), detail.height()).zip_map(detail, |v, detail| v + detail)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waves(strength: f32) -> Raster<f32> {
        Raster::from_fn(120, 90, |x, y| 0.3 + 0.002 * x as f32 + strength * ((x as f32 * 0.6).sine() * (y as f32 * 0.7).sine()))
    }

    #[test]
    fn remapping_by_nothing_leaves_everything() {
        let picture = waves(0.1);
        let same = local_laplacian(&picture, 1..5, Remapping { alpha: 1.0, sigma: 0.2, beta: 1.0 }, 14);
        assert!(picture.pixels().iter().zip(same.pixels()).all(|(a, b)| (a - b).abs() < 2e-3));
    }

    #[test]
    fn faint_waves_grow_and_a_step_has_no_halo() {
        let stronger = Remapping { alpha: 0.6, sigma: 0.2, beta: 1.0 };
        let grown = local_laplacian(&waves(0.03), 0..4, stronger, 14);
        let spread = |raster: &Raster<f32>| {
            let row: Vec<f32> = (50..70).map(|x| raster.get(x, 45) - 0.002 * x as f32).collect();
            row.iter().copied().fold(f32::MIN, f32::max) - row.iter().copied().fold(f32::MAX, f32::min)
        };
        assert!(spread(&grown) > 1.4 * spread(&waves(0.03)), "{} {}", spread(&grown), spread(&waves(0.03)));
        let step = Raster::from_fn(120, 60, |x, _| if x < 60 { 0.2 } else { 0.8 });
        let kept = local_laplacian(&step, 0..4, stronger, 14);
        assert!(kept.pixels().iter().zip(step.pixels()).all(|(a, b)| (a - b).abs() < 0.02));
    }
}
