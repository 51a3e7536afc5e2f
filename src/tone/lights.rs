//! Step 10: a face whose lights are large keeps only their middles as paper; its half tones run into the rest. Step 11: lights end in half
//! tones, not in borders.

use super::zones::Zones;
use crate::raster::{Raster, fast_gaussian, opening, soft_rise};

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

/// Blur of the half tones around a light, in widths of the face: about a pitch and a half at 90 mm. At 0.03 and more the light on a nose's
/// bridge is gone (03, 08, 12).
const BLUR: f64 = 0.02;
/// The ink around a place, from and to which it is less and less blurred: up to the second there are half tones. With 0.3 cheeks still
/// end in borders (12), with more noses flatten.
const BLURRED: [f32; 2] = [0.12, 0.4];
/// The share of the blur that lightens what is dark beside a light: with all of it the sides of noses, wings and folds are lost (03 04 07 14).
const LIGHTENED: f32 = 0.4;
/// Tones so far above paper count, so that the middle of a strong light stays bare.
const ABOVE_PAPER: f32 = 0.08;
/// Dark lines up to twice as wide are furrows, which stay, in widths of the face; and the softness with which fainter ones, pores, go.
const FURROW: f64 = 0.015;
const PORE: f32 = 0.02;

/// Half tones around the lights of the skin: the curve is steep there, and without them lights are white patches with hard edges beside even
/// dots, which every editor named. Furrows lose little of their depth. Tuned on eight of sixteen portraits and on a wrinkled face.
pub(super) fn with_half_tones(zones: &Zones, tone: &Raster<f32>, skin: &Raster<f32>) -> Raster<f32> {
    let skin = skin.zip_map(&zones.features, |skin, feature| skin * (1.0 - feature));
    let tone = tone.map(|v| v.min(1.0 + ABOVE_PAPER));
    let ink = tone.map(|v| (1.0 - v).min(MOST_INK));
    let broad = opening(&ink, (FURROW * zones.width).round().max(1.0) as usize);
    let mean = zones.over_skin(&broad, &skin.map(|v| v + 1e-6), BLUR);
    let soft = fast_gaussian(&skin, (0.5 * BLUR * zones.width) as f32);
    let more = Raster::from_fn(tone.width(), tone.height(), |x, y| {
        let (ink, broad, mean) = (ink.get(x, y), broad.get(x, y), mean.get(x, y));
        let light = ((BLURRED[1] - mean) / (BLURRED[1] - BLURRED[0])).clamp(0.0, 1.0);
        let share = soft.get(x, y).min(skin.get(x, y)) * light * light * (3.0 - 2.0 * light);
        let change = mean + soft_rise(ink - broad, PORE) - ink;
        share * if change < 0.0 { LIGHTENED * change } else { change }
    });
    tone.zip_map(&more, |tone, more| tone - more)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_ends_in_half_tones_and_furrows_and_features_stay() {
        const SIDE: usize = 240;
        let at = |x: usize, inside: f32| Raster::from_fn(SIDE, SIDE, |column, _| if column >= x { inside } else { 1.0 - inside });
        let (oval, skin) = (Raster::filled(SIDE, SIDE, 1_u8), Raster::filled(SIDE, SIDE, 1.0_f32));
        let zones = Zones { counted: oval.clone(), oval, skin: skin.clone(), features: at(210, 1.0), median: 0.5, width: 200.0 };
        let furrow = |x: usize| [150, 151].contains(&x);
        let tone = Raster::from_fn(SIDE, SIDE, |x, _| match x {
            _ if furrow(x) => 0.75,
            80.. if x < 200 => 1.06,
            _ => 0.75,
        });
        let soft = with_half_tones(&zones, &tone, &skin);
        let row: Vec<f32> = (0..SIDE).map(|x| soft.get(x, 120)).collect();
        let steepest = (60..100).map(|x| (row[x + 1] - row[x]).abs()).fold(0.0, f32::max);
        assert!(steepest < 0.15, "the border of the light: {steepest}");
        assert!((row[40] - 0.75).abs() < 0.01 && row[120] > 1.0, "far from the border: {} and {}", row[40], row[120]);
        assert!(row[150] < 0.82 && row[160] > 0.98, "the furrow: {} beside {}", row[150], row[160]);
        assert!((220..SIDE).all(|x| row[x] == 0.75), "a feature");
    }
}
