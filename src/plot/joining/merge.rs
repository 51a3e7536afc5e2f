//! Makes fewer and longer paths before ordering: paths that meet end to end become one.

use kurbo::{Point, Vec2};

use crate::geometry::kd_tree::KdTree;
use crate::interrupt::Interrupt;
use crate::order::Direction;
use crate::plot::Toolpath;

/// Maximum ends examined around each end. At a crossroads of more, some pairs may stay apart; examining all would take n^2 for a
/// star of n rays.
const MOST_MEETING: usize = 8;

/// The sharpest turn at which paths are joined, as 1 - cos of the angle: 150 degrees, still the point of a star. Beyond it the
/// pen would go back almost over the wet line, which frays the paper.
const SHARPEST: f64 = 1.866;

/// Maximum difference in pen height where two swelling paths are joined, in millimetres.
const STEP: f64 = 0.01;

/// Joins paths end to end where two ends are at most `tolerance` millimetres apart, so that the pen stays down.
///
/// Two ends that do not coincide are joined only if the turn is below 90 degrees:
///
/// ```text
///      -----------.  .-----------   joined, and the gap is drawn        -----------.   left apart: neighbouring
///                                                                       -----------'   lines of a hatch
/// ```
///
/// Coincident ends are joined up to a turn of 150 degrees, as that adds no ink. Each end is used once. Of several continuations
/// the straightest is taken, then the one with the smallest gap: where three ends meet like a T, its bar becomes one path. A
/// chain whose own ends meet becomes a closed path, its last point equal to its first. A path no longer than the tolerance is a
/// dot and is left alone. A path with heights is joined only to others with heights, where these match. Chains are ordered by
/// their first path, which keeps its direction; with [`Direction::AsDrawn`], the end of one path is joined only to the start of
/// the next. O(n log n). Once the interrupt is raised, some chains are missing.
pub fn chain(paths: Vec<Toolpath>, tolerance: f64, direction: Direction, interrupt: &Interrupt) -> Vec<Toolpath> {
    let links = matched(meetings(&paths, tolerance, direction, interrupt), 2 * paths.len());
    let mut left: Vec<Option<Toolpath>> = paths.into_iter().map(Some).collect();
    let mut chains = Vec::new();
    for path in (0..left.len()).take_while(|_| !interrupt.is_raised()) {
        let Some((dwell_seconds, group)) = left[path].as_ref().map(|path| (path.dwell_seconds, path.group)) else { continue };
        let first = first_entry(&links, 2 * path);
        let Some(mut chain) = entered(&mut left, first) else { continue };
        (chain.dwell_seconds, chain.group) = (dwell_seconds, group);
        let mut entry = links[first ^ 1];
        while let Some((end, next)) = entry.and_then(|end| Some((end, entered(&mut left, end)?))) {
            chain.append(next);
            entry = links[end ^ 1];
        }
        if entry.is_some() {
            chain.close();
        }
        chains.push(chain);
    }
    chains
}

/// Takes the path of an end, drawn from that end; none if it is taken already.
fn entered(left: &mut [Option<Toolpath>], end: usize) -> Option<Toolpath> {
    let path = left[end / 2].take()?;
    Some(if end.is_multiple_of(2) { path } else { path.reversed() })
}

/// Two ends that could be joined, ordered by turn, gap, ends; the least is best. End `2 p` is the first point of path `p`, `2 p +
/// 1` its last.
struct Meeting {
    turn: f64,
    gap: f64,
    ends: (usize, usize),
}

/// All pairs of ends that may be joined.
fn meetings(paths: &[Toolpath], tolerance: f64, direction: Direction, interrupt: &Interrupt) -> Vec<Meeting> {
    let is_line: Vec<bool> = paths.iter().map(|path| is_longer_than(path, tolerance)).collect();
    let ends: Vec<(Point, u32)> =
        (0..2 * paths.len()).filter(|end| is_line[end / 2]).map(|end| (place(paths, end), end as u32)).collect();
    let tree = KdTree::new(ends.clone());
    let mut found = Vec::new();
    let mut meetings = Vec::new();
    for &(at, end) in ends.iter().take_while(|_| !interrupt.is_raised()) {
        tree.nearest((at, end), MOST_MEETING, |other| other != end, &mut found);
        let pairs = found
            .iter()
            .map(|&(_, other)| (end as usize, other as usize))
            .filter(|(a, b)| a < b && (direction == Direction::Either || a % 2 != b % 2));
        meetings.extend(pairs.filter_map(|pair| meeting(paths, pair, tolerance)));
    }
    meetings
}

/// The meeting of two ends, if they may be joined.
fn meeting(paths: &[Toolpath], ends: (usize, usize), tolerance: f64) -> Option<Meeting> {
    let gap = place(paths, ends.0).distance(place(paths, ends.1));
    let (leaving, going_on) = (outwards(paths, ends.0, tolerance), -outwards(paths, ends.1, tolerance));
    // 0 is straight on, 1 a right angle, 2 a reversal.
    let turn = 1.0 - leaving.dot(going_on);
    // Below 90 degrees by more than rounding: lines that meet at right angles stay separate.
    let meets = gap == 0.0 && turn <= SHARPEST || gap <= tolerance && turn < 1.0 - 1e-9;
    let is_level = match (height(paths, ends.0), height(paths, ends.1)) {
        (Some(a), Some(b)) => (a - b).abs() <= STEP,
        (a, b) => a.is_none() && b.is_none(),
    };
    (meets && is_level).then_some(Meeting { turn, gap, ends })
}

/// The partner of each end after joining pairs, the best first.
fn matched(mut meetings: Vec<Meeting>, ends: usize) -> Vec<Option<usize>> {
    meetings.sort_unstable_by(|a, b| a.turn.total_cmp(&b.turn).then(a.gap.total_cmp(&b.gap)).then(a.ends.cmp(&b.ends)));
    let mut links = vec![None; ends];
    for Meeting { ends: (a, b), .. } in meetings {
        if links[a].is_none() && links[b].is_none() {
            links[a] = Some(b);
            links[b] = Some(a);
        }
    }
    links
}

/// The end at which the chain through `end` begins, or `end` itself if the chain is a ring.
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

fn place(paths: &[Toolpath], end: usize) -> Point {
    let path = &paths[end / 2];
    if end.is_multiple_of(2) { path.first() } else { path.last() }
}

fn height(paths: &[Toolpath], end: usize) -> Option<f64> {
    let heights = paths[end / 2].heights()?;
    if end.is_multiple_of(2) { heights.first().copied() } else { heights.last().copied() }
}

/// The direction in which a path arrives at one of its ends, measured from the nearest vertex farther away than the tolerance, as
/// shorter pieces have no reliable direction.
fn outwards(paths: &[Toolpath], end: usize, tolerance: f64) -> Vec2 {
    let at = place(paths, end);
    let path = paths[end / 2].points();
    let far = |p: &&Point| p.distance(at) > tolerance;
    let from = if end.is_multiple_of(2) { path.iter().find(far) } else { path.iter().rev().find(far) };
    from.map_or(Vec2::ZERO, |&from| (at - from) / at.distance(from))
}

/// True if some vertex is farther than `tolerance` from the first.
fn is_longer_than(path: &Toolpath, tolerance: f64) -> bool {
    path.points().iter().any(|p| p.distance(path.first()) > tolerance)
}
