//! Single strokes that taper at both ends.

use super::runs::Piece;
use crate::geometry::Point;

/// The shape of a stroke.
#[derive(Clone, Copy)]
pub(super) struct Tapered {
    /// Greatest width in pitches.
    pub width: f64,
    /// Share of the stroke over which it tapers at each end.
    pub taper: f64,
    /// The width of its tips, as a share.
    pub tip: f64,
    /// How much wider it may become until its ink is the ink wanted.
    pub widest: f64,
}

/// A stroke through nodes in working pixels.
pub(super) fn tapered(nodes: &[Point], shape: Tapered, pitch: f64) -> Piece {
    let last = (nodes.len() - 1).max(1) as f64;
    let width = |i: usize| {
        let to_end = (i as f64 / last).min(1.0 - i as f64 / last);
        shape.width * pitch * (shape.tip + (1.0 - shape.tip) * (to_end / shape.taper).min(1.0))
    };
    let widths: Vec<f64> = (0..nodes.len()).map(width).collect();
    let ceilings = widths.iter().map(|width| shape.widest * width).collect();
    Piece { nodes: nodes.to_vec(), widths, ceilings }
}
