//! Eyes and open mouths, whose small forms the tone of skin would grey over: eyes keep at least the photograph's contrast, whites are
//! lightened, irises darkened, catchlights left as paper, and the gaps between teeth kept.

use super::catchlights::share_of_opening;
use super::mixing::mixed;
use super::zones::{Zones, polygon};
use crate::geometry::{Point, convex_hull, polygon_area};
use crate::raster::{Raster, dilate, fast_gaussian, fast_gaussian_within};
use crate::source::{Iris, Landmarks, outlines};

/// Height over width of an opening: below the first it is closed, from the second on it is treated in full.
pub(super) const EYE_OPEN: [f64; 2] = [0.12, 0.22];
pub(super) const MOUTH_OPEN: [f64; 2] = [0.04, 0.12];
/// Teeth are lighter than this share of the skin's median.
const TEETH_ABOVE: f32 = 0.7;

/// The tone with its eyes and its mouth opened.
pub(super) fn opened(zones: &Zones, face: &Landmarks, tone: &Raster<f32>) -> Raster<f32> {
    let skin = zones.median_of(tone);
    let tone = eyes(face).into_iter().fold(tone.clone(), |tone, (lids, iris)| eye(&tone, &lids, iris, skin));
    let tone = teeth(zones, &tone, &face.line(&outlines::MOUTH), skin);
    lips(zones, face, &tone, skin)
}

/// The lids and the iris of the person's right eye, then of the left.
pub(super) fn eyes(face: &Landmarks) -> [(Vec<Point>, Iris); 2] {
    [(face.line(&outlines::RIGHT_EYE), face.irises[0]), (face.line(&outlines::LEFT_EYE), face.irises[1])]
}

/// How far an opening is open, 0 to 1: by its mean height over its width.
pub(super) fn openness(outline: &[Point], [closed, open]: [f64; 2]) -> f32 {
    let across = outline.iter().flat_map(|p| outline.iter().map(|q| p.distance(*q))).fold(0.0, f64::max);
    let height = polygon_area(outline).abs() / across.max(1e-9);
    ((height / across.max(1e-9) - closed) / (open - closed)).clamp(0.0, 1.0) as f32
}

/// How much darker than the skin around it an iris should be at least; the gain that is used for it at most; the difference below which there
/// is no eye to be seen; and the blur of the eye's zone with its lids, in widths of the face.
const EYE_DEPTH: f32 = 0.5;
const MOST_GAIN: f32 = 2.2;
const LEAST_DEPTH: f32 = 0.06;
/// The same gain and difference behind lenses, whose reflections veil the eye (portraits 11 and 14).
const BEHIND_LENSES: [f32; 2] = [3.6, 0.03];
const WITH_LIDS: f64 = 0.015;

/// Eyes that differ little from the skin around them, behind lenses or in shade, are raised until their irises do; `round` is the tone of
/// that skin.
pub(super) fn firm_eyes(zones: &Zones, face: &Landmarks, tone: &Raster<f32>, round: &Raster<f32>) -> Raster<f32> {
    let [most, least] = if face.spectacles.is_some() { BEHIND_LENSES } else { [MOST_GAIN, LEAST_DEPTH] };
    eyes(face).into_iter().fold(tone.clone(), |tone, (lids, iris)| {
        let below = round.zip_map(&tone, |round, v| round - v);
        let disc = Raster::from_fn(tone.width(), tone.height(), |x, y| {
            f32::from(u8::from(iris.centre.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5)) < 0.8 * iris.radius))
        });
        let Some(depth) = median(&below, &disc).filter(|depth| *depth > least) else { return tone };
        let gain = (EYE_DEPTH / depth).clamp(1.0, most) - 1.0;
        let hull = polygon(tone.width(), tone.height(), &convex_hull(lids));
        let around = dilate(&hull, (WITH_LIDS * zones.width).round().max(1.0) as usize).map(f32::from);
        let soft = fast_gaussian(&around, (WITH_LIDS * zones.width) as f32);
        tone.zip_map(&below.zip_map(&soft, |below, share| gain * share * below.max(0.0)), |tone, more| tone - more)
    })
}

/// The skin that an eye is compared with, in widths of the face; how much more than the photograph's its contrast is made, so that it is
/// left after printing (with 0.075 an eye in shade beside a bright white loses it, 16); and the most that it is darkened.
const COMPARED: f64 = 0.08;
const SPARE: f32 = 0.1;
const MOST_FIRMED: f32 = 0.2;

/// Eyes that a tone made for the whole face has left with less contrast than in the photograph get it back, and what their catchlights
/// will take; their lights are kept.
pub(super) fn eyes_at_least(zones: &Zones, face: &Landmarks, tone: &Raster<f32>, lightness: &Raster<f32>) -> Raster<f32> {
    eyes(face).into_iter().fold(tone.clone(), |tone, (lids, iris)| {
        let lit = share_of_opening(&lids, iris);
        let eye = polygon(tone.width(), tone.height(), &lids);
        let round = dilate(&eye, (COMPARED * zones.width).round().max(1.0) as usize);
        let round = round.zip_map(&zones.features, |near, feature| f32::from(u8::from(near == 1 && feature < 0.1)));
        let eye = eye.map(f32::from);
        let contrast = |of: &Raster<f32>| Some(mean(of, &round)? - mean(of, &eye)?);
        let (Some(wanted), Some(is)) = (contrast(lightness), contrast(&tone)) else { return tone };
        let missing = (wanted + SPARE + lit - is).clamp(0.0, MOST_FIRMED);
        if wanted <= 0.0 || missing == 0.0 {
            return tone;
        }
        let soft = fast_gaussian(&eye, (0.5 * WITH_LIDS * zones.width) as f32);
        let dark = tone.zip_map(&soft, |v, share| share * (1.1 - v).max(0.0));
        let Some(share) = mean(&dark, &eye).filter(|share| *share > 0.05) else { return tone };
        tone.zip_map(&dark, |v, dark| v - missing / share * dark)
    })
}

/// The lids' own line, in radii of the iris, is left as it is; so is a ring around the iris.
const LID: f64 = 0.16;
const LIMBUS: f64 = 1.08;
/// Blur of the zones' edges in radii of the iris.
const SOFT: f64 = 0.14;
/// The whites' median is raised to this, at most by this much and at most so far above the skin around. Whites of paper stare.
const WHITE: f32 = 0.93;
const MOST_RAISED: f32 = 0.28;
const ABOVE_SKIN: f32 = 0.22;
/// An iris is at least this much darker than its white; it is darkened at most by so much.
const IRIS_BELOW: f32 = 0.50;
const MOST_DARKENED: f32 = 0.16;
/// A catchlight is lighter than its iris' median by this, and its difference is raised by this factor.
const CATCHLIGHT: f32 = 0.22;
const SPARK: f32 = 1.5;

fn eye(tone: &Raster<f32>, lids: &[Point], iris: Iris, skin: f32) -> Raster<f32> {
    let open = openness(lids, EYE_OPEN);
    if open == 0.0 || iris.radius < 1.0 {
        return tone.clone();
    }
    let pixels = |radii: f64| radii * iris.radius;
    let outside = polygon(tone.width(), tone.height(), lids).map(|v| 1 - v);
    let inside = dilate(&outside, pixels(LID).round().max(1.0) as usize).map(|v| 1 - v);
    let distance = |x: usize, y: usize| iris.centre.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5)) / iris.radius;
    let zone = |is_in: &(dyn Fn(f64) -> bool + Sync)| {
        Raster::from_fn(tone.width(), tone.height(), |x, y| f32::from(inside.get(x, y) == 1 && is_in(distance(x, y))))
    };
    let (white, coloured) = (zone(&|d| d > LIMBUS), zone(&|d| d < 0.95));
    let (Some(whites), Some(middle)) = (median(tone, &white), median(tone, &coloured)) else { return tone.clone() };
    let raised = (WHITE.min(skin + ABOVE_SKIN) - whites).clamp(0.0, MOST_RAISED);
    let darkened = (middle - (whites + raised - IRIS_BELOW)).clamp(0.0, MOST_DARKENED);
    let soft = |zone: &Raster<f32>| fast_gaussian(zone, pixels(SOFT) as f32);
    let spark = |v: f32| SPARK * (v - middle - CATCHLIGHT).max(0.0);
    let whiter = tone.zip_map(&soft(&white), |v, white| v + open * white * raised);
    whiter.zip_map(&soft(&coloured), |v, iris| v + open * iris * (spark(v) - if spark(v) > 0.0 { 0.0 } else { darkened }))
}

/// Teeth: the gain of their detail (with 1.2 the gaps are drips and beads), the blur (in widths of the face) that it is measured from, and the most light of their mean.
const TEETH_DETAIL: f32 = 0.3;
const TEETH_REACH: f64 = 0.022;
const TEETH: f32 = 0.9;

fn teeth(zones: &Zones, tone: &Raster<f32>, lips: &[Point], skin: f32) -> Raster<f32> {
    let open = openness(lips, MOUTH_OPEN);
    let inside =
        polygon(tone.width(), tone.height(), lips).zip_map(tone, |inside, v| f32::from(inside == 1 && v > TEETH_ABOVE * skin));
    if open == 0.0 || inside.pixels().iter().all(|v| *v == 0.0) {
        return tone.clone();
    }
    let mean = fast_gaussian_within(tone, &inside.map(|v| v + 1e-6), (TEETH_REACH * zones.width) as f32);
    let drawn = tone.zip_map(&mean, |v, mean| mean.min(TEETH) + (1.0 + TEETH_DETAIL) * (v - mean));
    let soft = fast_gaussian(&inside, (0.3 * TEETH_REACH * zones.width) as f32);
    mixed(tone, &drawn, &soft.map(|share| open * share))
}

/// Lips are darker than the skin's median by this, within these limits; the share of their lights that is left above that; and the blur
/// of their edge in widths of the face.
const BELOW_SKIN: f32 = 0.25;
const LIPS: [f32; 2] = [0.42, 0.63];
const LIPS_LIGHT: f32 = 0.3;
const LIPS_SOFT: f64 = 0.008;

/// Lips stay darker than teeth and than lit skin: without an end in the lights a mouth is a slab of white.
fn lips(zones: &Zones, face: &Landmarks, tone: &Raster<f32>, skin: f32) -> Raster<f32> {
    let (columns, rows) = (tone.width(), tone.height());
    let [outer, inner] = [&outlines::LIPS, &outlines::MOUTH].map(|line| polygon(columns, rows, &face.line(line)));
    let zone = outer.zip_map(&inner, |outer, inner| f32::from(outer) * (1.0 - f32::from(inner)));
    let most = (skin - BELOW_SKIN).clamp(LIPS[0], LIPS[1]);
    let held = tone.map(|v| v.min(most + LIPS_LIGHT * (v - most).max(0.0)));
    mixed(tone, &held, &fast_gaussian(&zone, (LIPS_SOFT * zones.width) as f32))
}

/// Where an open mouth is dark, 0 to 1: it stays black behind the teeth.
pub(super) fn dark_of_mouth(zones: &Zones, face: &Landmarks, tone: &Raster<f32>) -> Raster<f32> {
    let line = face.line(&outlines::MOUTH);
    let open = openness(&line, MOUTH_OPEN);
    let most = TEETH_ABOVE * zones.median_of(tone);
    let inside = polygon(tone.width(), tone.height(), &line);
    inside.zip_map(tone, |inside, v| if inside == 1 && v < most { open } else { 0.0 })
}

/// The mean of the values in a zone; `None` if the zone is empty.
fn mean(values: &Raster<f32>, zone: &Raster<f32>) -> Option<f32> {
    let weighted = values.pixels().iter().zip(zone.pixels());
    let (sum, count) =
        weighted.filter(|(_, zone)| **zone > 0.5).fold((0.0, 0), |(sum, count), (v, _)| (sum + f64::from(*v), count + 1));
    (count > 0).then(|| (sum / f64::from(count)) as f32)
}

/// The median of the values in a zone; `None` if the zone is empty.
fn median(values: &Raster<f32>, zone: &Raster<f32>) -> Option<f32> {
    let inside = values.pixels().iter().zip(zone.pixels()).filter(|(_, zone)| **zone > 0.5);
    crate::raster::median(inside.map(|(v, _)| *v).collect())
}
