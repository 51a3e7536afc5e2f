//! Draws the threads of a net that are narrower than the nib. No line along a thread is also its neighbours' centre line, and the
//! nib's round ends reach into the holes. So the nib moves from point to point where it covers most and spills least, until the
//! threads' ink is laid.

use super::ground::Ground;
use super::needle::ink_of;
use crate::elementary::unit_at;
use crate::geometry::{Point, Rect, Vec2};
use crate::interrupt::Interrupt;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_4, TAU};

/// Size of the cells in which ink is counted, in nibs: a nib covers 50 of them.
const CELL: f64 = 0.125;
/// Length of one step of the nib, in nibs.
const STEP: f64 = 0.25;
/// Number of directions of a step.
const WAYS: usize = 16;
/// Pairs of the least share of newly laid ink that must lie on threads, and the share of a piece's ink drawn at that level: the
/// best places first. Tuned on the hedcuts of the tests, of which the dark bust at a nib of 0.8 mm spills most: with 1 at all
/// levels, it spills more than 3 % of its ink; without the last level, threads of half a nib and less would be lost.
const LEVELS: [(f64, f64); 4] = [(0.95, 1.0), (0.9, 1.0), (0.8, 0.5), (0.6, 0.15)];
/// Least share of a touch, and of a step, that must lie on bare threads.
const LEAST_TOUCH: f64 = 0.4;
const LEAST_STEP: f64 = 0.4;

/// A place on the grid of cells.
type Cell = (i64, i64);

/// A net's threads being drawn.
pub(super) struct Net<'a> {
    ground: &'a Ground,
    nib: f64,
    interrupt: &'a Interrupt,
    /// Cells that the nib has visited so far, by nib-sized squares.
    been: HashMap<Cell, Vec<Cell>>,
    /// Ink wanted but not laid yet, in square millimetres: pieces too small for a touch pass theirs on to the next.
    owed: f64,
    /// The cells under a nib, relative to its centre.
    under: Vec<Cell>,
}

/// Ink newly laid by the nib, in cells.
#[derive(Clone, Copy)]
struct Laid {
    covered: usize,
    spilt: usize,
}

impl Laid {
    fn hit(self) -> f64 {
        self.covered as f64 / ((self.covered + self.spilt) as f64).max(1.0)
    }
}

/// The ground around one piece, cell by cell.
struct Patch {
    low: Cell,
    width: usize,
    height: usize,
    cells: Vec<State>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Asked,
    Hole,
    Inked,
}

impl<'a> Net<'a> {
    pub fn new(ground: &'a Ground, nib: f64, interrupt: &'a Interrupt) -> Self {
        let reach = (0.5 / CELL) as i64;
        let is_under = |&(x, y): &Cell| ((x * x + y * y) as f64).sqrt() * CELL <= 0.5;
        let under = (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y))).filter(is_under).collect();
        Self { ground, nib, interrupt, been: HashMap::new(), owed: 0.0, under }
    }

    /// Lines with a piece's ink.
    pub fn lines(&mut self, piece: &[Vec<Point>]) -> Vec<Vec<Point>> {
        let ink = ink_of(piece);
        self.owed += ink;
        let mut patch = self.patch(piece);
        let mut lines = Vec::new();
        for (level, share) in LEVELS {
            let kept = (1.0 - share) * ink + 0.5 * self.touch();
            while self.owed > kept && !self.interrupt.is_raised() {
                let Some(line) = self.line(&mut patch, level) else { break };
                lines.push(line);
            }
        }
        // What could not be laid here is not laid elsewhere.
        self.owed = self.owed.min(0.5 * self.touch());
        lines
    }

    fn touch(&self) -> f64 {
        FRAC_PI_4 * self.nib * self.nib
    }

    fn middle(&self, cell: Cell) -> Point {
        (Vec2::new(cell.0 as f64, cell.1 as f64) * (CELL * self.nib)).to_point()
    }

    fn cell(&self, p: Point) -> Cell {
        let at = |v: f64| (v / (CELL * self.nib)).round() as i64;
        (at(p.x), at(p.y))
    }

    /// The ground under a piece and a nib around it.
    fn patch(&self, piece: &[Vec<Point>]) -> Patch {
        let corners = piece.iter().flatten().map(|p| Rect::from_points(*p, *p));
        let bounds = corners.reduce(|a, b| a.union(b)).unwrap_or_default().inflate(self.nib, self.nib);
        let (low, high) = (self.cell(bounds.origin()), self.cell(Point::new(bounds.x1, bounds.y1)));
        let state = |cell: Cell| match self.middle(cell) {
            p if self.ground.is_reached(p) => State::Inked,
            p if self.ground.is_asked(p) => State::Asked,
            _ => State::Hole,
        };
        let cells = (low.1..=high.1).flat_map(|y| (low.0..=high.0).map(move |x| (x, y))).map(state).collect();
        let mut patch = Patch { low, width: (high.0 - low.0 + 1) as usize, height: (high.1 - low.1 + 1) as usize, cells };
        let (first, last) = (square(low), square(high));
        let near = (first.1 - 1..=last.1 + 1).flat_map(|y| (first.0 - 1..=last.0 + 1).map(move |x| (x, y)));
        near.filter_map(|square| self.been.get(&square)).flatten().for_each(|at| patch.ink(*at, &self.under));
        patch
    }

    fn laid(&self, patch: &Patch, at: Cell) -> Laid {
        let states = || self.under.iter().filter_map(|&(x, y)| patch.index((at.0 + x, at.1 + y))).map(|i| patch.cells[i]);
        let count = |state: State| states().filter(|s| *s == state).count();
        Laid { covered: count(State::Asked), spilt: count(State::Hole) }
    }

    /// The next line: it starts where a touch covers most and continues while each step lays at least this share of its ink on
    /// threads.
    fn line(&mut self, patch: &mut Patch, level: f64) -> Option<Vec<Point>> {
        let starts = patch.places().map(|at| (at, self.laid(patch, at)));
        let least = LEAST_TOUCH * self.under.len() as f64;
        let good = starts.filter(|(_, laid)| laid.hit() >= level && laid.covered as f64 >= least);
        let (start, laid) = good.reduce(|a, b| if b.1.covered > a.1.covered { b } else { a })?;
        self.ink(patch, start, laid);
        let mut ends = [vec![self.middle(start)], Vec::new()];
        for end in &mut ends {
            let mut at = self.middle(start);
            while let Some(next) = self.step(patch, at, level) {
                end.push(next);
                at = next;
            }
        }
        let [mut forth, back] = ends;
        forth.reverse();
        forth.extend(back);
        Some(forth)
    }

    /// Moves the nib on to where it covers most; none if enough ink is laid or it would spill.
    fn step(&mut self, patch: &mut Patch, from: Point, level: f64) -> Option<Point> {
        if self.owed <= 0.0 || self.interrupt.is_raised() {
            return None;
        }
        let ways = (0..WAYS).map(|k| from + unit_at(TAU * k as f64 / WAYS as f64) * (STEP * self.nib));
        let least = LEAST_STEP * STEP / (CELL * CELL);
        let steps = ways.map(|to| (to, self.laid(patch, self.cell(to))));
        let good = steps.filter(|(_, laid)| laid.hit() >= level && laid.covered as f64 >= least);
        let (to, laid) = good.reduce(|a, b| if b.1.covered > a.1.covered { b } else { a })?;
        self.ink(patch, self.cell(to), laid);
        Some(to)
    }

    fn ink(&mut self, patch: &mut Patch, at: Cell, laid: Laid) {
        self.owed -= (laid.covered + laid.spilt) as f64 * (CELL * self.nib).powi(2);
        self.been.entry(square(at)).or_default().push(at);
        patch.ink(at, &self.under);
    }
}

/// The nib-sized square that contains a cell.
fn square((x, y): Cell) -> Cell {
    let cells = (1.0 / CELL) as i64;
    (x.div_euclid(cells), y.div_euclid(cells))
}

impl Patch {
    fn ink(&mut self, at: Cell, under: &[Cell]) {
        for &(x, y) in under {
            if let Some(i) = self.index((at.0 + x, at.1 + y)) {
                self.cells[i] = State::Inked;
            }
        }
    }

    fn index(&self, (x, y): Cell) -> Option<usize> {
        let (x, y) = (usize::try_from(x - self.low.0).ok()?, usize::try_from(y - self.low.1).ok()?);
        (x < self.width && y < self.height).then_some(y * self.width + x)
    }

    /// Every other cell, in rows and columns, that wants ink.
    fn places(&self) -> impl Iterator<Item = Cell> + '_ {
        let places = (0..self.height).step_by(2).flat_map(|y| (0..self.width).step_by(2).map(move |x| (x, y)));
        let asked = places.filter(|&(x, y)| self.cells[y * self.width + x] == State::Asked);
        asked.map(|(x, y)| (self.low.0 + x as i64, self.low.1 + y as i64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{BezPath, OffsetOutline, polyline_length};

    /// A net of threads of 0.4 mm around round holes, 1 mm apart, and a nib of 0.6 mm.
    #[test]
    fn a_net_s_ink_is_laid_and_little_of_its_holes_is() {
        let holes: Vec<String> =
            (0..100).map(|i| format!("M{},{} a.3,.3 0 1 0 .6,0 a.3,.3 0 1 0 -.6,0 Z", i % 10, f64::from(i / 10) + 0.5)).collect();
        let outline = BezPath::from_svg(&format!("M-1,0 H10.5 V10.5 H-1 Z {}", holes.join(" "))).unwrap();
        let asked = OffsetOutline::new(&outline, 0.005);
        let nib = 0.6;
        let outermost = asked.grown(-0.5 * nib);
        let ground = Ground::new(&asked, &outermost.grown(0.5 * nib));
        let interrupt = Interrupt::never();
        let mut net = Net::new(&ground, nib, &interrupt);
        let parts = asked.narrow_parts(&outermost, 0.5 * nib, &interrupt);
        let ink: f64 = parts.iter().map(|part| ink_of(part)).sum();
        let pieces = parts.into_iter().flat_map(|part| super::super::needle::pieces(part, nib));
        let lines: Vec<Vec<Point>> = pieces.flat_map(|piece| net.lines(&piece)).collect();
        assert!(!lines.is_empty());
        // Two thirds of a touch lie on threads of this width at best: no more than the last level's share is laid.
        let laid: f64 = lines.iter().map(|line| polyline_length(line) * nib + FRAC_PI_4 * nib * nib).sum();
        assert!((0.25..1.0).contains(&(laid / ink)), "{laid} for {ink}");
        // No line's middle lies in a hole.
        assert!(lines.iter().flatten().all(|p| ground.is_asked(*p)));
    }
}
