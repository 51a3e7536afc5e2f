//! The optimal order of a few paths, by dynamic programming over the sets of paths already drawn (Held and Karp 1962).

use super::stops::{Stop, Visit};
use kurbo::Point;

/// Maximum number of paths solved exactly; the table has `2^n n` rows of two directions, 9000 at nine paths.
pub(super) const MOST: usize = 9;

/// The shortest order of at most [`MOST`] paths from `home`.
pub(super) fn best_order(stops: &[Stop], home: Point) -> Vec<Visit> {
    let count = stops.len();
    let ways = |path: usize| 0..1 + usize::from(stops[path].may_turn);
    let (entry, exit) = (
        |path: usize, way: usize| if way == 0 { stops[path].ends.start } else { stops[path].ends.end },
        |path: usize, way: usize| if way == 0 { stops[path].ends.end } else { stops[path].ends.start },
    );
    let slot = |set: usize, path: usize, way: usize| (set * count + path) * 2 + way;
    // The least travel to draw `set` with this last path in this direction, and the path drawn before.
    let mut least = vec![(f64::INFINITY, None); (1 << count) * count * 2];
    for set in 1_usize..1 << count {
        for (path, way) in (0..count).filter(|path| set >> path & 1 == 1).flat_map(|path| ways(path).map(move |way| (path, way)))
        {
            let before = set & !(1 << path);
            let mut best = (home.distance(entry(path, way)), None);
            if before != 0 {
                best.0 = f64::INFINITY;
                for (last, turned) in
                    (0..count).filter(|last| before >> last & 1 == 1).flat_map(|last| ways(last).map(move |way| (last, way)))
                {
                    let travel = least[slot(before, last, turned)].0 + exit(last, turned).distance(entry(path, way));
                    if best.1.is_none() || travel < best.0 {
                        best = (travel, Some((last, turned)));
                    }
                }
            }
            least[slot(set, path, way)] = best;
        }
    }
    let all = (1_usize << count) - 1;
    let ends = (0..count).flat_map(|path| ways(path).map(move |way| (path, way)));
    let mut last = ends.min_by(|a, b| least[slot(all, a.0, a.1)].0.total_cmp(&least[slot(all, b.0, b.1)].0));
    let (mut set, mut visits) = (all, Vec::with_capacity(count));
    while let Some((path, way)) = last {
        visits.push(Visit { path, reversed: way == 1 });
        last = least[slot(set, path, way)].1;
        set &= !(1 << path);
    }
    visits.reverse();
    visits
}
