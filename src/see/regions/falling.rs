//! Hair that falls past the jaw, and over the side of the face.

use super::plate::Plate;
use crate::raster::{Raster, close, components, open};

/// Heights between which falling hair has no gap, in `v`: from the upper lip to the chin; and where beside the head.
const FROM: f32 = 0.4;
const BAND: f32 = 0.05;
const BANDS: usize = 8;
const ASIDE: [f32; 2] = [0.3, 1.2];
/// Height that it hangs from: a dark collar below short hair does not. And half the width of gaps that are none, in working pixels: strands in the
/// light.
const TEMPLE: f32 = 0.5;
const GAP: usize = 1;
/// Its least width at every height, in widths of the face. On the sides of 34 heads (sixteen portraits, two samples, sixteen of people in
/// company) long hair has at least 0.07 and other hair at most 0.05, but for full beards, bald heads and black shadow, which are not asked.
const LEAST_WIDTH: f32 = 0.06;

/// Whether hair continues from the temple past the jaw on the picture's left and right, in one piece. Plates of tiny faces are too coarse to tell.
pub(super) fn falls_past_jaw(plate: &Plate, is_hair: &Raster<bool>) -> [bool; 2] {
    let is_hair = close(&is_hair.map(u8::from), GAP);
    let (labels, count) = components(&is_hair);
    let side = |u: f32| usize::from(u > 0.0);
    let mut hangs = vec![[false; 2]; count + 1];
    for ([u, v], label) in plate.at.pixels().iter().zip(labels.pixels()) {
        hangs[*label as usize][side(*u)] |= *label != 0 && *v > TEMPLE;
    }
    let mut counts = [[0_usize; BANDS]; 2];
    for ([u, v], label) in plate.at.pixels().iter().zip(labels.pixels()) {
        let band = (FROM - v) / BAND;
        let is_counted = band >= 0.0 && (ASIDE[0]..ASIDE[1]).contains(&u.abs()) && hangs[*label as usize][side(*u)];
        if let Some(count) = counts[side(*u)].get_mut(band as usize).filter(|_| is_counted) {
            *count += 1;
        }
    }
    let height = f64::from(BAND) * plate.head.height * plate.scale;
    let least = LEAST_WIDTH * plate.face_width * height as f32;
    counts.map(|bands| bands.iter().all(|count| *count as f32 >= least))
}

/// The outer corners of the eyes, on the left and right of the picture.
const CORNERS: [usize; 2] = [33, 263];
/// How far outside them hair may cover the face, in widths of the face, and below what height: above it fringes hang. In a portrait of a turned
/// head the hair begins at the corner.
const BESIDE_EYES: f32 = 0.04;
const BELOW: f32 = 0.85;
/// The height where the hair of temples ends, in `v`: below it a cheek in shade is as dark.
const SIDEBURNS: f32 = 0.35;
/// Half the width in working pixels of what is too narrow for hair: frames of spectacles.
const THIN: usize = 2;

/// The pixels of the face that hair covers: hair that falls beside it, on the sides (left, right) where it does, and on the others the hair of
/// temples, which a turned head brings into the face's outline, down to the sideburns.
pub(super) fn over_face(plate: &Plate, is_hair: &Raster<bool>, sides: [bool; 2]) -> Raster<bool> {
    let corners = CORNERS.map(|corner| plate.coordinates(plate.point(corner))[0]);
    let lowest = sides.map(|falls| if falls { f32::MIN } else { SIDEBURNS });
    let is_beside =
        |u: f32, v: f32| (u < corners[0] - BESIDE_EYES && v > lowest[0]) || (u > corners[1] + BESIDE_EYES && v > lowest[1]);
    let covered =
        plate.pixels_where(|[u, v], i| is_hair.pixels()[i] && (!plate.oval.pixels()[i] || (v < BELOW && is_beside(u, v))));
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

/// Height of a fringe, in `v`: from above the brows. And where hair is without doubt, from which it hangs.
const ABOVE_BROWS: f32 = 0.8;
const CROWN: f32 = 1.05;

/// The pixels of a fringe over the forehead, among those that may be one: in one piece with what may be hair on the crown.
pub(super) fn fringe(plate: &Plate, may_be: &Raster<bool>) -> Raster<bool> {
    let low = plate.pixels_where(|[_, v], i| may_be.pixels()[i] && v > ABOVE_BROWS);
    let low = open(&low.map(u8::from), THIN);
    let (labels, count) = components(&low);
    let mut hangs = vec![false; count + 1];
    for ([_, v], label) in plate.at.pixels().iter().zip(labels.pixels()) {
        hangs[*label as usize] |= *label != 0 && *v > CROWN;
    }
    labels.map(|label| hangs[label as usize])
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
        assert_eq!(falls_past_jaw(&plate, &hair(&plate, -0.5, 0.5)), [false, true]);
        assert_eq!(falls_past_jaw(&plate, &hair(&plate, 0.1, 0.5)), [false; 2], "it ends beside the mouth");
        assert_eq!(falls_past_jaw(&plate, &hair(&plate, -0.5, 0.67)), [false; 2], "a thin strand");
        let collar = hair(&plate, -0.5, 0.5).zip_map(&hair(&plate, 0.42, 0.5), |all, above| all && !above);
        let cap = hair(&plate, 0.55, 0.5);
        assert_eq!(falls_past_jaw(&plate, &collar.zip_map(&cap, |a, b| a || b)), [false; 2], "a collar below short hair");
    }

    #[test]
    fn hair_covers_the_cheek_that_it_hangs_over_and_no_island_in_the_face() {
        let plate = plate(&Raster::filled(200, 200, [120_u8; 3]));
        let covered = |hair: &Raster<bool>, sides| over_face(&plate, hair, sides).pixels().iter().filter(|is| **is).count();
        let lowest = |hair: &Raster<bool>, sides| {
            let over = over_face(&plate, hair, sides);
            let heights = plate.at.pixels().iter().zip(over.pixels()).filter(|(_, is)| **is).map(|([_, v], _)| *v);
            heights.fold(f32::MAX, f32::min)
        };
        let hanging = hair(&plate, -0.5, 0.33);
        assert!(covered(&hanging, [false, true]) > 100);
        assert!(lowest(&hanging, [false, true]) < 0.3);
        assert!(covered(&hanging, [true, false]) > 50);
        assert!(lowest(&hanging, [true, false]) > SIDEBURNS, "it does not fall on that side: only the temple's");
        let island = plate.pixels_where(|[u, v], _| u > 0.31 && u < 0.4 && (v - 0.5).abs() < 0.1);
        assert_eq!(covered(&island, [false, true]), 0, "it does not reach out of the face");
    }

    #[test]
    fn a_fringe_hangs_from_the_crown_and_shade_on_a_forehead_does_not() {
        let plate = plate(&Raster::filled(200, 200, [120_u8; 3]));
        let count = |may_be: &Raster<bool>, from: f32, to: f32| {
            let fringe = fringe(&plate, may_be);
            plate.at.pixels().iter().zip(fringe.pixels()).filter(|([_, v], is)| **is && (from..to).contains(v)).count()
        };
        let fringe = plate.pixels_where(|[u, v], _| u.abs() < 0.3 && v > 0.6 && v < 1.2);
        assert!(count(&fringe, 0.85, 1.0) > 100);
        assert_eq!(count(&fringe, 0.0, ABOVE_BROWS), 0, "brows");
        let shade = plate.pixels_where(|[u, v], _| u.abs() < 0.3 && v > 0.85 && v < 1.0);
        assert_eq!(count(&shade, 0.0, 2.0), 0, "it has skin above it");
    }
}
