//! Step 7: bare highlights with a fade (Bruehl 2023, sections 4.3.2 and 4.4).
//!
//! Dots shrink over the fade; those that would become specks keep a visible size and are thinned out in blue-noise order, so that no
//! border shows.

use super::features::Features;
use super::{Drawer, SizedDot};
use crate::geometry::{Point, blue_noise_order};
use crate::raster::{Raster, components, gaussian_blur};
use crate::source::MaskRole;
use std::borrow::Cow;

/// Radius below which a fading dot is thinned out instead of shrunk, in pitches: 0.14 is 6 % ink. At 0.1 the fade ends in dust that
/// print loses; at 0.2 single dots stand out on a cheek (judged on the astronaut and Grace Hopper).
const LEAST_FADING_RADIUS: f64 = 0.14;

/// With a tone made for faces: ink below which paper stays bare, and ink at which the fade ends. That tone sets its own whites. With
/// 0.14 and 0.24, as from the levels of a plain photograph, foreheads are blown out, and with 0.05 and 0.13 cheeks have holes; without a fade
/// they end in dust (judged on sixteen portraits).
const PORTRAIT_BARE: f32 = 0.03;
const PORTRAIT_FADE: f32 = 0.09;

/// The ink without highlights: 0 in the lightest levels, rising to the full ink over the fade.
pub(super) fn fade_ink(drawer: &Drawer<'_>, ink: &Raster<f32>, features: &Features) -> Raster<f32> {
    if !drawer.parameters.has_highlights {
        return ink.clone();
    }
    drawer.observer.begin("highlights");
    let fade = Fade::new(drawer, features);
    let faded = ink.zip_map(&fade.light, |ink, light| ink * fade.share(light));
    drawer.observer.picture("highlights", &|| crate::style::Picture::Grey(faded.map(|v| 1.0 - v)));
    faded
}

/// Thins out the dots that fading has made too small.
pub(super) fn thin_out(drawer: &Drawer<'_>, dots: Vec<SizedDot>, features: &Features) -> Vec<SizedDot> {
    if !drawer.parameters.has_highlights {
        return dots;
    }
    let fade = Fade::new(drawer, features);
    let least = LEAST_FADING_RADIUS * drawer.pitch();
    let is_specks = |dot: &SizedDot| dot.radius < least && fade.share(fade.light.sample(dot.centre.x, dot.centre.y)) < 1.0;
    let (specks, mut kept): (Vec<SizedDot>, Vec<SizedDot>) = dots.into_iter().partition(is_specks);
    let centres: Vec<Point> = specks.iter().map(|dot| dot.centre).collect();
    let count = centres.len() as f64;
    for (rank, i) in blue_noise_order(&centres).into_iter().enumerate() {
        // A speck's area as a share of the smallest dot is its chance to be kept; its blue-noise rank decides.
        let share = (specks[i].radius / least).powi(2);
        if (rank as f64 + 0.5) / count < share {
            kept.push(SizedDot { centre: centres[i], radius: least });
        }
    }
    kept
}

/// Most dots of a group that stands alone and looks like dirt on the paper; groups of darker dots, whose mean radius in pitches is above the
/// second number, are moles. Judged on sixteen portraits: they have such groups of 1 to 7 on foreheads and chins.
const CRUMB: usize = 8;
const MOLE: f64 = 0.36;

/// Takes out the few dots that stand alone, as on a face's highlights: pores and fine folds. Features keep theirs.
pub(super) fn without_crumbs(drawer: &Drawer<'_>, dots: Vec<SizedDot>) -> Vec<SizedDot> {
    if !drawer.parameters.has_highlights || !drawer.portrait.has_portrait_tone() {
        return dots;
    }
    let detail = drawer.portrait.masks.get(&MaskRole::Detail);
    let is_feature = |dot: &SizedDot| detail.is_some_and(|mask| mask.sample(dot.centre.x, dot.centre.y) > 0.5);
    let is_crumb = crumbs(&dots, drawer.pitch());
    dots.into_iter().zip(is_crumb).filter(|(dot, is_crumb)| !is_crumb || is_feature(dot)).map(|(dot, _)| dot).collect()
}

/// Whether each dot belongs to a group of few pale dots; dots in neighbouring cells of a pitch are in one group.
fn crumbs(dots: &[SizedDot], pitch: f64) -> Vec<bool> {
    let cell = |dot: &SizedDot| [dot.centre.x, dot.centre.y].map(|v| (v / pitch).max(0.0) as usize);
    let last = dots.iter().map(cell).fold([0, 0], |[x, y], [cx, cy]| [x.max(cx), y.max(cy)]);
    let mut marked = Raster::filled(last[0] + 1, last[1] + 1, 0_u8);
    dots.iter().map(cell).for_each(|[x, y]| marked.set(x, y, 1));
    let (labels, count) = components(&marked);
    let group = |dot: &SizedDot| {
        let [x, y] = cell(dot);
        labels.get(x, y) as usize
    };
    let mut groups = vec![(0_usize, 0.0_f64); count + 1];
    for dot in dots {
        let (dots, radii) = &mut groups[group(dot)];
        (*dots, *radii) = (*dots + 1, *radii + dot.radius);
    }
    let is_crumb = |dot: &SizedDot| {
        let (dots, radii) = groups[group(dot)];
        dots <= CRUMB && radii < MOLE * pitch * dots as f64
    };
    dots.iter().map(is_crumb).collect()
}

/// The share of ink kept by lightness.
struct Fade<'a> {
    /// Lightness that controls the fade: the photograph's, or that of the tone made for its faces.
    light: Cow<'a, Raster<f32>>,
    /// Ink below which paper stays bare.
    bare: f32,
    /// Ink at which all of it is drawn.
    full: f32,
}

impl<'a> Fade<'a> {
    fn new(drawer: &Drawer<'_>, features: &'a Features) -> Self {
        if drawer.portrait.has_portrait_tone() {
            let tone = drawer.portrait.on_white(&drawer.portrait.tone);
            let light = gaussian_blur(&tone, (0.5 * drawer.pitch()) as f32);
            return Self { light: Cow::Owned(light), bare: PORTRAIT_BARE, full: PORTRAIT_FADE };
        }
        let bare = (drawer.parameters.highlight_steps / f64::from(drawer.parameters.levels)) as f32;
        let width = drawer.parameters.highlight_fade.max(1e-3) as f32;
        Self { light: Cow::Borrowed(&features.smoothed), bare, full: bare + width }
    }

    /// The share of ink that is kept; the drawn ink rises linearly with the target ink, from none to all of it.
    fn share(&self, light: f32) -> f32 {
        let ink = 1.0 - light;
        if ink >= self.full {
            return 1.0;
        }
        let drawn = self.full * ((ink - self.bare) / (self.full - self.bare)).max(0.0);
        drawn / ink.max(1e-6)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_pale_dots_alone_are_crumbs_and_moles_and_larger_groups_are_not() {
        let row = |x: f64, count: usize, radius: f64| {
            (0..count).map(move |i| SizedDot { centre: Point::new(x + i as f64, 5.0), radius })
        };
        let dots: Vec<SizedDot> = row(0.0, 8, 0.2).chain(row(20.0, 9, 0.2)).chain(row(40.0, 2, 0.4)).collect();
        let is_crumb = crumbs(&dots, 1.0);
        assert!(is_crumb[..8].iter().all(|is| *is), "a fold");
        assert!(!is_crumb[8..].iter().any(|is| *is), "a shade, and a mole");
        assert!(crumbs(&[], 1.0).is_empty());
    }
}
