//! Gums: as light as teeth in most photographs, but as red as lips. White, they make a slab of a laughing mouth.

use super::mouth_box::{MouthBox, sorted};
use super::openings::{MOUTH_OPEN, openness};
use crate::raster::{Raster, fast_gaussian, median};
use crate::source::{Landmarks, outlines};

/// Redness by which lips must exceed teeth: below it there is no colour to go by.
const LEAST_REDDER: f32 = 0.08;
/// The redness of teeth, as a quantile of that between the lips: a throat and a tongue are redder.
const TEETH: f64 = 0.25;
/// Where gums begin between the teeth's redness and the lips', and from where they are in full.
const GUMS: [f32; 2] = [0.25, 0.45];
/// The lightest tone of gums, and the share of their lights that is left above it: without lights they are lips.
const LIGHTEST: f32 = 0.55;
const LIGHTS: f32 = 0.3;
/// Blur of their edge in widths of the face.
const SOFT: f64 = 0.005;

/// The tone with gums darker than teeth, by the photograph's linear light; `strength` is that of the tone, 0 to 1.
pub(super) fn with_gums(mut tone: Raster<f32>, light: &Raster<[f32; 3]>, faces: &[Landmarks], strength: f32) -> Raster<f32> {
    for face in faces {
        let open = openness(&face.line(&outlines::MOUTH), MOUTH_OPEN);
        if open == 0.0 {
            continue;
        }
        let Some(mouth) = MouthBox::of(face, light, 0.0) else { continue };
        let Some(gums) = gums(&mouth, face.width()) else { continue };
        mouth.retone(&mut tone, |x, y, v| {
            let less = (1.0 - LIGHTS) * (v - LIGHTEST).max(0.0);
            v - strength * open * gums.get(x, y) * less
        });
    }
    tone
}

/// Where the gums of a face are, 0 to 1, in the box around its lips.
fn gums(mouth: &MouthBox, width: f64) -> Option<Raster<f32>> {
    let between = sorted(&mouth.redness, &mouth.inner.map(|inside| inside == 1));
    let teeth = *between.get((TEETH * between.len() as f64) as usize)?;
    let redder = median(sorted(&mouth.redness, &mouth.lips()))? - teeth;
    if redder < LEAST_REDDER {
        return None;
    }
    let share = mouth.redness.map(|red| (((red - teeth) / redder - GUMS[0]) / (GUMS[1] - GUMS[0])).clamp(0.0, 1.0));
    let gums = share.zip_map(&mouth.inner, |share, inside| share * f32::from(inside));
    Some(fast_gaussian(&gums, (SOFT * width) as f32))
}

#[cfg(test)]
mod tests {
    use super::super::mouth_box::tests::with_mouth;
    use super::super::zones::polygon;
    use super::*;
    use crate::geometry::Point;
    use crate::source::outlines;

    #[test]
    fn gums_are_darker_than_teeth_in_colour_and_as_they_are_in_grey() {
        let face = with_mouth(Point::new(60.0, 30.0));
        let mouth = polygon(120, 60, &face.line(&outlines::MOUTH));
        let light = Raster::from_fn(120, 60, |x, y| match (mouth.get(x, y) == 1, y < 22) {
            (true, true) => [0.8, 0.5, 0.5],
            (true, false) => [0.8, 0.78, 0.7],
            (false, _) => [0.4, 0.15, 0.15],
        });
        let tone = Raster::filled(120, 60, 0.9);
        let in_colour = with_gums(tone.clone(), &light, std::slice::from_ref(&face), 1.0);
        assert!(in_colour.get(60, 18) < 0.75, "{}", in_colour.get(60, 18));
        assert!(in_colour.get(60, 34) > 0.89, "{}", in_colour.get(60, 34));
        assert_eq!(with_gums(tone.clone(), &light.map(|[r, ..]| [r; 3]), &[face], 1.0), tone);
    }
}
