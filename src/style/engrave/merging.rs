//! Merging of regions whose lines have nearly the same direction.

use super::angles::{neighbours, upright};
use crate::elementary::{Elementary as _, unit_at};
use crate::geometry::Vec2;
use crate::raster::Raster;
use std::collections::BTreeSet;

/// Superpixels whose directions differ by less than this many degrees are merged: lines of two regions must not run side by side within
/// 15 degrees, and a seam between nearly parallel lines looks like a flaw. With much more, forms lose their own directions.
const SIMILAR_DEGREES: f64 = 18.0;

/// Merges neighbouring regions whose directions differ by less than [`SIMILAR_DEGREES`], the most similar first. Returns the new label of each old
/// one, and the direction of each remaining label, averaged by area.
pub(super) fn merge_similar(labels: &Raster<i32>, angles: &[f64]) -> (Vec<i32>, Vec<f64>) {
    let mut area = vec![0.0_f64; angles.len()];
    labels.pixels().iter().filter(|label| **label > 0).for_each(|&label| area[label as usize - 1] += 1.0);
    let doubled = |(angle, area): (&f64, f64)| unit_at(2.0 * angle.to_radians()) * area;
    let mut sums: Vec<Vec2> = angles.iter().zip(area).map(doubled).collect();
    let mut touching: Vec<BTreeSet<usize>> =
        neighbours(labels, angles.len() as i32).into_iter().map(|list| list.into_iter().collect()).collect();
    let mut owner: Vec<usize> = (0..angles.len()).collect();
    loop {
        let nearest: Vec<Option<usize>> = (0..sums.len()).map(|i| most_similar(i, &touching[i], &sums)).collect();
        let pairs: Vec<(usize, usize)> =
            (0..sums.len()).filter_map(|i| nearest[i].filter(|&j| i < j && nearest[j] == Some(i)).map(|j| (i, j))).collect();
        if pairs.is_empty() {
            break;
        }
        for (i, j) in pairs {
            sums[i] = sums[i] + sums[j];
            owner.iter_mut().filter(|owner| **owner == j).for_each(|owner| *owner = i);
            for k in std::mem::take(&mut touching[j]) {
                touching[k].remove(&j);
                if k != i {
                    touching[k].insert(i);
                    touching[i].insert(k);
                }
            }
        }
    }
    let angle = |sum: &Vec2| upright(0.5 * sum.y.angle_over(sum.x));
    (owner.into_iter().map(|i| i as i32 + 1).collect(), sums.iter().map(angle).collect())
}

/// The neighbour whose direction differs least, by less than [`SIMILAR_DEGREES`]; ties go to the pair with the lowest numbers, so that the most
/// similar pair choose each other.
fn most_similar(i: usize, touching: &BTreeSet<usize>, sums: &[Vec2]) -> Option<usize> {
    let apart = |j: usize| 0.5 * sums[i].cross(sums[j]).angle_over(sums[i].dot(sums[j])).abs().to_degrees();
    let candidates = touching.iter().map(|&j| (apart(j), i.min(j), i.max(j), j)).filter(|c| c.0 < SIMILAR_DEGREES);
    candidates.min_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2)))).map(|c| c.3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alike_neighbours_are_one_region() {
        let labels = Raster::from_fn(40, 10, |x, _| x as i32 / 10 + 1);
        // The first two are similar across the wrap at 90 degrees; the last is similar to the second but does not touch it.
        let (joined, angles) = merge_similar(&labels, &[86.0, -88.0, 30.0, -89.0]);
        assert_eq!(joined, [1, 1, 3, 4]);
        assert!((angles[0] - 89.0).abs() < 1e-6 && (angles[2] - 30.0).abs() < 1e-6, "{angles:?}");
    }
}
