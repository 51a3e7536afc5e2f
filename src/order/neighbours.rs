//! The neighbour list: for each path end, the few ends with which a good tour might link it.

use kurbo::Point;
use rayon::prelude::*;

use super::ends::End;
use super::sites::{Role, Sites};
use crate::geometry::kd_tree::KdTree;

/// Number of neighbours per path end with which links are tried. Tuned on 10,000 dots, segments and hatch lines: with 10, the
/// order ends up 0.2 to 2 % longer; 20 take a third longer on dots and gain nothing worth that.
pub(super) const NEIGHBOURS: usize = 14;

/// For each end, the nearest ends of other paths, the nearest first. The free end of the home path has no neighbours and is
/// nobody's neighbour, as it is equally near to all.
pub(super) struct Neighbours {
    list: Vec<End>,
    first: Vec<u32>,
}

impl Neighbours {
    /// Finds up to `count` neighbours of each end in O(n (count + log n)) on all threads.
    pub(super) fn new(sites: &Sites, count: usize) -> Self {
        let loose: Vec<End> = (0..sites.end_count() as End).filter(|&end| end != sites.free_end()).collect();
        let found = nearest_ends(sites, &loose, count, |end| sites.role(end), |a, b| a >> 1 != b >> 1);
        let mut found = found.into_iter();
        let of_each = (0..sites.end_count() as End)
            .map(|end| if end == sites.free_end() { Vec::new() } else { found.next().unwrap_or_default() });
        Self::collect(of_each, sites.end_count(), count)
    }

    /// The same lists for some of the ends, renumbered; `renumbered` returns an end's new number, if any.
    pub(super) fn part(&self, ends: &[End], renumbered: impl Fn(End) -> Option<End>) -> Self {
        let most = ends.iter().map(|&end| self.of(end).len()).max().unwrap_or(0);
        Self::collect(ends.iter().map(|&end| self.of(end).iter().filter_map(|&other| renumbered(other))), ends.len(), most)
    }

    fn collect<I: IntoIterator<Item = End>>(of_each: impl Iterator<Item = I>, ends: usize, most: usize) -> Self {
        let mut list = Vec::with_capacity(ends * most);
        let mut first = Vec::with_capacity(ends + 1);
        first.push(0);
        for neighbours in of_each {
            list.extend(neighbours);
            first.push(list.len() as u32);
        }
        Self { list, first }
    }

    /// The neighbours of an end, the nearest first.
    #[inline]
    pub(super) fn of(&self, end: End) -> &[End] {
        &self.list[self.first[end as usize] as usize..self.first[end as usize + 1] as usize]
    }
}

/// For each of some ends, up to `count` nearest ones among them with which their roles and `may_link` allow a link, the nearest
/// first.
pub(super) fn nearest_ends(
    sites: &Sites,
    ends: &[End],
    count: usize,
    role: impl Fn(End) -> Role + Sync,
    may_link: impl Fn(End, End) -> bool + Sync,
) -> Vec<Vec<End>> {
    // One tree per role rather than one with a filter: the nearest thousand ends may all have the wrong role.
    let roles = [Role::Entry, Role::Exit, Role::Either];
    let trees = roles.map(|wanted| {
        let labelled: Vec<(Point, End)> =
            ends.iter().filter(|&&end| role(end) == wanted).map(|&end| (sites.place(end), end)).collect();
        (wanted, KdTree::new(labelled))
    });
    ends.par_iter()
        .map_init(
            || (Vec::new(), Vec::new()),
            |(nearest, all), &end| {
                all.clear();
                if sites.interrupt().is_raised() {
                    return Vec::new();
                }
                for (_, tree) in trees.iter().filter(|(wanted, _)| wanted.may_link(role(end))) {
                    tree.nearest((sites.place(end), end), count, |other| may_link(end, other), nearest);
                    all.append(nearest);
                }
                // The sort is stable, so ties keep each tree's order.
                all.sort_by(|a: &(f64, End), b| a.0.total_cmp(&b.0));
                all.iter().take(count).map(|&(_, other)| other).collect()
            },
        )
        .collect()
}
