//! Step 12: lenses stay clear, so that eyes are seen behind them.

use super::zones::{Zones, polygon};
use crate::raster::{Raster, fast_gaussian};
use crate::source::Landmarks;

/// Share of the ink of skin behind a lens that is left out. Without it the dots there, with what the glass mirrors and the folds below the
/// eye, hide small eyes (04, 05, 14); with 0.4 the face behind black frames is not found again in its drawing (11).
const CLEAR: f32 = 0.3;
/// Soft edge of a lens in widths of the face; its rim lies on it.
const EDGE: f64 = 0.006;
/// Tones between which that share rises: frames, lashes and dark lenses keep their ink.
const SKIN: [f32; 2] = [0.2, 0.5];

/// The tone with less ink on the skin behind the lenses of spectacles.
pub(super) fn with_clear_lenses(zones: &Zones, face: &Landmarks, tone: Raster<f32>) -> Raster<f32> {
    let Some(spectacles) = &face.spectacles else { return tone };
    let lenses = spectacles.rims.iter().map(|rim| polygon(tone.width(), tone.height(), rim));
    let glass = lenses.fold(tone.map(|_| 0_u8), |all, lens| all.zip_map(&lens, u8::max)).map(f32::from);
    let skin =
        fast_gaussian(&glass, (EDGE * zones.width) as f32).zip_map(&zones.features, |glass, feature| glass * (1.0 - feature));
    tone.zip_map(&skin, |tone, share| {
        let light = ((tone - SKIN[0]) / (SKIN[1] - SKIN[0])).clamp(0.0, 1.0);
        tone + CLEAR * share * light * (1.0 - tone).max(0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::source::{Iris, Spectacles};

    #[test]
    fn skin_behind_a_lens_is_lighter_and_frames_and_features_are_not() {
        const SIDE: usize = 100;
        let rim =
            |x: f64| [(0.0, 0.0), (30.0, 0.0), (30.0, 40.0), (0.0, 40.0)].map(|(dx, y)| Point::new(x + dx, 30.0 + y)).to_vec();
        let spectacles =
            Spectacles { rims: [rim(10.0), rim(60.0)], bridge: Vec::new(), temples: [Vec::new(), Vec::new()], width: 2.0 };
        let iris = Iris { centre: Point::new(25.0, 50.0), radius: 4.0 };
        let bare = Landmarks { points: Vec::new(), irises: [iris; 2], spectacles: None, pearls: Vec::new() };
        let face = Landmarks { spectacles: Some(spectacles), ..bare.clone() };
        let all = Raster::filled(SIDE, SIDE, 1_u8);
        let features = Raster::from_fn(SIDE, SIDE, |x, _| if x > 75 { 1.0 } else { 0.0 });
        let zones = Zones { counted: all.clone(), skin: all.map(f32::from), oval: all, features, median: 0.6, width: 80.0 };
        let tone = Raster::from_fn(SIDE, SIDE, |_, y| if y > 60 { 0.1 } else { 0.6 });
        let clear = with_clear_lenses(&zones, &face, tone.clone());
        assert!((clear.get(25, 45) - 0.72).abs() < 1e-3, "{}", clear.get(25, 45));
        for (x, y, what) in [(50, 45, "skin beside"), (25, 65, "a dark frame"), (85, 45, "a feature")] {
            assert!((clear.get(x, y) - tone.get(x, y)).abs() < 1e-3, "{what}");
        }
        assert_eq!(with_clear_lenses(&zones, &bare, tone.clone()), tone);
    }
}
