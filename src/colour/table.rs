//! Coverages for every colour of a photograph: solved on a grid of colours, looked up between.

use super::pens::MOST_PENS;
use super::solver::Coverages;
use crate::parallel::collected;

/// Nodes along red, green and blue, equally spaced in the square root of light.
pub(super) const NODES: usize = 33;
/// The grid is solved from coarse to fine; each level has twice the cells of the one before.
const COARSEST: usize = 5;

/// Solved problems of one grid.
pub(super) trait Problems: Sync {
    /// Solves for linear sRGB light, from nothing.
    fn first(&self, light: [f32; 3]) -> Coverages;
    /// Solves for linear sRGB light, near to what its neighbours suggest.
    fn near(&self, light: [f32; 3], suggested: &Coverages) -> Coverages;
}

/// Coverages at the nodes, blue running fastest.
#[derive(Clone, Debug)]
pub(super) struct Table {
    nodes: Vec<Coverages>,
}

/// A place between nodes: the first of its four nodes, the steps to the others, and the weights of all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub nodes: [usize; 4],
    pub weights: [f32; 4],
}

/// Light at a node of a grid.
pub(super) fn light_at(node: usize, size: usize) -> [f32; 3] {
    let light = |i: usize| {
        let root = i as f32 / (size - 1) as f32;
        root * root
    };
    [light(node / (size * size)), light(node / size % size), light(node % size)]
}

impl Table {
    /// Solves all nodes. Each level starts from the interpolated one before and stays near it, so that neighbours use the same
    /// pens wherever they can.
    pub fn solved(problems: &impl Problems) -> Self {
        let mut size = COARSEST;
        let mut nodes: Vec<Coverages> = collected(size.pow(3), &|node| problems.first(light_at(node, size)));
        while size < NODES {
            let finer = 2 * size - 1;
            nodes = collected(finer.pow(3), &|node| problems.near(light_at(node, finer), &between(&nodes, size, node, finer)));
            size = finer;
        }
        Self { nodes }
    }

    /// The nodes' coverages.
    pub fn nodes(&self) -> &[Coverages] {
        &self.nodes
    }

    /// The first `LANES` coverages of each node, for lookups.
    pub fn lanes<const LANES: usize>(&self) -> Vec<[f32; LANES]> {
        self.nodes.iter().map(|node| std::array::from_fn(|i| node[i])).collect()
    }
}

/// The mean of the coarse nodes around a fine one.
fn between(nodes: &[Coverages], size: usize, node: usize, finer: usize) -> Coverages {
    let at = [node / (finer * finer), node / finer % finer, node % finer];
    let mut mean = [0.0; MOST_PENS];
    for corner in 0..8 {
        let axis = |i: usize| at[i] / 2 + (at[i] % 2) * (corner >> i & 1);
        let coarse = &nodes[(axis(0) * size + axis(1)) * size + axis(2)];
        mean.iter_mut().zip(coarse).for_each(|(m, c)| *m += c / 8.0);
    }
    mean
}

impl Place {
    /// Of linear sRGB light, clamped to 0 to 1; what is no number counts as 0.
    ///
    /// The cell is cut into six tetrahedra along its grey diagonal, so that greys lie between greys.
    #[inline]
    pub fn of(light: [f32; 3]) -> Self {
        let scale = (NODES - 1) as f32;
        let at = light.map(|v| if v > 0.0 { v.min(1.0).sqrt() * scale } else { 0.0 });
        let cell = at.map(|v| (v as usize).min(NODES - 2));
        let [r, g, b] = [at[0] - cell[0] as f32, at[1] - cell[1] as f32, at[2] - cell[2] as f32];
        let (red, green, blue) = (NODES * NODES, NODES, 1);
        let (high, middle, low) = match (r >= g, g >= b, r >= b) {
            (true, true, _) => ((r, red), (g, green), (b, blue)),
            (true, false, true) => ((r, red), (b, blue), (g, green)),
            (true, false, false) => ((b, blue), (r, red), (g, green)),
            (false, true, true) => ((g, green), (r, red), (b, blue)),
            (false, true, false) => ((g, green), (b, blue), (r, red)),
            (false, false, _) => ((b, blue), (g, green), (r, red)),
        };
        let first = cell[0] * red + cell[1] * green + cell[2];
        let second = first + high.1;
        let third = second + middle.1;
        Self { nodes: [first, second, third, third + low.1], weights: [1.0 - high.0, high.0 - middle.0, middle.0 - low.0, low.0] }
    }

    /// The value there.
    #[inline]
    pub fn mix<const LANES: usize>(&self, nodes: &[[f32; LANES]]) -> [f32; LANES] {
        let mut mixed = [0.0; LANES];
        for (node, weight) in self.nodes.iter().zip(self.weights) {
            let values = &nodes[*node];
            (0..LANES).for_each(|i| mixed[i] += weight * values[i]);
        }
        mixed
    }
}

/// A value for each node, from its light.
pub(super) fn of_nodes<T: Send>(value: impl Fn(usize, [f32; 3]) -> T + Sync) -> Vec<T> {
    collected(NODES.pow(3), &|node| value(node, light_at(node, NODES)))
}

const _: () = assert!((NODES - 1).is_multiple_of(COARSEST - 1));

#[cfg(test)]
mod tests {
    use super::*;

    struct Linear;

    impl Problems for Linear {
        fn first(&self, light: [f32; 3]) -> Coverages {
            self.near(light, &[0.0; MOST_PENS])
        }
        fn near(&self, light: [f32; 3], _: &Coverages) -> Coverages {
            let [r, g, b] = light.map(f32::sqrt);
            [r, g, b, 0.2 * r + 0.3 * g + 0.4 * b, 1.0, 0.0, 0.0, 0.0]
        }
    }

    #[test]
    fn lookups_are_exact_on_a_plane() {
        let table = Table::solved(&Linear);
        for light in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.3, 0.7, 0.1], [0.2, 0.2, 0.9], [0.999, 0.001, 0.5]] {
            let found = Place::of(light).mix(table.nodes());
            let wanted = Linear.first(light);
            assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-5), "{light:?} {found:?} {wanted:?}");
        }
    }

    #[test]
    fn what_is_outside_is_clamped() {
        let table = Table::solved(&Linear);
        assert_eq!(Place::of([f32::NAN, -1.0, f32::NEG_INFINITY]).mix(table.nodes())[0], 0.0);
        assert_eq!(Place::of([f32::INFINITY, 2.0, 1.0]).mix(table.nodes())[..3], [1.0, 1.0, 1.0]);
    }
}
