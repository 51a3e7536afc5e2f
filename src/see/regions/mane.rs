//! Hair that stands out beside the ears: its place tells it where its colour is that of skin in shade.

use super::plate::Plate;
use super::skin_model::{NO_SKIN, Skin};
use crate::raster::Raster;

/// Where no head has skin: beyond the ears, in `u`, and not as far as a neighbour; its lowest height in `v`, and the bands above it.
const BESIDE: [f32; 2] = [0.62, 1.1];
const FROM: f32 = 0.2;
const BAND: f32 = 0.1;
const BANDS: usize = 6;
/// How much more texture than the face it has, and the least share of what has skin's colour there that does. Hair of three heads that was taken for
/// skin has 6 to 13 more in a share of 0.8 to 1; arms beside two heads have it at their borders alone, in a share of 0.27 and 0.37.
const ROUGHER: f32 = 3.0;
const ROUGH: f32 = 0.6;
/// Its least width in every band, in `u`: of 93 heads those with such hair have at least 0.074, a bearded man with other people behind him 0.055.
const LEAST_WIDTH: f32 = 0.065;
/// How far a head may be turned to this side, by its chin in `u`: the face of a profile lies there, from 0.4 on.
const TURNED: f32 = 0.2;
/// The least share of it that has skin's colour: elsewhere colour tells. Hair that was taken for skin has 0.6 to 0.9, most other hair below 0.35.
const LIKE_SKIN: f32 = 0.4;

/// Least width of a face in working pixels: texture reaches over eight of them.
const LEAST_FACE: f32 = 40.0;

/// The hair of skin's colour that stands out beside the ears, at every height from the mouth to above the eyes; and on which sides there is some,
/// the picture's left and right.
pub(super) fn manes(plate: &Plate, skin: &Skin, from_skin: &Raster<f32>) -> (Raster<bool>, [bool; 2]) {
    let there = plate.pixels_where(|[u, v], i| {
        let is_there = (BESIDE[0]..BESIDE[1]).contains(&u.abs()) && (FROM..FROM + BAND * BANDS as f32).contains(&v);
        is_there && plate.inside.pixels()[i] && !plate.oval.pixels()[i]
    });
    let is_like_skin = from_skin.map(|far| far <= NO_SKIN);
    let is_rough = plate.features.map(|f| f[3] > skin.middle[3] + ROUGHER);
    let is_smooth_skin = is_like_skin.zip_map(&is_rough, |like, rough| like && !rough);
    let hair = there.zip_map(&is_smooth_skin, |there, smooth| there && !smooth);
    let sides = [-1.0, 1.0].map(|sign| {
        let count = |of: &Raster<bool>| {
            let each = plate.at.pixels().iter().zip(there.pixels().iter().zip(of.pixels()));
            each.filter(|([u, _], (there, is))| **there && **is && u * sign > 0.0).count() as f32
        };
        let (like, smooth) = (count(&is_like_skin), count(&is_smooth_skin));
        let is_rough = like - smooth > ROUGH * like;
        let is_like_skin = like - smooth > LIKE_SKIN * count(&hair);
        is_rough && is_like_skin && is_wide(plate, &hair, sign) && may_stand_out(plate, sign)
    });
    (plate.pixels_where(|[u, _], i| hair.pixels()[i] && sides[usize::from(u > 0.0)]), sides)
}

/// True if what stands out on the side of `sign` is wide enough at every height.
fn is_wide(plate: &Plate, hair: &Raster<bool>, sign: f32) -> bool {
    let mut counts = [0_usize; BANDS];
    for ([u, v], is_hair) in plate.at.pixels().iter().zip(hair.pixels()) {
        if *is_hair && u * sign > 0.0 {
            counts[(((v - FROM) / BAND) as usize).min(BANDS - 1)] += 1;
        }
    }
    let area = f64::from(BAND) * plate.head.height * plate.head.width * plate.scale * plate.scale;
    counts.iter().all(|count| *count as f32 >= LEAST_WIDTH * area as f32)
}

/// True where place and texture can tell hair: in colour, on a face that is large enough and not turned to this side.
fn may_stand_out(plate: &Plate, sign: f32) -> bool {
    !plate.is_grey && plate.face_width >= LEAST_FACE && plate.chin() * sign < TURNED
}

#[cfg(test)]
mod tests {
    use super::super::tests::plate;
    use super::*;

    const WALL: [u8; 3] = [80, 110, 180];

    /// A face with something on the picture's right, from the crown to a row, in locks of this contrast; all as far from skin's colour as asked for.
    fn sides(contrast: u8, to: usize, far: f32) -> [bool; 2] {
        let is_beside = |x: usize, y: usize| (140..172).contains(&x) && (10..to).contains(&y);
        let pixels = Raster::from_fn(200, 200, |x, y| match (x, y) {
            (x, y) if is_beside(x, y) && x % 4 < 2 => [150 - contrast, 110 - contrast, 90 - contrast],
            (x, y) if is_beside(x, y) || (60..140).contains(&x) => [150, 110, 90],
            _ => WALL,
        });
        let mut plate = plate(&pixels);
        assert!(!plate.is_grey);
        plate.inside = Raster::from_fn(plate.width(), plate.height(), |x, y| pixels.get(x, y) != WALL);
        manes(&plate, &Skin::learned(&plate), &plate.oval.map(|_| far)).1
    }

    #[test]
    fn locks_of_skins_colour_beside_the_ear_are_hair_and_an_arm_is_not() {
        assert_eq!(sides(40, 140, 0.0), [false, true]);
        assert_eq!(sides(0, 140, 0.0), [false; 2], "a raised arm is smooth but for its border");
        assert_eq!(sides(40, 80, 0.0), [false; 2], "it ends above the mouth");
        assert_eq!(sides(40, 140, 2.0 * NO_SKIN), [false; 2], "its colour tells it");
    }
}
