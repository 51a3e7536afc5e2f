//! More lines where displacement widens the spacing, fewer where it narrows it; their ends taper.

use super::lines::{Family, Line};
use crate::elementary::Elementary as _;
use crate::parallel::collected;

/// Minimum length of an inserted line or of an interruption, in pitches.
const LEAST_LENGTH: f64 = 3.0;
/// Length over which a line tapers, in pitches.
const TAPER: f64 = 2.0;
/// Maximum number of times that lines double or halve.
const LEVELS: usize = 5;

impl Family {
    /// With more lines where they are far apart and fewer where they are close.
    pub(super) fn in_full(mut self) -> Self {
        self.thin_out();
        self.fill_in();
        self
    }

    /// Ends every second line where lines are pressed together, and repeats with every second of the rest where that is not enough.
    fn thin_out(&mut self) {
        for level in 1..=LEVELS {
            let apart = 1_i64 << (level - 1);
            let reach = apart as usize;
            let ends = |i: usize| {
                let k = reach + i;
                let is_every_second = (self.first_base + k as i64).rem_euclid(2 * apart) == apart;
                is_every_second.then(|| self.ends_between(k, reach)).flatten()
            };
            let pressed = collected(self.lines.len().saturating_sub(2 * reach), &ends);
            if pressed.iter().all(Option::is_none) {
                return;
            }
            for (line, presence) in self.lines[reach..].iter_mut().zip(pressed) {
                line.presence = presence.unwrap_or_else(|| std::mem::take(&mut line.presence));
            }
        }
    }

    /// The presence of base line `k`, given those `reach` below and above; none if it is present everywhere.
    fn ends_between(&self, k: usize, reach: usize) -> Option<Vec<f32>> {
        /// Mean spacing below which every second line ends, in pitches: at 0.4 dark hollows fill up, at 0.7 the ends show as a
        /// seam.
        const CLOSED: f64 = 0.5;
        /// Mean spacing above which it continues.
        const CLOSED_NO_MORE: f64 = 0.6;
        let (below, above) = (&self.lines[k - reach].heights, &self.lines[k + reach].heights);
        let limit = |of: f64| 2.0 * of * self.pitch;
        let closed = self.spaced(below, above, |spacing, was| spacing < limit(if was { CLOSED_NO_MORE } else { CLOSED }));
        let columns = (LEAST_LENGTH * self.pitch / self.step) as usize;
        let closed: Vec<(usize, usize)> = closed.into_iter().filter(|(a, b)| b - a >= columns).collect();
        if closed.is_empty() {
            return None;
        }
        let mut presence = vec![1.0_f32; below.len()];
        let taper = (TAPER * self.pitch / self.step).max(1.0) as usize;
        for (a, b) in closed {
            for (i, presence) in presence.iter_mut().enumerate().take((b + taper).min(below.len())).skip(a.saturating_sub(taper))
            {
                let away = if i < a { a - i } else { i.saturating_sub(b) };
                *presence = presence.min(away as f32 / taper as f32);
            }
        }
        Some(presence)
    }

    /// Inserts tapered lines between those that are too far apart.
    fn fill_in(&mut self) {
        let bases = std::mem::take(&mut self.lines);
        let between: Vec<Vec<Line>> =
            collected(bases.len().saturating_sub(1), &|k| self.between(0, &bases[k].heights, &bases[k + 1].heights, LEVELS));
        self.bases.clear();
        let mut between = between.into_iter();
        for line in bases {
            self.bases.push(self.lines.len());
            self.lines.push(line);
            self.lines.extend(between.next().into_iter().flatten());
        }
    }

    /// Tapered lines between two curves whose first column is `first`, in order.
    fn between(&self, first: usize, below: &[f64], above: &[f64], levels: usize) -> Vec<Line> {
        /// Spacing above which a line is inserted between two, in pitches.
        const OPEN: f64 = 1.5;
        /// Spacing below which it ends; the hysteresis keeps it from coming and going.
        const OPEN_ENOUGH: f64 = 1.3;
        // Shortcut: most pairs are nowhere too far apart.
        if levels == 0 || below.iter().zip(above).all(|(a, b)| b - a <= OPEN * self.pitch) {
            return Vec::new();
        }
        let open = self.spaced(below, above, |spacing, was| spacing > self.pitch * if was { OPEN_ENOUGH } else { OPEN });
        let columns = (LEAST_LENGTH * self.pitch / self.step) as usize;
        let mut lines = Vec::new();
        for (a, b) in joined(open, columns).into_iter().filter(|(a, b)| b - a >= columns) {
            let heights: Vec<f64> = below[a..b].iter().zip(&above[a..b]).map(|(a, b)| 0.5 * (a + b)).collect();
            if !self.keeps_gap(&heights, &below[a..b], &above[a..b]) {
                continue;
            }
            let presence = self.tapered(b - a, first + a, first + b);
            lines.extend(self.between(first + a, &below[a..b], &heights, levels - 1));
            let upper = self.between(first + a, &heights, &above[a..b], levels - 1);
            lines.push(Line { first: first + a, heights, presence });
            lines.extend(upper);
        }
        lines
    }

    fn keeps_gap(&self, heights: &[f64], below: &[f64], above: &[f64]) -> bool {
        let (mut raised, mut sunk) = (heights.to_vec(), heights.to_vec());
        self.gap.raise(&mut raised, below);
        self.gap.sink(&mut sunk, above);
        raised == heights && sunk == heights
    }

    /// Presence of an inserted line of `columns` columns; it does not taper at the family's first or last column. Its neighbours are
    /// known only between its ends, so it is absent close to its ends.
    fn tapered(&self, columns: usize, first: usize, end: usize) -> Vec<f32> {
        let taper = (TAPER * self.pitch / self.step).max(1.0);
        let seen = |columns: usize| columns.saturating_sub(self.gap.reach()) as f64;
        (0..columns)
            .map(|i| {
                let from_start = if first == 0 { f64::INFINITY } else { seen(i) };
                let to_end = if end == self.columns { f64::INFINITY } else { seen(columns - 1 - i) };
                (from_start.min(to_end) / taper).min(1.0) as f32
            })
            .collect()
    }

    /// Runs of columns for which `holds` is true, given the perpendicular distance of two curves and whether it held before.
    fn spaced(&self, below: &[f64], above: &[f64], holds: impl Fn(f64, bool) -> bool) -> Vec<(usize, usize)> {
        let mut runs = Vec::new();
        let mut start = None;
        let last = below.len() - 1;
        for i in 0..below.len() {
            let (a, b) = (i.saturating_sub(2), (i + 2).min(last));
            let slope = 0.5 * (below[b] - below[a] + above[b] - above[a]) / ((b - a).max(1) as f64 * self.step);
            let spacing = (above[i] - below[i]) / slope.hypotenuse(1.0);
            match (holds(spacing, start.is_some()), start) {
                (true, None) => start = Some(i),
                (false, Some(from)) => {
                    runs.push((from, i));
                    start = None;
                }
                _ => {}
            }
        }
        runs.extend(start.map(|from| (from, below.len())));
        runs
    }
}

/// Runs, those nearer than `least` merged, so that no line ends beside the start of the next.
fn joined(runs: Vec<(usize, usize)>, least: usize) -> Vec<(usize, usize)> {
    let mut joined: Vec<(usize, usize)> = Vec::with_capacity(runs.len());
    for run in runs {
        match joined.last_mut() {
            Some(last) if run.0 - last.1 < least => last.1 = run.1,
            _ => joined.push(run),
        }
    }
    joined
}
