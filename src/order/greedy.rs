//! The first tour: links are made from the shortest up, as long as they create no fork and no ring.

use rayon::prelude::*;

use super::ends::End;
use super::neighbours::{Neighbours, nearest_ends};
use super::sites::{Role, Sites};
use crate::interrupt::Interrupt;

/// Neighbours of each loose end examined in later rounds. With fewer, more rounds are needed.
const LATER_NEIGHBOURS: usize = 6;

/// Number of runs into which candidates are split by length before sorting, so that an interrupt is noticed between two runs.
const RUNS: usize = 64;

/// Candidates sorted into runs between two looks at the interrupt.
const AT_ONCE: usize = 1 << 16;

/// Maximum rounds; after them the remaining fragments are strung together in order. If most ends have the same few nearest
/// partners, as with thousands of copies of one path drawn forwards only, a round joins next to nothing, and without a limit they
/// would take n^2.
const MOST_ROUNDS: usize = 30;

/// A possible link: its length, then the two ends. Lengths are stored as the bits of an `f32`, whose order is the same.
type Candidate = (u32, End, End);

/// Orders all paths greedily and returns the end at which each is entered, beginning with the home path. About 14 % above the
/// optimum on uniform dots; O(n log n). If interrupted, some paths are missing.
pub(super) fn greedy_tour(sites: &Sites, neighbours: &Neighbours) -> Vec<End> {
    if sites.interrupt().is_raised() {
        return Vec::new();
    }
    let mut fragments = Fragments::new(sites);
    let all = (0..sites.end_count() as End).into_par_iter();
    let candidates = all.flat_map_iter(|end| neighbours.of(end).iter().map(move |&other| candidate(sites, end, other)));
    fragments.join_shortest(candidates.collect(), sites.interrupt());
    for _ in 0..MOST_ROUNDS {
        if fragments.count == 1 || sites.interrupt().is_raised() {
            break;
        }
        let loose = fragments.loose_ends(sites);
        let root: Vec<u32> = (0..sites.path_count() as u32).map(|path| fragments.root(path)).collect();
        let apart = |a: End, b: End| root[a as usize >> 1] != root[b as usize >> 1];
        let found = nearest_ends(sites, &loose, LATER_NEIGHBOURS, |end| fragments.role[end as usize], apart);
        let pairs = loose.iter().zip(&found).flat_map(|(&end, others)| others.iter().map(move |&other| (end, other)));
        fragments.join_shortest(pairs.map(|(end, other)| candidate(sites, end, other)).collect(), sites.interrupt());
    }
    if sites.interrupt().is_raised() {
        return Vec::new();
    }
    fragments.string_together(sites);
    fragments.walk_from(sites.free_end())
}

fn candidate(sites: &Sites, a: End, b: End) -> Candidate {
    ((sites.distance(a, b) as f32).to_bits(), a.min(b), a.max(b))
}

/// Splits candidates into runs of about equal size in ascending order; within a run they are unsorted. If interrupted, some
/// candidates are missing.
fn runs(candidates: Vec<Candidate>, interrupt: &Interrupt) -> Vec<Vec<Candidate>> {
    let step = candidates.len() / (16 * RUNS);
    if step == 0 {
        return vec![candidates];
    }
    let mut sample: Vec<Candidate> = candidates.iter().step_by(step).copied().collect();
    sample.sort_unstable();
    let borders: Vec<Candidate> = sample.into_iter().skip(16).step_by(16).collect();
    let mut runs: Vec<Vec<Candidate>> = vec![Vec::new(); borders.len() + 1];
    for some in candidates.chunks(AT_ONCE).take_while(|_| !interrupt.is_raised()) {
        for &candidate in some {
            runs[borders.partition_point(|border| *border <= candidate)].push(candidate);
        }
    }
    runs
}

/// Pieces of the tour that grow together, as a union-find forest over paths.
struct Fragments {
    count: usize,
    parent: Vec<u32>,
    link: Vec<Option<End>>,
    /// For each loose end, the loose end on the other side of its fragment.
    far: Vec<End>,
    /// For each loose end, its role: whether its fragment is entered or left there.
    role: Vec<Role>,
}

impl Fragments {
    fn new(sites: &Sites) -> Self {
        Self {
            count: sites.path_count(),
            parent: (0..sites.path_count() as u32).collect(),
            link: vec![None; sites.end_count()],
            far: (0..sites.end_count() as End).map(|end| end ^ 1).collect(),
            role: (0..sites.end_count() as End).map(|end| sites.role(end)).collect(),
        }
    }

    fn root(&mut self, mut path: u32) -> u32 {
        while self.parent[path as usize] != path {
            let grandparent = self.parent[self.parent[path as usize] as usize];
            self.parent[path as usize] = grandparent;
            path = grandparent;
        }
        path
    }

    fn join_shortest(&mut self, candidates: Vec<Candidate>, interrupt: &Interrupt) {
        for mut run in runs(candidates, interrupt).into_iter().take_while(|_| !interrupt.is_raised()) {
            run.par_sort_unstable();
            self.join_all(&run);
        }
    }

    fn join_all(&mut self, candidates: &[Candidate]) {
        for &(_, a, b) in candidates {
            let fits = self.role[a as usize].may_link(self.role[b as usize]);
            if !fits || self.link[a as usize].is_some() || self.link[b as usize].is_some() {
                continue;
            }
            let (root_a, root_b) = (self.root(a >> 1), self.root(b >> 1));
            if root_a != root_b {
                self.parent[root_a as usize] = root_b;
                self.join(a, b);
            }
        }
    }

    /// Both ends of every fragment except the free end, which closes the tour at the end.
    fn loose_ends(&self, sites: &Sites) -> Vec<End> {
        (0..sites.end_count() as End).filter(|&end| self.link[end as usize].is_none() && end != sites.free_end()).collect()
    }

    fn join(&mut self, a: End, b: End) {
        self.link[a as usize] = Some(b);
        self.link[b as usize] = Some(a);
        self.count -= 1;
        let (far_a, far_b) = (self.far[a as usize], self.far[b as usize]);
        self.far[far_a as usize] = far_b;
        self.far[far_b as usize] = far_a;
        // A reversible fragment takes the direction of the one to which it is joined.
        if self.role[a as usize] == Role::Either {
            self.role[far_a as usize] = self.role[b as usize];
        }
        if self.role[b as usize] == Role::Either {
            self.role[far_b as usize] = self.role[a as usize];
        }
    }

    /// Joins all fragments in the order of their roots, which are numbered across the paper.
    fn string_together(&mut self, sites: &Sites) {
        let home = self.root(sites.free_end() >> 1);
        let loose = self.loose_ends(sites);
        let mut by_root: Vec<(u32, Role, u32, End)> =
            loose.iter().map(|&end| (self.root(end >> 1), self.role[end as usize], end & 1, end)).collect();
        by_root.sort_unstable();
        let Some(from_home) = by_root.iter().position(|&(root, ..)| root == home) else {
            return;
        };
        // The only loose end of the home fragment. All others have two, the entry first.
        let (.., mut tail) = by_root.remove(from_home);
        for fragment in by_root.chunks_exact(2) {
            self.join(tail, fragment[0].3);
            tail = fragment[1].3;
        }
    }

    fn walk_from(&self, end: End) -> Vec<End> {
        std::iter::successors(Some(end), |&entered| self.link[(entered ^ 1) as usize]).collect()
    }
}
