//! Step 10: a face whose lights are large keeps only their middles as paper; its half tones run into the rest.

use super::zones::Zones;
use crate::raster::{Raster, fast_gaussian, soft_rise};

/// Most of the counted skin, in hundredths, that may be paper as seen in print. With 25 foreheads and noses are holes with hard edges, with 13
/// and 8 still too white for editors; with 6 light faces look veiled (sixteen portraits). For light skin and for dark.
const MOST_BARE: [f64; 2] = [11.0, 7.0];
/// Reach of the half tones in widths of the face, their share at most, and the ink above which places are features and do not count.
const REACH: f64 = 0.09;
const MOST: f32 = 0.9;
const MOST_INK: f32 = 0.5;
/// The difference of ink over which a light ends, so that it has no border.
const SOFT: f32 = 0.04;
const HALVINGS: usize = 5;

/// Rubs the half tones of the skin into its lights, by the least amount that leaves few enough of them; `seen` blurs a tone as a print is
/// seen, `paper` is the tone from which that is bare.
pub(super) fn rubbed(zones: &Zones, tone: &Raster<f32>, seen: impl Fn(&Raster<f32>) -> Raster<f32>, paper: f32) -> Raster<f32> {
    let is_bare = |tone: &Raster<f32>| zones.percentile(&seen(tone), 100.0 - zones.by_skin(MOST_BARE)) >= paper;
    if !is_bare(tone) {
        return tone.clone();
    }
    let skin = zones.oval.map(f32::from).zip_map(&zones.features, |oval, feature| oval * (1.0 - feature));
    let ink = tone.map(|v| (1.0 - v).clamp(0.0, MOST_INK));
    let mean = zones.over_skin(&ink, &skin.map(|v| v + 1e-6), REACH);
    let soft = fast_gaussian(&skin, (0.3 * REACH * zones.width) as f32);
    let with = |share: f32| {
        let rub = mean.zip_map(&soft, |mean, skin| share * mean * skin);
        tone.zip_map(&rub, |tone, rub| tone.min(1.0) - soft_rise(rub - (1.0 - tone).max(0.0), SOFT))
    };
    let (mut low, mut high) = (0.0, MOST);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_bare(&with(middle)) { low = middle } else { high = middle }
    }
    with(high)
}
