//! Flow-based difference of Gaussians (Kang, Lee and Chui 2007): coherent lines.
//!
//! ```text
//!        . . . . .          1. at each pixel, a difference of Gaussians across the flow
//!     - - - o - - - flow    2. those responses averaged along the streamline
//!        . . . . .          3. strongly negative: a dark line; lines found darken the picture for the next round
//! ```

mod padded;
mod stencil;
mod streamline;

use super::tangent_flow::EdgeTangentFlow;
use crate::elementary::Elementary as _;
use crate::parallel::shares;
use crate::raster::{Raster, dilate};
use padded::Padded;
use stencil::Stencils;
use streamline::Streamlines;

/// Parameters of line detection; lengths in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineParameters {
    /// Standard deviation of the inner Gaussian across the line (Kang: `sigma_c` = 1): the lines' width.
    pub width: f32,
    /// Standard deviation along the line (Kang: `sigma_m` = 3): how far a line continues over gaps.
    pub length: f32,
    /// Weight of the outer Gaussian (Kang: `rho` = 0.99); lower values find fewer lines.
    pub contrast: f32,
    /// Lines are where `1 + tanh(H)` is below this, 0 to 1 (Kang: `tau` = 0.5).
    pub threshold: f32,
    /// How often the filter runs, each time on a picture darkened by the lines found so far (Kang: 2 to 3).
    pub rounds: u32,
}

/// Result of the filter.
#[derive(Clone, Debug)]
pub struct FlowLines {
    /// The last round's response `H`, negative on dark lines.
    pub response: Raster<f32>,
    /// 1 on the lines.
    pub line: Raster<u8>,
}

/// Finds the coherent lines of a grey raster, 0 to 1.
///
/// Each round recomputes only the pixels within reach of those that the previous round darkened.
pub fn flow_lines(grey: &Raster<f32>, flow: &EdgeTangentFlow, parameters: LineParameters) -> FlowLines {
    let nothing = grey.map(|_| 0.0);
    let mut found = FlowLines { response: nothing.clone(), line: grey.map(|_| 0_u8) };
    if grey.is_empty() {
        return found;
    }
    // 1 + tanh(H) < threshold, solved for H.
    let least = (parameters.threshold.clamp(1e-6, 1.0) - 1.0).max(-0.999_999).atanh().min(0.0);
    let across = Stencils::new(&difference_kernel(parameters.width, parameters.contrast), grey.width());
    let along = Streamlines::new(flow, parameters.length);
    let (mut differences, mut darkened) = (nothing, grey.clone());
    let mut stale = grey.map(|_| 1_u8);
    for _ in 0..parameters.rounds {
        across_flow(&darkened, flow, &across, &stale, &mut differences);
        stale = dilate(&stale, along.margin());
        along_flow(&differences, &along, least, &stale, &mut found.response);
        let line = found.line.zip_map(&found.response, |line, h| line | u8::from(h < least));
        let fresh = line.zip_map(&found.line, |now, before| now & (1 - before));
        found.line = line;
        darkened = grey.zip_map(&found.line, |grey, line| if line == 0 { grey } else { 0.0 });
        stale = dilate(&fresh, across.reach);
    }
    found
}

/// Standard deviation of the outer Gaussian, as a multiple of the inner one.
const OUTER: f32 = 1.6;
/// The filter's response assumes grey from 0 to 255 (errata): with 0 to 1 no line would appear.
const GREY_LEVELS: f32 = 255.0;

/// The centre and right half of `G(s_c) - rho G(1.6 s_c)` at whole pixels, each Gaussian summing to 1.
fn difference_kernel(sigma: f32, rho: f32) -> Vec<f32> {
    let outer = half_gaussian(OUTER * sigma);
    let mut inner = half_gaussian(sigma);
    inner.resize(outer.len(), 0.0);
    inner.iter().zip(&outer).map(|(inner, outer)| GREY_LEVELS * (inner - rho * outer)).collect()
}

/// Cut-off of the Gaussians, in standard deviations: 1.2 % of their weight lies beyond.
const CUT: f32 = 2.5;

/// The centre and right half of a Gaussian; the whole sums to 1.
fn half_gaussian(sigma: f32) -> Vec<f32> {
    let sigma = sigma.max(0.1);
    let reach = (CUT * sigma).ceil() as i32;
    let half: Vec<f32> = (0..=reach).map(|i| (-0.5 * (i as f32 / sigma).powi(2)).exponential()).collect();
    let sum = half[0] + 2.0 * half[1..].iter().sum::<f32>();
    half.iter().map(|weight| weight / sum).collect()
}

/// Step 1 where `stale`; 0 where there is no direction.
fn across_flow(grey: &Raster<f32>, flow: &EdgeTangentFlow, stencils: &Stencils, stale: &Raster<u8>, out: &mut Raster<f32>) {
    let padded = Padded::new(grey, stencils.reach);
    recompute_stale(out, stale, |x, y| {
        let tangent = flow.tangent.get(x, y);
        if tangent == [0.0, 0.0] {
            return 0.0;
        }
        stencils.sum(&padded, tangent, x, y)
    });
}

/// Recomputes the pixels that are `stale`.
fn recompute_stale(out: &mut Raster<f32>, stale: &Raster<u8>, value: impl Fn(usize, usize) -> f32 + Sync) {
    let width = out.width();
    shares(out.pixels_mut(), width, &|y, row| {
        for (x, (out, stale)) in row.iter_mut().zip(stale.row(y)).enumerate() {
            if *stale != 0 {
                *out = value(x, y);
            }
        }
    });
}

/// Side of the tiles that are skipped if nothing near them can become a line.
const TILE: usize = 8;

/// Step 2 where `stale`. Tiles without a response below `least` within reach stay 0, since no average can be below it.
fn along_flow(differences: &Raster<f32>, along: &Streamlines, least: f32, stale: &Raster<u8>, out: &mut Raster<f32>) {
    let lowest = lowest_by_tile(differences, along.margin().div_ceil(TILE));
    let columns = differences.width().div_ceil(TILE);
    let padded = Padded::new(differences, along.margin());
    recompute_stale(
        out,
        stale,
        |x, y| if lowest[y / TILE * columns + x / TILE] < least { along.mean(&padded, x, y) } else { 0.0 },
    );
}

/// Minimum over each tile and its neighbours within `reach` tiles.
fn lowest_by_tile(raster: &Raster<f32>, reach: usize) -> Vec<f32> {
    let (columns, rows) = (raster.width().div_ceil(TILE), raster.height().div_ceil(TILE));
    let mut own = vec![f32::INFINITY; columns * rows];
    shares(&mut own, columns, &|j, own| {
        for y in j * TILE..((j + 1) * TILE).min(raster.height()) {
            for (tile, chunk) in own.iter_mut().zip(raster.row(y).chunks(TILE)) {
                *tile = chunk.iter().copied().fold(*tile, f32::min);
            }
        }
    });
    let near = |i: usize, count: usize| i.saturating_sub(reach)..(i + reach + 1).min(count);
    (0..columns * rows)
        .map(|i| {
            let tiles = near(i / columns, rows).flat_map(|y| near(i % columns, columns).map(move |x| y * columns + x));
            tiles.map(|tile| own[tile]).fold(f32::INFINITY, f32::min)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::edge_tangent_flow;
    use super::*;

    const KANG: LineParameters = LineParameters { width: 1.0, length: 3.0, contrast: 0.99, threshold: 0.5, rounds: 2 };

    #[test]
    fn a_dark_ring_is_a_line_and_flat_grey_is_none() {
        let grey = Raster::from_fn(120, 120, |x, y| {
            let r = (x as f32 - 59.5).hypotenuse(y as f32 - 59.5);
            1.0 - 0.5 * (-0.5 * ((r - 35.0) / 1.2).powi(2)).exponential()
        });
        let lines = flow_lines(&grey, &edge_tangent_flow(&grey, 5, 3), KANG);
        let mut count = 0;
        for y in 0..120 {
            for x in 0..120 {
                if lines.line.get(x, y) == 1 {
                    count += 1;
                    let r = (x as f32 - 59.5).hypotenuse(y as f32 - 59.5);
                    assert!((r - 35.0).abs() < 3.0, "a line at radius {r}");
                }
            }
        }
        assert!(count > 400, "{count} pixels for a circumference of 220");
        let flat = Raster::filled(40, 30, 0.3_f32);
        let none = flow_lines(&flat, &edge_tangent_flow(&flat, 5, 3), KANG);
        assert!(none.line.pixels().iter().all(|&v| v == 0));
        let nothing = Raster::filled(0, 0, 0.3_f32);
        assert!(flow_lines(&nothing, &edge_tangent_flow(&nothing, 5, 3), KANG).line.is_empty());
    }

    #[test]
    fn gaps_are_bridged_along_the_flow() {
        let dashed = Raster::from_fn(100, 60, |x, y| {
            let line = (-0.5 * ((y as f32 - 29.5) / 1.2).powi(2)).exponential() * f32::from(x % 20 >= 2);
            1.0 - 0.6 * line
        });
        let lines = flow_lines(&dashed, &edge_tangent_flow(&dashed, 5, 3), KANG);
        let covered = (10..90).filter(|&x| (27..33).any(|y| lines.line.get(x, y) == 1)).count();
        assert!(covered >= 78, "{covered} of 80 columns");
    }
}
