//! The tone that ink must match where faces are drawn: exposure, contrast and local detail are set so that the *faces* use the
//! paper's range.
//!
//! In: a [`Portrait`] with faces, its subject and, if present, its masks of hair, beards, headwear and clothing. Out: its tone. Nothing
//! here knows of styles.
//!
//! ```text
//!   lightness -> light evened over skin -> local contrast -> one rising curve, through the skin's median and its lights,
//!                                                              on a base layer; its detail added back
//!   -> clothing by a curve of its own -> light hair held back -> eyes, brows and lips raised
//!   -> folds of ears raised -> eyes and mouths opened -> large blacks opened -> lights to paper -> large lights held
//!   -> half tones around lights -> lenses cleared -> eyes at least as dark as in the photograph -> gums -> red lips -> dim teeth
//!   -> grooves of noses -> nostrils -> irises without specks, brown ones black, light ones lighter than their pupils -> catchlights
//! ```
//!
//! Darker skin stays darker than lighter skin: the target tone of a face's median rises with the median.

mod catchlights;
mod curve;
mod dim_teeth;
mod ears;
mod face;
mod gums;
mod irises;
mod lenses;
mod lights;
mod mixing;
mod mouth_box;
mod nose_wings;
mod nostrils;
mod openings;
mod red_lips;
mod specks;
mod zones;

use crate::raster::{Raster, box_blur, enlarge, reduce};
use crate::source::{MaskRole, Portrait};
use catchlights::with_catchlights;
use dim_teeth::with_dim_teeth;
use gums::with_gums;
use irises::with_irises;
use nose_wings::with_nose_wings;
use nostrils::with_nostrils;
use red_lips::with_red_lips;
use specks::without_specks;

/// The masks that are used besides the subject.
pub const ROLES: &[MaskRole] = &[MaskRole::Hair, MaskRole::FacialHair, MaskRole::Headwear, MaskRole::Clothing];

/// Least width of a face in pixels at which the tone is computed; finer detail is copied unchanged. Two thirds of it lose lids, twice as
/// much costs four times the time and shows no difference (seen on sixteen portraits).
const FACE_WIDTH: f64 = 180.0;
/// Most faces with a tone of their own, largest first; other faces take the nearest one's.
const MOST_FACES: usize = 6;
/// Radius, in widths of a face, within which its own tone prevails if there are several faces.
const REACH: f64 = 1.2;
/// Transfer of the tone to full size: radius in pixels of the reduced grid, and the squared contrast from which edges count.
const TRANSFER_RADIUS: usize = 2;
const TRANSFER_EPS: f32 = 1e-4;

/// The tone of a portrait by its faces, 0 to 1; `None` if it has no face, or no face has measurable skin. `strength` runs from 0
/// (lightness unchanged) to 1.
///
/// ```no_run
/// # fn example(mut portrait: drypoint::source::Portrait) {
/// use drypoint::{source::ToneCurve, tone::portrait_tone};
///
/// if let Some(tone) = portrait_tone(&portrait, 1.0) {
///     portrait.set_portrait_tone(&tone, ToneCurve::default());
/// }
/// # }
/// ```
pub fn portrait_tone(portrait: &Portrait, strength: f32) -> Option<Raster<f32>> {
    let widest = portrait.faces.first()?.width();
    let factor = ((widest / FACE_WIDTH).floor() as usize).max(1);
    let lightness = reduce(&portrait.lightness, factor);
    let reduced = |role: MaskRole| portrait.masks.get(&role).map(|mask| reduce(mask, factor));
    let hair = [MaskRole::Hair, MaskRole::FacialHair, MaskRole::Headwear].into_iter().filter_map(reduced);
    let setting = face::Setting {
        lightness: &lightness,
        subject: reduce(portrait.people(), factor).map(|v| ((v - 0.35) / 0.3).clamp(0.0, 1.0)),
        hair: hair.reduce(|a, b| a.zip_map(&b, f32::max)),
        facial_hair: reduced(MaskRole::FacialHair),
        clothing: reduced(MaskRole::Clothing),
    };
    let scale = 1.0 / factor as f64;
    let faces = portrait.faces.iter().take(MOST_FACES).map(|face| face.placed(|p| (p.to_vec2() * scale).to_point(), scale));
    let tones: Vec<(Raster<f32>, Raster<f32>)> = faces
        .filter_map(|face| {
            let (middle, reach) = (face.point(1), REACH * face.width());
            let weight = |x: usize, y: usize| {
                let (dx, dy) = ((x as f64 - middle.x) / reach, (y as f64 - middle.y) / reach);
                (1.0 / (1.0 + (dx * dx + dy * dy).powi(3))) as f32
            };
            Some((face::tone(&face, &setting)?, Raster::from_fn(lightness.width(), lightness.height(), weight)))
        })
        .collect();
    let tone = blended(&tones)?.zip_map(&lightness, |tone, lightness| lightness + strength * (tone - lightness));
    let tone = at_full_size(&tone, &lightness, &portrait.lightness, factor);
    if strength == 0.0 {
        return Some(tone);
    }
    let tone = with_gums(tone, &portrait.light, &portrait.faces, strength);
    let tone = with_red_lips(tone, &portrait.light, portrait.masks.get(&MaskRole::FacialHair), &portrait.faces, strength);
    let tone = with_dim_teeth(tone, &portrait.light, &portrait.faces, strength);
    let tone = with_nose_wings(tone, portrait.masks.get(&MaskRole::FacialHair), &portrait.faces, strength);
    let tone = with_nostrils(tone, &portrait.lightness, &portrait.faces, strength);
    let tone = without_specks(tone, &portrait.faces, strength);
    let tone = with_irises(tone, &portrait.lightness, &portrait.light, &portrait.faces, strength);
    Some(with_catchlights(tone, &portrait.lightness, &portrait.faces))
}

/// The weighted mean of the tones of several faces.
fn blended(tones: &[(Raster<f32>, Raster<f32>)]) -> Option<Raster<f32>> {
    let (first, _) = tones.first()?;
    if tones.len() == 1 {
        return Some(first.clone());
    }
    let total = tones.iter().fold(first.map(|_| 0.0), |sum, (_, weight)| sum.zip_map(weight, |sum, w| sum + w));
    let sum = tones
        .iter()
        .fold(first.map(|_| 0.0), |sum, (tone, weight)| sum.zip_map(&tone.zip_map(weight, |tone, w| tone * w), |sum, v| sum + v));
    Some(sum.zip_map(&total, |sum, total| sum / total))
}

/// The tone at the portrait's size: in each window of the reduced grid it is fitted as a linear function of lightness, by least
/// squares, and that function is applied at full size (fast guided filter, He and Sun 2015).
fn at_full_size(tone: &Raster<f32>, reduced: &Raster<f32>, full: &Raster<f32>, factor: usize) -> Raster<f32> {
    if factor == 1 {
        return tone.map(|v| v.clamp(0.0, 1.0));
    }
    let mean = |raster: &Raster<f32>| box_blur(raster, TRANSFER_RADIUS);
    let (mean_in, mean_out) = (mean(reduced), mean(tone));
    let spread = mean(&reduced.map(|v| v * v)).zip_map(&mean_in, |square, m| (square - m * m).max(0.0));
    let product = mean(&reduced.zip_map(tone, |a, b| a * b));
    let shared = product.zip_map(&mean_in.zip_map(&mean_out, |a, b| a * b), |ab, means| ab - means);
    // Where there is no contrast, the slope is 1, so that detail is copied unchanged.
    let slope = shared.zip_map(&spread, |shared, spread| (shared + TRANSFER_EPS) / (spread + TRANSFER_EPS));
    let offset = mean_out.zip_map(&slope.zip_map(&mean_in, |a, m| a * m), |out, am| out - am);
    let large = |raster: &Raster<f32>| enlarge(raster, factor, full.width(), full.height());
    let (slope, offset) = (large(&mean(&slope)), large(&mean(&offset)));
    slope.zip_map(full, |a, v| a * v).zip_map(&offset, |av, b| (av + b).clamp(0.0, 1.0))
}
