//! The tour and what it takes to improve it: everywhere, patch by patch on all threads.

use kurbo::Point;
use rayon::prelude::*;

use super::ends::End;
use super::kicks::kick;
use super::lin_kernighan::LinKernighan;
use super::loop_entries;
use super::neighbours::{NEIGHBOURS, Neighbours};
use super::patch::Patch;
use super::random::SplitMix;
use super::rings::Rings;
use super::sites::Sites;
use super::stops::Stop;
use super::tiles::tiles;
use super::tour::Tour;

/// A tour with the data needed to improve it.
pub(super) struct Workpiece {
    pub(super) sites: Sites,
    pub(super) neighbours: Neighbours,
    pub(super) tour: Tour,
}

impl Workpiece {
    /// Kicks the tour `kicks_per_path` times the number of paths. A different `sequence` gives different kicks, in tiles with
    /// other borders.
    pub(super) fn kick(&mut self, kicks_per_path: f64, sequence: u32) {
        if self.sites.interrupt().is_raised() {
            return;
        }
        let tiles = tiles(&self.sites, Some(sequence as usize));
        self.improve_in(&tiles, |patch, tile| {
            let mut random = SplitMix::new((u64::from(sequence) << 32) + tile as u64);
            let kicks = (kicks_per_path * tiles[tile].len() as f64).round() as usize;
            let mut search = LinKernighan::new(&patch.sites, &patch.neighbours, patch.tour());
            kick(&mut search, kicks, &mut random);
            search.tour
        });
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

    /// Searches from all links: first in tiles, where changes are cheap; then in the whole tour, from the ends at their borders.
    pub(super) fn settle(&mut self) {
        let tiles = tiles(&self.sites, None);
        self.improve_in(&tiles, |patch, _| {
            let all = 0..patch.sites.end_count() as End;
            settled(&patch.sites, &patch.neighbours, patch.tour(), all)
        });
        if !self.sites.interrupt().is_raised() {
            let rim = self.ends_at_borders(&tiles);
            self.settle_at(rim);
        }
    }

    /// The ends with their link or a neighbour in another tile, in tour order.
    fn ends_at_borders(&self, tiles: &[Vec<u32>]) -> Vec<End> {
        let mut tile_of = vec![0; self.sites.path_count()];
        for (number, tile) in (0..).zip(tiles) {
            for &path in tile {
                tile_of[path as usize] = number;
            }
        }
        let tile_of = |end: End| tile_of[end as usize >> 1];
        let near = |end: End| self.neighbours.of(end).iter().copied().chain([self.tour.link(end)]);
        let entries = self.tour.entries_from(self.tour.entry(0));
        let ends = entries.into_iter().flat_map(|entry| [entry, entry ^ 1]);
        ends.filter(|&end| near(end).any(|other| tile_of(other) != tile_of(end))).collect()
    }

    /// Searches from these ends in the whole tour.
    fn settle_at(&mut self, ends: Vec<End>) {
        if !ends.is_empty() {
            let tour = std::mem::replace(&mut self.tour, Tour::new(Vec::new()));
            self.tour = settled(&self.sites, &self.neighbours, tour, ends);
        }
    }

    /// Improves the tour in the patch of each tile, all at the same time. `improved` takes a patch and the number of its tile, and
    /// returns its small tour.
    fn improve_in(&mut self, tiles: &[Vec<u32>], improved: impl Fn(&Patch, usize) -> Tour + Sync) {
        // A patch keeps the directions of one-way paths outside it only as long as these are linked as before.
        let at_once = if self.sites.one_way().is_mixed() { 1 } else { tiles.len() };
        let mut first = 0;
        let interrupt = self.sites.interrupt().clone();
        for tiles in tiles.chunks(at_once).take_while(|_| !interrupt.is_raised()) {
            let scratch = || vec![End::MAX; self.sites.end_count()];
            let links = tiles.par_iter().enumerate().map_init(scratch, |renumbered, (tile, paths)| {
                let patch = Patch::new(&self.sites, &self.neighbours, &self.tour, paths, renumbered);
                let small = improved(&patch, first + tile);
                patch.new_links(&small)
            });
            let links: Vec<[End; 2]> = links.collect::<Vec<_>>().concat();
            first += at_once;
            // Joining a long tour takes a while: once interrupted, the tour stays as it was.
            if !links.is_empty() && !interrupt.is_raised() {
                let (tour, joints) = Rings::with(&self.tour, links.into_iter()).joined(&self.sites, &self.neighbours);
                self.tour = tour;
                self.settle_at(joints);
            }
        }
    }
}

/// The tour after a search from these ends.
fn settled(sites: &Sites, neighbours: &Neighbours, tour: Tour, ends: impl IntoIterator<Item = End>) -> Tour {
    let mut search = LinKernighan::new(sites, neighbours, tour);
    for end in ends {
        search.look_at(end);
    }
    search.improve(LinKernighan::keep);
    search.tour
}
