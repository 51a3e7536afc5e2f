//! Locks, curls and braids of hair: its tone with more contrast between neighbouring places, so that the few strokes of a hedcut
//! show them.

use super::Drawer;
use crate::raster::{Raster, fast_gaussian_within};

/// What a lock's tone differs from the hair around it counts so much more. Tuned on portraits 03 (braids), 13 and 15 (curls): with 0
/// all hair is combed strands of one tone.
const GAIN: f32 = 1.0;
/// Blur of a lock and of the hair around it, in pitches: less is the photograph's grain, more is light and shade of the whole head.
const LOCK: f64 = 0.4;
const AROUND: f64 = 3.0;

impl Drawer<'_> {
    /// A tone with more contrast between the locks of a region, 0 to 1; what lies beside the region does not count. The mean around
    /// a place stays about as it is, but where black or white is reached.
    pub(super) fn with_locks(&self, tone: &Raster<f32>, hair: &Raster<f32>) -> Raster<f32> {
        let [lock, mean] = [LOCK, AROUND].map(|reach| fast_gaussian_within(tone, hair, (reach * self.pitch()) as f32));
        let change = lock.zip_map(&mean, |lock, mean| GAIN * (lock - mean)).zip_map(hair, |change, hair| change * hair);
        tone.zip_map(&change, |tone, change| (tone + change).clamp(0.0, 1.0))
    }
}
