//! The paths in compact pieces of the paper.

use kurbo::Point;

use super::sites::Sites;
use crate::geometry::kd_tree;

/// Maximum paths in a tile. Tuned on 100,000 dots and segments: with 2000, dots end up 0.1 % longer, as more exchanges would cross
/// the borders of the tiles; with 8000 they are 0.03 % shorter, but changes move more paths, and segments take twice as long.
const MOST: usize = 4000;

/// Where the paper and its halves are cut: at this share of the paths. The parts are then halved, so that each share gives other
/// borders; none is a simple fraction of another.
const SHARES: [f64; 9] = [0.59, 0.41, 0.54, 0.46, 0.62, 0.38, 0.57, 0.43, 0.64];

/// How many times the paths are cut at the share of the tiling instead of at half.
const UNEVEN_CUTS: u32 = 2;

/// All paths in tiles. Each of the first nine tilings has borders of its own; without one, all parts are halves.
pub(super) fn tiles(sites: &Sites, tiling: Option<usize>) -> Vec<Vec<u32>> {
    let middle = |path: u32| sites.place(2 * path).midpoint(sites.place(2 * path + 1));
    let mut paths: Vec<(Point, u32)> = (0..sites.path_count() as u32).map(|path| (middle(path), path)).collect();
    let mut tiles = Vec::new();
    cut(&mut paths, tiling.map_or(0.5, |tiling| SHARES[tiling % SHARES.len()]), UNEVEN_CUTS, &mut tiles);
    tiles
}

/// Cuts the paths across the longer side of their bounds until no part is too large.
fn cut(paths: &mut [(Point, u32)], share: f64, uneven: u32, tiles: &mut Vec<Vec<u32>>) {
    if paths.len() <= MOST {
        tiles.push(paths.iter().map(|&(_, path)| path).collect());
        return;
    }
    let share_here = if uneven > 0 { share } else { 0.5 };
    let middle = (paths.len() as f64 * share_here) as usize;
    kd_tree::split(paths, middle);
    let (low, high) = paths.split_at_mut(middle);
    cut(low, share, uneven.saturating_sub(1), tiles);
    cut(high, share, uneven.saturating_sub(1), tiles);
}
