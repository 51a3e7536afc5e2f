//! Less ink than a nib can make: dots smaller than the nib are thinned out, so that their mean ink stays.

use crate::drawing::Mark;
use crate::geometry::{Point, Rect, blue_noise_order};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The eye's two blurs, in mean spacings of the dots: the inner one keeps neighbours apart, the outer one keeps the tone of a whole
/// passage. Tuned on wedges of dots with 2 to 60 % of a nib's ink: with the inner one alone, passages of few dots drift by 0.02 in
/// tone; with an outer one of 6, the work doubles and nothing is gained.
const BLURS: [f64; 2] = [1.2, 3.0];
/// Where a blur ends, in its own widths.
const REACH: f64 = 2.6;
/// How far apart, in spacings, two places may exchange their touches.
const NEAR: f64 = 1.8;
/// Rounds of exchanges; on sample drawings fewer than one in a thousand dots still changes in the sixth.
const ROUNDS: usize = 8;

/// Which marks are drawn. A dot smaller than the nib would lay down a whole nib's disc: it stands for its neighbours with the share
/// of that disc which was asked for.
///
/// The choice starts in blue-noise order and is improved by direct binary search (Analoui and Allebach 1992): a dot is taken in,
/// left out or exchanged with a neighbour when that brings the blurred ink nearer to what was asked for.
pub(super) fn keeps_tone(marks: &[Mark], nib: f64) -> Vec<bool> {
    let smallest = 0.5 * nib;
    let small: Vec<(usize, Point, f64)> = marks
        .iter()
        .enumerate()
        .filter_map(|(i, mark)| match mark {
            Mark::Dot(dot) if dot.radius < smallest && dot.centre.is_finite() => {
                Some((i, dot.centre, (dot.radius / smallest).powi(2)))
            }
            _ => None,
        })
        .collect();
    let mut kept = vec![true; marks.len()];
    let chosen = choose(&small.iter().map(|&(_, centre, share)| (centre, share)).collect::<Vec<_>>());
    for ((mark, ..), chosen) in small.into_iter().zip(chosen) {
        kept[mark] = chosen;
    }
    kept
}

/// For each place and the share of a touch wanted there, whether it gets one.
pub(super) fn choose(wanted: &[(Point, f64)]) -> Vec<bool> {
    let places: Vec<Point> = wanted.iter().map(|(place, _)| *place).collect();
    let mut chosen = vec![false; wanted.len()];
    let count = wanted.len() as f64;
    for (rank, i) in blue_noise_order(&places).into_iter().enumerate() {
        chosen[i] = (rank as f64 + 0.5) / count < wanted[i].1;
    }
    let Some(spacing) = usual_spacing(&places) else { return chosen };
    let mut search = Search::new(wanted, chosen, &places, spacing);
    for _ in 0..ROUNDS {
        if search.round() * 2000 < wanted.len() {
            break;
        }
    }
    search.chosen
}

/// Places sorted into square cells, so that all within a cell's width of a place are in 3 x 3 cells.
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

    /// The members of the 3 x 3 cells around a place.
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

/// The side of the square that a place has to itself in the sparser parts: the page's empty ones do not count. None for too few.
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
    // Three quarters of the inked paper are at least as dense as this: where it is denser, the blurs take in more dots.
    let mut counts: Vec<usize> = cells.into_values().collect();
    counts.sort_unstable();
    Some(coarse / (counts[counts.len() / 4] as f64).sqrt())
}

/// The search's state: what is chosen, and the blurred surplus of ink at each place.
struct Search<'a> {
    wanted: &'a [(Point, f64)],
    chosen: Vec<bool>,
    surplus: Vec<f64>,
    felt: Buckets,
    near: Buckets,
    spacing: f64,
    eye: Eye,
}

impl<'a> Search<'a> {
    fn new(wanted: &'a [(Point, f64)], chosen: Vec<bool>, places: &[Point], spacing: f64) -> Self {
        let eye = Eye::new(spacing);
        let felt = Buckets::new(places, spacing * BLURS[1] * REACH);
        let error = |j: usize| f64::from(u8::from(chosen[j])) - wanted[j].1;
        let at = |i: usize| {
            let here = wanted[i].0;
            felt.around(here).map(|j| error(j) * eye.at(here.distance_squared(wanted[j].0))).sum()
        };
        let surplus = (0..wanted.len()).into_par_iter().map(at).collect();
        let near = Buckets::new(places, NEAR * spacing);
        Self { wanted, chosen, surplus, felt, near, spacing, eye }
    }

    /// Tries every place once; returns how many changed.
    fn round(&mut self) -> usize {
        (0..self.wanted.len()).filter(|&i| self.improve(i)).count()
    }

    /// Turns a place over, or exchanges it with a near one in the other state, whichever gains more.
    fn improve(&mut self, i: usize) -> bool {
        let own = self.eye.at(0.0);
        let delta = if self.chosen[i] { -1.0 } else { 1.0 };
        let mut best = (2.0 * delta * self.surplus[i] + own, None);
        let here = self.wanted[i].0;
        let reach = (NEAR * self.spacing).powi(2);
        for j in self.near.around(here).filter(|&j| self.chosen[j] != self.chosen[i]) {
            let squared = here.distance_squared(self.wanted[j].0);
            let change = 2.0 * delta * (self.surplus[i] - self.surplus[j]) + 2.0 * (own - self.eye.at(squared));
            if squared < reach && change < best.0 {
                best = (change, Some(j));
            }
        }
        // Rounding must not turn a place over for ever.
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
        let here = self.wanted[i].0;
        for j in self.felt.around(here) {
            self.surplus[j] += delta * self.eye.at(here.distance_squared(self.wanted[j].0));
        }
    }
}

/// The two blurs by squared distance: Gaussians of equal volume, faded out where the outer one ends.
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
            (1.0 - share) * BLURS.iter().map(|blur| (-0.5 * squared / (blur * blur)).exp() / (blur * blur)).sum::<f64>()
        };
        let reach = edge * spacing;
        Self { table: (0..=Self::STEPS).map(at).collect(), per_square: Self::STEPS as f64 / (reach * reach) }
    }

    fn at(&self, squared: f64) -> f64 {
        self.table[((squared * self.per_square) as usize).min(Self::STEPS)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Dot;

    fn grid(radius: impl Fn(i32) -> f64) -> Vec<Mark> {
        (0..2500).map(|i| Mark::Dot(Dot::circle(Point::new(f64::from(i % 50), f64::from(i / 50)), radius(i)))).collect()
    }

    #[test]
    fn as_much_ink_is_left_as_was_asked_for() {
        let kept = keeps_tone(&grid(|_| 0.09), 0.3).into_iter().filter(|k| *k).count();
        assert!((880..=920).contains(&kept), "{kept}: (0.09 / 0.15)^2 of 2500 is 900");
        assert!(keeps_tone(&grid(|_| 0.09), 0.18).into_iter().all(|k| k));
    }

    #[test]
    fn every_passage_keeps_its_own_share_even_where_dots_are_dense() {
        // A quarter of the page has nine times the dots.
        let mut marks = grid(|_| 0.09);
        let step = 1.0 / 3.0;
        marks.extend((0..5625).map(|i| {
            let (x, y) = (f64::from(i % 75) * step, f64::from(i / 75) * step);
            Mark::Dot(Dot::circle(Point::new(x + 0.1, y + 0.1), 0.09))
        }));
        let kept = keeps_tone(&marks, 0.3);
        let is_dense = |i: &usize| *i >= 2500 || (i % 50 < 26 && i / 50 < 26);
        for (of, name) in [(true, "dense"), (false, "sparse")] {
            let members: Vec<usize> = (0..marks.len()).filter(|i| is_dense(i) == of).collect();
            let share = members.iter().filter(|i| kept[**i]).count() as f64 / members.len() as f64;
            assert!((share - 0.36).abs() < 0.03, "{name}: {share}");
        }
    }

    #[test]
    fn small_windows_keep_their_tone() {
        let share = |i: i32| f64::from(i % 50) / 60.0;
        let marks = grid(|i| 0.15 * share(i).sqrt());
        let kept = keeps_tone(&marks, 0.3);
        let mut worst: f64 = 0.0;
        for row in 0..44 {
            for column in 0..44 {
                let inside = (0..36).map(|k| (row + k / 6) * 50 + column + k % 6);
                let error: f64 = inside.map(|i| f64::from(u8::from(kept[i as usize])) - share(i)).sum();
                worst = worst.max(error.abs());
            }
        }
        assert!(worst < 3.0, "{worst} dots of 36");
    }

    #[test]
    fn few_or_coincident_dots_do_no_harm() {
        for count in [0, 1, 2, 5, 300] {
            let marks = vec![Mark::Dot(Dot::circle(Point::new(1.0, 1.0), 0.1)); count];
            assert_eq!(keeps_tone(&marks, 0.3).len(), count);
        }
    }
}
