//! The order in which patches of the tour are kicked: once along the tour on all threads, once across the paper.

use kurbo::Point;
use rayon::prelude::*;

use super::ends::End;
use super::kicks::kick;
use super::lin_kernighan::LinKernighan;
use super::loop_entries;
use super::neighbours::NEIGHBOURS;
use super::neighbours::Neighbours;
use super::patch::Patch;
use super::random::SplitMix;
use super::sites::Sites;
use super::stops::Stop;
use super::tour::Tour;
use crate::geometry::kd_tree;

/// Maximum paths in a patch. Tuned on 100,000 dots: with 1000, the tour ends up 0.2 to 0.4 % longer, as more links would cross
/// the borders of the patches; with many more, changes cost more and there are too few patches for all threads.
const PATCH: usize = 5000;

/// A tour with the data needed to improve it.
pub(super) struct Workpiece {
    pub(super) sites: Sites,
    pub(super) neighbours: Neighbours,
    pub(super) tour: Tour,
}

impl Workpiece {
    /// Kicks the tour `kicks_per_path` times the number of paths, in patches that are consecutive pieces of the tour. They do not
    /// overlap, so they are processed in parallel, but links between them cannot be made. A different `sequence` gives different
    /// kicks.
    pub(super) fn along_the_tour(&mut self, kicks_per_path: f64, sequence: u64) {
        let len = self.tour.len();
        let count = len.div_ceil(PATCH);
        let scratch = || vec![End::MAX; self.sites.end_count()];
        let windows = (0..count).into_par_iter().map_init(scratch, |renumbered, window| {
            let seats: Vec<usize> = (window * len / count..(window + 1) * len / count).collect();
            let patch = Patch::new(&self.sites, &self.neighbours, &self.tour, &seats, renumbered);
            let (small, _) =
                kicked(&patch, kicks_per_path * seats.len() as f64, &mut SplitMix::new((sequence << 32) + window as u64));
            // The bundle of everything else is the last piece: skip it; the rest follows in its direction.
            let outside = usize::from(patch.piece_count() > seats.len());
            patch.spread(&self.tour, small.entries_from(patch.last_piece()).into_iter().skip(outside))
        });
        let windows: Vec<Vec<End>> = windows.collect();
        self.tour = Tour::new(windows.concat());
    }

    /// Kicks the tour as often as [`Workpiece::along_the_tour`], in patches that are compact on paper, one after another: each
    /// may reverse the tour's course outside it. A different `sequence` gives different kicks.
    pub(super) fn across_the_paper(&mut self, kicks_per_path: f64, sequence: u64) {
        let mut random = SplitMix::new(u64::MAX - sequence);
        self.on_each_tile(|patch, paths| kicked(patch, kicks_per_path * paths.len() as f64, &mut random));
    }

    /// Chooses new entries for all loops and returns the millimetres gained.
    pub(super) fn seat(&mut self, stops: &mut [Stop], numbering: &[usize], home: Point) -> f64 {
        let (entries, gained) = loop_entries::with_best_entries(stops, numbering, &self.sites, &self.tour);
        if gained > 0.0 {
            self.tour = Tour::new(entries);
            self.sites = Sites::new(stops, numbering, home, &self.sites.interrupt().clone());
            self.neighbours = Neighbours::new(&self.sites, NEIGHBOURS);
        }
        gained
    }

    /// Searches from all links: first in patches that are compact on paper, where changes are cheap; then in the whole tour, from
    /// the ends at the borders of the patches.
    pub(super) fn settle(&mut self) {
        let mut patch_of = vec![0; self.sites.path_count()];
        if self.tour.len() > PATCH {
            let mut count = 0;
            self.on_each_tile(|patch, paths| {
                count += 1;
                for &(_, path) in paths {
                    patch_of[path as usize] = count;
                }
                settled(&patch.sites, &patch.neighbours, patch.tour(), |_| true)
            });
        }
        let is_single = self.tour.len() <= PATCH;
        let tour = std::mem::replace(&mut self.tour, Tour::new(Vec::new()));
        let patch_of = |end: End| patch_of[end as usize >> 1];
        let is_at_rim = |end| self.neighbours.of(end).iter().any(|&other| patch_of(other) != patch_of(end));
        (self.tour, _) = settled(&self.sites, &self.neighbours, tour, |end| is_single || is_at_rim(end));
    }

    /// Replaces the tour patch by patch. `improved` takes a patch and its paths without the bundles, and returns the patch's
    /// small tour and the millimetres gained.
    fn on_each_tile(&mut self, mut improved: impl FnMut(&Patch, &[(Point, u32)]) -> (Tour, f64)) {
        let mut renumbered = vec![End::MAX; self.sites.end_count()];
        let middle = |path: u32| self.sites.place(2 * path).midpoint(self.sites.place(2 * path + 1));
        let mut paths: Vec<(Point, u32)> = (0..self.sites.path_count() as u32).map(|path| (middle(path), path)).collect();
        for tile in tiles(&mut paths).into_iter().take_while(|_| !self.sites.interrupt().is_raised()) {
            let mut seats: Vec<usize> = tile.iter().map(|&(_, path)| self.tour.seat_of(2 * path)).collect();
            seats.sort_unstable();
            let patch = Patch::new(&self.sites, &self.neighbours, &self.tour, &seats, &mut renumbered);
            let (small, gained) = improved(&patch, tile);
            if gained > 0.0 {
                self.tour = Tour::new(patch.spread(&self.tour, small.entries_from(patch.last_piece())));
            }
        }
    }
}

/// The tour after a search from all wanted ends, and the millimetres gained.
fn settled(sites: &Sites, neighbours: &Neighbours, tour: Tour, is_wanted: impl Fn(End) -> bool) -> (Tour, f64) {
    let entries = tour.entries_from(tour.entry(0));
    let mut search = LinKernighan::new(sites, neighbours, tour);
    for end in entries.into_iter().flat_map(|entry| [entry, entry ^ 1]).filter(|&end| is_wanted(end)) {
        search.look_at(end);
    }
    let gained = search.improve(Tour::keep);
    (search.tour, gained)
}

/// The small tour of a patch after some kicks, and the millimetres gained.
fn kicked(patch: &Patch, kicks: f64, random: &mut SplitMix) -> (Tour, f64) {
    let mut search = LinKernighan::new(&patch.sites, &patch.neighbours, patch.tour());
    let gained = kick(&mut search, kicks.round() as usize, random);
    (search.tour, gained)
}

/// Halves the paths across the longer side of their bounds until no part is too large.
fn tiles(paths: &mut [(Point, u32)]) -> Vec<&mut [(Point, u32)]> {
    if paths.len() <= PATCH {
        return vec![paths];
    }
    let middle = paths.len() / 2;
    kd_tree::split(paths, middle);
    let (low, high) = paths.split_at_mut(middle);
    let mut all = tiles(low);
    all.append(&mut tiles(high));
    all
}
