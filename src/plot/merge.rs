//! Joining paths end to end.

use super::order::Direction;
use super::Toolpath;
use crate::geometry::Point;
use std::collections::HashMap;

/// Joins paths whose ends meet within `tolerance` millimetres, each end once, the nearest first; a touch joins nothing.
///
/// Two lines are joined only where the line goes on without turning back: neighbouring hatch lines whose ends lie close stay
/// apart. `AsDrawn` joins an end only to a start.
pub fn join_ends(paths: Vec<Toolpath>, tolerance: f64, direction: Direction) -> Vec<Toolpath> {
    let links = links(&paths, tolerance, direction);
    // partner[2 i] is what the start of path i is joined to, partner[2 i + 1] its end.
    let mut partner: Vec<Option<usize>> = vec![None; 2 * paths.len()];
    for (_, a, b) in links {
        if partner[a].is_none() && partner[b].is_none() {
            partner[a] = Some(b);
            partner[b] = Some(a);
        }
    }
    let mut used = vec![false; paths.len()];
    let mut joined = Vec::new();
    // Chains from their free ends first, then the rings that have none.
    for pass in [false, true] {
        for i in 0..paths.len() {
            for entry in [2 * i, 2 * i + 1] {
                if !used[i] && (pass || partner[entry].is_none()) {
                    joined.push(walk(&paths, &partner, &mut used, entry));
                }
            }
        }
    }
    joined
}

/// The chain that begins at an end and goes through its path.
fn walk(paths: &[Toolpath], partner: &[Option<usize>], used: &mut [bool], mut entry: usize) -> Toolpath {
    let mut points: Vec<Point> = Vec::new();
    loop {
        let path = &paths[entry / 2].points;
        used[entry / 2] = true;
        let oriented: Box<dyn Iterator<Item = &Point>> = if entry % 2 == 0 { Box::new(path.iter()) } else { Box::new(path.iter().rev()) };
        for &p in oriented {
            if points.last() != Some(&p) {
                points.push(p);
            }
        }
        match partner[entry ^ 1] {
            Some(next) if !used[next / 2] => entry = next,
            _ => return Toolpath { points },
        }
    }
}

/// Pairs of ends that may be joined, the nearest first; ends are numbered as in `join_ends`.
fn links(paths: &[Toolpath], tolerance: f64, direction: Direction) -> Vec<(f64, usize, usize)> {
    let cell = tolerance.max(1e-6);
    let key = |p: Point| ((p.x / cell).floor() as i64, (p.y / cell).floor() as i64);
    let mut grid: HashMap<(i64, i64), Vec<usize>> = HashMap::new();
    let mut found = Vec::new();
    for end in (0..2 * paths.len()).filter(|&end| paths[end / 2].points.len() > 1) {
        let (at, outward) = end_of(&paths[end / 2], end % 2);
        let (cx, cy) = key(at);
        for (x, y) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (cx + dx, cy + dy))) {
            for &other in grid.get(&(x, y)).into_iter().flatten() {
                let (there, its_outward) = end_of(&paths[other / 2], other % 2);
                let gap = at.distance(there);
                let goes_on = outward.dot(its_outward) < 0.0;
                let agrees = direction == Direction::Either || end % 2 != other % 2;
                if gap <= tolerance && goes_on && agrees && end / 2 != other / 2 {
                    found.push((gap, other, end));
                }
            }
        }
        grid.entry((cx, cy)).or_default().push(end);
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    found
}

/// Where an end lies (0 the start, 1 the end) and the direction in which the path leaves there.
fn end_of(path: &Toolpath, side: usize) -> (Point, crate::geometry::Vec2) {
    let points = &path.points;
    let last = points.len() - 1;
    let (end, inner) = if side == 0 { (points[0], points[1]) } else { (points[last], points[last - 1]) };
    (end, end - inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(points: &[(f64, f64)]) -> Toolpath {
        Toolpath { points: points.iter().map(|&(x, y)| Point::new(x, y)).collect() }
    }

    #[test]
    fn a_broken_line_becomes_one_whichever_way_its_pieces_run() {
        let pieces = vec![path(&[(0.0, 0.0), (1.0, 0.0)]), path(&[(3.0, 0.0), (2.02, 0.0)]), path(&[(1.0, 0.01), (2.0, 0.0)])];
        let joined = join_ends(pieces.clone(), 0.05, Direction::Either);
        assert_eq!(joined.len(), 1);
        assert_eq!(joined[0].points.len(), 6);
        assert_eq!(join_ends(pieces, 0.05, Direction::AsDrawn).len(), 2);
    }

    #[test]
    fn neighbouring_hatch_lines_and_touches_stay_apart() {
        let hatch = vec![path(&[(0.0, 0.0), (5.0, 0.0)]), path(&[(0.0, 0.04), (5.0, 0.04)]), path(&[(5.0, 0.02)])];
        assert_eq!(join_ends(hatch, 0.05, Direction::Either).len(), 3);
    }

    #[test]
    fn four_sides_become_a_ring() {
        let sides = vec![
            path(&[(0.0, 0.0), (1.0, 0.1)]),
            path(&[(1.0, 0.1), (1.2, 1.0)]),
            path(&[(1.2, 1.0), (0.0, 1.1)]),
            path(&[(0.0, 1.1), (0.0, 0.0)]),
        ];
        let joined = join_ends(sides, 0.05, Direction::Either);
        // A square corner neither goes on nor turns back: 90 degrees and less are joined, sharper ones are not.
        assert!(joined.len() <= 3);
        assert_eq!(joined.iter().map(|p| p.points.len() - 1).sum::<usize>(), 4);
    }
}
