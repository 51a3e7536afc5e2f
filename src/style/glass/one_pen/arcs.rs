//! Evenly spaced arcs along a flow.

use crate::field::Flow;
use crate::geometry::{Point, Vec2};
use crate::raster::Raster;
use crate::style::random;
use rand::RngExt;
use std::collections::VecDeque;

/// The target of a drawing; lengths in pixels.
pub(super) struct Wanted<'a> {
    pub flow: &'a Flow,
    /// Share of ink, 0 to 1.
    pub ink: &'a Raster<f32>,
    /// Distance between neighbouring arcs; infinite where there are none.
    pub spacing: &'a Raster<f32>,
    /// Width of an arc.
    pub width: f64,
    /// Approximate length of an arc.
    pub length: f64,
}

/// Distance between an arc's points in pixels.
const STEP: f64 = 0.5;

/// The arcs so far, their points sorted into square cells.
pub(super) struct Arcs<'a> {
    wanted: &'a Wanted<'a>,
    seed: u64,
    lines: Vec<Vec<Point>>,
    cell: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<(Point, u32)>>,
}

impl<'a> Arcs<'a> {
    /// Draws arcs beside existing ones at the right distance as long as such a place is free, then wherever a gap is left.
    pub(super) fn draw(wanted: &'a Wanted<'a>, seed: u64) -> Vec<Vec<Point>> {
        let cell = 2.0 * wanted.width;
        let columns = (wanted.ink.width() as f64 / cell).ceil() as usize + 1;
        let rows = (wanted.ink.height() as f64 / cell).ceil() as usize + 1;
        let mut arcs = Self { wanted, seed, lines: Vec::new(), cell, columns, rows, cells: vec![Vec::new(); columns * rows] };
        for start in arcs.starts() {
            if arcs.grow(start) {
                arcs.surround();
            }
        }
        arcs.lines
    }

    /// One random place in each cell of the picture, in random order.
    fn starts(&self) -> Vec<Point> {
        let mut random = random::stream(self.seed, "arc starts", 0);
        let mut starts: Vec<(u64, Point)> = (0..self.columns * self.rows)
            .map(|i| {
                let (dx, dy): (f64, f64) = (random.random(), random.random());
                let (column, row) = ((i % self.columns) as f64, (i / self.columns) as f64);
                (random.random(), Point::new((column + dx) * self.cell, (row + dy) * self.cell))
            })
            .collect();
        starts.sort_by_key(|start| start.0);
        starts.into_iter().map(|start| start.1).collect()
    }

    /// Grows arcs beside the last one, then beside the new ones, until there is no more room.
    fn surround(&mut self) {
        let mut queue = VecDeque::from([self.lines.len() - 1]);
        while let Some(line) = queue.pop_front() {
            for i in (0..self.lines[line].len()).step_by(4) {
                let p = self.lines[line][i];
                let spacing = self.spacing(p);
                let beside = self.wanted.flow.at(p).turn_90() * spacing;
                if !spacing.is_finite() {
                    continue;
                }
                for side in [p + beside, p - beside] {
                    if self.grow(side) {
                        queue.push_back(self.lines.len() - 1);
                    }
                }
            }
        }
    }

    fn spacing(&self, p: Point) -> f64 {
        let nearest = self.wanted.spacing.clamped(p.x.floor() as isize, p.y.floor() as isize);
        f64::from(nearest)
    }

    /// An arc through a place, if there is room for one.
    fn grow(&mut self, start: Point) -> bool {
        /// Shortest arc, as a share of the target length; shorter ones look like dirt.
        const LEAST_LENGTH: f64 = 0.12;
        if !self.is_free(start, &[]) {
            return false;
        }
        let mut random = random::stream(self.seed, "arcs", self.lines.len() as u64);
        let length = self.wanted.length * random.random_range(0.6..1.4);
        let ahead = (0.5 * length / STEP) as usize;
        let mut line = vec![start];
        self.extend(&mut line, ahead, 1.0);
        line.reverse();
        let left = (length / STEP) as usize - line.len().min((length / STEP) as usize);
        self.extend(&mut line, left, -1.0);
        if (line.len() - 1) as f64 * STEP < (LEAST_LENGTH * self.wanted.length).max(self.wanted.width) {
            return false;
        }
        for &p in &line {
            let cell = self.cell_of(p);
            self.cells[cell].push((p, self.lines.len() as u32));
        }
        self.lines.push(line);
        true
    }

    /// Adds up to `count` points to the line's end.
    fn extend(&self, line: &mut Vec<Point>, count: usize, sign: f64) {
        /// Cosine of the maximum turn in one step, a radius of two pixels: tighter whirls would be blots.
        const MOST_TURN: f64 = 0.969;
        let mut direction = Vec2::ZERO;
        for _ in 0..count {
            let here = line[line.len() - 1];
            let middle = here + self.wanted.flow.at(here) * (0.5 * sign * STEP);
            let next_direction = self.wanted.flow.at(middle) * sign;
            let next = here + next_direction * STEP;
            let turns_off = direction != Vec2::ZERO && direction.dot(next_direction) < MOST_TURN;
            if next_direction == Vec2::ZERO || turns_off || !self.is_free(next, line) {
                return;
            }
            direction = next_direction;
            line.push(next);
        }
    }

    fn cell_of(&self, p: Point) -> usize {
        (p.y / self.cell) as usize * self.columns + (p.x / self.cell) as usize
    }

    /// True if a place lies on the picture, needs ink and is far enough from all arcs and from the earlier part of its own.
    fn is_free(&self, p: Point, own: &[Point]) -> bool {
        /// Share of the local spacing at which a growing arc stops before another one. At 0.5 arcs pinch and the spacing varies,
        /// at 0.9 they break up into dashes (Jobard and Lefer: 0.5 to 0.8).
        const LEAST_SHARE: f64 = 0.75;
        /// Minimum distance of arcs as a share of their width; after smoothing moves them, they overlap by less than half of it.
        const LEAST_WIDTHS: f64 = 0.75;
        let spacing = self.spacing(p);
        if !self.wanted.flow.contains(p) || !spacing.is_finite() {
            return false;
        }
        let distance = (LEAST_SHARE * spacing).max(LEAST_WIDTHS * self.wanted.width);
        // Skips the points that are near along the arc itself.
        let skipped = (2.0 * distance / STEP) as usize + 2;
        let earlier = own.len().saturating_sub(skipped);
        if own[..earlier].iter().any(|q| q.distance_squared(p) < distance * distance) {
            return false;
        }
        let range = |at: f64, count: usize| {
            let (first, last) = ((at - distance) / self.cell, (at + distance) / self.cell);
            first.max(0.0) as usize..=(last as usize).min(count - 1)
        };
        range(p.y, self.rows).all(|row| {
            range(p.x, self.columns).all(|column| {
                self.cells[row * self.columns + column].iter().all(|(q, _)| q.distance_squared(p) >= distance * distance)
            })
        })
    }
}
