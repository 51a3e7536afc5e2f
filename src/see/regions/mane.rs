//! Hair that stands out beside the ears: its place tells it where its colour is that of skin in shade.

use super::plate::Plate;
use super::skin_model::{NO_SKIN, Skin};
use crate::raster::Raster;

/// Where no head has skin: beyond the ears, in `u`, and not as far as a neighbour; its lowest height in `v`, and the bands above it.
const BESIDE: [f32; 2] = [0.62, 1.1];
const FROM: f32 = 0.2;
const BAND: f32 = 0.1;
const BANDS: usize = 6;
/// How much more texture than the face it has: raised arms have as much as the face, or less.
const ROUGHER: f32 = 3.0;
/// Its least width in every band, in `u`.
const LEAST_WIDTH: f32 = 0.06;
/// How far a head may be turned to this side, by its chin in `u`: there is the face of a profile.
const TURNED: f32 = 0.2;
/// The least share of it that has skin's colour: elsewhere colour tells.
const LIKE_SKIN: f32 = 0.4;

/// The hair of skin's colour that stands out beside the ears, from the mouth to above the eyes without a gap; and on which sides there is some, the
/// picture's left and right.
pub(super) fn manes(plate: &Plate, skin: &Skin, from_skin: &Raster<f32>) -> (Raster<bool>, [bool; 2]) {
    let is_rough = |i: usize| plate.features.pixels()[i][3] > skin.middle[3] + ROUGHER;
    let all = plate.pixels_where(|[u, v], i| {
        let is_there = (BESIDE[0]..BESIDE[1]).contains(&u.abs()) && (FROM..FROM + BAND * BANDS as f32).contains(&v);
        is_there && plate.inside.pixels()[i] && !plate.oval.pixels()[i] && (from_skin.pixels()[i] > NO_SKIN || is_rough(i))
    });
    let sides = [-1.0, 1.0].map(|sign| is_mane(plate, &all, from_skin, sign));
    (plate.pixels_where(|[u, _], i| all.pixels()[i] && sides[usize::from(u > 0.0)]), sides)
}

/// True if what stands out on the side of `sign` is wide enough at every height, and much of it has skin's colour.
fn is_mane(plate: &Plate, all: &Raster<bool>, from_skin: &Raster<f32>, sign: f32) -> bool {
    let (mut counts, mut like_skin) = ([0_usize; BANDS], 0_usize);
    for (i, [_, v]) in plate.at.pixels().iter().enumerate().filter(|(i, [u, _])| all.pixels()[*i] && u * sign > 0.0) {
        counts[(((v - FROM) / BAND) as usize).min(BANDS - 1)] += 1;
        like_skin += usize::from(from_skin.pixels()[i] <= NO_SKIN);
    }
    let area = f64::from(BAND) * plate.head.height * plate.head.width * plate.scale * plate.scale;
    let least = LEAST_WIDTH * area as f32;
    let whole = counts.iter().sum::<usize>() as f32;
    let is_wide = counts.iter().all(|count| *count as f32 >= least);
    is_wide && like_skin as f32 > LIKE_SKIN * whole && plate.chin() * sign < TURNED && !plate.is_grey
}

#[cfg(test)]
mod tests {
    use super::super::skin_model::Place;
    use super::super::tests::plate;
    use super::*;

    /// A face with something of its colour on the picture's right, from the crown to a row, in locks of this contrast.
    fn sides(contrast: u8, to: usize) -> [bool; 2] {
        let is_beside = |x: usize, y: usize| (140..172).contains(&x) && (10..to).contains(&y);
        let pixels = Raster::from_fn(200, 200, |x, y| match (x, y) {
            (x, y) if is_beside(x, y) && x % 4 < 2 => [150 - contrast, 110 - contrast, 90 - contrast],
            (x, y) if is_beside(x, y) || (60..140).contains(&x) => [150, 110, 90],
            _ => [60, 90, 160],
        });
        let mut plate = plate(&pixels);
        plate.inside = Raster::from_fn(plate.width(), plate.height(), |x, y| pixels.get(x, y) != [60, 90, 160]);
        let skin = Skin::learned(&plate);
        let from_skin = plate.features.map(|f| skin.distance(f, Place::Face).min(skin.shaded_distance(f)).min(NO_SKIN));
        manes(&plate, &skin, &from_skin).1
    }

    #[test]
    fn locks_of_skins_colour_beside_the_ear_are_hair_and_an_arm_is_not() {
        assert_eq!(sides(40, 140), [false, true]);
        assert_eq!(sides(0, 140), [false; 2], "a raised arm is as smooth as the face");
        assert_eq!(sides(40, 60), [false; 2], "it ends above the mouth");
    }
}
