//! Locks, curls and braids of hair: its tone with more contrast between neighbouring places, so that the few strokes of a hedcut
//! show them.

use super::Drawer;
use crate::raster::{Raster, fast_gaussian};

/// What a lock's tone differs from the hair around it counts so much more. Tuned on portraits 03 (braids), 13 and 15 (curls): with 0
/// all hair is combed strands, with 2 dark hair has white holes.
const GAIN: f32 = 1.0;
/// Blur of a lock and of the hair around it, in pitches: less is the photograph's grain, more is light and shade of the whole head.
const LOCK: f64 = 0.4;
const AROUND: f64 = 3.0;
/// Hair around a place that is as good as none.
const LEAST_SHARE: f32 = 1e-3;
/// The least tone, so that strands stay apart.
const LEAST_TONE: f32 = 0.02;

impl Drawer<'_> {
    /// A tone with more contrast between the locks of a region, 0 to 1; the region's own mean around each place is kept.
    pub(super) fn with_locks(&self, tone: &Raster<f32>, hair: &Raster<f32>) -> Raster<f32> {
        let around = |raster: &Raster<f32>| fast_gaussian(raster, (AROUND * self.pitch()) as f32);
        let mean = around(&tone.zip_map(hair, |tone, hair| tone * hair))
            .zip_map(&around(hair), |tone, hair| tone / hair.max(LEAST_SHARE));
        let lock = fast_gaussian(tone, (LOCK * self.pitch()) as f32).zip_map(&mean, |lock, mean| GAIN * (lock - mean));
        let change = lock.zip_map(hair, |lock, hair| lock * hair);
        tone.zip_map(&change, |tone, change| if change == 0.0 { tone } else { (tone + change).clamp(LEAST_TONE, 1.0) })
    }
}
