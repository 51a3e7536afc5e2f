//! Beards and moustaches: below the nose and round the lips, where their signs are.

use super::beard_signs::{Face, Limits};
use super::plate::Plate;
use super::segmentation::{CLOTHING, HAIR, Shares};
use super::smoothing::Guide;
use crate::raster::{Raster, close, components, dilate, open};
use crate::source::outlines::{LIPS, MOUTH};

/// The upper lip from the nose's wings to the mouth's corners, and the nose's underside, whose shadow is no moustache.
const MOUSTACHE: [usize; 8] = [98, 327, 2, 61, 291, 0, 37, 267];
const UNDER_NOSE: [usize; 5] = [98, 97, 2, 326, 327];
/// The chin below the lower lip.
const CHIN: [usize; 12] = [17, 84, 314, 181, 405, 152, 148, 377, 176, 400, 149, 378];
/// Lowest extent of a beard below the chin, in `v`: a longer beard is taken for clothing there; with a lower limit a shaded neck
/// is taken for beard.
const BELOW_CHIN: f32 = -0.25;
/// Least share of hairs on the jaw for a beard without a moustache: a white one in warm light has 0.33.
const BEARDED_JAW: f32 = 0.3;
/// The wings of the nose, its tip and its underside.
const NOSE: [usize; 12] = [4, 45, 275, 48, 278, 64, 294, 98, 327, 2, 97, 326];

/// A beard, a moustache or both.
pub(super) struct Beard {
    hairs: Raster<bool>,
    /// Where facial hair may be, whatever is worn below it.
    allowed: Raster<bool>,
    /// The zones that a piece of hair must reach.
    zones: Raster<bool>,
    /// Whether it covers the chin.
    is_full: bool,
    /// Whether it covers the chin so densely that it and long hair cannot be told apart.
    pub is_dense: bool,
}

impl Beard {
    /// The facial hair, if both halves of the upper lip or of the chin are covered; or of both, by the signs of a soft beard.
    pub(super) fn found(plate: &Plate) -> Option<Self> {
        let sure = Self::within(plate, Limits::Sure);
        if sure.as_ref().is_some_and(|beard| beard.is_full) {
            return sure;
        }
        let faint = Self::within(plate, Limits::Faint);
        if faint.as_ref().is_some_and(|beard| beard.is_full) {
            return faint;
        }
        // Over a chin in shade a moustache that is sure is no beard.
        sure.or_else(|| Self::within(plate, Limits::Soft)).or(faint)
    }

    fn within(plate: &Plate, limits: Limits) -> Option<Self> {
        let face = Face::new(plate, limits)?;
        let off_lips = |zone: Raster<bool>| zone.zip_map(&face.lips, |zone, lips| zone && !lips);
        let under_nose = plate.round(&UNDER_NOSE, 0.035);
        let moustache = off_lips(plate.hull(&MOUSTACHE)).zip_map(&under_nose, |zone, nose| zone && !nose);
        let chin = off_lips(plate.hull(&CHIN));
        let middle = plate.chin();
        let jaw = off_lips(plate.pixels_where(|[u, v], i| plate.oval.pixels()[i] && v < 0.42 && (u - middle).abs() > 0.28));
        let hairs = face.hairs(&chin);
        let is_soft = matches!(limits, Limits::Soft);
        let has_moustache = if is_soft { face.is_soft_beard(&chin, &moustache) } else { face.is_covered(&moustache) };
        let is_bearded = has_moustache || share_of(&hairs, &jaw) > BEARDED_JAW || face.is_white_goatee(&chin, &moustache);
        let is_full = if is_soft { has_moustache } else { face.is_covered(&chin) && is_bearded };
        if !has_moustache && !is_full {
            return None;
        }
        let lip = plate.hull(&MOUSTACHE).zip_map(&plate.hull(&LIPS), |a, b| a || b).map(u8::from);
        let lip = dilate(&lip, (0.04 * plate.face_width) as usize);
        let nose = plate.hull(&NOSE);
        let mouth = plate.hull(&MOUTH);
        let near_oval = dilate(&plate.oval.map(u8::from), (0.06 * plate.face_width) as usize);
        let over_lips = face.over_lips();
        let hairs = if is_full { face.with_rough(&hairs) } else { hairs };
        let hairs = if is_soft { without_gaps(&hairs, &face, plate) } else { hairs };
        let hairs = if is_full { face.with_thin_moustache(hairs, &moustache) } else { hairs };
        let is_other = if is_full { face.beside_beard(&hairs, &chin) } else { hairs.map(|_| false) };
        let allowed = plate.pixels_where(|[u, v], i| {
            let is_below = v < 0.06 && v > BELOW_CHIN && (u - middle).abs() < 0.42 && !(is_soft && v < 0.0 && face.is_smooth(i));
            let is_jaw = v < 0.44 && near_oval.pixels()[i] != 0;
            let on_lip = has_moustache && lip.pixels()[i] != 0 && !plate.is_below_lips(i);
            let is_free = !face.lips.pixels()[i] || (!is_soft && over_lips.pixels()[i] && !mouth.pixels()[i]);
            plate.inside.pixels()[i]
                && !nose.pixels()[i]
                && is_free
                && (on_lip || (is_full && !is_other.pixels()[i] && (is_below || (is_jaw && v > -0.05))))
        });
        // Of a soft beard shaded cheeks would be islands.
        let zones = plate.pixels_where(|_, i| moustache.pixels()[i] || chin.pixels()[i] || (jaw.pixels()[i] && !is_soft));
        Some(Self { hairs, allowed, zones, is_full, is_dense: is_full && !is_soft })
    }

    /// Share of beard or moustache in each pixel; collars below the chin are excluded.
    pub(super) fn shares(&self, plate: &Plate, shares: &Raster<Shares>) -> Raster<f32> {
        /// Half the width of what is left out of a beard as too thin, in widths of the face: spikes towards the ears, which begin so far
        /// aside.
        const THIN: f32 = 0.02;
        const JAW: f32 = 0.28;
        let middle = plate.chin();
        let found = plate.pixels_where(|_, i| {
            let (s, [u, v]) = (shares.pixels()[i], plate.at.pixels()[i]);
            let aside = (u - middle).abs();
            let is_under_chin = aside < 0.25 && v > -0.05;
            let is_worn = !plate.oval.pixels()[i]
                && ((s[CLOTHING] > 0.5 && !is_under_chin) || (aside > 0.42 && (v < 0.05 || s[HAIR] < 0.5)));
            self.hairs.pixels()[i] && self.allowed.pixels()[i] && !is_worn
        });
        let hair = close(&found.map(u8::from), 1);
        let wide = open(&hair, (THIN * plate.face_width).round() as usize);
        let whole = plate.pixels_where(|[u, _], i| wide.pixels()[i] == 1 || (hair.pixels()[i] == 1 && (u - middle).abs() < JAW));
        let kept = large_pieces(&whole.map(u8::from), &self.zones, 0.006 * plate.face_width * plate.face_width);
        Guide::new(&plate.colours, 3, 1e-3).filtered(&kept)
    }
}

/// A soft beard without the gaps that light makes in it, and without its spikes, folds of the cheeks.
fn without_gaps(hairs: &Raster<bool>, face: &Face<'_>, plate: &Plate) -> Raster<bool> {
    /// Half the widths of gaps and of spikes, in widths of the face.
    const GAP: f32 = 0.05;
    const SPIKE: f32 = 0.035;
    let pixels = |width: f32| (width * plate.face_width).round() as usize;
    let off_lips = hairs.zip_map(&face.lips, |hair, lips| u8::from(hair && !lips));
    open(&close(&off_lips, pixels(GAP)), pixels(SPIKE)).map(|v| v != 0)
}

/// The pieces of more than `least` pixels that reach into the zones.
fn large_pieces(found: &Raster<u8>, zones: &Raster<bool>, least: f32) -> Raster<f32> {
    let (labels, count) = components(found);
    let mut sizes = vec![(0.0_f32, false); count + 1];
    for (&label, &zone) in labels.pixels().iter().zip(zones.pixels()) {
        let (size, reaches) = &mut sizes[label as usize];
        *size += 1.0;
        *reaches |= zone;
    }
    labels.map(|label| f32::from(u8::from(label != 0 && sizes[label as usize].0 > least && sizes[label as usize].1)))
}

fn share_of(marked: &Raster<bool>, zone: &Raster<bool>) -> f32 {
    let both = marked.pixels().iter().zip(zone.pixels()).filter(|(m, z)| **m && **z).count();
    let all = zone.pixels().iter().filter(|is| **is).count();
    if all > 10 { both as f32 / all as f32 } else { 0.0 }
}
