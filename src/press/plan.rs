//! What the press makes of a mark.

use crate::drawing::{Mark, Stroke};
use crate::geometry::Point;

/// A stroke in pieces from start to end. The thin ones may be left out.
pub(super) struct Broken {
    pub stroke: Stroke,
    pub pieces: Vec<Piece>,
}

/// A piece of the centre line with the widths wanted in print. Neighbours share a point.
pub(super) struct Piece {
    pub points: Vec<Point>,
    pub widths: Vec<f64>,
    /// If the piece is too thin: its ink as a share of a full dash's.
    pub share: Option<f64>,
}

/// The plan for one mark.
pub(super) enum Plan {
    /// Print it, with its size corrected.
    Whole(Mark),
    /// The part that is large enough, and the specks for the rest.
    Specks(Option<Mark>, Vec<Speck>),
    /// A line that is partly too thin.
    Broken(Broken),
}

/// A mark of the smallest size at a point where less ink is wanted.
pub(super) struct Speck {
    pub at: Point,
    /// The ink wanted there, as a share of the smallest mark's.
    pub share: f64,
    pub mark: Mark,
}
