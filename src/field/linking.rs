//! Traced lines that continue one another become one.

use super::curve::Curve;
use crate::geometry::{Point, Vec2};

/// Ends nearer than this are linked if their directions agree: a window plus a step.
const LINK_DISTANCE: f64 = 6.0;

/// Cosine of the maximum turn at a link or across a crossing, 50 degrees.
pub(super) const LINK_COSINE: f64 = 0.64;

/// Joins lines whose ends are close and point at each other, closest pairs first, and closes loops.
pub(super) fn link(lines: Vec<Vec<Point>>) -> Vec<Curve> {
    let mut chains: Vec<Option<Vec<Point>>> = lines.into_iter().map(Some).collect();
    let mut closed = vec![false; chains.len()];
    // The index of the chain that holds each line.
    let mut holder: Vec<usize> = (0..chains.len()).collect();
    for (_, a, b) in candidate_links(&chains) {
        let (ca, cb) = (find(&holder, a.line), find(&holder, b.line));
        if closed[ca] || closed[cb] {
            continue;
        }
        if ca == cb {
            closed[ca] = chains[ca].as_ref().is_some_and(|chain| chain.len() > 3 && ends_are(chain, a.at, b.at));
        } else if let Some(joined) = joined(chains[ca].as_ref(), a.at, chains[cb].as_ref(), b.at) {
            chains[ca] = Some(joined);
            chains[cb] = None;
            holder[cb] = ca;
        }
    }
    chains.into_iter().zip(closed).filter_map(|(points, closed)| points.map(|points| Curve { points, closed })).collect()
}

#[derive(Clone, Copy)]
struct End {
    line: usize,
    at: Point,
    outward: Vec2,
}

fn find(holder: &[usize], mut line: usize) -> usize {
    while holder[line] != line {
        line = holder[line];
    }
    line
}

fn candidate_links(chains: &[Option<Vec<Point>>]) -> Vec<(f64, End, End)> {
    let outward = |points: &[Point]| {
        let (end, inner) = (points[points.len() - 1], points[points.len().saturating_sub(3)]);
        if end == inner { Vec2::ZERO } else { (end - inner).normalize() }
    };
    let mut ends: Vec<End> = Vec::new();
    for (line, points) in chains.iter().enumerate().filter_map(|(i, p)| p.as_ref().map(|p| (i, p))) {
        let reversed: Vec<Point> = points.iter().rev().copied().collect();
        ends.push(End { line, at: points[points.len() - 1], outward: outward(points) });
        ends.push(End { line, at: points[0], outward: outward(&reversed) });
    }
    ends.sort_by(|a, b| a.at.x.total_cmp(&b.at.x));
    let mut links = Vec::new();
    for (i, a) in ends.iter().enumerate() {
        for b in ends[i + 1..].iter().take_while(|b| b.at.x - a.at.x <= LINK_DISTANCE) {
            let gap = b.at - a.at;
            // Both ends of one line may turn by up to 90 degrees: a small ring bends that much within the gap.
            let least_cosine = if a.line == b.line { 0.0 } else { LINK_COSINE };
            let meets = gap.hypot() <= LINK_DISTANCE && -a.outward.dot(b.outward) >= least_cosine;
            // The gap must lie ahead of both ends, unless it is too short to have a direction.
            let faces = a.line == b.line
                || gap.hypot() < 2.5
                || (gap.normalize().dot(a.outward) > LINK_COSINE && -gap.normalize().dot(b.outward) > LINK_COSINE);
            if meets && faces {
                links.push((gap.hypot(), *a, *b));
            }
        }
    }
    links.sort_by(|a, b| a.0.total_cmp(&b.0));
    links
}

fn ends_are(chain: &[Point], a: Point, b: Point) -> bool {
    let (first, last) = (chain[0], chain[chain.len() - 1]);
    (first == a && last == b) || (first == b && last == a)
}

/// Joins two chains at the given ends; none if an end is no longer free.
fn joined(first: Option<&Vec<Point>>, a: Point, second: Option<&Vec<Point>>, b: Point) -> Option<Vec<Point>> {
    let oriented = |chain: &Vec<Point>, end: Point, at_end: bool| -> Option<Vec<Point>> {
        let has_last = chain.last() == Some(&end);
        let has_first = chain.first() == Some(&end);
        if !has_first && !has_last {
            return None;
        }
        let mut chain = chain.clone();
        if has_last != at_end {
            chain.reverse();
        }
        Some(chain)
    };
    let mut joined = oriented(first?, a, true)?;
    joined.extend(oriented(second?, b, false)?);
    Some(joined)
}
