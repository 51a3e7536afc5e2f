//! Lips as an old plate sees them: red is dark. On brown skin and in the light, lips are as light as the skin around them, and told by their
//! colour alone; without it a mouth has no shape.

use super::mouth_box::{MouthBox, sorted};
use crate::raster::{Raster, fast_gaussian, fast_gaussian_within, median};
use crate::source::Landmarks;

/// How far around the lips the skin is looked at, in their sizes, and the blur of its tone in widths of the face.
const AROUND: f64 = 0.35;
const REACH: f64 = 0.07;
/// The blur of the tone of the lips themselves, in widths of the face: a lip's height.
const OF_LIPS: f64 = 0.04;
/// How much pinker than the skin around them lips are where they begin to count, and where they count in full.
const PINKER: [f32; 2] = [0.1, 0.28];
/// By how much such lips are darker than the skin around them, and by how much more for each unit of pinkness; and how much of their
/// own lights is left. Without lights painted lips are slabs (07, 12), and with all of them streaks (15). Of the sixteen portraits
/// eleven have lips 0.2 to 0.36 pinker in the median, four, in beards or half shade, 0.07 to 0.08, and one, in a beard, none.
const DARKER: f32 = 0.12;
const BY_PINKNESS: f32 = 0.3;
const LIGHTS: f32 = 0.6;
/// The darkest tone that a lip gets by this: below it lips and the line between them are one. On dark skin it is by this darker than the skin, and
/// at least the second: painted lips had the tone of the skin (01).
const DARKEST: f32 = 0.3;
const DARKER_THAN_DARK: f32 = 0.2;
const LEAST: f32 = 0.22;
/// Blur of pinkness, in which photographs are coarse, and of the lips' edge, in widths of the face.
const COARSE: f64 = 0.012;
const SOFT: f64 = 0.008;

/// The tone with lips that are darker than the skin around them where they are pinker, by the photograph's linear light; `beard` is none of
/// the skin. `strength` is that of the tone, 0 to 1.
pub(super) fn with_red_lips(
    mut tone: Raster<f32>,
    light: &Raster<[f32; 3]>,
    beard: Option<&Raster<f32>>,
    faces: &[Landmarks],
    strength: f32,
) -> Raster<f32> {
    for face in faces {
        let Some(mut mouth) = MouthBox::of(face, light, AROUND) else { continue };
        mouth.pinkness = fast_gaussian(&mouth.pinkness, (COARSE * face.width()) as f32);
        let beard = beard.map(|beard| beard.part(&mouth.columns, &mouth.rows));
        let skin = Raster::from_fn(mouth.outer.width(), mouth.outer.height(), |x, y| {
            mouth.outer.get(x, y) == 0 && beard.as_ref().is_none_or(|beard| beard.get(x, y) < 0.1)
        });
        let Some(pinker) = pinker_lips(&mouth, &skin, face.width()) else { continue };
        let part = tone.part(&mouth.columns, &mouth.rows);
        let around = fast_gaussian_within(&part, &skin.map(|is| f32::from(u8::from(is)) + 1e-6), (REACH * face.width()) as f32);
        let lips = mouth.lips().map(|is| f32::from(u8::from(is)) + 1e-6);
        let mean = fast_gaussian_within(&part, &lips, (OF_LIPS * face.width()) as f32);
        mouth.retone(&mut tone, |x, y, v| {
            let (pink, mean, around) = (pinker.get(x, y), mean.get(x, y), around.get(x, y));
            let darkest = DARKEST.min(around - DARKER_THAN_DARK).max(LEAST);
            let wanted = (around - DARKER - BY_PINKNESS * pink).max(darkest);
            let share = strength * ((pink - PINKER[0]) / (PINKER[1] - PINKER[0])).clamp(0.0, 1.0);
            let less = (mean - wanted).max(0.0).min((v - darkest).max(0.0)) + (1.0 - LIGHTS) * (v - mean.max(wanted)).max(0.0);
            v - share * less
        });
    }
    tone
}

/// How much pinker than the skin around them lips are, in their box; 0 beside them. None without skin to compare with.
fn pinker_lips(mouth: &MouthBox, skin: &Raster<bool>, width: f64) -> Option<Raster<f32>> {
    let of_skin = median(sorted(&mouth.pinkness, skin))?;
    let red = mouth.pinkness.zip_map(&mouth.lips(), |red, is_lip| if is_lip { (red - of_skin).max(0.0) } else { 0.0 });
    Some(fast_gaussian(&red, (SOFT * width) as f32))
}

#[cfg(test)]
mod tests {
    use super::super::mouth_box::tests::with_mouth;
    use super::*;
    use crate::geometry::Point;
    use crate::source::outlines;
    use crate::tone::zones::polygon;

    /// The tone of the lower lip on skin of an even tone.
    fn lower_lip(lips: [f32; 3], beard: Option<f32>) -> f32 {
        let face = with_mouth(Point::new(100.0, 60.0));
        let outer = polygon(200, 120, &face.line(&outlines::LIPS));
        let light = Raster::from_fn(200, 120, |x, y| if outer.get(x, y) == 1 { lips } else { [0.5, 0.3, 0.2] });
        let beard = beard.map(|share| Raster::filled(200, 120, share));
        with_red_lips(Raster::filled(200, 120, 0.7), &light, beard.as_ref(), &[face], 1.0).get(100, 80)
    }

    #[test]
    fn lips_pinker_than_the_skin_are_darker_and_painted_ones_darkest() {
        let [natural, painted] = [[0.5, 0.22, 0.2], [0.5, 0.1, 0.1]].map(|lips| lower_lip(lips, None));
        assert!(natural < 0.6 && painted < natural - 0.05 && painted > DARKEST, "{natural} {painted}");
        assert_eq!(lower_lip([0.5, 0.3, 0.2], None), 0.7, "the skin's colour");
        assert_eq!(lower_lip([0.5, 0.1, 0.1], Some(1.0)), 0.7, "no skin to compare with");
    }
}
