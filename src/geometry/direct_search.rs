//! Direct binary search (Analoui and Allebach 1992) over scattered points: chooses which of them get a whole dot when each should
//! get a share of one.

use crate::elementary::Elementary as _;
use crate::interrupt::Interrupt;
use crate::parallel::collected;
use kurbo::{Point, Rect};
use std::collections::BTreeMap;

/// Standard deviations of the two Gaussian blurs that model the eye, in mean dot spacings. The inner one keeps neighbours apart,
/// the outer one keeps the tone of larger areas. Tuned on wedges of dots with 2 to 60 % of a nib's ink: with the inner one alone,
/// areas of few dots drift by 0.02 in tone; with an outer one of 6, the work doubles and nothing is gained.
const BLURS: [f64; 2] = [1.2, 3.0];
/// Cut-off radius of a blur, in its standard deviations.
const REACH: f64 = 2.6;
/// Maximum distance, in spacings, of two points that are swapped.
const NEAR: f64 = 1.8;
/// Maximum number of rounds; on sample drawings fewer than one in a thousand dots still changes in the sixth.
const ROUNDS: usize = 8;

/// Improves a choice of points: toggles a point, or swaps it with a near one, if that brings the blurred sum of the chosen points
/// closer to that of the shares (each from 0 to 1). Points must be finite. Ends early once the interrupt is raised.
pub(super) fn improved(places: &[Point], shares: &[f64], chosen: Vec<bool>, interrupt: &Interrupt) -> Vec<bool> {
    let Some(spacing) = usual_spacing(places) else { return chosen };
    let mut search = Search::new(places, shares, chosen, spacing, interrupt);
    for _ in 0..ROUNDS {
        if search.round() * 2000 < places.len() {
            break;
        }
    }
    search.chosen
}

/// Points sorted into square cells, so that all within a cell's width of a point are in 3 x 3 cells.
struct Buckets {
    cell: f64,
    corner: Point,
    columns: usize,
    rows: usize,
    first: Vec<u32>,
    members: Vec<u32>,
}

impl Buckets {
    fn new(places: &[Point], cell: f64) -> Self {
        let bounds = bounds(places);
        let cell = cell.max(bounds.width().max(bounds.height()) / 2000.0);
        let (columns, rows) = ((bounds.width() / cell) as usize + 1, (bounds.height() / cell) as usize + 1);
        let mut buckets = Self { cell, corner: bounds.origin(), columns, rows, first: Vec::new(), members: Vec::new() };
        let cells: Vec<usize> = places.iter().map(|p| buckets.cell_of(*p)).collect();
        let mut first = vec![0_u32; columns * rows + 1];
        cells.iter().for_each(|&cell| first[cell + 1] += 1);
        (1..first.len()).for_each(|i| first[i] += first[i - 1]);
        let mut next = first.clone();
        let mut members = vec![0; places.len()];
        for (i, &cell) in cells.iter().enumerate() {
            members[next[cell] as usize] = i as u32;
            next[cell] += 1;
        }
        (buckets.first, buckets.members) = (first, members);
        buckets
    }

    fn cell_of(&self, p: Point) -> usize {
        let at = |v: f64, count: usize| ((v / self.cell) as usize).min(count - 1);
        at(p.y - self.corner.y, self.rows) * self.columns + at(p.x - self.corner.x, self.columns)
    }

    /// The members of the 3 x 3 cells around a point.
    fn around(&self, p: Point) -> impl Iterator<Item = usize> + '_ {
        let cell = self.cell_of(p);
        let (column, row) = (cell % self.columns, cell / self.columns);
        let columns = column.saturating_sub(1)..(column + 2).min(self.columns);
        (row.saturating_sub(1)..(row + 2).min(self.rows)).flat_map(move |row| {
            let range = |column: usize| self.first[row * self.columns + column] as usize;
            self.members[range(columns.start)..range(columns.end)].iter().map(|&i| i as usize)
        })
    }
}

fn bounds(places: &[Point]) -> Rect {
    places.iter().map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b)).unwrap_or_default()
}

/// The side of the square per point in the sparser parts; empty parts of the page do not count. `None` for fewer than 3 points or
/// no extent.
fn usual_spacing(places: &[Point]) -> Option<f64> {
    let bounds = bounds(places);
    let extent = bounds.width().max(bounds.height());
    if places.len() < 3 || extent <= 0.0 {
        return None;
    }
    let side = (bounds.width() * bounds.height() / places.len() as f64).sqrt().max(extent / 1000.0);
    let mut cells: BTreeMap<(i64, i64), usize> = BTreeMap::new();
    let coarse = 3.0 * side;
    for p in places {
        *cells.entry(((p.x / coarse) as i64, (p.y / coarse) as i64)).or_default() += 1;
    }
    // The lower quartile: three quarters of the inked cells are at least this dense. In denser ones the blurs cover more dots.
    let mut counts: Vec<usize> = cells.into_values().collect();
    counts.sort_unstable();
    Some(coarse / (counts[counts.len() / 4] as f64).sqrt())
}

/// The search's state: the choice, and the blurred surplus of ink at each point.
struct Search<'a> {
    places: &'a [Point],
    shares: &'a [f64],
    chosen: Vec<bool>,
    surplus: Vec<f64>,
    blur_cells: Buckets,
    near: Buckets,
    spacing: f64,
    eye: Eye,
    interrupt: &'a Interrupt,
}

impl<'a> Search<'a> {
    fn new(places: &'a [Point], shares: &'a [f64], chosen: Vec<bool>, spacing: f64, interrupt: &'a Interrupt) -> Self {
        let eye = Eye::new(spacing);
        let blur_cells = Buckets::new(places, spacing * BLURS[1] * REACH);
        let error = |j: usize| f64::from(u8::from(chosen[j])) - shares[j];
        let at = |i: usize| {
            let here = places[i];
            blur_cells
                .around(here)
                .filter(|_| !interrupt.is_raised())
                .map(|j| error(j) * eye.at(here.distance_squared(places[j])))
                .sum()
        };
        let surplus = collected(places.len(), &at);
        let near = Buckets::new(places, NEAR * spacing);
        Self { places, shares, chosen, surplus, blur_cells, near, spacing, eye, interrupt }
    }

    /// Tries every point once; returns how many changed.
    fn round(&mut self) -> usize {
        (0..self.places.len()).filter(|&i| !self.interrupt.is_raised() && self.is_open(i) && self.improve(i)).count()
    }

    /// True if the point may change: a share of 0 or 1 is fixed.
    fn is_open(&self, i: usize) -> bool {
        self.shares[i] > 0.0 && self.shares[i] < 1.0
    }

    /// Toggles a point, or swaps it with a near one in the other state, whichever gains more. True if something changed.
    fn improve(&mut self, i: usize) -> bool {
        let own = self.eye.at(0.0);
        let delta = if self.chosen[i] { -1.0 } else { 1.0 };
        let mut best = (2.0 * delta * self.surplus[i] + own, None);
        let here = self.places[i];
        let reach = (NEAR * self.spacing).powi(2);
        for j in self.near.around(here).filter(|&j| self.chosen[j] != self.chosen[i] && self.is_open(j)) {
            let squared = here.distance_squared(self.places[j]);
            let change = 2.0 * delta * (self.surplus[i] - self.surplus[j]) + 2.0 * (own - self.eye.at(squared));
            if squared < reach && change < best.0 {
                best = (change, Some(j));
            }
        }
        // A margin, so that rounding cannot toggle a point forever.
        if best.0 > -1e-6 * own {
            return false;
        }
        self.turn(i);
        best.1.into_iter().for_each(|j| self.turn(j));
        true
    }

    fn turn(&mut self, i: usize) {
        self.chosen[i] = !self.chosen[i];
        let delta = if self.chosen[i] { 1.0 } else { -1.0 };
        let here = self.places[i];
        for j in self.blur_cells.around(here) {
            self.surplus[j] += delta * self.eye.at(here.distance_squared(self.places[j]));
        }
    }
}

/// Table of the two blurs by squared distance: Gaussians of equal volume, faded to 0 at the outer one's cut-off.
struct Eye {
    table: Vec<f64>,
    per_square: f64,
}

impl Eye {
    const STEPS: usize = 2048;

    fn new(spacing: f64) -> Self {
        let edge = BLURS[1] * REACH;
        let at = |step: usize| {
            let share = step as f64 / Self::STEPS as f64;
            let squared = share * edge * edge;
            (1.0 - share) * BLURS.iter().map(|blur| (-0.5 * squared / (blur * blur)).exponential() / (blur * blur)).sum::<f64>()
        };
        let reach = edge * spacing;
        Self { table: (0..=Self::STEPS).map(at).collect(), per_square: Self::STEPS as f64 / (reach * reach) }
    }

    fn at(&self, squared: f64) -> f64 {
        self.table[((squared * self.per_square) as usize).min(Self::STEPS)]
    }
}
