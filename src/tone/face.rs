//! The tone of one face, over the whole picture.

use super::curve::Curve;
use super::ears::with_ears;
use super::lenses::with_clear_lenses;
use super::lights::{rubbed, with_half_tones};
use super::mixing::mixed;
use super::openings::{dark_of_mouth, eyes_at_least, firm_eyes, opened};
use super::zones::Zones;
use crate::elementary::Elementary as _;
use crate::geometry::Point;
use crate::raster::{Raster, Remapping, fast_gaussian, fast_gaussian_within, local_laplacian, self_guided};
use crate::source::Landmarks;

/// Lighting: the blur (in widths of the face) that separates light from form, and the share of its difference from the median
/// that is removed in shade and in light.
const LIGHT_REACH: f64 = 0.22;
const SHADE_EVENED: f32 = 0.5;
const LIGHT_EVENED: f32 = 0.35;
/// Local contrast: contrasts below `sigma` are raised by the power `alpha`, larger ones lowered a little. Pyramid levels finer
/// than `FINE` of a sixtieth of the face (about a dot) are left unchanged.
const CONTRAST: Remapping = Remapping { alpha: 0.65, sigma: 0.16, beta: 0.85 };
const DOTS: f64 = 60.0;
const FINE: f64 = 0.35;
const SAMPLES: usize = 14;
/// The base layer of the curve: its radius in widths of the face, the contrast that it keeps, and the gain of the detail.
const BASE_REACH: f64 = 0.045;
const BASE_CONTRAST: f32 = 0.03;
const DETAIL: f32 = 1.25;
/// Target tone on paper for a face's median `m`: `MEDIAN[0] + MEDIAN[1] m`.
const MEDIAN: [f32; 2] = [0.32, 0.61];
/// Black, and the end of the curve's toe.
const BLACK: f32 = 0.06;
const TOE: [f32; 2] = [0.10, 0.19];
/// The lights: the percentiles of the skin that get `LIGHT_TONE` and white, of light skin and of dark; and the range of the curve's slope up to
/// the first. With the percentiles of light skin, brown foreheads are white (01, 04, 11); with a tone of 0.955 for both, which is nearly
/// paper, editors called the skin of 11 of 16 blown out; with 0.91 and 0.86 the lights lose their shape (02, 04, 06, 12, 14, 15).
const LIGHTS: [f64; 2] = [84.0, 93.0];
const LIGHT_TONE: [f64; 2] = [0.93, 0.88];
const WHITES: [f64; 2] = [96.0, 98.5];
const SLOPES: [f32; 2] = [0.8, 3.1];
/// Lights are measured at the size of a dot, in widths of the face.
const DOT: f64 = 0.012;
/// Clothing's own curve: black cloth is lightened, white cloth stays white.
const CLOTHING: [[f32; 2]; 6] = [[-0.3, 0.0], [0.0, 0.06], [0.10, 0.17], [0.35, 0.40], [0.70, 0.73], [1.0, 1.0]];
/// Hair lighter than `LIGHT_HAIR` is compressed, and the contrast of its strands raised. With 0.76 and 0.45 white hair is bare paper with a
/// few lines (12, 13); without a limit on how far strands go from their surroundings, shade between white locks is black blots (12 to 14).
const LIGHT_HAIR: f32 = 0.68;
const HELD: f32 = 0.4;
const STRANDS: f32 = 2.2;
const MOST_STRAND: f32 = 0.3;
/// The same for beards, most of which are short: with the contrast of locks a white one is splashes of paper (14).
const STRANDS_OF_BEARD: f32 = 0.6;
const MOST_OF_BEARD: f32 = 0.16;
/// How much the difference of eyes, brows and lips from the surrounding skin is raised.
const FEATURES: f32 = 0.40;
/// Large blacks below this tone are lightened; in the face the threshold is higher.
const OPENED: f32 = 0.19;
const OPENED_IN_FACE: f32 = 0.07;

/// What is seen as bare paper at the viewing distance of a print: a blur in widths of the face, the percentile above which the
/// face's lights reach paper, and the tone of paper. With the 98th percentile, three of sixteen faces had less than 2 % of bare
/// paper.
const SEEN: f64 = 0.03;
const BELOW_PAPER: f64 = 92.5;
const PAPER: f32 = 0.985;
/// Lights above this percentile are raised, at most by this multiple of the range from there to the lights.
const RAISED_FROM: f64 = 75.0;
const MOST_RAISED: f32 = 1.8;
/// Lights that are narrow, as on moist skin, are raised from a lower percentile on, at lowest this one, until this percentile is seen as this
/// tone, which a print still shows as paper.
const LOWEST_RAISED: f64 = 20.0;
const LEAST_BARE: f64 = 95.2;
const NEARLY_PAPER: f32 = 0.975;
/// Above this percentile a face is not raised to paper, however scattered that is: Grace Hopper's would be to more than a quarter.
const MOST_SPREAD: f64 = 80.0;
/// How far these narrow lights are told by the tone around them, 0 to 1: by their own tone alone, single pores are raised and the skin between
/// is not.
const WIDE: f32 = 0.8;
/// What is darker than the light around it by more than this is a furrow.
const PORES: f32 = 0.04;
const HALVINGS: usize = 5;
/// Width of the transition, in widths of the face, from raised lights inside the face to the unchanged tone outside.
const FACE_EDGE: f64 = 0.05;

/// The picture that faces are in.
pub(super) struct Setting<'a> {
    pub lightness: &'a Raster<f32>,
    /// 0 to 1, with a sharpened edge.
    pub subject: Raster<f32>,
    /// Hair, beards and headwear.
    pub hair: Option<Raster<f32>>,
    /// Beards and moustaches, which `hair` holds too.
    pub facial_hair: Option<Raster<f32>>,
    pub clothing: Option<Raster<f32>>,
}

/// Applies all steps in order. Values may leave 0 to 1. `None` if the face has no skin to measure.
pub(super) fn tone(face: &Landmarks, setting: &Setting<'_>) -> Option<Raster<f32>> {
    let zones = Zones::new(face, setting.lightness)?;
    let evened = evened_light(&zones, setting.lightness);
    let contrasted = local_contrast(&zones, &evened, &setting.subject);
    let base = self_guided(&contrasted, (BASE_REACH * zones.width).round().max(2.0) as usize, BASE_CONTRAST * BASE_CONTRAST);
    let detail = contrasted.zip_map(&base, |v, base| DETAIL * (v - base));
    let curve = curve_of(&zones, &contrasted, &base);
    let mut tone = base.zip_map(&detail, |base, detail| curve.at(base) + detail);
    if let Some(clothing) = &setting.clothing {
        let own = Curve::through(&CLOTHING);
        let cloth = base.zip_map(&detail, |base, detail| own.at(base) + detail);
        tone = mixed(&tone, &cloth, &fast_gaussian(clothing, (0.012 * zones.width) as f32));
    }
    if let Some(hair) = &setting.hair {
        tone = light_hair(&zones, face, &tone, hair, setting);
    }
    let tone = raised_features(&zones, face, &tone, setting);
    let skin = skin_of(setting);
    let tone = with_ears(&zones, &tone, &skin, face, heights(face));
    let tone = opened(&zones, face, &tone);
    let tone = opened_blacks(&zones, face, &tone, setting);
    let tone = lights_to_paper(&zones, &tone, setting.hair.as_ref());
    let tone = rubbed(&zones, &tone, |tone| seen(&zones, tone), PAPER);
    let tone = with_half_tones(&zones, &tone, &skin);
    let tone = with_clear_lenses(&zones, face, tone);
    let tone = eyes_at_least(&zones, face, &tone, setting.lightness);
    Some(mixed(setting.lightness, &tone, &setting.subject))
}

/// Step 1: a heavily blurred lightness of the skin is pulled towards its median.
fn evened_light(zones: &Zones, lightness: &Raster<f32>) -> Raster<f32> {
    let weight = zones.skin.zip_map(&zones.oval, |skin, oval| skin + 1e-5 * f32::from(oval));
    let smooth = zones.over_skin(lightness, &weight, LIGHT_REACH);
    let sigma = (LIGHT_REACH * zones.width) as f32;
    let sure = fast_gaussian(&zones.skin, sigma).map(|v| (v / 0.25).clamp(0.0, 1.0));
    let median = zones.median;
    let off = smooth.zip_map(&sure, |smooth, sure| {
        let share = if smooth < median { SHADE_EVENED } else { LIGHT_EVENED };
        share * (median - smooth) * sure
    });
    let off = fast_gaussian(&off, 0.5 * sigma);
    // Blacks stay black, and whites white.
    lightness.zip_map(&off, |l, off| (l + off * (l / 0.25).clamp(0.0, 1.0) * ((1.0 - l) / 0.1).clamp(0.0, 1.0)).clamp(0.0, 1.0))
}

/// Step 2: the subject is extended beyond its border by its own mean, so that the border has no contrast and no halo.
fn local_contrast(zones: &Zones, evened: &Raster<f32>, subject: &Raster<f32>) -> Raster<f32> {
    let weight = subject.map(|v| v + 1e-6);
    let beyond = zones.over_skin(evened, &weight, 0.1);
    let filled = mixed(&beyond, evened, subject);
    let count = ((zones.width / 10.0).max(1.0).binary_logarithm().round() as usize).max(3);
    let left = (0..count).take_while(|level| f64::from(1 << level) < FINE * zones.width / DOTS).count();
    local_laplacian(&filled, left..count, CONTRAST, SAMPLES)
}

/// Step 3: the rising curve through the skin's median and its lights.
fn curve_of(zones: &Zones, contrasted: &Raster<f32>, base: &Raster<f32>) -> Curve {
    let median = zones.median_of(contrasted);
    let paper = MEDIAN[0] + MEDIAN[1] * zones.median;
    let dots = fast_gaussian(base, (DOT * zones.width) as f32);
    let at = |percentiles: [f64; 2]| zones.percentile(&dots, zones.by_skin(percentiles));
    let lights = at(LIGHTS).max(median + 0.03);
    let light_tone = zones.by_skin(LIGHT_TONE) as f32;
    let slope = ((light_tone - paper) / (lights - median)).clamp(SLOPES[0], SLOPES[1]);
    let lights = median + (light_tone - paper) / slope;
    let white = if lights < 0.94 { at(WHITES).min(lights + 0.06).max(lights + 0.02) } else { lights + 0.05 };
    let toe = TOE[0].min(0.4 * median);
    Curve::through(&[
        [-0.3, BLACK - 0.15],
        [0.0, BLACK],
        [toe, TOE[1]],
        [median, paper],
        [lights, light_tone],
        [white, 1.0],
        [(white + 0.2).max(1.3), 1.12],
    ])
}

/// Step 5: light hair gets strands instead of bare paper.
fn light_hair(zones: &Zones, face: &Landmarks, tone: &Raster<f32>, hair: &Raster<f32>, setting: &Setting<'_>) -> Raster<f32> {
    /// Height, in heights of the face above the chin, at which hair counts no more, and over which its share falls: clothing in its place below is
    /// likelier than a mistake.
    const LOWEST: f64 = -1.3;
    const FADE: f64 = 0.3;
    let subject = &setting.subject;
    let height = heights(face);
    let soft = fast_gaussian(hair, (0.015 * zones.width) as f32);
    let zone = Raster::from_fn(tone.width(), tone.height(), |x, y| {
        soft.get(x, y) * subject.get(x, y) * ((height(x, y) - LOWEST) / FADE).clamp(0.0, 1.0) as f32
    });
    let weight = zone.zip_map(subject, |zone, subject| zone + 1e-4 * subject + 1e-6);
    let mean = zones.over_skin(&tone.map(|v| v.clamp(0.0, 1.05)), &weight, 0.05);
    let beard = setting.facial_hair.as_ref().map(|beard| fast_gaussian(beard, (0.015 * zones.width) as f32));
    let held = Raster::from_fn(tone.width(), tone.height(), |x, y| {
        let (tone, mean) = (tone.get(x, y), mean.get(x, y));
        let short = beard.as_ref().map_or(0.0, |beard| beard.get(x, y));
        let (strand, light) = (tone - mean, ((mean - 0.5) / 0.3).clamp(0.0, 1.0));
        let most = MOST_STRAND + short * (MOST_OF_BEARD - MOST_STRAND);
        let raised = most * ((1.0 + STRANDS + short * (STRANDS_OF_BEARD - STRANDS)) * strand / most).hyperbolic_tangent();
        let strand = strand + light * (raised - strand);
        mean.min(LIGHT_HAIR + HELD * (mean - LIGHT_HAIR).max(0.0)) + strand
    });
    mixed(tone, &held, &zone)
}

/// The person without hair and clothing.
fn skin_of(setting: &Setting<'_>) -> Raster<f32> {
    let without = |skin: Raster<f32>, mask: &Option<Raster<f32>>| match mask {
        Some(mask) => skin.zip_map(mask, |skin, mask| skin * (1.0 - mask)),
        None => skin,
    };
    without(without(setting.subject.clone(), &setting.hair), &setting.clothing)
}

/// A share of the face that beards have none of: they are hair, and a black moustache among lips and skin would be mottled.
fn without_beard(share: &Raster<f32>, setting: &Setting<'_>) -> Raster<f32> {
    match &setting.facial_hair {
        Some(beard) => share.zip_map(beard, |share, beard| share * (1.0 - beard)),
        None => share.clone(),
    }
}

/// Height of a pixel's middle above the chin, in heights of the face.
fn heights(face: &Landmarks) -> impl Fn(usize, usize) -> f64 + Sync {
    let (chin, up) = (face.point(152), face.point(10) - face.point(152));
    move |x, y| (Point::new(x as f64 + 0.5, y as f64 + 0.5) - chin).dot(up) / up.hypot2().max(1e-9)
}

/// Step 6: eyes, brows and lips get more contrast against the surrounding skin, and moustaches as a whole: with more contrast
/// between its hairs, a black one is mottled (02).
fn raised_features(zones: &Zones, face: &Landmarks, tone: &Raster<f32>, setting: &Setting<'_>) -> Raster<f32> {
    /// Blur of beards in widths of the face.
    const WHOLE: f64 = 0.03;
    let subject = &setting.subject;
    let weight = zones.skin.zip_map(subject, |skin, subject| (skin + 1e-4) * subject + 1e-6);
    let round = zones.over_skin(tone, &weight, 0.10);
    let seen = match &setting.facial_hair {
        Some(beard) => mixed(tone, &zones.over_skin(tone, &beard.map(|beard| beard + 1e-6), WHOLE), beard),
        None => tone.clone(),
    };
    let raised = seen.zip_map(&round, |seen, round| FEATURES * (seen - round));
    let tone = tone.zip_map(&raised.zip_map(&zones.features, |raised, feature| raised * feature), |tone, more| tone + more);
    firm_eyes(zones, face, &tone, &round)
}

/// Step 8: hair, beards and cloth keep gaps of paper; thin dark lines stay.
fn opened_blacks(zones: &Zones, face: &Landmarks, tone: &Raster<f32>, setting: &Setting<'_>) -> Raster<f32> {
    let subject = &setting.subject;
    let clamped = tone.map(|v| v.clamp(0.0, 1.0));
    let mean = fast_gaussian_within(&clamped, &subject.map(|v| v + 1e-6), (zones.width / 40.0) as f32);
    let in_face = without_beard(&fast_gaussian(&zones.oval.map(f32::from), (0.03 * zones.width) as f32), setting);
    let lift = mean.zip_map(&in_face, |mean, face| (0.45 + 0.2 * face) * (OPENED + OPENED_IN_FACE * face - mean).clamp(0.0, 1.0));
    let lift = lift.zip_map(&dark_of_mouth(zones, face, tone), |lift, mouth| lift * (1.0 - mouth));
    tone.zip_map(&lift, |tone, lift| tone + lift)
}

/// Step 9: a face whose lights are small or scattered gets bare paper too. Above the face's bright quarter the curve is
/// steepened, by the least amount that takes its lights, as seen in print, to paper; if that is not enough, from further below. Light
/// beards keep their strands.
fn lights_to_paper(zones: &Zones, tone: &Raster<f32>, hair: Option<&Raster<f32>>) -> Raster<f32> {
    let before = seen(zones, tone);
    let [from, lowest, lights] =
        [RAISED_FROM, LOWEST_RAISED, BELOW_PAPER].map(|hundredths| zones.percentile(&before, hundredths));
    let range = lights - from;
    let in_face = fast_gaussian(&zones.oval.map(f32::from), (FACE_EDGE * zones.width) as f32);
    let in_face = hair.map_or_else(|| in_face.clone(), |hair| in_face.zip_map(hair, |face, hair| face * (1.0 - hair)));
    let raised = |from: f32, most: f32, wide: f32| {
        let more = tone.zip_map(&before, |v, light| {
            let above = ((v + wide * (light - v) - from) / range).max(0.0);
            most * if above < 1.0 { above * above } else { 2.0 * above - 1.0 }
        });
        let raised = tone.zip_map(&more.zip_map(&in_face, |more, face| more * face), |tone, more| tone + more);
        // Furrows stay as deep as they are; pores go.
        let most = tone.zip_map(&before, |v, light| v.max(1.0 + (v - light + PORES).min(0.0)));
        raised.zip_map(&most, f32::min)
    };
    if lights >= PAPER || range <= 0.0 {
        return tone.clone();
    }
    let reaches = |tone: Raster<f32>, hundredths: f64, paper: f32| zones.percentile(&seen(zones, &tone), hundredths) >= paper;
    let most = MOST_RAISED * range;
    if reaches(raised(from, most, 0.0), LEAST_BARE, NEARLY_PAPER) {
        raised(from, most * least(|share| reaches(raised(from, share * most, 0.0), BELOW_PAPER, PAPER)), 0.0)
    } else {
        let lower = |share: f32| raised(from + share * (lowest - from), most, WIDE);
        let is_spread = |tone: &Raster<f32>| zones.percentile(tone, MOST_SPREAD) >= NEARLY_PAPER;
        lower(least(|share| is_spread(&lower(share)) || reaches(lower(share), LEAST_BARE, NEARLY_PAPER)))
    }
}

/// The least share that is enough, or 1.
fn least(is_enough: impl Fn(f32) -> bool) -> f32 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_enough(middle) { high = middle } else { low = middle }
    }
    high
}

/// A tone as it is seen at the viewing distance of a print.
fn seen(zones: &Zones, tone: &Raster<f32>) -> Raster<f32> {
    fast_gaussian(&tone.map(|v| v.clamp(0.0, 1.0)), (SEEN * zones.width) as f32)
}
