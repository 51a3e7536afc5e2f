//! The small steps of a relaxation, from row to row. Its numbers lie in planes with a border of zeros, so that no node is a special case.

use super::relaxation::unit;
use crate::elementary::Elementary as _;
use crate::parallel::shares;
use crate::raster::Raster;

/// Share of each of the four neighbours in one small step; above 0.25 steps overshoot.
pub(super) const SHARE: f32 = 0.2;

/// From a node to its right or lower neighbour. The phase `(re, im)` here predicts `(a re - b im, c re + d im)` there, and the phase
/// there `(a re + c im, d im - b re)` here: it turns by the gain, and its sign is changed where the waves are opposite. All are 0 where
/// one of both has no stripes.
const PARTS: usize = 4;

/// All edges of a lattice, and what a step leaves of a node's own phase.
pub(super) struct Edges {
    width: usize,
    height: usize,
    /// For each row with its border, the parts of all edges to the right, then of those down.
    right: Vec<f32>,
    down: Vec<f32>,
    own: Vec<f32>,
}

impl Edges {
    /// By the phase gained from a node to its neighbour in radians and whether their waves are opposite; none where one has no stripes.
    pub(super) fn new(
        (width, height): (usize, usize),
        edge: impl Fn((usize, usize), (usize, usize)) -> Option<(f64, bool)> + Sync,
    ) -> Self {
        let wide = width + 2;
        let parts = |from: (usize, usize), to: (usize, usize)| {
            let (gain, turned) = if to.0 < width && to.1 < height { edge(from, to)? } else { return None };
            let (sin, cos) = (gain as f32).sine_and_cosine();
            Some(if turned { [cos, sin, -sin, -cos] } else { [cos, sin, sin, cos] })
        };
        let plane = |di: usize, dj: usize| {
            let mut plane = vec![0.0_f32; PARTS * wide * (height + 2)];
            shares(&mut plane[PARTS * wide..], PARTS * wide, &|j, row| {
                for i in (0..width).filter(|_| j < height) {
                    let Some(parts) = parts((i, j), (i + di, j + dj)) else { continue };
                    parts.into_iter().enumerate().for_each(|(k, part)| row[k * wide + i + 1] = part);
                }
            });
            plane
        };
        let (right, down) = (plane(1, 0), plane(0, 1));
        let mut own = vec![1.0; wide * (height + 2)];
        shares(&mut own[wide..wide * (height + 1)], wide, &|j, row| {
            let at = |plane: &[f32], j: usize, i: usize| is_edge(&plane[PARTS * wide * j..], wide, i);
            for (i, own) in row.iter_mut().enumerate().take(width + 1).skip(1) {
                let sides = [at(&right, j + 1, i - 1), at(&right, j + 1, i), at(&down, j, i), at(&down, j + 1, i)];
                *own = 1.0 - SHARE * sides.into_iter().filter(|is| *is).count() as f32;
            }
        });
        Self { width, height, right, down, own }
    }

    /// The part `k` of the edges that begin in a row with its border, for its nodes from `first` on.
    fn part<'a>(&self, plane: &'a [f32], j: usize, k: usize, first: usize) -> &'a [f32] {
        let wide = self.width + 2;
        &plane[(PARTS * j + k) * wide + first..][..self.width]
    }
}

/// True if there is an edge: its cosine and sine, the first two parts, are not both 0.
fn is_edge(row: &[f32], wide: usize, i: usize) -> bool {
    row[i] != 0.0 || row[wide + i] != 0.0
}

/// Phases after so many rounds of small steps towards the four neighbours' predictions; each round ends by normalising every phase to
/// length 1, so that no patch of stripes fades away. An anchor is added in each step.
pub(super) fn relaxed_phases(
    phase: &Raster<[f32; 2]>,
    edges: &Edges,
    steps: usize,
    rounds: u32,
    anchor: Option<&Raster<[f32; 2]>>,
) -> Raster<[f32; 2]> {
    /// Least nodes of a share: a row of a small lattice takes less time than handing it to a thread.
    const LEAST_NODES: usize = 2048;
    let (width, height, wide) = (edges.width, edges.height, edges.width + 2);
    let rows = (LEAST_NODES / wide).max(1);
    let mut now = vec![0.0_f32; 2 * wide * (height + 2)];
    for (j, i) in (0..height).flat_map(|j| (0..width).map(move |i| (j, i))) {
        let at = 2 * wide * (j + 1) + i + 1;
        [now[at], now[at + wide]] = phase.get(i, j);
    }
    let mut next = now.clone();
    let inner = 2 * wide..2 * wide * (height + 1);
    for step in 0..steps * rounds as usize {
        let is_last = (step + 1) % steps == 0;
        shares(&mut next[inner.clone()], rows * 2 * wide, &|part, out| {
            for (j, row) in (rows * part + 1..).zip(out.chunks_mut(2 * wide)) {
                small_step(&now, edges, j, row);
                if let Some(anchor) = anchor {
                    pull(row, anchor.row(j - 1));
                }
                if is_last {
                    normalise(row, wide);
                }
            }
        });
        std::mem::swap(&mut now, &mut next);
    }
    Raster::from_fn(width, height, |i, j| {
        let at = 2 * wide * (j + 1) + i + 1;
        [now[at], now[at + wide]]
    })
}

/// One row, with its border.
fn small_step(now: &[f32], edges: &Edges, j: usize, row: &mut [f32]) {
    let (width, wide) = (edges.width, edges.width + 2);
    let phase = |j: usize, k: usize, first: usize| &now[(2 * j + k) * wide + first..][..width];
    let (re, im) = row.split_at_mut(wide);
    let outs = [&mut re[1..=width], &mut im[1..=width]];
    let own = &edges.own[wide * j + 1..][..width];
    for (k, out) in outs.into_iter().enumerate() {
        // The parts that make the real, or the imaginary, part of a prediction ahead and back.
        let (ahead, back) = if k == 0 { ([0, 1], [0, 2]) } else { ([2, 3], [1, 3]) };
        let sign = if k == 0 { [-1.0, 1.0] } else { [1.0, -1.0] };
        let part = |plane, j, k, first| edges.part(plane, j, k, first);
        let here = phase(j, k, 1);
        let sides = [
            (part(&edges.right, j, ahead[0], 0), part(&edges.right, j, ahead[1], 0), phase(j, 0, 0), phase(j, 1, 0)),
            (
                part(&edges.down, j - 1, ahead[0], 1),
                part(&edges.down, j - 1, ahead[1], 1),
                phase(j - 1, 0, 1),
                phase(j - 1, 1, 1),
            ),
            (part(&edges.right, j, back[0], 1), part(&edges.right, j, back[1], 1), phase(j, 0, 2), phase(j, 1, 2)),
            (part(&edges.down, j, back[0], 1), part(&edges.down, j, back[1], 1), phase(j + 1, 0, 1), phase(j + 1, 1, 1)),
        ];
        let [left, above, right, below] = sides;
        for i in 0..width {
            let before =
                (left.0[i] * left.2[i] + above.0[i] * above.2[i]) + sign[0] * (left.1[i] * left.3[i] + above.1[i] * above.3[i]);
            let after = sign[1] * (right.0[i] * right.2[i] + below.0[i] * below.2[i])
                + (right.1[i] * right.3[i] + below.1[i] * below.3[i]);
            out[i] = own[i] * here[i] + SHARE * (before + after);
        }
    }
}

fn pull(row: &mut [f32], anchor: &[[f32; 2]]) {
    let wide = row.len() / 2;
    for (i, [re, im]) in anchor.iter().enumerate() {
        row[i + 1] += re;
        row[wide + i + 1] += im;
    }
}

fn normalise(row: &mut [f32], wide: usize) {
    for i in 1..wide - 1 {
        [row[i], row[wide + i]] = unit([row[i], row[wide + i]]);
    }
}
