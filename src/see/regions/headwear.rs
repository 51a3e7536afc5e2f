//! Hats, caps and scarves: pixels where hair would be, in colours that hair does not have, or in black and white side by side.

use super::mixture::Mixture;
use super::plate::Plate;
use super::segmentation::{HAIR, Shares, greatest};
use super::smoothing::Guide;
use crate::elementary::Elementary as _;
use crate::raster::{Raster, gaussian_blur, open};

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
/// L* below and above which a pixel is black or white.
const BLACK: f32 = 28.0;
const WHITE: f32 = 72.0;
/// Least fraction of odd colours in a hat, or least fraction of both black and white. Grey hair has 0.08 of the lesser of both.
const ODD: f32 = 0.5;
const BOTH: f32 = 0.12;

/// True if what lies above the forehead is not hair.
fn is_hat(plate: &Plate, is_hair: &Raster<bool>) -> bool {
    let smooth = gaussian_blur(&plate.lab.map(|c| c[0]), 0.02 * plate.face_width);
    let (mut all, mut odd, mut black, mut white) = (0.0_f32, 0.0_f32, 0.0_f32, 0.0_f32);
    let above = is_hair.pixels().iter().zip(plate.at.pixels()).enumerate().filter(|(_, (is, at))| **is && at[1] > 1.0);
    for (i, _) in above {
        let [_, a, b] = plate.lab.pixels()[i];
        let hue = b.angle_over(a).to_degrees();
        let is_odd = (a.hypotenuse(b) > LEAST_CHROMA && !(HUES.0..=HUES.1).contains(&hue)) || a > REDDEST;
        let light = smooth.pixels()[i];
        let count = |is: bool| f32::from(u8::from(is));
        all += 1.0;
        odd += count(is_odd);
        black += count(light < BLACK);
        white += count(light > WHITE);
    }
    all > 0.1 * plate.face_width * plate.face_width && (odd > ODD * all || black.min(white) > BOTH * all)
}
