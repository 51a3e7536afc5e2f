//! Whether hair grows on the crown. Hair begins somewhere between forehead and crown, with a step into the dark or away from the
//! skin's colour; shade and shine on a bare scalp come gradually and keep the hue.

use super::plate::Plate;
use crate::elementary::Elementary as _;
use crate::raster::{Raster, gaussian_blur, median};
use crate::source::srgb_to_linear;

/// Samples dropped before the silhouette, and the fewest that a profile needs.
const MARGIN: usize = 3;
const LEAST: usize = 12;
/// Signs of hair: drop of L*, relative loss of colour, drop of redness. On 41 faces (sixteen portraits, five samples, four of two
/// men, sixteen of women in company) the greatest of the three, each divided by its limit, is at least 1.0 where there is hair
/// (least: a fair fringe in soft light, 1.0) and at most 0.9 on the two bare heads and the cropped one.
const DARKER: f32 = 15.0;
const PALER: f32 = 0.25;
const LESS_RED: f32 = 0.2;

/// What is on a crown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Crown {
    Hair,
    /// Hair of a few millimetres: skin by all signs but its border.
    Cropped,
    Bare,
}

/// One sample of a profile.
#[derive(Clone, Copy)]
struct Spot {
    lab: [f32; 3],
    light: [f32; 3],
    texture: f32,
}

/// The middle of the forehead's upper border, about which the profiles are centred.
const TOP: usize = 10;
/// Number of profiles, and the offset of the outermost ones from the middle, in `u`.
const PROFILES: usize = 13;
const ASIDE: f64 = 0.3;
/// Blur in working pixels, to suppress single hairs and grain.
const BLUR: f32 = 1.2;

/// What most profiles show on the crown; hair if too little of it is in the picture.
pub(super) fn crown(plate: &Plate) -> Crown {
    if (plate.is_grey && is_wide(plate)) || is_curtained(plate) {
        return Crown::Hair;
    }
    let tells = if plate.is_grey { Tells::Texture } else { Tells::Colour };
    let planes = |of: &(dyn Fn([f32; 3]) -> [f32; 3] + Sync), from: &Raster<[f32; 3]>| {
        let from = from.map(of);
        [0, 1, 2].map(|k| gaussian_blur(&from.map(|c| c[k]), BLUR))
    };
    let lab = planes(&|c| c, &plate.lab);
    let light = planes(&|c| c.map(srgb_to_linear), &plate.colours);
    let middle = f64::from(plate.coordinates(plate.point(TOP))[0]);
    let profiles: Vec<Vec<Spot>> = (0..PROFILES)
        .filter_map(|i| profile(plate, middle + ASIDE * (2.0 * i as f64 / (PROFILES - 1) as f64 - 1.0), &lab, &light))
        .collect();
    let most = |sign: &dyn Fn(&[Spot]) -> f32| median(profiles.iter().map(|spots| sign(spots)).collect());
    let is = |sign: &dyn Fn(&[Spot]) -> f32| most(sign).is_none_or(|sign| sign >= 1.0);
    if is(&|spots| hairiness(spots, tells)) {
        Crown::Hair
    } else if is(&|spots| hairline(spots) / HAIRLINE) {
        Crown::Cropped
    } else {
        Crown::Bare
    }
}

/// True if something light goes on beside the face from the temple to below the mouth, where only long hair hangs: fair hair in much light
/// clips as a shining scalp does, dark hair tells itself.
fn is_curtained(plate: &Plate) -> bool {
    /// Heights, in `v`, and where beside the head, in `u`; the least share of the person at each height. A bald head turned aside has 0.58 at one of
    /// them, the heads with long hair on a side 1.
    const HEIGHTS: [f32; 6] = [0.15, 0.3, 0.45, 0.6, 0.75, 0.9];
    const BESIDE: [f32; 2] = [0.6, 0.8];
    const LEAST: f32 = 0.95;
    /// Least median L* of the zone: fair hair has 80 and more.
    const FAIR: f32 = 60.0;
    let is_beside = |side: f32, u: f32| (BESIDE[0]..BESIDE[1]).contains(&(side * u));
    let is_filled =
        |side: f32, from: f32, to: f32| share_within(plate, &|u, v| (from..to).contains(&v) && is_beside(side, u)) > LEAST;
    let is_fair = |side: f32| {
        let zone = |[u, v]: [f32; 2]| (HEIGHTS[0]..HEIGHTS[HEIGHTS.len() - 1]).contains(&v) && is_beside(side, u);
        let light = plate.lab.pixels().iter().zip(plate.at.pixels()).filter(|(_, at)| zone(**at)).map(|(lab, _)| lab[0]);
        median(light.collect()).is_some_and(|light| light > FAIR)
    };
    [-1.0, 1.0].iter().any(|side| is_fair(*side) && HEIGHTS.windows(2).all(|band| is_filled(*side, band[0], band[1])))
}

/// The share of the person in a zone in `u` and `v`.
fn share_within(plate: &Plate, zone: &dyn Fn(f32, f32) -> bool) -> f32 {
    let (mut all, mut within) = (0_usize, 0_usize);
    for (at, inside) in plate.at.pixels().iter().zip(plate.inside.pixels()) {
        if zone(at[0], at[1]) {
            all += 1;
            within += usize::from(*inside);
        }
    }
    within as f32 / all.max(1) as f32
}

/// True for a head too high or too wide for a bare one: in black and white the grey of a forehead and of white hair are one.
fn is_wide(plate: &Plate) -> bool {
    /// The zones above the crown and beside the temples, in `u` and `v`, and the least share of the person in them: beside both temples
    /// (white curls have 0.87, a bald head turned aside 0.51), or above (white hair 1, bare heads 0.1).
    const ABOVE: f32 = 0.4;
    const BESIDE: f32 = 0.6;
    let beside = |sign: f32| share_within(plate, &|u, v| (0.75..1.0).contains(&v) && (0.6..0.75).contains(&(sign * u)));
    share_within(plate, &|u, v| (1.45..1.6).contains(&v) && u.abs() < 0.3) > ABOVE || beside(-1.0).min(beside(1.0)) > BESIDE
}

/// Profiles start at `FROM` (in `v`) and run upwards in steps of `STEP` to the person's silhouette, at most `MOST` steps.
const FROM: f64 = 0.7;
const STEP: f64 = 0.02;
const MOST: usize = 60;
/// Least height that a profile must reach, in `v`: on a head that leans back the hair begins behind the edge.
const HIGHEST: f64 = 1.15;

/// Colours from the forehead up to just below the silhouette.
fn profile(plate: &Plate, u: f64, lab: &[Raster<f32>; 3], light: &[Raster<f32>; 3]) -> Option<Vec<Spot>> {
    // Texture spreads over the silhouette by so many working pixels.
    const SPREAD: f64 = 10.0;
    let apart = STEP * plate.head.height * plate.scale;
    let margin = if plate.is_grey { ((SPREAD / apart) as usize).max(MARGIN) } else { MARGIN };
    let mut spots = Vec::with_capacity(MOST);
    for i in 0..MOST {
        let p = plate.head.place(u, FROM + i as f64 * STEP) - plate.part.origin();
        let (x, y) = ((p.x * plate.scale).floor() as isize, (p.y * plate.scale).floor() as isize);
        if !plate.inside.contains(x, y) || !plate.inside.get(x as usize, y as usize) {
            break;
        }
        let at = |planes: &[Raster<f32>; 3]| [0, 1, 2].map(|k| planes[k].get(x as usize, y as usize));
        let texture = plate.features.get(x as usize, y as usize)[3];
        spots.push(Spot { lab: at(lab), light: at(light), texture });
    }
    let reached = FROM + spots.len().saturating_sub(MARGIN) as f64 * STEP;
    spots.truncate(spots.len().saturating_sub(margin));
    (spots.len() >= LEAST && reached >= HIGHEST).then_some(spots)
}

/// Samples on either side of a step, whose means are compared: a tenth of the face's height.
const HALF: usize = 5;
/// Samples on either side of the border of cropped hair, and the least fall of L* there: one cropped head has 5 to 8, on three that are bare
/// (one by a lamp, one in shade) nothing falls.
const SHARP: usize = 2;
const HAIRLINE: f32 = 4.5;
/// Samples at either end, whose hues are compared.
const END: usize = 8;
/// Below this chroma hue is unreliable.
const LEAST_CHROMA: f32 = 5.0;

/// The strongest sign of hair on a profile; 1 is the threshold.
fn hairiness(spots: &[Spot], tells: Tells) -> f32 {
    let usual = mean(&spots[..LEAST]).lab[0];
    let steps = (HALF..=spots.len() - HALF).map(|i| step([&spots[i - HALF..i], &spots[i..i + HALF]], usual, tells));
    let step = steps.fold(0.0, f32::max);
    let (first, last) = (mean(&spots[..END]), mean(&spots[spots.len() - END..]));
    let has_hue = chroma(first) > LEAST_CHROMA && chroma(last) > LEAST_CHROMA;
    let hue = if has_hue { (redness(first) - redness(last)) / LESS_RED } else { 0.0 };
    step.max(hue)
}

/// A lamp's reflection on a bare scalp only adds white, until the photograph clips: from this L* on colour loss is ignored.
const SHINE: f32 = 92.0;

/// In black and white hair is darker than the forehead, or rougher by this texture.
const ROUGHER: f32 = 6.0;

/// What tells hair from skin besides darkness.
#[derive(Clone, Copy)]
enum Tells {
    Colour,
    Texture,
}

/// The fall of L* at the sharpest border into the dark, which stays dark beyond it: a furrow of the forehead does not, and shade falls slowly.
fn hairline(spots: &[Spot]) -> f32 {
    let usual = mean(&spots[..LEAST]).lab[0];
    let fall = |i: usize| {
        let below = mean(&spots[i - SHARP..i]).lab[0].min(usual);
        let [above, beyond] = [0, HALF - SHARP].map(|from| mean(&spots[i + from..i + from + SHARP]).lab[0]);
        below - above.max(beyond)
    };
    (HALF..=spots.len() - HALF).map(fall).fold(0.0, f32::max)
}

/// How much the change from one stretch to the next resembles a hairline. `usual` is the forehead's L*: the fall from a
/// reflection back to plain skin above it does not count.
fn step([below, above]: [&[Spot]; 2], usual: f32, tells: Tells) -> f32 {
    let is_shine = below.iter().chain(above).any(|spot| spot.lab[0] > SHINE);
    let (below, above) = (mean(below), mean(above));
    let darker = (below.lab[0].min(usual) - above.lab[0]) / DARKER;
    let rougher = (above.texture - below.texture) / ROUGHER;
    let shade = (above.light[1] / below.light[1].max(1e-4)).min(1.0);
    let kept = colourfulness(above) / (colourfulness(below) * shade).max(0.002);
    match tells {
        _ if is_shine => darker,
        Tells::Texture => darker.max(rougher),
        Tells::Colour => darker.max((1.0 - kept) / PALER),
    }
}

fn mean(spots: &[Spot]) -> Spot {
    let count = spots.len() as f32;
    let of = |part: &dyn Fn(&Spot) -> [f32; 3]| [0, 1, 2].map(|k| spots.iter().map(|spot| part(spot)[k]).sum::<f32>() / count);
    let [texture, ..] = of(&|spot| [spot.texture; 3]);
    Spot { lab: of(&|spot| spot.lab), light: of(&|spot| spot.light), texture }
}

fn chroma(spot: Spot) -> f32 {
    spot.lab[1].hypotenuse(spot.lab[2])
}

/// Red minus blue, in linear light; unchanged by added white.
fn colourfulness(spot: Spot) -> f32 {
    spot.light[0] - spot.light[2]
}

/// Position of green between blue (1) and red (0): unchanged by shade and by added white.
fn redness(spot: Spot) -> f32 {
    let [r, g, b] = spot.light;
    (r - g) / (r - b).max(0.004)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spots(colour: impl Fn(f32) -> [f32; 3]) -> Vec<Spot> {
        let spot = |i: usize| {
            let light = colour(i as f32 / 30.0);
            let y = 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
            let l = 116.0 * y.cube_root() - 16.0;
            Spot { lab: [l, 15.0, 15.0], light, texture: 0.0 }
        };
        (0..30).map(spot).collect()
    }

    #[test]
    fn cropped_hair_has_a_border_that_shade_and_furrows_have_not() {
        let skin = [0.3, 0.18, 0.12];
        let dark = |share: f32| skin.map(|v| v * share);
        assert!(hairline(&spots(|t| dark(1.0 - 0.6 * t))) < 0.8 * HAIRLINE, "shade");
        assert!(hairline(&spots(|t| dark(if (0.4..0.47).contains(&t) { 0.7 } else { 1.0 }))) < HAIRLINE, "a furrow");
        let cropped = spots(|t| dark(if t < 0.5 { 1.0 } else { 0.75 }));
        assert!(hairline(&cropped) > HAIRLINE && hairiness(&cropped, Tells::Colour) < 1.0);
    }

    #[test]
    fn shade_and_shine_are_skin_and_a_hairline_is_hair() {
        let skin = [0.5, 0.3, 0.2];
        assert!(hairiness(&spots(|t| skin.map(|v| v * (1.0 - 0.6 * t))), Tells::Colour) < 1.0);
        assert!(hairiness(&spots(|t| skin.map(|v| v + 0.5 * t)), Tells::Colour) < 1.0);
        assert!(hairiness(&spots(|t| if t < 0.5 { skin } else { [0.05, 0.03, 0.02] }), Tells::Colour) > 1.5);
        assert!(hairiness(&spots(|t| if t < 0.5 { skin } else { [0.6, 0.58, 0.57] }), Tells::Colour) > 1.5);
    }
}
