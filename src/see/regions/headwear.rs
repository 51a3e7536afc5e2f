//! Hats, caps and scarves: pixels where hair would be, in colours that hair does not have, or in black and white side by side.

use super::mixture::Mixture;
use super::plate::Plate;
use super::segmentation::{HAIR, Shares, greatest};
use super::smoothing::Guide;
use crate::elementary::Elementary as _;
use crate::raster::{Raster, erode, gaussian_blur, open};

/// Farther from the middle of the head than this (in `u`), and above the mouth, hair is taken for brim.
const BRIM: f32 = 0.66;

/// Share of headwear in each pixel, at most its share of hair; `None` on a bare head.
pub(super) fn headwear(plate: &Plate, shares: &Raster<Shares>) -> Option<Raster<f32>> {
    let is_hair = shares.map(|s| greatest(s) == HAIR);
    if !is_hat(plate, &is_hair) {
        return None;
    }
    let side = plate.pixels_where(|[_, v], i| is_hair.pixels()[i] && v < 0.5 && v > 0.1);
    let top = plate.pixels_where(|[_, v], i| is_hair.pixels()[i] && v > 1.12);
    let (side, top) = (plate.samples(&side), plate.samples(&top));
    let models = (side.len() > 40 && top.len() > 40).then(|| (Mixture::fitted(&side, 3), Mixture::fitted(&top, 4)));
    let marked = plate.pixels_where(|[u, v], i| {
        let is_like_top = || match &models {
            Some((Some(side), Some(top))) => {
                let f = plate.features.pixels()[i];
                top.log_density(f) + 14.0 * (v - 0.85).clamp(-0.6, 0.5) > side.log_density(f)
            }
            _ => v > 0.8,
        };
        is_hair.pixels()[i] && (v > 0.86 || (v > 0.5 && u.abs() > BRIM) || is_like_top())
    });
    let opened = open(&marked.map(u8::from), 1).map(f32::from);
    let smooth = Guide::new(&plate.colours, 4, 1e-3).filtered(&opened);
    Some(smooth.zip_map(shares, |v, s| v * s[HAIR]))
}

/// Range of hair's hues in degrees from red towards yellow, for chroma above `LEAST_CHROMA`; a* above `REDDEST` is dyed or no
/// hair.
const HUES: (f32, f32) = (20.0, 105.0);
const LEAST_CHROMA: f32 = 14.0;
const REDDEST: f32 = 32.0;
/// Least fraction of odd colours in a hat.
const ODD: f32 = 0.5;
/// Least range of L* of a hat in black and white, without outliers and without a border of this width, in widths of the face; black hair before a
/// forehead in strong light is black beside white. And the least mean difference of a place from its surroundings in shares of that range,
/// for black and white are side by side. Of 50 heads the two hats have 73 and 0.19, 88 and 0.13; hair of more than 52 has at most 0.1,
/// and a scalp that shines above black hair, which some light makes hair, 98 and 0.05.
const RANGE: f32 = 58.0;
const OUTLIERS: f32 = 0.03;
const SIDE_BY_SIDE: f32 = 0.115;
const BORDER: f32 = 0.06;
/// Fewest pixels that are asked.
const LEAST: usize = 100;
/// Blurs that leave out grain and make the surroundings, in widths of the face.
const GRAIN: f32 = 0.02;
const SURROUNDINGS: f32 = 0.08;

/// True if what lies above the forehead is not hair.
fn is_hat(plate: &Plate, is_hair: &Raster<bool>) -> bool {
    let above: Vec<usize> = (0..is_hair.len()).filter(|i| is_hair.pixels()[*i] && plate.at.pixels()[*i][1] > 1.0).collect();
    if (above.len() as f32) <= 0.1 * plate.face_width * plate.face_width {
        return false;
    }
    let is_odd = |i: &&usize| {
        let [_, a, b] = plate.lab.pixels()[**i];
        let hue = b.angle_over(a).to_degrees();
        (a.hypotenuse(b) > LEAST_CHROMA && !(HUES.0..=HUES.1).contains(&hue)) || a > REDDEST
    };
    let odd = above.iter().filter(is_odd).count() as f32;
    let inner = erode(&is_hair.map(u8::from), (BORDER * plate.face_width) as usize);
    let inner: Vec<usize> = above.iter().copied().filter(|i| inner.pixels()[*i] != 0).collect();
    odd > ODD * above.len() as f32 || is_black_and_white(plate, &inner)
}

/// True if pixels are black and white side by side.
fn is_black_and_white(plate: &Plate, pixels: &[usize]) -> bool {
    if pixels.len() < LEAST {
        return false;
    }
    let light = gaussian_blur(&plate.lab.map(|c| c[0]), GRAIN * plate.face_width);
    let mut counted = light.map(|_| 0.0);
    pixels.iter().for_each(|i| counted.pixels_mut()[*i] = 1.0);
    let around = |of: &Raster<f32>| gaussian_blur(of, SURROUNDINGS * plate.face_width);
    let mean = around(&light.zip_map(&counted, |l, is| l * is)).zip_map(&around(&counted), |sum, share| sum / share.max(1e-3));
    let apart = pixels.iter().map(|i| (light.pixels()[*i] - mean.pixels()[*i]).abs()).sum::<f32>() / pixels.len() as f32;
    let mut light: Vec<f32> = pixels.iter().map(|i| light.pixels()[*i]).collect();
    light.sort_unstable_by(f32::total_cmp);
    let at = |share: f32| light[((light.len() - 1) as f32 * share) as usize];
    let range = at(1.0 - OUTLIERS) - at(OUTLIERS);
    range > RANGE && apart > SIDE_BY_SIDE * range
}
