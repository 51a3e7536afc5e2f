//! A neck in the shade of its chin: too dark to be like the skin of the face, but of its colour.

use super::plate::Plate;
use super::segmentation::{CLOTHING, HAIR, SKIN, Shares, greatest};
use super::skin_model::apart;
use crate::raster::{Raster, box_blur, components, dilate, median};

/// Where necks are between chin and collar, in `u` and `v`.
const ASIDE: f32 = 0.5;
const HEIGHTS: [f32; 2] = [-0.6, 0.3];
/// Where clothing is whose colour is sure.
const CLOTH_BELOW: f32 = -0.5;
/// A neck's shade-free colour has at least this share of the face's, and lies nearer to it than this share of its distance from the clothing's, of
/// which some falls on the neck (07); red and brown clothes are too near to tell.
const COLOURED: f32 = 0.5;
const FROM_CLOTH: f32 = 0.45;
const TOLD_APART: f32 = 0.1;
/// Darker places, in L*, have no colour.
const BLACK: f32 = 2.5;
/// Radius in working pixels of the mean of a colour: that of a single dark pixel is noise.
const MEAN: usize = 1;
/// The smallest piece of a neck, in squared widths of the face, and how near it comes to the face, its beard, or other skin or hair above, in
/// working pixels.
const LEAST: f32 = 0.004;
const NEAR: usize = 3;
/// Where the collar around a piece is looked for, in working pixels, and the least step between their colours in L*, a*, b*. A black shirt goes on
/// beyond the zone of the neck, with no step (4); the fainter of five necks has 13.
const BESIDE: usize = 3;
const COLLAR: f32 = 9.0;

/// The shares with shaded necks as skin.
pub(super) fn with_shaded_neck(plate: &Plate, mut shares: Raster<Shares>, beard: Option<&Raster<f32>>) -> Raster<Shares> {
    let Some(neck) = shaded_neck(plate, &shares, beard) else { return shares };
    for (share, _) in shares.pixels_mut().iter_mut().zip(neck.pixels()).filter(|(_, is)| **is) {
        share[SKIN] += share[CLOTHING];
        share[CLOTHING] = 0.0;
    }
    shares
}

fn shaded_neck(plate: &Plate, shares: &Raster<Shares>, beard: Option<&Raster<f32>>) -> Option<Raster<bool>> {
    let class = shares.map(greatest);
    let is_beard = |i: usize| beard.is_some_and(|beard| beard.pixels()[i] > 0.5);
    let lab = [0, 1, 2].map(|k| box_blur(&plate.lab.map(|lab| lab[k]), MEAN));
    let colour = Raster::from_fn(plate.width(), plate.height(), |x, y| {
        let [l, a, b] = [0, 1, 2].map(|k| lab[k].get(x, y));
        [a / (l + 16.0), b / (l + 16.0)]
    });
    let usual = |is_counted: &dyn Fn(usize, [f32; 2]) -> bool| {
        let counted: Vec<usize> = (0..class.len()).filter(|i| is_counted(*i, plate.at.pixels()[*i])).collect();
        let axis = |k: usize| median(counted.iter().map(|i| colour.pixels()[*i][k]).collect());
        Some([axis(0)?, axis(1)?])
    };
    let skin = usual(&|i, _| plate.core.pixels()[i] && class.pixels()[i] == SKIN)?;
    let cloth = usual(&|i, [u, v]| class.pixels()[i] == CLOTHING && (u.abs() > ASIDE || v < CLOTH_BELOW))?;
    if apart(skin, cloth) < TOLD_APART {
        return None;
    }
    let nearest = FROM_CLOTH * apart(skin, cloth);
    let is_coloured = |c: [f32; 2]| c[0] * skin[0] + c[1] * skin[1] > COLOURED * (skin[0] * skin[0] + skin[1] * skin[1]);
    let is_like = |i: usize| {
        let [u, v] = plate.at.pixels()[i];
        class.pixels()[i] == CLOTHING
            && !is_beard(i)
            && u.abs() < ASIDE
            && (HEIGHTS[0]..HEIGHTS[1]).contains(&v)
            && lab[0].pixels()[i] > BLACK
            && is_coloured(colour.pixels()[i])
            && apart(colour.pixels()[i], skin) < nearest
    };
    let like = Raster::from_fn(plate.width(), plate.height(), |x, y| u8::from(is_like(y * plate.width() + x)));
    let above = Raster::from_fn(plate.width(), plate.height(), |x, y| {
        let i = y * plate.width() + x;
        let is_above = plate.oval.pixels()[i] || is_beard(i) || matches!(class.pixels()[i], SKIN | HAIR);
        u8::from(is_above && plate.at.pixels()[i][0].abs() < ASIDE)
    });
    let near = dilate(&above, NEAR);
    let (labels, count) = components(&like);
    let (mut sizes, mut is_joined) = (vec![0_usize; count + 1], vec![false; count + 1]);
    for (label, near) in labels.pixels().iter().zip(near.pixels()) {
        sizes[*label as usize] += 1;
        is_joined[*label as usize] |= *near == 1;
    }
    let least = (LEAST * plate.face_width * plate.face_width).max(1.0) as usize;
    let is_cloth = class.map(|class| class == CLOTHING);
    let is_cloth = Raster::from_fn(plate.width(), plate.height(), |x, y| is_cloth.get(x, y) && !is_beard(y * plate.width() + x));
    let is_neck =
        |label: usize| label != 0 && sizes[label] >= least && is_joined[label] && has_collar(&labels, label, &is_cloth, &lab);
    let is_kept: Vec<bool> = (0..=count).map(is_neck).collect();
    let neck = labels.map(|label| u8::from(is_kept[label as usize]));
    // The edge of a chin, between it and the neck, is neither's colour.
    let edge = dilate(&neck, NEAR).zip_map(&near, |neck, above| neck == 1 && above == 1);
    let edge = edge.zip_map(&is_cloth, |edge, is_cloth| edge && is_cloth);
    let neck = neck.zip_map(&edge, |neck, edge| neck == 1 || edge);
    let reflected = under_chin(plate, &is_cloth, &neck.zip_map(&class, |is, class| is || class == SKIN));
    Some(neck.zip_map(&reflected, |neck, reflected| neck || reflected))
}

/// Cloth between a chin and the skin of its neck below: light that a collar throws up there, which has the collar's colour.
fn under_chin(plate: &Plate, is_cloth: &Raster<bool>, is_skin: &Raster<bool>) -> Raster<bool> {
    /// The most that lies between, in widths of the face, and how far aside in `u`.
    const BETWEEN: f32 = 0.14;
    const ASIDE: f32 = 0.3;
    let most = (BETWEEN * plate.face_width) as usize;
    let mut between = is_cloth.map(|_| false);
    for x in 0..plate.width() {
        let rows = (0..plate.height()).filter(|y| plate.oval.get(x, *y));
        let Some(chin) = rows.max() else { continue };
        let is_cloth_at = |y: &usize| is_cloth.get(x, *y) && plate.at.get(x, *y)[0].abs() < ASIDE;
        let below = (chin + 1..plate.height()).take(most + 1).take_while(is_cloth_at).count();
        if below <= most && chin + 1 + below < plate.height() && is_skin.get(x, chin + 1 + below) {
            (chin + 1..=chin + below).for_each(|y| between.set(x, y, true));
        }
    }
    between
}

/// True if a piece differs from the clothing around it, or there is none.
fn has_collar(labels: &Raster<u32>, label: usize, is_cloth: &Raster<bool>, lab: &[Raster<f32>; 3]) -> bool {
    let piece = labels.map(|own| u8::from(own as usize == label));
    let beside = dilate(&piece, BESIDE);
    let colour = |is_counted: &dyn Fn(usize) -> bool| {
        let counted: Vec<usize> = (0..piece.len()).filter(|i| is_counted(*i)).collect();
        let axis = |k: usize| median(counted.iter().map(|i| lab[k].pixels()[*i]).collect());
        Some([axis(0)?, axis(1)?, axis(2)?])
    };
    let inside = colour(&|i| piece.pixels()[i] == 1);
    let outside = colour(&|i| beside.pixels()[i] == 1 && piece.pixels()[i] == 0 && is_cloth.pixels()[i]);
    let (Some(inside), Some(outside)) = (inside, outside) else { return true };
    let step = [0, 1, 2].map(|k| inside[k] - outside[k]).iter().map(|d| d * d).sum::<f32>().sqrt();
    step > COLLAR
}

#[cfg(test)]
mod tests {
    use super::super::tests::plate;
    use super::*;

    /// The share of skin below a chin of this colour above clothing of that one.
    fn skin_at_neck(neck: [u8; 3], cloth: [u8; 3]) -> f32 {
        let pixels = Raster::from_fn(200, 200, |x, y| {
            let (dx, dy) = ((x as f64 - 100.0) / 40.0, (y as f64 - 70.0) / 50.0);
            if dx * dx + dy * dy < 1.0 {
                [200, 140, 110]
            } else if y < 150 && (78..122).contains(&x) {
                neck
            } else {
                cloth
            }
        });
        let plate = plate(&pixels);
        let shares = plate.oval.map(|is_face| if is_face { [0.0, 1.0, 0.0, 0.0] } else { [0.0, 0.0, 0.0, 1.0] });
        let shares = with_shaded_neck(&plate, shares, None);
        let at = |v: f64, from: f64| ((v - from) * plate.scale) as usize;
        shares.get(at(100.0, plate.part.x0), at(135.0, plate.part.y0))[SKIN]
    }

    #[test]
    fn a_dark_neck_is_skin_and_a_black_shirt_is_not() {
        let navy = [30, 35, 70];
        assert_eq!(skin_at_neck([60, 42, 33], navy), 1.0, "the face's colour in shade");
        assert_eq!(skin_at_neck([20, 20, 22], navy), 0.0, "a black shirt");
        assert_eq!(skin_at_neck([28, 20, 16], [28, 20, 16]), 0.0, "a brown pullover");
    }
}
