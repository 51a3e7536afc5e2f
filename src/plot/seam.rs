//! Where a loop begins and ends, if not where the pen reaches it soonest.

use super::Toolpath;
use crate::geometry::Point;

/// The position of a loop's seam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Seam {
    /// Wherever the travel is shortest.
    #[default]
    Nearest,
    /// Where the loop begins as drawn.
    Drawn,
    /// At its highest vertex on the page.
    Top,
    /// At its lowest.
    Bottom,
    /// At its leftmost.
    Left,
    /// At its rightmost.
    Right,
    /// At its sharpest corner, where a blot shows least.
    Corner,
}

impl Seam {
    /// Rotates a loop so that its seam lies here. Other paths are returned unchanged.
    pub(super) fn place(self, path: Toolpath) -> Toolpath {
        if !path.is_free() {
            return path;
        }
        let around = &path.points()[..path.points().len() - 1];
        let least = |key: &dyn Fn(usize) -> f64| (0..around.len()).min_by(|&a, &b| key(a).total_cmp(&key(b))).unwrap_or(0);
        let vertex = match self {
            Self::Nearest | Self::Drawn => return path,
            Self::Top => least(&|i| around[i].y),
            Self::Bottom => least(&|i| -around[i].y),
            Self::Left => least(&|i| around[i].x),
            Self::Right => least(&|i| -around[i].x),
            Self::Corner => least(&|i| straightness(around, i)),
        };
        path.rotated(vertex, around[vertex])
    }
}

/// Cosine of the turn at a vertex of a loop: 1 is straight on, -1 a reversal.
fn straightness(around: &[Point], vertex: usize) -> f64 {
    let at = around[vertex];
    let len = around.len();
    let other = |step: &dyn Fn(usize) -> usize| (1..len).map(|k| around[step(k)]).find(|p| *p != at).unwrap_or(at);
    let (before, after) = (at - other(&|k| (vertex + len - k) % len), other(&|k| (vertex + k) % len) - at);
    before.dot(after) / (before.hypot() * after.hypot()).max(f64::MIN_POSITIVE)
}
