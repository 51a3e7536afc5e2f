//! Teeth in the shade of a mouth: as dark as the lips in the photograph, and told from them by their colour alone. A draughtsman leaves
//! them lighter.

use super::mouth_box::{MouthBox, sorted};
use super::openings::openness;
use crate::raster::{Raster, dilate, fast_gaussian, median};
use crate::source::{Landmarks, outlines};

/// By how much teeth are lighter than the lips, and the most that they are lightened by: portraits 11, 13 and 16 have such teeth. With 0.3 and 0.35
/// the face finder's noses in charcoal are off by 3.4 % of the distance of the eyes in the median of sixteen portraits, with these by 2.8 %.
const LIGHTER: f32 = 0.2;
const MOST: f32 = 0.2;
/// Height over width of an opening between which teeth begin to count, and how far around it they are looked for, in widths of the face: the
/// mesh takes them for a part of the lower lip (11, 13).
const OPEN: [f64; 2] = [0.04, 0.08];
const AROUND: f64 = 0.03;
/// Pinkness by which lips must exceed teeth: below it there is no colour to go by. That of teeth is this quantile of what lies between
/// the lips, and they end at these shares of the way to the lips' own.
const LEAST_PINKER: f32 = 0.08;
const TEETH: f64 = 0.25;
const ENDS: [f32; 2] = [0.35, 0.6];
/// The tone below which a place is the dark of the mouth, and from which it may be a tooth.
const DARK: [f32; 2] = [0.15, 0.3];
/// Blur of the colour, in which photographs are coarse, and of the teeth's edge, in widths of the face.
const COARSE: f64 = 0.012;
const SOFT: f64 = 0.005;

/// The tone with teeth lighter than the lips, by the photograph's linear light; `strength` is that of the tone, 0 to 1.
pub(super) fn with_dim_teeth(mut tone: Raster<f32>, light: &Raster<[f32; 3]>, faces: &[Landmarks], strength: f32) -> Raster<f32> {
    for face in faces {
        let open = openness(&face.line(&outlines::MOUTH), OPEN);
        let Some(mut mouth) = MouthBox::of(face, light, 0.0).filter(|_| open > 0.0) else { continue };
        mouth.pinkness = fast_gaussian(&mouth.pinkness, (COARSE * face.width()) as f32);
        mouth.inner = dilate(&mouth.inner, (AROUND * face.width()) as usize).zip_map(&mouth.outer, u8::min);
        let part = tone.part(&mouth.columns, &mouth.rows);
        let Some(teeth) = teeth(&mouth, &part) else { continue };
        let of = |zone: &Raster<bool>| {
            let inside = part.pixels().iter().zip(zone.pixels()).filter(|(_, is)| **is);
            median(inside.map(|(v, _)| *v).collect())
        };
        let (Some(lips), Some(is)) = (of(&mouth.lips()), of(&teeth.map(|share| share > 0.5))) else { continue };
        let more = strength * open * (lips + LIGHTER - is).clamp(0.0, MOST);
        let soft = fast_gaussian(&teeth, (SOFT * face.width()) as f32);
        mouth.retone(&mut tone, |x, y, v| v + more * soft.get(x, y));
    }
    tone
}

/// Where the teeth of a face are, 0 to 1, in the box around its lips.
fn teeth(mouth: &MouthBox, tone: &Raster<f32>) -> Option<Raster<f32>> {
    let between = sorted(&mouth.pinkness, &mouth.inner.zip_map(tone, |inside, v| inside == 1 && v > DARK[1]));
    let of_teeth = *between.get((TEETH * between.len() as f64) as usize)?;
    let pinker = median(sorted(&mouth.pinkness, &mouth.lips()))? - of_teeth;
    if pinker < LEAST_PINKER {
        return None;
    }
    let share = mouth.pinkness.map(|pink| ((ENDS[1] - (pink - of_teeth) / pinker) / (ENDS[1] - ENDS[0])).clamp(0.0, 1.0));
    let lit = tone.map(|v| ((v - DARK[0]) / (DARK[1] - DARK[0])).clamp(0.0, 1.0));
    Some(share.zip_map(&lit, |share, lit| share * lit).zip_map(&mouth.inner, |share, inside| share * f32::from(inside)))
}

#[cfg(test)]
mod tests {
    use super::super::mouth_box::tests::with_mouth;
    use super::super::zones::polygon;
    use super::*;
    use crate::geometry::Point;

    #[test]
    fn teeth_in_the_shade_are_lighter_than_lips_and_the_dark_above_them_is_not() {
        let face = with_mouth(Point::new(60.0, 30.0));
        let mouth = polygon(120, 60, &face.line(&outlines::MOUTH));
        let light = Raster::from_fn(120, 60, |x, y| match (mouth.get(x, y) == 1, y < 22) {
            (true, true) => [0.02, 0.01, 0.01],
            (true, false) => [0.2, 0.19, 0.16],
            (false, _) => [0.4, 0.15, 0.15],
        });
        let tone = |teeth: f32| {
            let tone = Raster::from_fn(120, 60, |x, y| match (mouth.get(x, y) == 1, y < 22) {
                (true, true) => 0.05,
                (true, false) => teeth,
                (false, _) => 0.4,
            });
            with_dim_teeth(tone, &light, std::slice::from_ref(&face), 1.0)
        };
        let dim = tone(0.4);
        assert!(dim.get(60, 34) > 0.55 && dim.get(60, 18) < 0.1, "{} {}", dim.get(60, 34), dim.get(60, 18));
        assert!((tone(0.8).get(60, 34) - 0.8).abs() < 1e-6, "light ones stay");
    }
}
