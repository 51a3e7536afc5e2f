//! Histogram equalisation by exact ranks.

use super::Raster;
use rayon::prelude::*;

/// Ranks of the pixels spread evenly over [-1/2, 1/2] (Papari 2009, equation 7.11); equal values share the middle of their ranks.
pub fn equalised(raster: &Raster<f32>) -> Raster<f32> {
    let sorted = sorted(raster);
    let count = sorted.len() as f32;
    raster.map(|v| {
        let below = sorted.partition_point(|s| *s < v);
        let to = sorted.partition_point(|s| *s <= v);
        0.5 * (below + to) as f32 / count - 0.5
    })
}

/// All values in ascending order.
pub fn sorted(raster: &Raster<f32>) -> Vec<f32> {
    let mut values = raster.pixels().to_vec();
    values.par_sort_unstable_by(f32::total_cmp);
    values
}

/// The middle of some values, the upper one of two; none of none.
pub(crate) fn median(mut values: Vec<f32>) -> Option<f32> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_flat_and_ties_are_shared() {
        let raster = Raster::from_vec(4, 1, vec![3.0, 1.0, 3.0, 10.0]);
        assert_eq!(equalised(&raster).pixels(), [0.0, -0.375, 0.0, 0.375]);
    }
}
