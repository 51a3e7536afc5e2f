//! Fewer and longer paths before they are ordered: repeated paths go, and paths that meet end to end become one.

use std::collections::HashMap;

use kurbo::{Point, Vec2};

use super::Direction;
use super::kd_tree::KdTree;

/// Ends that are looked at around each end. At a crossroads of more, some pairs may stay apart; with all of them, a star of n rays would
/// take n^2.
const MOST_MEETING: usize = 8;

/// Joins paths end to end where two ends are at most `tolerance` millimetres apart, so that the pen stays down.
///
/// Two ends that do not coincide are joined only if the path goes on by a turn below 90 degrees:
///
/// ```text
///      -----------.  .-----------   joined, and the gap is drawn        -----------.   left apart: neighbouring
///                                                                       -----------'   lines of a hatch
/// ```
///
/// Ends at the very same point are joined at any angle, as that adds no ink. Each end is used once, and of several ways to go on the
/// straightest is taken, then the one with the smallest gap. A chain whose own ends meet becomes a closed path, its last point
/// equal to its first. A path not longer than the tolerance is a dot and left alone. Chains come in the order of their first
/// path, which keeps its direction; with [`Direction::AsDrawn`] the end of one is joined only to the start of the next.
/// O(n log n).
#[expect(clippy::needless_pass_by_value, reason = "the paths are replaced by their chains")]
pub fn chain(paths: Vec<Vec<Point>>, tolerance: f64, direction: Direction) -> Vec<Vec<Point>> {
    let links = matched(meetings(&paths, tolerance, direction), 2 * paths.len());
    let mut used = vec![false; paths.len()];
    let mut chains = Vec::new();
    for path in 0..paths.len() {
        if used[path] {
            continue;
        }
        let first = first_entry(&links, 2 * path);
        let mut points: Vec<Point> = Vec::new();
        let mut entry = Some(first);
        while let Some(end) = entry.filter(|end| !used[end / 2]) {
            used[end / 2] = true;
            let piece = &paths[end / 2];
            if end % 2 == 0 {
                append(&mut points, piece.iter());
            } else {
                append(&mut points, piece.iter().rev());
            }
            entry = links[end ^ 1];
        }
        if entry.is_some() {
            let start = points[0];
            append(&mut points, std::iter::once(&start));
        }
        chains.push(points);
    }
    chains
}

/// Drops each path that repeats an earlier one: as many vertices, each at most `tolerance` millimetres from its counterpart, in
/// either direction. Of closed paths only those that begin at the same vertex are recognised. O(number of vertices), as long
/// as few paths with equally many vertices share the middle of their bounds without being the same.
pub fn drop_duplicates(paths: Vec<Vec<Point>>, tolerance: f64) -> Vec<Vec<Point>> {
    let mut kept: Vec<Vec<Point>> = Vec::with_capacity(paths.len());
    let mut by_middle: HashMap<(usize, i64, i64), Vec<usize>> = HashMap::new();
    for path in paths {
        // The middle of the bounds is the same in both directions, and moves no farther than the vertices: two equal paths lie in the same
        // cell or in adjacent ones.
        let (x, y) = cell(middle_of_bounds(&path), tolerance);
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x.saturating_add(dx), y.saturating_add(dy))));
        let mut candidates = around.filter_map(|(x, y)| by_middle.get(&(path.len(), x, y))).flatten();
        if !candidates.any(|&other| is_same(&path, &kept[other], tolerance)) {
            by_middle.entry((path.len(), x, y)).or_default().push(kept.len());
            kept.push(path);
        }
    }
    kept
}

/// Two ends that could be joined, the best pairs first in order: turn, gap, ends. End `2 p` is the first point of path `p`, `2 p + 1` its last.
struct Meeting {
    turn: f64,
    gap: f64,
    ends: (usize, usize),
}

/// All pairs of ends that may be joined.
fn meetings(paths: &[Vec<Point>], tolerance: f64, direction: Direction) -> Vec<Meeting> {
    let is_line: Vec<bool> = paths.iter().map(|path| is_longer_than(path, tolerance)).collect();
    let ends: Vec<(Point, u32)> =
        (0..2 * paths.len()).filter(|end| is_line[end / 2]).map(|end| (place(paths, end), end as u32)).collect();
    let tree = KdTree::new(ends.clone());
    let mut found = Vec::new();
    let mut meetings = Vec::new();
    for &(at, end) in &ends {
        tree.nearest((at, end), MOST_MEETING, |other| other != end, &mut found);
        let pairs = found
            .iter()
            .map(|&(_, other)| (end as usize, other as usize))
            .filter(|(a, b)| a < b && (direction == Direction::Either || a % 2 != b % 2));
        meetings.extend(pairs.filter_map(|pair| meeting(paths, pair, tolerance)));
    }
    meetings
}

/// These two ends, if they may be joined.
fn meeting(paths: &[Vec<Point>], ends: (usize, usize), tolerance: f64) -> Option<Meeting> {
    let gap = place(paths, ends.0).distance(place(paths, ends.1));
    let (leaving, going_on) = (outwards(paths, ends.0, tolerance), -outwards(paths, ends.1, tolerance));
    // 0 straight on, 1 at a right angle, 2 back.
    let turn = 1.0 - leaving.dot(going_on);
    // Below 90 degrees by more than rounding: lines that meet at right angles are two lines.
    let meets = gap == 0.0 || gap <= tolerance && turn < 1.0 - 1e-9;
    meets.then_some(Meeting { turn, gap, ends })
}

/// The partner of each end after joining the best pairs first.
fn matched(mut meetings: Vec<Meeting>, ends: usize) -> Vec<Option<usize>> {
    meetings.sort_by(|a, b| a.turn.total_cmp(&b.turn).then(a.gap.total_cmp(&b.gap)).then(a.ends.cmp(&b.ends)));
    let mut links = vec![None; ends];
    for Meeting { ends: (a, b), .. } in meetings {
        if links[a].is_none() && links[b].is_none() {
            links[a] = Some(b);
            links[b] = Some(a);
        }
    }
    links
}

/// The end at which a chain through `end` begins, or `end` itself if the chain is a ring.
fn first_entry(links: &[Option<usize>], end: usize) -> usize {
    let mut entry = end;
    while let Some(before) = links[entry] {
        entry = before ^ 1;
        if entry == end {
            break;
        }
    }
    entry
}

fn append<'a>(points: &mut Vec<Point>, more: impl Iterator<Item = &'a Point>) {
    let mut more = more.peekable();
    if points.last().is_some() && points.last() == more.peek().copied() {
        more.next();
    }
    points.extend(more);
}

fn place(paths: &[Vec<Point>], end: usize) -> Point {
    let path = &paths[end / 2];
    if end.is_multiple_of(2) { path[0] } else { path[path.len() - 1] }
}

/// The direction in which a path arrives at one of its ends: from the nearest vertex that is farther away than the tolerance,
/// as shorter pieces point anywhere.
fn outwards(paths: &[Vec<Point>], end: usize, tolerance: f64) -> Vec2 {
    let at = place(paths, end);
    let path = &paths[end / 2];
    let far = |p: &&Point| p.distance(at) > tolerance;
    let from = if end.is_multiple_of(2) { path.iter().find(far) } else { path.iter().rev().find(far) };
    from.map_or(Vec2::ZERO, |&from| (at - from) / at.distance(from))
}

/// Whether some vertex is farther than this from the first.
fn is_longer_than(path: &[Point], tolerance: f64) -> bool {
    path.iter().any(|p| p.distance(path[0]) > tolerance)
}

fn is_same(a: &[Point], b: &[Point], tolerance: f64) -> bool {
    let close = |(p, q): (&Point, &Point)| p.distance(*q) <= tolerance;
    a.len() == b.len() && (a.iter().zip(b).all(close) || a.iter().zip(b.iter().rev()).all(close))
}

fn middle_of_bounds(path: &[Point]) -> Point {
    let corner = |pick: fn(f64, f64) -> f64| {
        path.iter().copied().reduce(|p, q| Point::new(pick(p.x, q.x), pick(p.y, q.y))).unwrap_or_default()
    };
    corner(f64::min).midpoint(corner(f64::max))
}

/// The cell of a grid as fine as the tolerance, but for rounding.
fn cell(p: Point, tolerance: f64) -> (i64, i64) {
    let size = tolerance.max(1e-9);
    ((p.x / size).floor() as i64, (p.y / size).floor() as i64)
}
