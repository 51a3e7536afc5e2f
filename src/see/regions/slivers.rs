//! The shade along a jaw and a collar: as dark as hair, narrow, and between skin and clothing.

use super::plate::Plate;
use super::segmentation::{CLOTHING, HAIR, SKIN, Shares, greatest};
use crate::raster::{Raster, components, dilate, erode};

/// Half the width of the widest shade, in widths of the face: under jaws it is up to 0.1 wide (03), a lock beside a neck is wider.
const HALF_WIDTH: f32 = 0.05;
/// The smallest piece in squared widths of the face: smaller ones are crumbs of its border.
const LEAST: f32 = 0.004;
/// How far from broad hair narrow hair is its edge, in working pixels.
const EDGE: usize = 2;
/// Where it lies, in `u` and `v`: beside and below the mouth. Its middle is not below the second height, where tips of locks lie in front of
/// a neck (08).
const ASIDE: f32 = 0.72;
const BELOW: f32 = 0.3;
const LOWEST: f32 = -0.1;
/// Locks in front of the background are narrow too: how near it is, in working pixels, and the most of a piece that may be so.
const NEAR: usize = 3;
const MOST_NEAR: f32 = 0.1;
/// The least share of what surrounds a piece that is skin.
const LEAST_SKIN: f32 = 0.25;
/// From these shares of skin and of clothing a piece is between them, and more of it may be near the background: at a nape (09).
const BETWEEN: f32 = 0.3;
const MOST_NEAR_NAPE: f32 = 0.5;

/// The shares with the shade between skin and clothing as skin.
pub(super) fn without_slivers(plate: &Plate, mut shares: Raster<Shares>) -> Raster<Shares> {
    let class = shares.map(greatest);
    let (labels, count) = components(&narrow_hair(plate, &class));
    let beyond = dilate(&plate.inside.map(|is| u8::from(!is)), NEAR);
    for label in 1..=count {
        let piece = labels.map(|own| u8::from(own as usize == label));
        if is_shade(plate, &class, &piece, &beyond) {
            for (share, _) in shares.pixels_mut().iter_mut().zip(piece.pixels()).filter(|(_, is)| **is == 1) {
                share[SKIN] += share[HAIR];
                share[HAIR] = 0.0;
            }
        }
    }
    shares
}

/// 1 on hair beside and below the mouth that is narrower than a lock.
fn narrow_hair(plate: &Plate, class: &Raster<usize>) -> Raster<u8> {
    let hair = class.map(|class| u8::from(class == HAIR));
    let radius = (HALF_WIDTH * plate.face_width).round().max(1.0) as usize;
    let broad = dilate(&erode(&hair, radius), radius + EDGE);
    Raster::from_fn(plate.width(), plate.height(), |x, y| {
        let [u, v] = plate.at.get(x, y);
        u8::from(hair.get(x, y) == 1 && broad.get(x, y) == 0 && u.abs() < ASIDE && v < BELOW)
    })
}

/// True if a piece of narrow hair lies between skin and what is worn.
fn is_shade(plate: &Plate, class: &Raster<usize>, piece: &Raster<u8>, beyond: &Raster<u8>) -> bool {
    let pixels: Vec<usize> = (0..piece.len()).filter(|i| piece.pixels()[*i] == 1).collect();
    if (pixels.len() as f32) < LEAST * plate.face_width * plate.face_width {
        return false;
    }
    let ring = dilate(piece, 1).zip_map(piece, |around, piece| around - piece);
    let ring: Vec<usize> = (0..ring.len()).filter(|i| ring.pixels()[*i] == 1).collect();
    let share = |of: &[usize], is: &dyn Fn(usize) -> bool| of.iter().filter(|i| is(**i)).count() as f32 / of.len().max(1) as f32;
    let near = share(&pixels, &|i| beyond.pixels()[i] == 1);
    let skin = share(&ring, &|i| class.pixels()[i] == SKIN || plate.oval.pixels()[i]);
    let cloth = share(&ring, &|i| class.pixels()[i] == CLOTHING);
    let middle = pixels.iter().map(|i| plate.at.pixels()[*i][1]).sum::<f32>() / pixels.len().max(1) as f32;
    let is_between = near < MOST_NEAR_NAPE && skin > BETWEEN && cloth > BETWEEN;
    middle > LOWEST && ((near < MOST_NEAR && skin > LEAST_SKIN) || is_between)
}

#[cfg(test)]
mod tests {
    use super::super::tests::plate;
    use super::*;

    #[test]
    fn narrow_shade_under_a_jaw_is_skin_and_a_broad_lock_is_hair() {
        let plate = plate(&Raster::filled(200, 200, [120_u8; 3]));
        let share = |class: usize| std::array::from_fn(|k| f32::from(u8::from(k == class)));
        // A lock beside the cheek, a band from it under the jaw, skin above and clothing below.
        let band = |thickness: f32| {
            let shares: Raster<Shares> = Raster::from_fn(plate.width(), plate.height(), |x, y| {
                let [u, v] = plate.at.get(x, y);
                let is_lock = u > 0.62 && v > -0.3;
                let is_band = (0.1..0.62).contains(&u) && (0.02 - thickness..0.02).contains(&v);
                share(if is_lock || is_band {
                    HAIR
                } else if v > 0.02 {
                    SKIN
                } else {
                    CLOTHING
                })
            });
            let shares = without_slivers(&plate, shares);
            let at = |u: f32, v: f32| {
                let near = |i: &usize| {
                    let [own_u, own_v] = plate.at.pixels()[*i];
                    (own_u - u).powi(2) + (own_v - v).powi(2)
                };
                let nearest = (0..shares.len()).min_by(|a, b| near(a).total_cmp(&near(b)));
                greatest(shares.pixels()[nearest.expect("a pixel")])
            };
            [at(0.3, 0.02 - 0.5 * thickness), at(0.75, 0.3)]
        };
        assert_eq!(band(0.06), [SKIN, HAIR]);
        assert_eq!(band(0.3)[0], HAIR);
    }
}
