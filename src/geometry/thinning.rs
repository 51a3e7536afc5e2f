//! Thins points: chooses which stay when each should stay with a given share.

use super::blue_noise::blue_noise_order_until;
#[cfg(test)]
use super::blue_noise_order;
use super::direct_search::improved;
use crate::interrupt::Interrupt;
use kurbo::{Point, Rect};

/// Maximum number of points in a part that is not split further; within it the blue-noise rank decides. With 32 the count of a
/// patch is off by a sixtieth at most; with 4 the cells show as a grid.
const TOGETHER: usize = 32;

/// Chooses points, evenly spread, so that the number that stay is everywhere close to the sum of their shares (each from 0 to 1).
///
/// The points are halved repeatedly by position; each half gets a whole number within 1 of the sum of its shares. In the smallest
/// parts, those first in blue-noise order stay, with ranks divided by share (ranks alone would keep points in sparse areas and at
/// borders, where they are less crowded, and leave dense areas too light). Then points are toggled and swapped as long as that
/// makes the tone more even. Points must be finite. Time O(n log n). Once the interrupt is raised, the choice is incomplete.
pub fn thinned(points: &[Point], shares: &[f64], interrupt: &Interrupt) -> Vec<bool> {
    improved(points, shares, counted(points, shares, interrupt), interrupt)
}

/// The initial choice, by counts and ranks.
fn counted(points: &[Point], shares: &[f64], interrupt: &Interrupt) -> Vec<bool> {
    let mut order = vec![0.0; points.len()];
    for (rank, i) in blue_noise_order_until(points, interrupt).into_iter().enumerate() {
        order[i] = (rank as f64 + 0.5) / shares[i].clamp(1e-9, 1.0);
    }
    let mut stays = vec![false; points.len()];
    let sum = |part: &[usize]| part.iter().map(|&i| shares[i].clamp(0.0, 1.0)).sum::<f64>();
    let all: Vec<usize> = (0..points.len()).collect();
    let wanted = sum(&all).round() as usize;
    let mut parts = vec![(all, wanted)];
    while let Some((mut part, wanted)) = parts.pop().filter(|_| !interrupt.is_raised()) {
        if part.len() <= TOGETHER || wanted == 0 || wanted >= part.len() {
            part.sort_unstable_by(|&a, &b| order[a].total_cmp(&order[b]).then(a.cmp(&b)));
            part.iter().take(wanted).for_each(|&i| stays[i] = true);
            continue;
        }
        let second = half(points, &mut part);
        let (first_sum, second_sum) = (sum(&part), sum(&second));
        let rest = wanted as f64 - first_sum - second_sum;
        let fewest = wanted.saturating_sub(second.len());
        let first = ((first_sum + 0.5 * rest).round().max(0.0) as usize).clamp(fewest, wanted.min(part.len()));
        parts.push((part, first));
        parts.push((second, wanted - first));
    }
    stays
}

/// Splits points at the median across the longer side of their bounds.
fn half(points: &[Point], part: &mut Vec<usize>) -> Vec<usize> {
    let bounds = part.iter().map(|&i| Rect::from_points(points[i], points[i])).reduce(|a, b| a.union(b)).unwrap_or_default();
    let along = |i: usize| if bounds.width() > bounds.height() { points[i].x } else { points[i].y };
    part.sort_unstable_by(|&a, &b| along(a).total_cmp(&along(b)).then(a.cmp(&b)));
    part.split_off(part.len() / 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_patch_keeps_its_share() {
        // Left sparse, right nine times as dense; shares rise from top to bottom.
        let grid = |n: i32, x: f64| {
            let step = 30.0 / f64::from(n);
            (0..n * n).map(move |i| Point::new(x + step * (f64::from(i % n) + 0.5), step * (f64::from(i / n) + 0.5)))
        };
        let points: Vec<Point> = grid(30, 0.0).chain(grid(90, 30.0)).collect();
        let shares: Vec<f64> = points.iter().map(|p| p.y / 30.0).collect();
        let stays = thinned(&points, &shares, &Interrupt::never());
        for (row, column) in (0..5).flat_map(|row| (0..10).map(move |column| (row, column))) {
            let patch =
                Rect::new(6.0 * f64::from(column), 6.0 * f64::from(row), 6.0 * f64::from(column + 1), 6.0 * f64::from(row + 1));
            let inside = || (0..points.len()).filter(|&i| patch.contains(points[i]));
            let (kept, asked) = (inside().filter(|&i| stays[i]).count() as f64, inside().map(|i| shares[i]).sum::<f64>());
            // A part of 32 points may lie across the border of a patch.
            assert!((kept - asked).abs() < 8.0 + 0.03 * asked, "{patch:?}: {kept} of {asked}");
        }
    }

    #[test]
    fn sparse_places_are_not_spared() {
        let sparse = (0..400).map(|i| Point::new(f64::from(i % 20), f64::from(i / 20)));
        let dense = (0..3600).map(|i| Point::new(30.0 + f64::from(i % 60) / 3.0, f64::from(i / 60) / 3.0));
        let points: Vec<Point> = sparse.chain(dense).collect();
        let stays = thinned(&points, &vec![0.4; 4000], &Interrupt::never());
        let kept = stays[..400].iter().filter(|stays| **stays).count();
        assert!((155..=165).contains(&kept), "{kept} of 160");
        // By ranks alone nearly all of the sparse ones would stay.
        let by_rank = blue_noise_order(&points)[..1600].iter().filter(|&&i| i < 400).count();
        assert!(by_rank > 200, "{by_rank}");
    }

    #[test]
    fn none_all_and_nothing() {
        let points = [Point::ORIGIN; 100];
        assert!(thinned(&points, &[0.0; 100], &Interrupt::never()).iter().all(|stays| !stays));
        assert!(thinned(&points, &[1.5; 100], &Interrupt::never()).iter().all(|stays| *stays));
        assert!(thinned(&[], &[], &Interrupt::never()).is_empty());
    }
}
