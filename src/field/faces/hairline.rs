//! Hair and headgear that extend into a face, detected by tone: darker than the skin, too tall for a feature, connected with the crown.

use super::super::dark_relief::dark_relief;
use super::features::{SkinTone, skin_tone};
use super::frame::{CROWN, FaceFrame};
use crate::elementary::Elementary as _;
use crate::geometry::Point;
use crate::raster::{Raster, components, dilate, remove_components};

/// Lightness relative to the skin's below which a place may be hair: blond hair has 0.6, a cheek turned away from a 2:1 light 0.85.
const HAIR_TONE: f32 = 0.8;
/// If the crown is darker than this, the limit lies this far from the crown's lightness towards the skin's: a shaded cheek and an ear
/// beside dark hair stay face, while a blond fringe blends into skin.
const DARK_HAIR: f32 = 0.58;
const HAIR_SPREAD: f32 = 0.2;
/// Inside an oval from the brows to the chin nothing counts as hair, since dark places there are shadows or features: half its width,
/// its middle and half its height, in eye distances.
const CORE: [f64; 3] = [0.95, 0.5, 0.97];
/// Half the width of gaps in the hair that are closed, in eye distances: a lit crown is as light as skin.
const GAP: f64 = 0.2;
/// The searched zone around a head.
const ZONE: [f64; 3] = [2.2, -2.4, 1.5];
/// Box of skin between brow and mouth that gives the skin's tone.
const CHEEKS: [f64; 3] = [0.75, -0.2, 0.95];
/// Width of the border's blur, which belongs to the hair, in eye distances.
const BORDER: f64 = 0.05;

/// 1 where hair or headgear of the subject covers a face whose pattern lies at `frame`.
pub fn hair_over_face(lightness: &Raster<f32>, subject: &Raster<f32>, frame: &FaceFrame) -> Raster<u8> {
    let relative = |x: usize, y: usize| frame.relative(Point::new(x as f64 + 0.5, y as f64 + 0.5));
    let within =
        |[breadth, top, bottom]: [f64; 3], (across, down): (f64, f64)| across.abs() < breadth && (top..bottom).contains(&down);
    let is_core = |(across, down): (f64, f64)| (across / CORE[0]).hypotenuse((down - CORE[1]) / CORE[2]) < 1.0;
    let (width, height) = (lightness.width(), lightness.height());
    let cheeks = Raster::from_fn(width, height, |x, y| f32::from(u8::from(within(CHEEKS, relative(x, y)))));
    let skin = skin_tone(lightness, &cheeks, frame, SkinTone::Found);
    let filled = dark_relief(lightness, frame.eye_distance).filled;
    let crown = crown_tone(&filled, subject, &skin, frame);
    let limit = if crown < DARK_HAIR { crown + HAIR_SPREAD * (1.0 - crown) } else { HAIR_TONE };
    let dark = Raster::from_fn(width, height, |x, y| {
        let place = relative(x, y);
        let is_free = within(ZONE, place) && !is_core(place) && subject.get(x, y) >= 0.5;
        u8::from(is_free && filled.get(x, y) < skin[x] * limit)
    });
    let (labels, count) = components(&dark);
    let mut crowned = vec![false; count + 1];
    for y in 0..height {
        for x in (0..width).filter(|x| labels.get(*x, y) != 0 && relative(*x, y).1 < CROWN) {
            crowned[labels.get(x, y) as usize] = true;
        }
    }
    let hair = remove_components(&dark, &labels, |label| crowned[label as usize]);
    let pixels = |share: f64| (share * frame.eye_distance).round() as usize;
    let grown = dilate(&hair, pixels(GAP + BORDER)).map(|hair| 1 - hair);
    dilate(&grown, pixels(GAP)).map(|free| 1 - free)
}

/// Median lightness, relative to the skin's, of the subject's crown where it is darker than skin; 1 if nothing is.
fn crown_tone(filled: &Raster<f32>, subject: &Raster<f32>, skin: &[f32], frame: &FaceFrame) -> f32 {
    let mut tones = Vec::new();
    for y in 0..filled.height() {
        for x in (0..filled.width()).filter(|x| subject.get(*x, y) >= 0.5) {
            let (across, down) = frame.relative(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            let tone = filled.get(x, y) / skin[x].max(0.02);
            if across.abs() < ZONE[0] && (ZONE[1]..CROWN).contains(&down) && tone < HAIR_TONE {
                tones.push(tone);
            }
        }
    }
    tones.sort_unstable_by(f32::total_cmp);
    tones.get(tones.len() / 2).copied().unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fringe_is_hair_and_a_brow_is_not() {
        let frame = FaceFrame {
            between_eyes: Point::new(100.0, 150.0),
            eye_distance: 60.0,
            stretch: 1.0,
            tilt: 0.0,
            score: 0.3,
            windows: crate::field::USUAL_WINDOWS,
        };
        let page = Raster::from_fn(200, 300, |_, y| if y < 120 || (129..134).contains(&y) { 0.4 } else { 0.8 });
        let hair = hair_over_face(&page, &Raster::filled(200, 300, 1.0), &frame);
        assert_eq!((hair.get(100, 60), hair.get(100, 118), hair.get(100, 131), hair.get(100, 200)), (1, 1, 0, 0));
    }
}
