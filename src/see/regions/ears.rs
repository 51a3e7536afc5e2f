//! The ear of a turned head in shade: as dark as black hair, but red where that has no colour.

use super::hair::Hair;
use super::plate::Plate;
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

#[cfg(test)]
mod tests {
    use super::super::mixture::Mixture;
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
}
