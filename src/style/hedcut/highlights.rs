//! Step 7: bare highlights with a fade (Bruehl 2023, sections 4.3.2 and 4.4).
//!
//! Over the fade dots shrink; those that would become specks keep a visible size and thin out in blue-noise order, so that no
//! border shows.

use super::features::Features;
use super::{Drawer, SizedDot};
use crate::geometry::{Point, blue_noise_order};
use crate::raster::Raster;

/// Radius below which a fading dot is thinned out instead of shrunk, in pitches: 0.14 is 6 % ink. At 0.1 the fade ends in dust
/// that print loses; at 0.2 single dots stand out on a cheek (looked at on the astronaut and Grace Hopper).
const LEAST_FADING_RADIUS: f64 = 0.14;

/// The ink field with highlights taken out: none in the lightest steps, rising to all of it over the fade.
pub(super) fn fade_ink(drawer: &Drawer<'_>, ink: &Raster<f32>, features: &Features) -> Raster<f32> {
    if !drawer.parameters.has_highlights {
        return ink.clone();
    }
    drawer.observer.begin("highlights");
    let fade = Fade::new(drawer);
    let faded = ink.zip_map(&features.smoothed, |ink, lightness| ink * fade.share(lightness));
    drawer.observer.picture("highlights", &|| crate::style::Picture::Grey(faded.map(|v| 1.0 - v)));
    faded
}

/// Thins out the dots that fading has made too small.
pub(super) fn thin_out(drawer: &Drawer<'_>, dots: Vec<SizedDot>, features: &Features) -> Vec<SizedDot> {
    if !drawer.parameters.has_highlights {
        return dots;
    }
    let fade = Fade::new(drawer);
    let least = LEAST_FADING_RADIUS * drawer.pitch();
    let is_specks = |dot: &SizedDot| dot.radius < least && fade.share(features.smoothed.sample(dot.centre.x, dot.centre.y)) < 1.0;
    let (specks, mut kept): (Vec<SizedDot>, Vec<SizedDot>) = dots.into_iter().partition(is_specks);
    let centres: Vec<Point> = specks.iter().map(|dot| dot.centre).collect();
    let count = centres.len() as f64;
    for (rank, i) in blue_noise_order(&centres).into_iter().enumerate() {
        // The speck's share of a least dot is the chance to stand for its neighbours; its rank is the throw of the dice.
        let share = (specks[i].radius / least).powi(2);
        if (rank as f64 + 0.5) / count < share {
            kept.push(SizedDot { centre: centres[i], radius: least });
        }
    }
    kept
}

/// How much of its ink a lightness keeps.
struct Fade {
    bare: f32,
    width: f32,
}

impl Fade {
    fn new(drawer: &Drawer<'_>) -> Self {
        let bare = 1.0 - drawer.parameters.highlight_steps / f64::from(drawer.parameters.levels);
        Self { bare: bare as f32, width: drawer.parameters.highlight_fade.max(1e-3) as f32 }
    }

    /// 0 in the highlight, 1 below the fade, smooth between.
    fn share(&self, lightness: f32) -> f32 {
        let t = ((self.bare - lightness) / self.width).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}
