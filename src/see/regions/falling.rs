//! Hair that falls past the jaw, and over the side of the face.

use super::plate::Plate;
use crate::raster::{Raster, components, open};

/// Heights between which falling hair has no gap, in `v`: from the lips to the chin; those that are looked at, and where beside the head.
const FROM: f32 = 0.5;
const BAND: f32 = 0.05;
const BANDS: usize = 10;
const ASIDE: [f32; 2] = [0.3, 1.2];
/// Its least width at every height, in widths of the face. On the sides of 34 heads (sixteen portraits, two samples, sixteen of people in
/// company) long hair had at least 0.08, but for one thin lock, and other hair at most 0.05, but for full beards, bald heads and black shadow,
/// which are not asked.
const LEAST_WIDTH: f32 = 0.06;

/// True if hair continues from beside the lips to beside the chin on a side of the picture (-1 left, 1 right).
pub(super) fn falls_past_jaw(plate: &Plate, is_hair: &Raster<bool>, side: f32) -> bool {
    let mut counts = [0_usize; BANDS];
    for ([u, v], is) in plate.at.pixels().iter().zip(is_hair.pixels()) {
        let band = (FROM - v) / BAND;
        let is_beside = band >= 0.0 && (ASIDE[0]..ASIDE[1]).contains(&(side * u));
        if let Some(count) = counts.get_mut(band as usize).filter(|_| *is && is_beside) {
            *count += 1;
        }
    }
    let height = f64::from(BAND) * plate.head.height * plate.scale;
    let least = LEAST_WIDTH * plate.face_width * height as f32;
    counts.iter().all(|count| *count as f32 >= least)
}

/// The outer corners of the eyes, on the left and right of the picture.
const CORNERS: [usize; 2] = [33, 263];
/// How far outside them hair may cover the face, in widths of the face; below what height: above it fringes hang, of any place.
const BESIDE_EYES: f32 = 0.04;
const BELOW: f32 = 0.85;
/// Half the width in working pixels of what is too narrow for hair: frames of spectacles.
const THIN: usize = 2;

/// The pixels of the face that hair covers which falls beside it, on the sides (left, right) where it does.
pub(super) fn over_face(plate: &Plate, is_hair: &Raster<bool>, sides: [bool; 2]) -> Raster<bool> {
    let corners = CORNERS.map(|corner| plate.coordinates(plate.point(corner))[0]);
    let is_beside = |u: f32| (sides[0] && u < corners[0] - BESIDE_EYES) || (sides[1] && u > corners[1] + BESIDE_EYES);
    let covered = plate.pixels_where(|[u, v], i| is_hair.pixels()[i] && (!plate.oval.pixels()[i] || (v < BELOW && is_beside(u))));
    let covered = open(&covered.map(u8::from), THIN);
    let (labels, count) = components(&covered);
    let mut reaches_out = vec![false; count + 1];
    for (label, is_face) in labels.pixels().iter().zip(plate.oval.pixels()) {
        reaches_out[*label as usize] |= !is_face;
    }
    plate.pixels_where(|_, i| {
        let label = labels.pixels()[i] as usize;
        label != 0 && reaches_out[label] && plate.oval.pixels()[i]
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::plate;
    use super::*;

    /// Hair on the right of the picture down to a height in `v`, from a place across on.
    fn hair(plate: &Plate, to: f32, from: f32) -> Raster<bool> {
        plate.pixels_where(|[u, v], _| u > from && u < 0.7 && v > to)
    }

    #[test]
    fn hair_to_the_shoulders_falls_past_the_jaw_and_a_bob_does_not() {
        let plate = plate(&Raster::filled(200, 200, [120_u8; 3]));
        assert!(falls_past_jaw(&plate, &hair(&plate, -0.5, 0.5), 1.0));
        assert!(!falls_past_jaw(&plate, &hair(&plate, 0.1, 0.5), 1.0), "it ends beside the mouth");
        assert!(!falls_past_jaw(&plate, &hair(&plate, -0.5, 0.5), -1.0), "the other side");
        assert!(!falls_past_jaw(&plate, &hair(&plate, -0.5, 0.67), 1.0), "a thin strand");
    }

    #[test]
    fn hair_covers_the_cheek_that_it_hangs_over_and_no_island_in_the_face() {
        let plate = plate(&Raster::filled(200, 200, [120_u8; 3]));
        let covered = |hair: &Raster<bool>, sides| over_face(&plate, hair, sides).pixels().iter().filter(|is| **is).count();
        let hanging = hair(&plate, -0.5, 0.33);
        assert!(covered(&hanging, [false, true]) > 100);
        assert_eq!(covered(&hanging, [true, false]), 0, "it does not fall on that side");
        let island = plate.pixels_where(|[u, v], _| u > 0.31 && u < 0.4 && (v - 0.5).abs() < 0.1);
        assert_eq!(covered(&island, [false, true]), 0, "it does not reach out of the face");
    }
}
