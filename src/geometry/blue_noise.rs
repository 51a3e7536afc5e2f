//! Progressive order of points: every prefix is evenly spread. By sample elimination (Yuksel 2015).

use crate::interrupt::Interrupt;
use kurbo::Point;
use std::collections::BinaryHeap;

/// Ranks points so that the first `k` of the order are well spread for every `k`. Returns indices, the last eliminated first.
///
/// Each round eliminates half of the remaining points, the most crowded first, and doubles the search area. Time O(n log n). Ties
/// are broken by index, so the order is deterministic.
pub fn blue_noise_order(points: &[Point]) -> Vec<usize> {
    blue_noise_order_until(points, &Interrupt::never())
}

/// [`blue_noise_order`] with an interrupt; once it is raised, the order is arbitrary.
pub(super) fn blue_noise_order_until(points: &[Point], interrupt: &Interrupt) -> Vec<usize> {
    let mut kept: Vec<usize> = (0..points.len()).collect();
    let mut eliminated = Vec::with_capacity(points.len());
    while kept.len() > 8 && !interrupt.is_raised() {
        let goal = kept.len() / 2;
        kept = eliminate(points, &kept, goal, &mut eliminated, interrupt);
    }
    eliminated.extend(kept.iter().rev());
    eliminated.reverse();
    eliminated
}

/// Removes the most crowded of `from` until `goal` are left, and returns those. Appends the removed ones to `removed`, in order.
fn eliminate(points: &[Point], from: &[usize], goal: usize, removed: &mut Vec<usize>, interrupt: &Interrupt) -> Vec<usize> {
    let reach = crowding_radius(points, from, goal);
    let grid = Grid::new(points, from, reach);
    let crowding_of = |a: usize, b: usize| {
        let closeness = 1.0 - points[a].distance(points[b]) / reach;
        if closeness > 0.0 { closeness.powi(8) } else { 0.0 }
    };
    let slot_of: std::collections::HashMap<usize, usize> = from.iter().enumerate().map(|(slot, &i)| (i, slot)).collect();
    let crowding_at = |&i: &usize| {
        if interrupt.is_raised() {
            return 0.0;
        }
        grid.around(points[i]).filter(|&j| j != i).map(|j| crowding_of(i, j)).sum()
    };
    let mut crowding: Vec<f64> = from.iter().map(crowding_at).collect();
    let mut alive = vec![true; from.len()];
    let mut heap: BinaryHeap<Crowded> = crowding.iter().enumerate().map(|(slot, &crowding)| Crowded { crowding, slot }).collect();
    let mut left = from.len();
    while left > goal && !interrupt.is_raised() {
        let Some(Crowded { crowding: stale, slot }) = heap.pop() else { break };
        if !alive[slot] {
            continue;
        }
        if stale > crowding[slot] {
            heap.push(Crowded { crowding: crowding[slot], slot });
            continue;
        }
        alive[slot] = false;
        left -= 1;
        removed.push(from[slot]);
        for j in grid.around(points[from[slot]]) {
            let other = slot_of[&j];
            if alive[other] {
                crowding[other] = (crowding[other] - crowding_of(from[slot], j)).max(0.0);
            }
        }
    }
    from.iter().zip(alive).filter(|(_, alive)| *alive).map(|(&i, _)| i).collect()
}

/// The distance below which two kept points count as crowded: twice (as in the paper, section 3.3) the distance of `goal` points
/// in a hexagonal packing of the area that the points cover.
fn crowding_radius(points: &[Point], from: &[usize], goal: usize) -> f64 {
    let bounds = from.iter().fold(None::<kurbo::Rect>, |bounds, &i| {
        let r = kurbo::Rect::from_points(points[i], points[i]);
        Some(bounds.map_or(r, |b| b.union(r)))
    });
    let area = bounds.map_or(0.0, |b| b.width().max(1e-9) * b.height().max(1e-9));
    2.0 * (area / (2.0 * 3.0_f64.sqrt() * goal.max(1) as f64)).sqrt()
}

/// A candidate for elimination, ordered by crowding, then by index.
struct Crowded {
    crowding: f64,
    slot: usize,
}

impl Ord for Crowded {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.crowding.total_cmp(&other.crowding).then(self.slot.cmp(&other.slot))
    }
}

impl PartialOrd for Crowded {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Crowded {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Crowded {}

/// Points sorted into square cells, in one flat array.
struct Grid<'a> {
    points: &'a [Point],
    cell: f64,
    columns: usize,
    rows: usize,
    origin: Point,
    start: Vec<usize>,
    members: Vec<usize>,
    reach: f64,
}

impl<'a> Grid<'a> {
    fn new(points: &'a [Point], from: &[usize], reach: f64) -> Self {
        let x = |i: &usize| points[*i].x;
        let y = |i: &usize| points[*i].y;
        let origin =
            Point::new(from.iter().map(x).fold(f64::INFINITY, f64::min), from.iter().map(y).fold(f64::INFINITY, f64::min));
        let span = |of: &dyn Fn(&usize) -> f64, low: f64| from.iter().map(of).fold(low, f64::max) - low;
        let (width, height) = (span(&x, origin.x), span(&y, origin.y));
        // At most about as many cells as points, however small the reach.
        let cell = reach.max((width * height / from.len() as f64).sqrt()).max((width + height) / from.len() as f64).max(1e-12);
        let (columns, rows) = ((width / cell) as usize + 1, (height / cell) as usize + 1);
        let mut grid =
            Self { points, cell, columns, rows, origin, start: vec![0; columns * rows + 1], members: vec![0; from.len()], reach };
        for &i in from {
            let (cx, cy) = grid.cell_of(points[i]);
            grid.start[cy * columns + cx + 1] += 1;
        }
        for c in 0..columns * rows {
            grid.start[c + 1] += grid.start[c];
        }
        let mut next = grid.start.clone();
        for &i in from {
            let (cx, cy) = grid.cell_of(points[i]);
            grid.members[next[cy * columns + cx]] = i;
            next[cy * columns + cx] += 1;
        }
        grid
    }

    fn cell_of(&self, p: Point) -> (usize, usize) {
        let cx = ((p.x - self.origin.x) / self.cell) as usize;
        let cy = ((p.y - self.origin.y) / self.cell) as usize;
        (cx.min(self.columns - 1), cy.min(self.rows - 1))
    }

    /// Members closer than the reach, including the point itself.
    fn around(&self, p: Point) -> impl Iterator<Item = usize> + '_ {
        let (cx, cy) = self.cell_of(p);
        let columns = cx.saturating_sub(1)..=(cx + 1).min(self.columns - 1);
        (cy.saturating_sub(1)..=(cy + 1).min(self.rows - 1))
            .flat_map(move |row| {
                let (first, last) = (row * self.columns + *columns.start(), row * self.columns + *columns.end());
                self.members[self.start[first]..self.start[last + 1]].iter().copied()
            })
            .filter(move |&i| self.points[i].distance(p) < self.reach)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    fn least_distance(points: &[Point]) -> f64 {
        let mut least = f64::INFINITY;
        for (i, a) in points.iter().enumerate() {
            for b in &points[..i] {
                least = least.min(a.distance(*b));
            }
        }
        least
    }

    #[test]
    fn it_is_a_permutation_whose_beginnings_are_spread() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let points: Vec<Point> =
            (0..2000).map(|_| Point::new(random.random_range(0.0..10.0), random.random_range(0.0..10.0))).collect();
        let order = blue_noise_order(&points);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &j)| i == j));
        for count in [50, 200, 500] {
            let first: Vec<Point> = order[..count].iter().map(|&i| points[i]).collect();
            // A random subset of this size has pairs closer than 5 % of the hexagonal spacing.
            let hexagonal = (100.0 / count as f64 * 2.0 / 3.0_f64.sqrt()).sqrt();
            assert!(least_distance(&first) > 0.4 * hexagonal, "{count}: {} of {hexagonal}", least_distance(&first));
        }
    }

    #[test]
    fn coincident_and_few_points() {
        assert!(blue_noise_order(&[]).is_empty());
        assert_eq!(blue_noise_order(&[Point::ORIGIN]).len(), 1);
        assert_eq!(blue_noise_order(&[Point::new(1.0, 1.0); 40]).len(), 40);
    }
}
