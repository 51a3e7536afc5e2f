//! Binary rasters (0 or 1): dilation, majority, connected components.

use super::Raster;
use crate::parallel::{rows_with, shares};

/// Grows the marked region by `radius` pixels (a square, by chessboard distance).
pub fn dilate(mask: &Raster<u8>, radius: usize) -> Raster<u8> {
    let rows = grown_along_rows(mask, radius).transposed();
    grown_along_rows(&rows, radius).transposed()
}

/// Shrinks the marked region by `radius` pixels; the raster's border is no edge of it.
pub fn erode(mask: &Raster<u8>, radius: usize) -> Raster<u8> {
    dilate(&mask.map(|v| u8::from(v == 0)), radius).map(|v| 1 - v)
}

/// Marks what is marked up to `radius` pixels to the left or right, in steps that double the reach.
fn grown_along_rows(mask: &Raster<u8>, radius: usize) -> Raster<u8> {
    let width = mask.width();
    let radius = radius.min(width);
    let window = 2 * radius + 1;
    let mut out = Raster::filled(width, mask.height(), 0_u8);
    let scratch = || [0, 1].map(|_| vec![0_u8; width + 2 * radius]);
    rows_with(out.pixels_mut(), width, &scratch, &|[from, to], y, out| {
        from.fill(0);
        from[radius..radius + width].iter_mut().zip(mask.row(y)).for_each(|(padded, v)| *padded = u8::from(*v != 0));
        let mut reached = 1;
        while reached < window {
            let step = reached.min(window - reached);
            to.iter_mut().zip(from.iter().zip(&from[step..])).for_each(|(to, (a, b))| *to = a | b);
            std::mem::swap(from, to);
            reached += step;
        }
        out.copy_from_slice(&from[..width]);
    });
    out
}

/// The marked region without its parts of up to `2 radius` pixels.
pub fn open(mask: &Raster<u8>, radius: usize) -> Raster<u8> {
    dilate(&erode(mask, radius), radius)
}

/// The marked region with its gaps of up to `2 radius` pixels filled.
pub fn close(mask: &Raster<u8>, radius: usize) -> Raster<u8> {
    erode(&dilate(mask, radius), radius)
}

/// The marked region without what a disc of a radius in pixels does not fit into; the raster's border is no edge of it.
pub fn open_round(mask: &Raster<u8>, radius: usize) -> Raster<u8> {
    let gap = grown_round(&mask.map(|v| u8::from(v == 0)), radius);
    grown_round(&gap.map(|v| 1 - v), radius)
}

/// Grows the marked region by `radius` pixels, by Euclidean distance.
fn grown_round(mask: &Raster<u8>, radius: usize) -> Raster<u8> {
    let (width, height) = (mask.width(), mask.height());
    let mut before = Raster::filled(width + 1, height, 0_u32);
    shares(before.pixels_mut(), width + 1, &|y, before| {
        for (x, v) in mask.row(y).iter().enumerate() {
            before[x + 1] = before[x] + u32::from(*v);
        }
    });
    let halves: Vec<usize> = (0..=radius).map(|dy| (radius * radius - dy * dy).isqrt()).collect();
    Raster::from_fn(width, height, |x, y| {
        let holds = |row: usize| {
            let half = halves[row.abs_diff(y)];
            before.get((x + half + 1).min(width), row) > before.get(x.saturating_sub(half), row)
        };
        u8::from((y.saturating_sub(radius)..(y + radius + 1).min(height)).any(holds))
    })
}

/// The median of a binary raster: marked where more than half of the `(2r+1)^2` window is marked. Pixels outside the raster count
/// as unmarked.
pub fn majority(mask: &Raster<u8>, radius: usize) -> Raster<u8> {
    let half = ((2 * radius + 1) * (2 * radius + 1) / 2) as u32;
    window_count(mask, radius).map(|count| u8::from(count > half))
}

/// The number of marked pixels in the window around each pixel.
fn window_count(mask: &Raster<u8>, radius: usize) -> Raster<u32> {
    let rows = running_count(&mask.map(u32::from), radius).transposed();
    running_count(&rows, radius).transposed()
}

fn running_count(raster: &Raster<u32>, radius: usize) -> Raster<u32> {
    let width = raster.width();
    let mut out = Raster::filled(width, raster.height(), 0_u32);
    shares(out.pixels_mut(), width, &|y, out| {
        let row = raster.row(y);
        let mut sum: u32 = row.iter().take(radius).sum();
        for x in 0..width {
            sum += row.get(x + radius).copied().unwrap_or(0);
            out[x] = sum;
            if x >= radius {
                sum -= row[x - radius];
            }
        }
    });
    out
}

/// Labels the connected components of a mask (eight neighbours): 0 outside, then 1, 2, ... in row order of their first pixel.
/// Returns the labels and the number of components.
///
/// Two passes over the runs of marked pixels in each row: the first takes a label from the runs above that touch it, and records which
/// labels meet there; the second renumbers the joined labels.
pub fn components(mask: &Raster<u8>) -> (Raster<u32>, usize) {
    let mut meets = LabelUnion(vec![0]);
    let mut runs: Vec<(Run, u32)> = Vec::new();
    let mut starts = vec![0];
    for y in 0..mask.height() {
        let above = starts.len().checked_sub(2).map_or(0, |before| starts[before])..runs.len();
        let mut next = above.start;
        for run in runs_of(mask.row(y)) {
            // Runs that end before this one touches them cannot touch a later one.
            while next < above.end && runs[next].0.end < run.start {
                next += 1;
            }
            let touching = runs[next..above.end].iter().take_while(|(other, _)| other.start <= run.end).map(|(_, label)| *label);
            let joined = touching.reduce(|a, b| meets.join(a, b));
            runs.push((run, joined.unwrap_or_else(|| meets.fresh())));
        }
        starts.push(runs.len());
    }
    let (numbers, count) = meets.numbers();
    let mut labels = Raster::filled(mask.width(), mask.height(), 0_u32);
    shares(labels.pixels_mut(), mask.width(), &|y, out| {
        runs[starts[y]..starts[y + 1]].iter().for_each(|(run, label)| out[run.clone()].fill(numbers[*label as usize]));
    });
    (labels, count)
}

/// Columns of a row from the first to behind the last.
type Run = std::ops::Range<usize>;

/// The runs of marked pixels of a row.
fn runs_of(row: &[u8]) -> impl Iterator<Item = Run> {
    let mut from = 0;
    std::iter::from_fn(move || {
        let start = from + row[from..].iter().position(|v| *v != 0)?;
        from = row[start..].iter().position(|v| *v == 0).map_or(row.len(), |length| start + length);
        Some(start..from)
    })
}

/// Union-find: for each label a smaller one that it is joined to, or itself.
struct LabelUnion(Vec<u32>);

impl LabelUnion {
    fn fresh(&mut self) -> u32 {
        let label = self.0.len() as u32;
        self.0.push(label);
        label
    }

    /// The smallest label joined to this one; halves the path for later searches.
    fn least(&mut self, mut label: u32) -> u32 {
        while self.0[label as usize] != label {
            let next = self.0[self.0[label as usize] as usize];
            self.0[label as usize] = next;
            label = next;
        }
        label
    }

    fn join(&mut self, a: u32, b: u32) -> u32 {
        let (a, b) = (self.least(a), self.least(b));
        self.0[a.max(b) as usize] = a.min(b);
        a.min(b)
    }

    /// A number for each label, without gaps, and how many there are.
    fn numbers(self) -> (Vec<u32>, usize) {
        let (mut numbers, mut count) = (self.0, 0);
        for label in 1..numbers.len() {
            // A label is joined only to smaller ones, which have their numbers by now.
            if numbers[label] == label as u32 {
                count += 1;
                numbers[label] = count;
            } else {
                numbers[label] = numbers[numbers[label] as usize];
            }
        }
        (numbers, count as usize)
    }
}

/// Keeps the components of `mask` for which `keep(label)` is true; labels as [`components`] returns them.
pub fn remove_components(mask: &Raster<u8>, labels: &Raster<u32>, keep: impl Fn(u32) -> bool + Sync) -> Raster<u8> {
    mask.zip_map(labels, |marked, label| u8::from(marked != 0 && keep(label)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(rows: &[&str]) -> Raster<u8> {
        let width = rows[0].len();
        Raster::from_vec(width, rows.len(), rows.iter().flat_map(|r| r.bytes().map(|b| u8::from(b == b'#'))).collect())
    }

    #[test]
    fn dilation_grows_a_square() {
        let grown = dilate(&drawn(&[".....", ".....", "..#..", ".....", "....."]), 1);
        assert_eq!(grown, drawn(&[".....", ".###.", ".###.", ".###.", "....."]));
    }

    #[test]
    fn majority_removes_specks_and_fills_pinholes() {
        let cleaned = majority(&drawn(&["#......", "...###.", "...#.#.", "...###.", "......."]), 1);
        assert_eq!(cleaned.get(0, 0), 0);
        assert_eq!(cleaned.get(4, 2), 1);
    }

    #[test]
    fn components_join_over_corners() {
        let (labels, count) = components(&drawn(&["#..#", ".#..", "...#"]));
        assert_eq!(count, 3);
        assert_eq!(labels.get(0, 0), labels.get(1, 1));
        assert_ne!(labels.get(3, 0), labels.get(3, 2));
    }

    #[test]
    fn components_are_numbered_in_row_order_even_where_they_meet_late() {
        let (labels, count) = components(&drawn(&["#.#.#..#", "#.#.#...", "###.#.##", "....##.."]));
        assert_eq!(count, 3);
        let first: Vec<u32> = [(0, 0), (2, 0), (4, 0), (7, 0), (7, 2)].map(|(x, y)| labels.get(x, y)).to_vec();
        assert_eq!(first, [1, 1, 2, 3, 2]);
    }
}
