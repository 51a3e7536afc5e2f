//! One tour from patches that were improved at the same time.

use std::collections::BTreeSet;

use super::ends::End;
use super::neighbours::Neighbours;
use super::sites::Sites;
use super::tour::Tour;

/// The links of a tour. When several patches have changed, each as if the others had not, the tour may have fallen apart into
/// some rings: of 100,000 dots up to some tens at first, later fewer than ten. Each passes near another in many places, so that
/// joining them as a rule makes the tour even shorter.
pub(super) struct Rings {
    link: Vec<End>,
}

/// Where two rings are joined: `ends` were linked to `others`.
struct Joint {
    ends: [End; 2],
    others: [End; 2],
    cost: f64,
}

impl Rings {
    /// The links of this tour, but for those that are made anew.
    pub(super) fn with(tour: &Tour, links: impl Iterator<Item = [End; 2]>) -> Self {
        let mut rings = Self { link: (0..2 * tour.len() as End).map(|end| tour.link(end)).collect() };
        links.for_each(|link| rings.set(link));
        rings
    }

    fn set(&mut self, [a, b]: [End; 2]) {
        self.link[a as usize] = b;
        self.link[b as usize] = a;
    }

    /// Joins all rings where that is shortest, the smallest first. Returns the tour, and the ends of the links made. No path may
    /// be one-way unless all are.
    pub(super) fn joined(mut self, sites: &Sites, neighbours: &Neighbours) -> (Tour, Vec<End>) {
        let mut made = Vec::new();
        let (mut ring_of, mut rings) = self.rings();
        let mut by_size: BTreeSet<(usize, u32)> = (0..).zip(&rings).map(|(ring, paths)| (paths.len(), ring)).collect();
        while let Some((_, ring)) = by_size.pop_first() {
            let paths = std::mem::take(&mut rings[ring as usize]);
            let Some(joint) = self.cheapest(&paths, &ring_of, sites, neighbours) else { break };
            let other = ring_of[joint.others[0] as usize >> 1];
            self.set([joint.ends[0], joint.others[0]]);
            self.set([joint.ends[1], joint.others[1]]);
            made.extend(joint.ends.into_iter().chain(joint.others));
            for &path in &paths {
                ring_of[path as usize] = other;
            }
            by_size.remove(&(rings[other as usize].len(), other));
            rings[other as usize].extend(paths);
            by_size.insert((rings[other as usize].len(), other));
        }
        (Tour::new(self.entries_from(0)), made)
    }

    /// The ring of each path, and the paths of each ring.
    fn rings(&self) -> (Vec<u32>, Vec<Vec<u32>>) {
        let mut ring_of = vec![u32::MAX; self.link.len() / 2];
        let mut rings = Vec::new();
        for path in 0..ring_of.len() as u32 {
            if ring_of[path as usize] == u32::MAX {
                let paths: Vec<u32> = self.entries_from(2 * path).into_iter().map(|end| end >> 1).collect();
                for &path in &paths {
                    ring_of[path as usize] = rings.len() as u32;
                }
                rings.push(paths);
            }
        }
        (ring_of, rings)
    }

    /// The entered ends of this end's ring, in its order.
    fn entries_from(&self, first: End) -> Vec<End> {
        let next = |&entry: &End| Some(self.link[entry as usize ^ 1]).filter(|&next| next != first);
        std::iter::successors(Some(first), next).collect()
    }

    /// The shortest way to join the ring of these paths to another. `None` if there is no other.
    fn cheapest(&self, paths: &[u32], ring_of: &[u32], sites: &Sites, neighbours: &Neighbours) -> Option<Joint> {
        let is_elsewhere = |end: &End| ring_of[*end as usize >> 1] != ring_of[paths[0] as usize];
        let ends = paths.iter().flat_map(|path| [2 * path, 2 * path + 1]);
        let near = ends.flat_map(|end| neighbours.of(end).iter().map(move |&other| (end, other)));
        let shortest = |a: &Joint, b: &Joint| a.cost.total_cmp(&b.cost);
        let joint =
            near.filter(|(_, other)| is_elsewhere(other)).map(|(end, other)| self.joint(end, other, sites)).min_by(shortest);
        joint.or_else(|| {
            // Far from all others: any exit to the first entry elsewhere.
            let other = (0..self.link.len() as End).step_by(2).find(is_elsewhere)?;
            paths.iter().map(|path| self.joint(2 * path + 1, other, sites)).min_by(shortest)
        })
    }

    fn joint(&self, end: End, other: End, sites: &Sites) -> Joint {
        let (ends, others) = ([end, self.link[end as usize]], [other, self.link[other as usize]]);
        let made = sites.distance(ends[0], others[0]) + sites.distance(ends[1], others[1]);
        Joint { ends, others, cost: made - sites.distance(ends[0], ends[1]) - sites.distance(others[0], others[1]) }
    }
}
