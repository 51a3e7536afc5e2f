//! Connected pieces: hair belongs to the head, clothing to the shoulders, skin to the face; stray pieces join what surrounds
//! them.

use super::facial_hair::Beard;
use super::plate::Plate;
use super::segmentation::{CLOTHING, HAIR, SKIN, Segmentation, Shares, greatest};
use crate::raster::{Raster, components, dilate};
use crate::source::outlines;

/// Smaller pieces, in working pixels, are not kept as pieces of their own.
const LEAST: usize = 50;
/// A piece of hair is a brow or a shaded lid if its middle is below `BROW_HEIGHT`, more than `BROW_INSIDE` of it lies inside the
/// face's outline, and it is smaller than `BROW_SIZE` times the squared width of the face.
const BROW_HEIGHT: f32 = 0.85;
const BROW_INSIDE: f32 = 0.8;
const BROW_SIZE: f32 = 0.08;
/// The far brow of a turned head lies beyond the outline (16): the share of a piece that lies on brows, and how far these reach, in widths of the
/// face.
const ON_BROW: f32 = 0.5;
const AROUND_BROW: f32 = 0.05;

/// A connected piece of a class: its pixel indices and its mean height.
struct Piece {
    pixels: Vec<usize>,
    middle: f32,
    /// Its mean distance across from the middle of the head.
    aside: f32,
}

/// Reassigns stray pieces, and cuts off below the jaw hair that ends there.
pub(super) fn reassign_stray_pieces(
    parting: &Segmentation,
    plate: &Plate,
    mut shares: Raster<Shares>,
    beard: Option<&Beard>,
) -> Raster<Shares> {
    let width = plate.width();
    let at = |i: usize| plate.at.pixels()[i];
    clear_eyes(plate, &mut shares);
    for piece in pieces(plate, &shares, HAIR) {
        let is_on_head = piece.pixels.iter().any(|&i| at(i)[1] > 0.5 && at(i)[0].abs() < 0.95);
        if is_brow(plate, &piece) {
            give(&mut shares, &piece.pixels, HAIR, SKIN);
        } else if !is_on_head || piece.pixels.len() < LEAST {
            let is_worn = piece.middle < -0.12 || piece.aside > 0.55;
            give(&mut shares, &piece.pixels, HAIR, if is_worn { CLOTHING } else { SKIN });
        }
    }
    let is_at_border = |i: usize| {
        let (x, y) = (i % width, i / width);
        y + 3 >= plate.height() || x < 2 || x + 2 >= width
    };
    for piece in pieces(plate, &shares, CLOTHING) {
        let is_low = piece.pixels.iter().any(|&i| at(i)[1] < -0.25 || (at(i)[1] < -0.05 && is_at_border(i)));
        if !is_low || piece.pixels.len() < LEAST {
            give(&mut shares, &piece.pixels, CLOTHING, if piece.middle > 0.3 && parting.has_hair() { HAIR } else { SKIN });
        }
    }
    for piece in pieces(plate, &shares, SKIN) {
        if let Some(to) = class_of_stray_skin(parting, plate, &shares, &piece) {
            give(&mut shares, &piece.pixels, SKIN, to);
        }
    }
    for sign in [-1.0, 1.0] {
        end_at_jaw(parting, plate, &mut shares, sign, beard.is_some_and(|beard| beard.is_dense));
    }
    shares
}

/// Gives to skin what is hair between the lids: the far eye of a turned head lies beside its outline, and is as dark as hair (16).
fn clear_eyes(plate: &Plate, shares: &mut Raster<Shares>) {
    /// How far around the lids, in widths of the face: lashes and their shade.
    const AROUND: f32 = 0.03;
    for eye in [&outlines::LEFT_EYE, &outlines::RIGHT_EYE] {
        let eye = dilate(&plate.hull(eye).map(u8::from), (AROUND * plate.face_width) as usize);
        let pixels: Vec<usize> = (0..eye.pixels().len()).filter(|i| eye.pixels()[*i] == 1).collect();
        give(shares, &pixels, HAIR, SKIN);
    }
}

/// Gives to clothing the hair that only a beard joins to the head: jackets as dark as the beard above them (04).
pub(super) fn without_hair_under_beard(plate: &Plate, mut shares: Raster<Shares>, beard: &Raster<f32>) -> Raster<Shares> {
    /// Heights between the mouth and the eyes, in `v`: hair of the head reaches above them, and what is worn has its middle below the first.
    const HEIGHTS: [f32; 2] = [0.2, 0.5];
    /// Where shoulders begin beside the head, in `u`.
    const ASIDE: f32 = 0.5;
    const OUTSIDE: Shares = [1.0, 0.0, 0.0, 0.0];
    let bare = shares.zip_map(beard, |s, b| if b > 0.5 { OUTSIDE } else { s });
    for piece in pieces(plate, &bare, HAIR) {
        let is_on_head = piece.pixels.iter().any(|&i| plate.at.pixels()[i][1] > HEIGHTS[1]);
        if !is_on_head && piece.middle < HEIGHTS[0] && piece.aside > ASIDE {
            give(&mut shares, &piece.pixels, HAIR, CLOTHING);
        }
    }
    shares
}

fn is_brow(plate: &Plate, piece: &Piece) -> bool {
    let count = |is: &dyn Fn(usize) -> bool| piece.pixels.iter().filter(|i| is(**i)).count() as f32;
    let size = piece.pixels.len() as f32;
    let inside = count(&|i| plate.oval.pixels()[i]);
    let is_inside = piece.middle < BROW_HEIGHT && inside > BROW_INSIDE * size;
    let brows = [&outlines::LEFT_BROW, &outlines::RIGHT_BROW]
        .map(|brow| dilate(&plate.hull(brow).map(u8::from), (AROUND_BROW * plate.face_width) as usize));
    let on_brow = count(&|i| brows.iter().any(|brow| brow.pixels()[i] == 1));
    (is_inside || on_brow > ON_BROW * size) && size < BROW_SIZE * plate.face_width * plate.face_width
}

fn pieces(plate: &Plate, shares: &Raster<Shares>, class: usize) -> Vec<Piece> {
    let (labels, count) = components(&shares.map(|s| u8::from(greatest(s) == class)));
    let mut pieces: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (i, &label) in labels.pixels().iter().enumerate().filter(|(_, label)| **label != 0) {
        pieces[label as usize - 1].push(i);
    }
    let measured = |pixels: Vec<usize>| {
        let middle = pixels.iter().map(|&i| plate.at.pixels()[i][1]).sum::<f32>() / pixels.len().max(1) as f32;
        let aside = pixels.iter().map(|&i| plate.at.pixels()[i][0].abs()).sum::<f32>() / pixels.len().max(1) as f32;
        Piece { pixels, middle, aside }
    };
    pieces.into_iter().map(measured).collect()
}

fn give(shares: &mut Raster<Shares>, pixels: &[usize], from: usize, to: usize) {
    for &i in pixels {
        let share = &mut shares.pixels_mut()[i];
        share[to] += share[from];
        share[from] = 0.0;
    }
}

/// The class of skin that does not touch the face: what surrounds it, hair above the brow, clothing far below; `None` if it is
/// skin.
fn class_of_stray_skin(parting: &Segmentation, plate: &Plate, shares: &Raster<Shares>, piece: &Piece) -> Option<usize> {
    let is_ear = || piece.middle > 0.2 && piece.middle < 0.85 && parting.may_be_ear(&piece.pixels);
    if piece.pixels.iter().any(|&i| plate.oval.pixels()[i]) || is_ear() {
        return None;
    }
    let (width, height) = (plate.width(), plate.height());
    let mut counts = [0_usize; 4];
    for &i in &piece.pixels {
        let (x, y) = (i % width, i / width);
        let round =
            [(x.saturating_sub(2), y), ((x + 2).min(width - 1), y), (x, y.saturating_sub(2)), (x, (y + 2).min(height - 1))];
        for class in round.map(|(x, y)| greatest(shares.get(x, y))).into_iter().filter(|class| *class != SKIN) {
            counts[class] += 1;
        }
    }
    let all: usize = counts.iter().sum();
    let is_small = (piece.pixels.len() as f32) < 0.25 * plate.face_width * plate.face_width;
    if 2 * (counts[HAIR] + counts[CLOTHING]) > all && is_small {
        return Some(if counts[HAIR] >= counts[CLOTHING] { HAIR } else { CLOTHING });
    }
    match piece.middle {
        v if v > 0.75 && !parting.is_bald => Some(HAIR),
        v if v < -0.9 => Some(CLOTHING),
        _ => None,
    }
}

/// Hair that is short beside the jaw does not continue below it.
fn end_at_jaw(parting: &Segmentation, plate: &Plate, shares: &mut Raster<Shares>, sign: f32, with_beard: bool) {
    if parting.falls(sign) {
        return;
    }
    // A full beard covers the area beside the jaw too; long hair shows farther out.
    let from = if with_beard { 0.65 } else { 0.5 };
    let (mut hair, mut all) = (0_usize, 0_usize);
    for i in 0..plate.at.len() {
        let [u, v] = plate.at.pixels()[i];
        let is_out = plate.inside.pixels()[i] && !plate.oval.pixels()[i];
        if is_out && v > 0.12 && v < 0.42 && u * sign > from && u * sign < from + 0.3 {
            all += 1;
            hair += usize::from(greatest(shares.pixels()[i]) == HAIR);
        }
    }
    let covered = if all > 20 { hair as f32 / all as f32 } else { 0.0 };
    if covered >= 0.2 && parting.is_long(sign) {
        return;
    }
    for i in 0..plate.at.len() {
        let [u, v] = plate.at.pixels()[i];
        if v < 0.12 && u * sign > 0.0 {
            let share = &mut shares.pixels_mut()[i];
            share[if v < 0.0 || u.abs() > 0.6 { CLOTHING } else { SKIN }] += share[HAIR];
            share[HAIR] = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{plate, plate_with};
    use super::*;
    use crate::elementary::unit_at;

    #[test]
    fn what_is_between_the_lids_is_no_hair() {
        let lids = |i: usize| {
            let along = unit_at(std::f64::consts::TAU * i as f64 / outlines::LEFT_EYE.len() as f64);
            [125.0 + 10.0 * along.x, 60.0 + 5.0 * along.y]
        };
        let landmarks: Vec<(usize, [f64; 2])> =
            outlines::LEFT_EYE.iter().enumerate().map(|(i, point)| (*point, lids(i))).collect();
        let plate = plate_with(&Raster::filled(200, 200, [120_u8; 3]), &landmarks);
        let mut shares = Raster::filled(plate.width(), plate.height(), [0.0, 0.0, 1.0, 0.0]);
        clear_eyes(&plate, &mut shares);
        let eye = plate.point(outlines::LEFT_EYE[0]).midpoint(plate.point(outlines::LEFT_EYE[outlines::LEFT_EYE.len() / 2]));
        let at = |x: f64, y: f64| shares.get((eye.x + x) as usize, (eye.y + y) as usize);
        assert_eq!((at(0.0, 0.0)[SKIN], at(0.0, 0.0)[HAIR]), (1.0, 0.0));
        assert_eq!(at(0.0, -20.0)[HAIR], 1.0, "above the eye");
    }

    #[test]
    fn hair_that_only_a_beard_joins_to_the_head_is_clothing() {
        let plate = plate(&Raster::filled(200, 200, [120_u8; 3]));
        let share = |class: usize| std::array::from_fn(|k| f32::from(u8::from(k == class)));
        let shares: Raster<Shares> = Raster::from_fn(plate.width(), plate.height(), |x, y| {
            let [u, v] = plate.at.get(x, y);
            share(if (0.55..0.75).contains(&u) && v < 0.9 { HAIR } else { SKIN })
        });
        let beard = |heights: std::ops::Range<f32>| plate.at.map(|[_, v]| f32::from(u8::from(heights.contains(&v))));
        let worn = |beard: &Raster<f32>| {
            let shares = without_hair_under_beard(&plate, shares.clone(), beard);
            shares.pixels().iter().filter(|s| s[CLOTHING] > 0.5).count()
        };
        assert!(worn(&beard(-0.1..0.3)) > 50, "the piece below the beard");
        assert_eq!(worn(&beard(2.0..3.0)), 0, "long hair");
    }
}
