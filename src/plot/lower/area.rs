//! Fills an outline with one nib: rings that follow the outline from its border inwards, or one ring and hatching inside it,
//! whichever is shorter. Parts narrower than the nib are drawn like thin lines.

use super::super::Toolpath;
use super::dash::dashes;
use super::dot::OVERLAP;
use super::ground::Ground;
use super::hatch::hatching;
use super::needle::{ink_of, needle, pieces};
use super::net::Net;
use super::room::Room;
use crate::geometry::{OffsetOutline, Point, distance_to_segment, resample};
use crate::interrupt::Interrupt;
use std::cell::OnceCell;
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_4;

/// Cost of one pen lift in millimetres of line, when two ways to fill are compared: about 0.35 s of a servo at 30 mm/s.
const LIFT: f64 = 10.0;
/// Least ink of a narrow part that is drawn, as a share of a touch's: corners of wide parts stay round.
const LEAST_PART: f64 = 0.5;
/// Simplification tolerance of a ring, in pitches. An offset splits each vertex at a rounded corner in two; without
/// simplification, rings would double their vertices at each level.
const SMOOTH: f64 = 0.02;
/// Total ring vertices beyond which an area is hatched instead: about three seconds. A disc of 400 rings has a tenth of that.
const MOST_RING_VERTICES: usize = 2_000_000;

/// The paths that fill a shape; incomplete once the interrupt is raised. `phase` is the phase of the dashes of narrow parts.
pub(super) fn fill(insets: &OffsetOutline, nib: f64, phase: f64, interrupt: &Interrupt) -> Vec<Toolpath> {
    let pitch = nib * (1.0 - OVERLAP);
    let outermost = insets.grown(-0.5 * nib);
    let border = closed_rings(outermost.borders());
    let room = Room::new(&outermost, nib);
    // One large area may be most of a drawing: its three parts are computed side by side.
    let ringed = || rings(outermost.clone(), pitch, interrupt).map(|rings| joined(&rings, &room, 1.5 * pitch, interrupt));
    let (narrow, (hatched, ringed)) = rayon::join(
        || narrow_parts(insets, &outermost, nib, phase, interrupt),
        || rayon::join(|| hatching(insets, &border, &room, nib, pitch, interrupt), ringed),
    );
    let mut paths = match (hatched, ringed) {
        (Some(hatched), Some(ringed)) if cost(&hatched) < cost(&ringed) => hatched,
        (Some(hatched), None) => hatched,
        (_, Some(ringed)) => ringed,
        (None, None) => joined(&[border], &room, 1.5 * pitch, interrupt),
    };
    paths.extend(narrow);
    paths
}

/// The parts narrower than the nib, as dashes with the same ink; `outermost` is where the nib's centre fits.
fn narrow_parts(insets: &OffsetOutline, outermost: &OffsetOutline, nib: f64, phase: f64, interrupt: &Interrupt) -> Vec<Toolpath> {
    let least = LEAST_PART * FRAC_PI_4 * nib * nib;
    let ground = OnceCell::new();
    let ground = || ground.get_or_init(|| Ground::new(insets, &outermost.grown(0.5 * nib)));
    let (nets, strips): (Vec<_>, Vec<_>) =
        insets.narrow_parts(outermost, 0.5 * nib, interrupt).into_iter().partition(|part| part.len() > 1);
    let strips = strips.into_iter().filter(|strip| ink_of(strip) >= least).take_while(|_| !interrupt.is_raised());
    let drawn = strips.enumerate().flat_map(|(i, strip)| dashes(&needle(&strip, nib), nib, phase + 0.618 * i as f64));
    let mut paths: Vec<Toolpath> = drawn.filter(|path| !interrupt.is_raised() && ground().may_draw(path.points(), nib)).collect();
    if !nets.is_empty() {
        let mut net = Net::new(ground(), nib, interrupt);
        let pieces = nets.into_iter().flat_map(|part| pieces(part, nib)).take_while(|_| !interrupt.is_raised());
        paths.extend(pieces.flat_map(|piece| net.lines(&piece)).filter_map(Toolpath::new));
    }
    paths
}

fn cost(paths: &[Toolpath]) -> f64 {
    paths.iter().map(|path| path.length() + LIFT).sum()
}

/// The outermost rings, then level by level those one pitch further in. Between two levels come pieces of a ring where the next
/// one is missing and the middle would stay bare. None if there would be too many.
///
/// Each level is offset from the one before. Offset from the border, each tooth of a comb would swing an arc as wide as the depth
/// through all others.
fn rings(outermost: OffsetOutline, pitch: f64, interrupt: &Interrupt) -> Option<Vec<Vec<Vec<Point>>>> {
    let mut levels = Vec::new();
    let mut rings = outermost;
    let mut work = 0;
    while !rings.is_empty() && !interrupt.is_raised() {
        work += rings.len();
        if work > MOST_RING_VERTICES {
            return None;
        }
        let next = rings.grown(-pitch).simplified(SMOOTH * pitch);
        let between = rings.rings(0.5 * pitch);
        let sides = Sides::new(&next.borders(), 0.75 * pitch);
        let pieces: Vec<Vec<Point>> = between.iter().flat_map(|ring| far_pieces(ring, &sides, interrupt)).collect();
        levels.push(closed_rings(rings.borders()));
        if !pieces.is_empty() {
            levels.push(pieces);
        }
        rings = next;
    }
    Some(levels)
}

fn closed_rings(rings: Vec<Vec<Point>>) -> Vec<Vec<Point>> {
    rings.into_iter().filter(|ring| ring.len() > 2).map(closed).collect()
}

fn closed(mut ring: Vec<Point>) -> Vec<Point> {
    ring.push(ring[0]);
    ring
}

/// A cell of a grid.
type Cell = (i64, i64);

fn cell(p: Point, size: f64) -> Cell {
    ((p.x / size).floor() as i64, (p.y / size).floor() as i64)
}

fn around((x, y): Cell) -> impl Iterator<Item = Cell> {
    (-1..=1).flat_map(move |dy| (-1..=1).map(move |dx| (x + dx, y + dy)))
}

/// The sides of rings in the cells of a grid whose size is their reach.
struct Sides {
    reach: f64,
    cells: HashMap<Cell, Vec<[Point; 2]>>,
}

impl Sides {
    fn new(rings: &[Vec<Point>], reach: f64) -> Self {
        let mut cells: HashMap<Cell, Vec<[Point; 2]>> = HashMap::new();
        for (a, b) in rings.iter().flat_map(|ring| (0..ring.len()).map(move |i| (ring[i], ring[(i + 1) % ring.len()]))) {
            // Split into pieces no longer than a cell, each stored in the cell of its midpoint.
            let pieces = (a.distance(b) / reach).ceil().max(1.0);
            let at = |k: f64| a.lerp(b, k / pieces);
            for k in 0..pieces as usize {
                let piece = [at(k as f64), at(k as f64 + 1.0)];
                cells.entry(cell(piece[0].midpoint(piece[1]), reach)).or_default().push(piece);
            }
        }
        Self { reach, cells }
    }

    /// True if a side lies within reach of a point. The midpoint of its nearest piece is at most one and a half cells away.
    fn is_near(&self, p: Point) -> bool {
        let (x, y) = cell(p, self.reach);
        let near = (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| (x + dx, y + dy)));
        near.filter_map(|cell| self.cells.get(&cell)).flatten().any(|[a, b]| distance_to_segment(p, *a, *b) <= self.reach)
    }
}

/// The parts of a ring that are far from the sides of other rings, as open lines; the whole ring, closed, if all of it is far.
fn far_pieces(ring: &[Point], others: &Sides, interrupt: &Interrupt) -> Vec<Vec<Point>> {
    let points = resample(&closed(ring.to_vec()), 0.6 * others.reach);
    let far: Vec<bool> = points.iter().map(|p| interrupt.is_raised() || !others.is_near(*p)).collect();
    let Some(first_near) = far.iter().position(|far| !far) else { return vec![points] };
    // Go round once from a near point, so that no piece is cut where the ring begins.
    let last = points.len() - 1;
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    let mut was_far = false;
    for i in (1..=last).map(|k| (first_near + k) % last) {
        if far[i] {
            if !was_far {
                pieces.push(Vec::new());
            }
            pieces.last_mut().into_iter().for_each(|piece| piece.push(points[i]));
        }
        was_far = far[i];
    }
    pieces
}

/// Joins rings to few paths: each continues at the nearest ring of the next level if the step is short. If several paths could
/// continue there, the one begun last does.
fn joined(levels: &[Vec<Vec<Point>>], room: &Room, reach: f64, interrupt: &Interrupt) -> Vec<Toolpath> {
    let mut paths: Vec<Toolpath> = Vec::new();
    let mut ends: HashMap<Cell, Vec<usize>> = HashMap::new();
    for line in levels.iter().flatten().take_while(|_| !interrupt.is_raised()) {
        let is_ring = line.len() > 2 && line[0] == line[line.len() - 1];
        let starts = if is_ring { 0..line.len() - 1 } else { 0..1 };
        let known = &ends;
        let near = |start: usize| around(cell(line[start], reach)).filter_map(|cell| known.get(&cell)).flatten();
        let pairs = starts.flat_map(|start| near(start).map(move |path| (*path, start)));
        let pairs = pairs.map(|(path, start)| (path, line[start].distance(paths[path].last()), start));
        let mut best: Option<(usize, f64, usize)> = None;
        for next in pairs.filter(|(_, distance, _)| *distance <= reach) {
            let is_better = best.is_none_or(|best| next.0 > best.0 || (next.0 == best.0 && next.1 < best.1));
            if is_better && room.allows_step(paths[next.0].last(), line[next.2]) {
                best = Some(next);
            }
        }
        let from = |start: usize| {
            let turned = line[start..].iter().chain(if is_ring { &line[1..=start] } else { &[] });
            turned.copied()
        };
        let path = if let Some((path, _, start)) = best {
            ends.entry(cell(paths[path].last(), reach)).or_default().retain(|other| *other != path);
            paths[path].extend(from(start));
            path
        } else {
            let Some(begun) = Toolpath::new(line.clone()) else { continue };
            paths.push(begun);
            paths.len() - 1
        };
        ends.entry(cell(paths[path].last(), reach)).or_default().push(path);
    }
    paths
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::BezPath;

    fn filled(text: &str, nib: f64) -> Vec<Toolpath> {
        fill(&OffsetOutline::new(&BezPath::from_svg(text).unwrap(), 0.01), nib, 0.0, &Interrupt::never())
    }

    #[test]
    fn a_square_is_one_path_of_about_its_area_over_the_pitch() {
        let paths = filled("M0,0 H10 V10 H0 Z", 0.5);
        assert_eq!(paths.len(), 1);
        let expected = 100.0 / (0.5 * (1.0 - OVERLAP));
        assert!((paths[0].length() / expected - 1.0).abs() < 0.06, "{} for {expected}", paths[0].length());
        assert!(paths[0].points().iter().all(|p| p.x > 0.24 && p.x < 9.76 && p.y > 0.24 && p.y < 9.76));
    }

    #[test]
    fn slivers_are_dashes_with_their_ink_or_nothing() {
        let ink = |paths: &[Toolpath]| -> f64 { paths.iter().map(|path| 0.3 * path.length() + 0.0707).sum() };
        let line = filled("M0,0 H40 V0.1 H0 Z", 0.3);
        assert!((ink(&line) / 4.0 - 1.0).abs() < 0.06, "{}", ink(&line));
        assert!(line.iter().flat_map(Toolpath::points).all(|p| (p.y - 0.05).abs() < 0.02));
        assert!(filled("M0,0 H0.05 V0.05 H0 Z", 0.3).is_empty());
    }

    #[test]
    fn a_comb_s_teeth_are_drawn() {
        // A back of 1 mm with teeth of 0.2 mm, thinner than the nib.
        let teeth: Vec<String> = (0..10).map(|i| format!("H{} V3 H{} V1", i + 1, f64::from(i) + 1.2)).collect();
        let paths = filled(&format!("M12,1 V0 H0 V1 {} Z", teeth.join(" ")), 0.3);
        for i in 0..10 {
            let is_on = |p: &Point| p.y > 1.5 && (p.x - f64::from(i) - 1.1).abs() < 0.05;
            assert!(paths.iter().any(|path| path.points().iter().all(is_on)), "tooth {i}");
        }
    }

    #[test]
    fn the_middle_of_a_frame_is_filled_although_its_corners_are_wider() {
        let paths = filled("M5,5 H15 V15 H5 Z M8,8 V12 H12 V8 Z", 0.5);
        for p in [Point::new(6.5, 10.0), Point::new(10.0, 13.5), Point::new(6.45, 8.0)] {
            let near = |path: &Toolpath| path.points().windows(2).any(|w| distance_to_segment(p, w[0], w[1]) < 0.25);
            assert!(paths.iter().any(near), "{p:?}");
        }
    }
}
