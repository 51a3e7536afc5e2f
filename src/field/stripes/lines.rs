//! The stripes' lines: where the phase is 0, followed from cell to cell at sub-pixel accuracy.

use super::super::curve::Curve;
use super::lattice::StripeLattice;
use crate::geometry::Point;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// One line of a family.
pub type StripeLine = Curve;

/// Phases at the corners of one cell, unwrapped: seen with the first corner's wave, and free of jumps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellPhases {
    /// In radians, in the order upper left, upper right, lower right, lower left.
    pub corners: [f64; 4],
    /// The side that unwrapping could not close (a line ends there), if any: 0 top, 1 right, 2 bottom, 3 left.
    pub broken: Option<usize>,
}

const CORNERS: [(usize, usize); 4] = [(0, 0), (1, 0), (1, 1), (0, 1)];

impl CellPhases {
    /// The cell whose upper left corner is node `(i, j)`.
    pub(crate) fn new(lattice: &StripeLattice, i: usize, j: usize) -> Self {
        let node = |k: usize| (i + CORNERS[k % 4].0, j + CORNERS[k % 4].1);
        // Each side's actual growth in the frame of its first corner, and whether the frame turns.
        let mut growth = [0.0; 4];
        let mut strain = [0.0_f64; 4];
        let mut turned = [false; 4];
        for k in 0..4 {
            let (gain, remainder) = lattice.step_between(node(k), node(k + 1));
            growth[k] = gain + remainder;
            strain[k] = remainder.abs();
            turned[k] = lattice.gain(node(k), node(k + 1)).1;
        }
        let mut sign = [1.0; 5];
        for k in 0..4 {
            sign[k + 1] = if turned[k] { -sign[k] } else { sign[k] };
        }
        let around: f64 = (0..4).map(|k| sign[k] * growth[k]).sum();
        let is_closed = sign[4] > 0.0 && around.abs() < 1e-3;
        let first = lattice.angle(i, j);
        if is_closed {
            let a = first + growth[0];
            let b = a + sign[1] * growth[1];
            return Self { corners: [first, a, b, b + sign[2] * growth[2]], broken: None };
        }
        let worst = (0..4).max_by(|&a, &b| strain[a].total_cmp(&strain[b])).unwrap_or(0);
        // From the first corner in both directions, up to the side that breaks.
        let mut corners = [first; 4];
        for k in 0..worst {
            if k + 1 < 4 {
                corners[k + 1] = corners[k] + sign[k] * growth[k];
            }
        }
        // Backwards: corner k from corner k + 1 over side k, with the frame turned where side k turns.
        let mut back_sign = 1.0;
        for k in (worst + 1..4).rev() {
            let next = if k == 3 { corners[0] } else { corners[k + 1] };
            if turned[k] {
                back_sign = -back_sign;
            }
            corners[k] = next - back_sign * growth[k];
        }
        Self { corners, broken: Some(worst) }
    }

    /// The phase at a place in the cell, both coordinates 0 to 1, and its gradient by them.
    pub(crate) fn at(&self, u: f64, v: f64) -> (f64, f64, f64) {
        let [a, b, c, d] = self.corners;
        let value = (a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v;
        ((value), (b - a) * (1.0 - v) + (c - d) * v, (d - a) * (1.0 - u) + (c - b) * u)
    }

    /// Least and greatest phase in the cell.
    pub(crate) fn range(&self) -> (f64, f64) {
        self.corners.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &c| (low.min(c), high.max(c)))
    }
}

impl StripeLattice {
    /// The phase at a place in pixels, in radians, bilinear within its cell; of one sign in each cell only.
    pub fn phase_at(&self, p: Point) -> f64 {
        let x = (p.x + self.margin) / self.step - 0.5;
        let y = (p.y + self.margin) / self.step - 0.5;
        let i = (x.max(0.0) as usize).min(self.phase.width().saturating_sub(2));
        let j = (y.max(0.0) as usize).min(self.phase.height().saturating_sub(2));
        CellPhases::new(self, i, j).at(x - i as f64, y - j as f64).0
    }
}

/// A crossing on a side of the lattice: the side's first node, whether it runs down (or right), and the crossing's index on it.
type Key = (u32, u32, bool, u8);

/// The number of no crossing.
const NONE: u32 = u32::MAX;

/// The crossings found so far, numbered.
struct Crossings {
    columns: usize,
    /// The number of the first crossing on each side, right and down from each node.
    first: Vec<u32>,
    /// The numbers of the others, where stripes are closer than nodes.
    others: HashMap<Key, u32>,
    points: Vec<Point>,
    /// The crossings that lines lead to from each.
    links: Vec<[u32; 2]>,
    /// Those with links, in the order in which they were linked.
    linked: Vec<u32>,
}

impl Crossings {
    fn new(lattice: &StripeLattice) -> Self {
        let (columns, rows) = (lattice.phase.width(), lattice.phase.height());
        let first = vec![NONE; 2 * columns * rows];
        Self { columns, first, others: HashMap::new(), points: Vec::new(), links: Vec::new(), linked: Vec::new() }
    }

    /// The crossing's number; a new one lies at `point`.
    fn number(&mut self, key: Key, point: Point) -> u32 {
        let (i, j, down, rank) = key;
        let fresh = self.points.len() as u32;
        let side = 2 * (j as usize * self.columns + i as usize) + usize::from(down);
        let slot = if rank == 0 { &mut self.first[side] } else { self.others.entry(key).or_insert(NONE) };
        if *slot == NONE {
            *slot = fresh;
            self.points.push(point);
            self.links.push([NONE; 2]);
        }
        *slot
    }

    fn link(&mut self, a: u32, b: u32) {
        for (from, to) in [(a, b), (b, a)] {
            let slots = &mut self.links[from as usize];
            if slots[0] == NONE {
                slots[0] = to;
                self.linked.push(from);
            } else {
                slots[1] = to;
            }
        }
    }
}

/// The lines of phase 0, in pixels.
pub fn stripe_lines(lattice: &StripeLattice) -> Vec<StripeLine> {
    let mut crossings = Crossings::new(lattice);
    for j in 0..lattice.phase.height().saturating_sub(1) {
        for i in 0..lattice.phase.width().saturating_sub(1) {
            link_cell(lattice, i, j, &mut crossings);
        }
    }
    chain(&crossings)
}

/// The points where the phase passes a whole number of cycles on a side of the cell, with the level as the cell counts it.
fn on_side(lattice: &StripeLattice, (i, j): (usize, usize), side: usize, from: f64, to: f64) -> Vec<(i64, Key, Point)> {
    // Sides are always processed in one direction, so that both cells find the same points.
    let forward = side < 2;
    let (low, high) = if from < to { (from, to) } else { (to, from) };
    let levels: Vec<i64> = ((low / TAU).ceil() as i64..=(high / TAU).floor() as i64).collect();
    let (start, end) = (CORNERS[side], CORNERS[(side + 1) % 4]);
    let (first, down) = match side {
        0 => ((i, j), false),
        1 => ((i + 1, j), true),
        2 => ((i, j + 1), false),
        _ => ((i, j), true),
    };
    let (a, b) = (lattice.position(i + start.0, j + start.1), lattice.position(i + end.0, j + end.1));
    let count = levels.len();
    let rising = (to > from) == forward;
    levels
        .into_iter()
        .enumerate()
        .map(|(n, level)| {
            let t = (level as f64 * TAU - from) / (to - from);
            let rank = if rising { n } else { count - 1 - n };
            (level, (first.0 as u32, first.1 as u32, down, rank as u8), a.lerp(b, t))
        })
        .collect()
}

/// Links the crossings of one cell.
fn link_cell(lattice: &StripeLattice, i: usize, j: usize, crossings: &mut Crossings) {
    if CORNERS.iter().any(|(di, dj)| !lattice.is_striped(i + di, j + dj)) {
        return;
    }
    let cell = CellPhases::new(lattice, i, j);
    let (low, high) = cell.range();
    if (low / TAU).ceil() > (high / TAU).floor() {
        return;
    }
    let mut by_level: Vec<(i64, u32)> = Vec::with_capacity(4);
    for side in (0..4).filter(|&side| cell.broken != Some(side)) {
        for (level, key, point) in on_side(lattice, (i, j), side, cell.corners[side], cell.corners[(side + 1) % 4]) {
            by_level.push((level, crossings.number(key, point)));
        }
    }
    by_level.sort_by_key(|entry| entry.0);
    for group in by_level.chunk_by(|a, b| a.0 == b.0) {
        for pair in group.chunks_exact(2) {
            crossings.link(pair[0].1, pair[1].1);
        }
    }
}

/// Follows the links, first from open ends, then around loops.
fn chain(crossings: &Crossings) -> Vec<StripeLine> {
    let Crossings { points, links, linked, .. } = crossings;
    let mut used = vec![false; points.len()];
    let mut lines = Vec::new();
    let ends = linked.iter().filter(|number| links[**number as usize][1] == NONE);
    for &start in ends.chain(linked) {
        if used[start as usize] {
            continue;
        }
        let mut line = vec![points[start as usize]];
        used[start as usize] = true;
        let (mut here, mut before) = (start, NONE);
        let closed = loop {
            let is_next = |next: u32| next != NONE && next != before && (!used[next as usize] || next == start);
            match links[here as usize].into_iter().find(|next| is_next(*next)) {
                Some(next) if next == start => break line.len() > 2,
                Some(next) => {
                    line.push(points[next as usize]);
                    used[next as usize] = true;
                    before = here;
                    here = next;
                }
                None => break false,
            }
        };
        if line.len() > 1 {
            lines.push(Curve { points: line, closed });
        }
    }
    lines
}
