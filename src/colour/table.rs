//! Coverages for every colour of a photograph: solved on a grid of colours, looked up between.

use super::pens::MOST_PENS;
use super::solver::Coverages;
use crate::parallel::{collected, mapped};

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

/// Some of a grid's nodes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Nodes(Vec<u64>);

impl Nodes {
    const fn words(size: usize) -> usize {
        (size * size * size).div_ceil(64)
    }

    fn none(size: usize) -> Self {
        Self(vec![0; Self::words(size)])
    }

    /// All nodes of the finest grid.
    pub fn all() -> Self {
        let mut all = Self::none(NODES);
        (0..NODES.pow(3)).for_each(|node| all.add(node));
        all
    }

    /// Those of the finest grid between which a photograph's colours lie.
    pub fn used_by(pixels: &[[f32; 3]]) -> Self {
        const SHARE: usize = 1 << 16;
        let parts = collected(pixels.len().div_ceil(SHARE), &|k| {
            let mut part = Self::none(NODES);
            pixels[k * SHARE..].iter().take(SHARE).flat_map(|light| Place::of(*light).nodes).for_each(|node| part.add(node));
            part
        });
        let mut used = Self::none(NODES);
        for part in parts {
            used.0.iter_mut().zip(part.0).for_each(|(all, word)| *all |= word);
        }
        used
    }

    fn add(&mut self, node: usize) {
        self.0[node / 64] |= 1 << (node % 64);
    }

    /// Their numbers, ascending.
    pub fn numbers(&self) -> Vec<usize> {
        (0..64 * self.0.len()).filter(|node| self.0[node / 64] >> (node % 64) & 1 == 1).collect()
    }

    /// The nodes of the coarser grid between which these lie.
    fn coarser(&self, finer: usize) -> Self {
        let size = finer.div_ceil(2);
        let mut coarse = Self::none(size);
        self.numbers().into_iter().flat_map(|node| around(node, finer)).for_each(|node| coarse.add(node));
        coarse
    }
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
    /// Solves the wanted nodes; the others are 0. Each level starts from the interpolated one before and stays near it, so that
    /// neighbours use the same pens wherever they can. Of each level only those are solved on which a wanted node depends.
    pub fn solved(problems: &impl Problems, wanted: &Nodes) -> Self {
        let mut levels = vec![(NODES, wanted.clone())];
        while let Some((finer, nodes)) = levels.last().filter(|(size, _)| *size > COARSEST) {
            levels.push((finer.div_ceil(2), nodes.coarser(*finer)));
        }
        let mut nodes = Vec::new();
        for (size, wanted) in levels.into_iter().rev() {
            nodes = spread(size, &wanted, &|node| match size {
                COARSEST => problems.first(light_at(node, size)),
                _ => problems.near(light_at(node, size), &between(&nodes, node, size)),
            });
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

/// A value for each of a grid's wanted nodes, nothing for the others.
fn spread<T: Copy + Default + Send>(size: usize, wanted: &Nodes, value: &(impl Fn(usize) -> T + Sync)) -> Vec<T> {
    let numbers = wanted.numbers();
    let mut all = vec![T::default(); size.pow(3)];
    for (node, value) in numbers.iter().zip(mapped(&numbers, &|node| value(*node))) {
        all[*node] = value;
    }
    all
}

/// The coarse nodes around a fine one; one that lies between fewer than eight has some of them several times.
fn around(node: usize, finer: usize) -> [usize; 8] {
    let size = finer.div_ceil(2);
    let at = [node / (finer * finer), node / finer % finer, node % finer];
    std::array::from_fn(|corner| {
        let axis = |i: usize| at[i] / 2 + (at[i] % 2) * (corner >> i & 1);
        (axis(0) * size + axis(1)) * size + axis(2)
    })
}

/// The mean of the coarse nodes around a fine one.
fn between(coarse: &[Coverages], node: usize, finer: usize) -> Coverages {
    let mut mean = [0.0; MOST_PENS];
    for corner in around(node, finer) {
        mean.iter_mut().zip(&coarse[corner]).for_each(|(m, c)| *m += c / 8.0);
    }
    mean
}

/// A place between nodes: the first of its four nodes, the steps to the others, and the weights of all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub nodes: [usize; 4],
    pub weights: [f32; 4],
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

/// A value for each wanted node, from its light; nothing for the others.
pub(super) fn of_nodes<T: Copy + Default + Send>(wanted: &Nodes, value: impl Fn(usize, [f32; 3]) -> T + Sync) -> Vec<T> {
    spread(NODES, wanted, &|node| value(node, light_at(node, NODES)))
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

    /// Each level depends on the one before.
    struct Held;

    impl Problems for Held {
        fn first(&self, light: [f32; 3]) -> Coverages {
            Linear.first(light)
        }
        fn near(&self, light: [f32; 3], suggested: &Coverages) -> Coverages {
            let own = Linear.first(light.map(|v| v * v));
            std::array::from_fn(|i| 0.7 * suggested[i] + 0.3 * own[i])
        }
    }

    #[test]
    fn lookups_are_exact_on_a_plane() {
        let table = Table::solved(&Linear, &Nodes::all());
        for light in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.3, 0.7, 0.1], [0.2, 0.2, 0.9], [0.999, 0.001, 0.5]] {
            let found = Place::of(light).mix(table.nodes());
            let wanted = Linear.first(light);
            assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-5), "{light:?} {found:?} {wanted:?}");
        }
    }

    #[test]
    fn nodes_that_a_photograph_uses_are_as_if_all_were_solved() {
        let lights = [[0.0, 0.0, 0.0], [0.3, 0.7, 0.1], [0.31, 0.69, 0.1], [0.02, 0.02, 0.9], [0.999, 0.001, 0.5]];
        let used = Nodes::used_by(&lights);
        assert!(used.numbers().len() <= 4 * lights.len());
        let (some, all) = (Table::solved(&Held, &used), Table::solved(&Held, &Nodes::all()));
        for light in lights {
            assert_eq!(Place::of(light).mix(some.nodes()), Place::of(light).mix(all.nodes()));
        }
        assert_eq!(Nodes::all().numbers().len(), NODES.pow(3));
    }

    #[test]
    fn what_is_outside_is_clamped() {
        let table = Table::solved(&Linear, &Nodes::all());
        assert_eq!(Place::of([f32::NAN, -1.0, f32::NEG_INFINITY]).mix(table.nodes())[0], 0.0);
        assert_eq!(Place::of([f32::INFINITY, 2.0, 1.0]).mix(table.nodes())[..3], [1.0, 1.0, 1.0]);
    }
}
