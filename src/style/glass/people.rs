//! Strokes over people: along the form of faces, locks and folds, finer along eyes and mouth, broader behind.
//!
//! The chapter follows the photograph's gradient alone, which turns around every highlight of a cheek. Where the gradient is faint, the
//! form's directions take its place; at edges it stays.

use super::parameters::{Strokes, Transform};
use super::{Drawer, noise};
use crate::elementary::{Elementary as _, unit_at};
use crate::field::Flow;
use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, fast_gaussian, gradient};
use crate::source::MaskRole;
use crate::style::drawn_directions::DrawnDirections;
use crate::style::form::Surface;
use crate::style::head::Head;
use crate::style::solids::detail_zone;
use std::f64::consts::FRAC_PI_2;

/// Blur of the flow behind people in that of the others: larger whirls.
pub(super) const BEHIND: f32 = 4.0;
/// The band of eyes and spectacles, in heights of the face above its chin and in its widths from the middle, how fast it fades, and how
/// fine its strokes are.
const BAND: std::ops::Range<f64> = -0.80..-0.44;
const BAND_REACH: f64 = 0.56;
const BAND_FADE: f64 = 0.06;
const BAND_DETAIL: f64 = 0.8;

/// Where strokes differ from the others, on the working grid.
pub(super) struct People {
    /// 0 to 1 towards the middle of eyes, brows, noses and mouths.
    pub detail: Raster<f32>,
    /// 0 on skin and hair, 1 on the background.
    pub broad: Raster<f32>,
}

impl People {
    /// What is left of the range of lightness between strokes at a place.
    pub(super) fn contrast(&self, p: Point) -> f32 {
        /// What is left of the range of lightness between strokes on faces and behind people: with all of it skin is scratched,
        /// and walls are livelier than who stands before them.
        const CALM: [f32; 2] = [0.4, 0.4];
        let behind = self.broad.sample(p.x, p.y).clamp(0.0, 1.0);
        CALM[0] + (CALM[1] - CALM[0]) * behind
    }
}

impl Drawer<'_> {
    /// What is known of people; none without a face, or where all places are to be alike.
    pub(super) fn people(&self) -> Option<People> {
        /// Blur of the border of broad strokes in pitches.
        const BROAD_BLUR: f64 = 1.5;
        /// How broad strokes on cloth are, between those of skin (0) and those of the background (1).
        const CLOTH: f32 = 0.4;
        let parameters = &self.parameters;
        let is_even = parameters.strokes == Strokes::Even || parameters.transform != Transform::Photograph;
        if self.portrait.faces.is_empty() || is_even {
            return None;
        }
        let heads: Vec<Head> = self.portrait.faces.iter().map(Head::new).collect();
        let zone = detail_zone(self.portrait, self.pixels(parameters.pitch));
        let detail = Raster::from_fn(zone.width(), zone.height(), |x, y| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            heads.iter().map(|head| (BAND_DETAIL * in_band(head, p)) as f32).fold(zone.get(x, y), f32::max)
        });
        let masks = &self.portrait.masks;
        let cloth = masks.get(&MaskRole::Clothing);
        let beyond = self.portrait.people().map(|people| 1.0 - people);
        let broad = match cloth {
            Some(cloth) => beyond.zip_map(cloth, |beyond, cloth| beyond.max(CLOTH * cloth)),
            None => beyond,
        };
        Some(People { detail, broad: fast_gaussian(&broad, (BROAD_BLUR * self.pixels(parameters.pitch)) as f32) })
    }

    /// A photograph's flow, bent to the form where the smoothed picture's lightness (`light`) hardly changes over `sigma` pixels.
    pub(super) fn over_people(&self, flow: &Flow, light: &Raster<f32>, sigma: f32) -> Flow {
        /// Change of lightness over the blur of the flow at which the photograph and the form count the same, on skin and cloth
        /// and in hair. At half of it cheeks whirl around their highlights, at three times it strokes run across lips (judged on
        /// six portraits); in hair less is enough, so that curls curl.
        const CLEAR: f32 = 0.1;
        const CLEAR_HAIR: f32 = 0.04;
        /// Blur of that weight, as a share of the flow's.
        const CLEAR_BLUR: f32 = 0.35;
        /// How far the form's directions wander, in radians (standard deviation), and over how many pitches: without it foreheads
        /// look ruled.
        const WANDER: f32 = 0.22;
        const WANDER_REACH: f64 = 4.0;
        let people = self.portrait.people();
        let surfaces = self.surfaces(people);
        let directions = self.directions(&surfaces);
        let slope = gradient(&fast_gaussian(light, CLEAR_BLUR * sigma)).map(|[x, y]| x.hypotenuse(y) * sigma);
        let turn = self.parameters.angle.0 - FRAC_PI_2;
        let reach = self.pixels(WANDER_REACH * self.parameters.pitch) as f32;
        let wander = noise::wandering(light.width(), light.height(), reach, self.seed);
        Flow::from_fn(light.width(), light.height(), |p| {
            let (x, y) = (p.x as usize, p.y as usize);
            let [fx, fy] = flow.directions().get(x, y);
            let seen = Vec2::new(f64::from(fx), f64::from(fy));
            let share = people.get(x, y);
            if share <= 0.0 {
                return seen;
            }
            let on = |surface| surfaces.of(surface).get(x, y);
            let surface = [Surface::Beard, Surface::Hair, Surface::Cloth].into_iter().find(|surface| on(*surface) > 0.5);
            let along = f64::from(directions.of(surface.unwrap_or(Surface::Skin)).get(x, y));
            let form = unit_at(along + turn + f64::from(WANDER * wander.get(x, y)));
            let usual = if surface.is_some_and(Surface::is_hair) { CLEAR_HAIR } else { CLEAR };
            let clear = slope.get(x, y).powi(2) / (slope.get(x, y).powi(2) + usual * usual);
            let weight = f64::from(share * (1.0 - clear));
            between(seen, form, weight)
        })
    }
}

/// How far a place lies in the band of a face's eyes, 0 to 1.
fn in_band(head: &Head, p: Point) -> f64 {
    let (u, v) = head.relative(p);
    let inside = (v - BAND.start).min(BAND.end - v).min(BAND_REACH - u.abs());
    (0.5 + inside / BAND_FADE).clamp(0.0, 1.0)
}

/// A flow with the directions drawn by hand over it; the sense of the flow stays.
pub(super) fn along(flow: &Flow, drawn: &DrawnDirections) -> Flow {
    let flow = flow.completed();
    let directions = flow.directions();
    Flow::from_fn(directions.width(), directions.height(), |p| {
        let [x, y] = directions.get(p.x as usize, p.y as usize).map(f64::from);
        let (angle, weight) = drawn.at(p);
        let seen = Vec2::new(x, y);
        let wanted = unit_at(angle);
        between(seen, if wanted.dot(seen) < 0.0 { -wanted } else { wanted }, weight)
    })
}

/// The axis between two, by their doubled angles, with the sign of the second.
fn between(a: Vec2, b: Vec2, weight: f64) -> Vec2 {
    let doubled = |v: Vec2| Vec2::new(v.x * v.x - v.y * v.y, 2.0 * v.x * v.y);
    let mean = doubled(a) * (1.0 - weight) + doubled(b) * weight;
    let axis = unit_at(0.5 * mean.y.angle_over(mean.x));
    if axis.dot(b) < 0.0 { -axis } else { axis }
}

#[cfg(test)]
mod tests {
    use super::super::grey;
    use super::super::parameters::GlassParameters;
    use super::*;
    use crate::style::form::mean_portrait;
    use crate::style::{Settings, Silent};

    #[test]
    fn strokes_run_over_a_highlight_and_do_not_whirl_around_it() {
        // A soft highlight on one cheek.
        let middle = Point::new(25.0, 33.0);
        let portrait = mean_portrait(4.0, 0.0, |p| (120.0 + 60.0 * (-(p - middle).hypot2() / 50.0).exponential()) as u8);
        let parameters = crate::style::find("glass").unwrap().parameters();
        let off = |strokes: &str| {
            let settings = Settings::resolve("glass", parameters, &[("strokes".to_owned(), strokes.to_owned())]).unwrap();
            let drawer = Drawer { portrait: &portrait, parameters: GlassParameters::new(&settings), seed: 0, observer: &Silent };
            let skin = drawer.directions(&drawer.surfaces(portrait.people())).of(Surface::Skin).clone();
            let ground = drawer.ground();
            let flow = ground.flow.unframed(ground.margin);
            assert_eq!(grey(&ground.smoothed).width(), portrait.placement.columns + 2 * ground.margin);
            // Around the highlight, where the photograph's flow is a circle.
            let places = (0..48).map(|i| Point::new(100.0, 132.0) + 14.0 * unit_at(f64::from(i) * 0.131));
            let angles = places.map(|p| {
                let wanted = unit_at(f64::from(skin.get(p.x as usize, p.y as usize)));
                flow.at(p).cross(wanted).abs().min(1.0).arc_sine().to_degrees()
            });
            angles.sum::<f64>() / 48.0
        };
        let (fitted, even) = (off("fitted"), off("even"));
        assert!(fitted < 12.0 && even > 35.0, "{fitted} and {even} degrees off the form");
    }

    #[test]
    fn axes_are_mixed_whatever_their_signs() {
        let (a, b) = (Vec2::new(1.0, 0.0), unit_at(0.5));
        for sign in [1.0, -1.0] {
            let mixed = between(a * sign, b, 0.5);
            assert!((mixed - unit_at(0.25)).hypot() < 1e-9, "{mixed}");
        }
    }
}
