//! The noise levels at which ribbons of a continuous Glass pattern are cut, and the ribbons' lightness.

use super::Ribbon;
use crate::raster::{Raster, sorted};

/// Share of the equalised pattern (0 to 1) between a single ribbon's outline and its crest. If lower, the ground shows between ribbons;
/// if higher, they cover places lighter than their rims. Correlation with the raster pattern is flat from 0.25 to 0.35, and lower by
/// 0.02 at 0.45 (fields of figures 7.1 to 7.3 and two photographs).
const LONE_DEPTH: f32 = 0.3;

/// Levels from the ranks of the pattern's values.
#[derive(Clone, Debug)]
pub struct GlassLevels {
    /// The pattern's values in ascending order.
    sorted: Vec<f32>,
    /// Levels shared by all maxima, ascending, the first below all noise; a single level means that each maximum has its own.
    shared: Vec<f32>,
}

impl GlassLevels {
    /// `count` levels at equal shares of the pattern; with a count of one, each maximum has one ribbon with its own outline and
    /// lightness.
    pub fn new(pattern: &Raster<f32>, count: usize) -> Self {
        let sorted = sorted(pattern);
        let level = |i: usize| if i == 0 { f32::MIN } else { sorted[i * sorted.len() / count] };
        let shared = (0..count.max(1)).map(level).collect();
        Self { sorted, shared }
    }

    /// The levels at which a maximum of this height is drawn.
    pub fn of(&self, height: f32) -> Vec<f32> {
        if self.shared.len() > 1 {
            return self.shared.iter().copied().filter(|level| *level < height).collect();
        }
        let rank = self.rank(height) - LONE_DEPTH;
        let level = if rank <= 0.0 { f32::MIN } else { self.sorted[(rank * self.sorted.len() as f32) as usize] };
        if height > self.sorted[0] { vec![level] } else { Vec::new() }
    }

    /// A ribbon's equalised value, -1/2 to 1/2: the middle of its range.
    pub fn value(&self, ribbon: &Ribbon) -> f32 {
        if self.shared.len() > 1 {
            let share = self.shared.partition_point(|level| *level < ribbon.level);
            (share as f32 + 0.5) / self.shared.len() as f32 - 0.5
        } else {
            let rank = self.rank(ribbon.height);
            0.5 * (rank + (rank - LONE_DEPTH).max(0.0)) - 0.5
        }
    }

    /// Share of the pattern below a height.
    fn rank(&self, height: f32) -> f32 {
        self.sorted.partition_point(|v| *v < height) as f32 / self.sorted.len() as f32
    }
}
