//! Ears: hair is not learned from them, and what has their place and suits skin better is one. That of a turned head in shade is as dark as
//! black hair, but red where that has no colour.

use super::hair::Hair;
use super::mixture::Mixture;
use super::plate::Plate;
use super::segmentation::{HAIR, SKIN, Segmentation};
use super::skin_model::LEAST_SEEDS;
use crate::elementary::Elementary as _;
use crate::raster::{Raster, close, components, dilate, gaussian_blur, open};

/// Chroma up to which hair has no colour. Brown hair in light has the red of an ear in shade.
const COLOURLESS: f32 = 5.0;
/// How much redder than the hair an ear in shade is, in a*, and the blur in working pixels under which it is.
const REDDER: f32 = 2.5;
const BLUR: f32 = 1.5;
/// How far the chin of a turned head is from the middle, in `u`: it shows an ear whole, behind the cheek. Cheeks and temples of other heads are
/// as red.
const TURNED: f32 = 0.15;
/// L* up to which an ear is in shade.
const SHADE: f32 = 40.0;
/// Where ears are: from the lobe to the rim in `v`, and how far beside the oval, in widths of the face.
const HEIGHTS: [f32; 2] = [0.25, 0.72];
const BESIDE: f32 = 0.3;
/// Half the width in working pixels of what is too narrow for an ear, and of its folds: faces have 110 pixels; in those of less than 60 no ear in
/// shade is found.
const THIN: usize = 2;
const FOLD: usize = 3;
/// Its least and greatest area, in squared widths of the face, and the least height, in heights of the face.
const AREA: [f32; 2] = [0.012, 0.12];
const TALL: f32 = 0.2;

/// The pixels of the ear in shade of a turned head beside hair without colour; none where hair falls. Tuned on one portrait and its copies in
/// other light; on fifty other heads it finds none.
pub(super) fn ears_in_shade(plate: &Plate, hair: &Hair) -> Raster<bool> {
    let chin = plate.chin();
    if plate.is_grey || chin.abs() < TURNED || hair.middle[1].hypotenuse(hair.middle[2]) > COLOURLESS {
        return plate.oval.map(|_| false);
    }
    let red = gaussian_blur(&plate.lab.map(|c| c[1]), BLUR);
    let near = dilate(&plate.oval.map(u8::from), (BESIDE * plate.face_width) as usize);
    let is_red = plate.pixels_where(|[u, v], i| {
        let is_there = plate.inside.pixels()[i] && near.pixels()[i] != 0 && !plate.core.pixels()[i] && u * chin < 0.0;
        // An ear is smoother than hair.
        let is_dark = plate.lab.pixels()[i][0] < SHADE && plate.features.pixels()[i][3] < hair.middle[3];
        is_there
            && is_dark
            && (HEIGHTS[0]..HEIGHTS[1]).contains(&v)
            && !hair.falls(u)
            && red.pixels()[i] > hair.middle[1] + REDDER
    });
    let is_red = close(&open(&is_red.map(u8::from), THIN), FOLD);
    let (labels, count) = components(&is_red);
    let mut sizes = vec![(0_usize, f32::MAX, f32::MIN); count + 1];
    for (i, label) in labels.pixels().iter().enumerate() {
        let (size, v) = (&mut sizes[*label as usize], plate.at.pixels()[i][1]);
        *size = (size.0 + 1, size.1.min(v), size.2.max(v));
    }
    let whole = plate.face_width * plate.face_width;
    let is_ear =
        |&(area, low, high): &(usize, f32, f32)| (AREA[0] * whole..AREA[1] * whole).contains(&(area as f32)) && high - low > TALL;
    plate.pixels_where(|[u, _], i| labels.pixels()[i] != 0 && !hair.falls(u) && is_ear(&sizes[labels.pixels()[i] as usize]))
}

impl Segmentation<'_> {
    /// The places where hair is learned without those beside the cheeks that suit the skin better than the hair above them: ears in shade.
    pub(super) fn without_ears(&self, seeds: Raster<bool>) -> Raster<bool> {
        /// Heights of ears in `v`.
        const HEIGHTS: [f32; 2] = [0.2, 0.75];
        /// How much likelier skin is, in natural logarithms.
        const LIKELIER: f32 = 4.0;
        /// Normal distributions in the mixture of the hair above the ears.
        const HAIRS: usize = 3;
        let plate = self.plate;
        let above = plate.samples(&plate.pixels_where(|[_, v], i| seeds.pixels()[i] && v > HEIGHTS[1]));
        let Some(hair) = Mixture::fitted(&above, HAIRS).filter(|_| above.len() > LEAST_SEEDS) else { return seeds };
        plate.pixels_where(|[_, v], i| {
            let may_be_ear = (HEIGHTS[0]..HEIGHTS[1]).contains(&v) && self.lighting.is_near_face(i);
            let suits = hair.log_density(plate.features.pixels()[i]);
            seeds.pixels()[i] && !(may_be_ear && self.skin_density(i) > suits + LIKELIER)
        })
    }

    /// Whether a piece of skin that does not touch the face may be an ear: it is like the face's skin, or suits skin far better than
    /// hair, in a size and at a place of ears, where no hair falls. The folds of ears have more texture than a face.
    pub(super) fn may_be_ear(&self, pixels: &[usize]) -> bool {
        /// Mean squared deviation from skin, and how much better skin suits, in natural logarithms.
        const LIKE_SKIN: f32 = 6.0;
        const BETTER: f32 = 6.0;
        /// Least area in squared widths of the face, and the share of it that lies within an ear's width of the face.
        const AREA: f32 = 0.01;
        const NEAR: f32 = 0.7;
        let mean = |of: &dyn Fn(usize) -> f32| pixels.iter().map(|&i| of(i)).sum::<f32>() / pixels.len().max(1) as f32;
        if mean(&|i| self.from_skin.pixels()[i].min(40.0)) < LIKE_SKIN {
            return true;
        }
        let better = |i: usize| {
            let suits = self.class_scores(i);
            suits[SKIN] - suits[HAIR]
        };
        let is_large = pixels.len() as f32 > AREA * self.plate.face_width * self.plate.face_width;
        is_large
            && !self.falls(mean(&|i| self.plate.at.pixels()[i][0]))
            && mean(&|i| f32::from(u8::from(self.lighting.is_near_face(i)))) > NEAR
            && mean(&better) > BETTER
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::plate_with;
    use super::*;

    /// The ear of a head with its chin on the picture's right, as red as asked for, beside black hair.
    fn ears(red: u8, chin: f64) -> usize {
        let is_ear = |x: usize, y: usize| (50..60).contains(&x) && (64..92).contains(&y);
        let pixels = Raster::from_fn(200, 200, |x, y| match (x, y) {
            (x, y) if is_ear(x, y) => [30 + red, 30, 30],
            // Two hues of one lightness: it is no toned photograph.
            (85..115, 60..90) => [110, 130, 200],
            (65..135, 40..110) => [170, 120, 100],
            _ => [25_u8; 3],
        });
        let plate = plate_with(&pixels, &[(152, [chin, 120.0]), (10, [chin, 20.0])]);
        let middle = [plate.lab.get(5, 5)[0], 0.0, 0.0, 90.0];
        let mixture = Mixture::fitted(&[middle; 4], 1).expect("a mixture");
        let hair = Hair::of(mixture, middle, (plate.width(), plate.height()));
        ears_in_shade(&plate, &hair).pixels().iter().filter(|is| **is).count()
    }

    #[test]
    fn the_red_ear_of_a_turned_head_is_found_and_no_other() {
        assert!(ears(40, 120.0) > 100, "{}", ears(40, 120.0));
        assert_eq!(ears(0, 120.0), 0, "hair");
        assert_eq!(ears(40, 100.0), 0, "a head that is not turned");
        assert_eq!(ears(40, 80.0), 0, "the far side");
    }

    /// A head with black hair and brown skin, whose ear on the picture's right is this many times as light as the cheeks.
    fn with_ear(light: f32, see: impl FnOnce(&Segmentation<'_>, &Raster<bool>)) {
        let is_ear = |x: usize, y: usize| (141..153).contains(&x) && (62..86).contains(&y);
        let pixels = Raster::from_fn(200, 200, |x, y| match (x, y) {
            (x, y) if is_ear(x, y) => [170.0, 120.0, 100.0].map(|v| (v * light) as u8),
            (60..140, 30..110) => [170, 120, 100],
            // The hair ends above the mouth.
            (_, 88..) => [110, 130, 200],
            _ => [25_u8 + (3 * x + 7 * y) as u8 % 9; 3],
        });
        let plate = plate_with(&pixels, &[]);
        let parting = Segmentation::learned(&plate, None);
        let scale = plate.scale as f32;
        let ear = plate.pixels_where(|_, i| {
            let (x, y) = ((i % plate.width()) as f32 / scale, (i / plate.width()) as f32 / scale);
            is_ear((x + plate.part.x0 as f32) as usize, (y + plate.part.y0 as f32) as usize)
        });
        see(&parting, &ear);
    }

    #[test]
    fn hair_is_not_learned_from_an_ear_and_an_ear_apart_from_the_face_is_skin() {
        with_ear(0.75, |parting, ear| {
            let all = parting.plate.oval.map(|is| !is);
            let kept = parting.without_ears(all.clone());
            let lost = |of: &Raster<bool>| of.pixels().iter().zip(kept.pixels()).filter(|(is, kept)| **is && !**kept).count();
            let size = ear.pixels().iter().filter(|is| **is).count();
            assert!(2 * lost(ear) > size, "{} of {size}", lost(ear));
            let pixels: Vec<usize> = (0..ear.pixels().len()).filter(|i| ear.pixels()[*i]).collect();
            assert!(parting.may_be_ear(&pixels));
            let crown = parting.plate.pixels_where(|[_, v], _| v > 1.0);
            let hair: Vec<usize> = (0..crown.pixels().len()).filter(|i| crown.pixels()[*i]).collect();
            assert!(hair.len() > pixels.len());
            assert!(!parting.may_be_ear(&hair));
        });
    }
}
