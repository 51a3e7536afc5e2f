//! Half tones of a face's skin rubbed into its lights, as a stump does on charcoal and as an engraver's dots do: lights end softly.

use crate::raster::{Raster, fast_gaussian, soft_rise};

/// The share of the half tones that reaches a light, and the most ink that counts as one. With more, faces are veiled; with less,
/// foreheads and noses are holes with hard edges (sixteen portraits in charcoal).
const RUBBED: f32 = 0.6;
const MOST_INK: f32 = 0.5;
/// The difference of ink over which a light ends, so that it has no border.
const SOFT: f32 = 0.04;

/// Ink with the mean of `skin` (0 to 1), blurred by `reach` pixels, in its lights.
pub(super) fn rubbed(ink: &Raster<f32>, skin: &Raster<f32>, reach: f32) -> Raster<f32> {
    let half_tones = half_tones(ink, skin, reach);
    ink.zip_map(&half_tones, |ink, rubbed| ink + soft_rise(rubbed - ink, SOFT))
}

/// What is rubbed into the lights: found in the box around the skin.
fn half_tones(ink: &Raster<f32>, skin: &Raster<f32>, reach: f32) -> Raster<f32> {
    /// Room around the skin in reaches of the blur, so that its borders do not count.
    const ROOM: f32 = 4.0;
    let mut all = skin.map(|_| 0.0);
    let room = (ROOM * reach).ceil() as usize + 2;
    let Some([columns, rows]) = skin.extent_with_room(0.0, room) else { return all };
    let (ink, skin) = (ink.part(&columns, &rows), skin.part(&columns, &rows));
    let sum = fast_gaussian(&ink.zip_map(&skin, |ink, skin| ink.min(MOST_INK) * skin), reach);
    let mean = sum.zip_map(&fast_gaussian(&skin, reach), |sum, skin| sum / skin.max(1e-3));
    let rubbed = mean.zip_map(&skin, |mean, skin| RUBBED * mean * skin);
    for (y, row) in rows.enumerate() {
        for (x, column) in columns.clone().enumerate() {
            all.set(column, row, rubbed.get(x, y));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_get_a_half_tone_and_darks_stay() {
        let ink = Raster::from_fn(60, 60, |x, _| if x < 20 { 0.0 } else { 0.5 });
        let skin = ink.map(|_| 1.0);
        let rubbed = rubbed(&ink, &skin, 10.0);
        assert!(rubbed.get(19, 30) > 0.05 && rubbed.get(19, 30) < 0.3 && rubbed.get(1, 30) < rubbed.get(19, 30));
        assert_eq!(rubbed.get(40, 30), 0.5);
    }
}
