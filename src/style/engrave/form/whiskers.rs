//! Beards and moustaches, as engravers cut them: tapered strokes over the lines of the skin, which show through between them. As even lines,
//! a beard ended at its border in a seam, and where two families crossed it had blots (looked at on 02, 04, 11, 14).

use super::super::Drawer;
use super::runs::Piece;
use super::shares::part_of;
use super::tapered::{Tapered, tapered};
use crate::elementary::Elementary as _;
use crate::field::{Covering, OrientationField, cover};
use crate::geometry::{Ring, smooth_polyline};
use crate::parallel::mapped;
use crate::raster::{Raster, fast_gaussian};
use crate::source::outlines;
use crate::style::form::Surfaces;
use crate::style::random::stream;
use crate::style::solids::inside_outlines;
use crate::style::streaks::Streaks;

/// The share of the darkness that hairs have over the lines of skin in dark beards, and in light ones, where lines of skin would be
/// crumbs; and the ink of these.
const SHARE: [f32; 2] = [0.9, 1.0];
const INK: [f32; 2] = [0.75, 0.5];
/// Reach of the mean by which a beard is dark or light, in pitches.
const AROUND: f64 = 6.0;
/// Blur of a beard's border in pitches; how far hairs begin before or behind it, as a share of that, in the mean; and width and length of
/// the tufts that begin together, in pitches.
const BORDER: f64 = 1.6;
const UNEVEN: f32 = 1.2;
const TUFT: [f64; 2] = [1.6, 8.0];
/// From where to where in the blurred border hairs take over, of dark beards and of light ones, and lines of skin end. Where light hairs begin
/// among whole lines of skin, a beard has a dark upper edge (14).
const HAIRS: [f32; 2] = [0.2, 0.7];
const LIGHT_HAIRS: [f32; 2] = [0.33, 0.85];
const SKIN: [f32; 2] = [0.5, 0.95];
/// Length and greatest width of a hair in pitches, and its greatest angle to the directions in degrees. With 0.42 hairs are spines (14).
const LENGTH: f64 = 13.0;
const WIDTH: f64 = 0.27;
const TURN: f64 = 13.0;
/// The mean width of a tapered hair, as a share of the greatest.
const MEAN: f64 = 0.66;
/// How much wider than that hairs may become until their ink is the ink wanted, in dark beards and in light ones: held back in dark ones they are a
/// grey net with the lines of skin (02).
const WIDEST: [f64; 2] = [2.4, 1.5];
/// Share of a hair over which it tapers at each end, and the width of its tips.
const TAPER: f64 = 0.36;
const TIP: f64 = 0.12;

/// Beards over skin.
pub(super) struct Whiskers {
    /// How much of the darkness is the hairs' at each place, 0 to 1.
    share: Raster<f32>,
    /// How much of it is no longer the skin's: its lines run on among the roots, whose tips would leave a white seam.
    over_skin: Raster<f32>,
    /// How dark the beard around each place is, 0 to 1.
    dark: Raster<f32>,
}

impl Drawer<'_> {
    /// The ink with gaps in the darkest tufts of beards, which would be blots among the hairs (02); the mouth stays.
    pub(super) fn with_open_tufts(&self, ink: &Raster<f32>, beard: &Raster<f32>) -> Raster<f32> {
        /// Ink from which it is held back, and how much of the rest is kept. With 0.65 and 0.4 black beards are grey (02, 04).
        const FROM: f32 = 0.75;
        const KEPT: f32 = 0.5;
        let mouths = inside_outlines(&self.portrait.faces, [&outlines::MOUTH; 2], (ink.width(), ink.height()));
        let tufts = beard.zip_map(&mouths, |beard, mouth| beard * (1.0 - mouth));
        ink.zip_map(&tufts, |ink, tuft| ink - tuft * (1.0 - KEPT) * (ink - FROM).max(0.0))
    }

    /// Where the hairs of beards lie, and how much of the ink they make; none without beards.
    pub(super) fn whiskers(&self, surfaces: &Surfaces, directions: &Raster<f32>, ink: &Raster<f32>) -> Option<Whiskers> {
        if surfaces.beard.pixels().iter().all(|beard| *beard < 0.5) {
            return None;
        }
        let pitch = self.pitch();
        let streaks = Streaks::new(TUFT[0] * pitch, TUFT[1] * pitch, self.seed ^ 0xbea2d);
        let soft = fast_gaussian(&surfaces.beard, (BORDER * pitch) as f32);
        let reach = (AROUND * pitch) as f32;
        let sum = fast_gaussian(&ink.zip_map(&surfaces.beard, |ink, beard| ink * beard), reach);
        let dark = sum.zip_map(&fast_gaussian(&surfaces.beard, reach), |ink, beard| {
            ((ink / beard.max(1e-3) - INK[1]) / (INK[0] - INK[1])).clamp(0.0, 1.0)
        });
        let inside = Raster::from_fn(ink.width(), ink.height(), |x, y| {
            let soft = soft.get(x, y);
            if soft < 0.02 { 0.0 } else { soft + 0.5 * UNEVEN * streaks.at(x, y, directions.get(x, y)) }
        });
        let share = |of_dark: [f32; 2], of_light: [f32; 2]| {
            inside.zip_map(&dark, |inside, dark| {
                let [from, to] = [0, 1].map(|k| of_light[k] + (of_dark[k] - of_light[k]) * dark);
                ((inside - from) / (to - from)).clamp(0.0, 1.0) * (SHARE[1] + (SHARE[0] - SHARE[1]) * dark)
            })
        };
        Some(Whiskers { share: share(HAIRS, LIGHT_HAIRS), over_skin: share(SKIN, SKIN), dark })
    }

    /// The hairs themselves, along the directions.
    pub(super) fn hairs(&self, whiskers: &Whiskers, directions: &Raster<f32>, ink: &Raster<f32>) -> Vec<Piece> {
        let pitch = self.pitch();
        let region = whiskers.share.map(|share| f32::from(u8::from(share > 0.1)));
        let ink = ink.zip_map(&whiskers.share, part_of);
        let field = OrientationField::new(directions.map(|angle| [(2.0 * angle).cosine(), (2.0 * angle).sine()]));
        let covering = Covering {
            width: MEAN * WIDTH * pitch,
            length: LENGTH * pitch,
            length_spread: 0.5,
            turn: TURN.to_radians(),
            reach: 0.75 * pitch,
        };
        let lines = cover(&field, &region, &ink, covering, |_| 1.0, &mut stream(self.seed, "whiskers", 0));
        mapped(&lines, &|line| {
            let nodes = smooth_polyline(line, Ring::Open, 0.5 * pitch, 0.5 * pitch);
            let middle = nodes[nodes.len() / 2];
            let dark = f64::from(whiskers.dark.sample(middle.x, middle.y));
            let widest = WIDEST[1] + (WIDEST[0] - WIDEST[1]) * dark;
            tapered(&nodes, Tapered { width: WIDTH, taper: TAPER, tip: TIP, widest }, pitch)
        })
    }
}

impl Whiskers {
    /// The ink of the lines of skin, beneath the hairs.
    pub(super) fn beneath(&self, ink: &Raster<f32>) -> Raster<f32> {
        /// Thinner lines would be dots among the hairs.
        const LEAST: f32 = 0.1;
        ink.zip_map(&self.over_skin, |ink, share| {
            let own = part_of(ink, 1.0 - share);
            if share > 0.3 && own < LEAST { 0.0 } else { own }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::parameters::EngraveParameters;
    use super::*;
    use crate::geometry::{Point, Vec2};
    use crate::source::MaskRole;
    use crate::style::form::mean_portrait;
    use crate::style::{Settings, Silent};

    /// The ink wanted, the share of the lines of skin and the hairs of a face with a beard below its mouth.
    fn bearded(ink: f32) -> (Raster<f32>, Raster<f32>, Vec<Piece>) {
        let mut portrait = mean_portrait(10.0, 0.0, |_| 100);
        let mouth = portrait.faces[0].point(14).y;
        let chin = portrait.faces[0].point(152).y;
        let beard = Raster::from_fn(portrait.subject.width(), portrait.subject.height(), |x, y| {
            let is_below = (mouth..chin).contains(&(y as f64));
            if is_below { portrait.subject.get(x, y) } else { 0.0 }
        });
        portrait.masks.insert(MaskRole::FacialHair, beard.clone());
        let parameters = crate::style::find("engrave").expect("a style").parameters();
        let settings = Settings::resolve("engrave", parameters, &[]).expect("defaults");
        let drawer = Drawer { portrait: &portrait, parameters: EngraveParameters::new(&settings), seed: 0, observer: &Silent };
        let surfaces = drawer.surfaces(&portrait.subject);
        // Hair grows straight down.
        let directions = beard.map(|_| std::f32::consts::FRAC_PI_2);
        let ink = beard.map(|_| ink);
        let whiskers = drawer.whiskers(&surfaces, &directions, &ink).expect("a beard");
        (beard, whiskers.beneath(&ink), drawer.hairs(&whiskers, &directions, &ink))
    }

    #[test]
    fn hairs_lie_in_the_beard_along_its_growth_and_end_in_points() {
        let (beard, _, hairs) = bearded(0.7);
        assert!(hairs.len() > 50, "{}", hairs.len());
        for hair in &hairs {
            let (first, last) = (hair.nodes[0], hair.nodes[hair.nodes.len() - 1]);
            let along: Vec2 = last - first;
            assert!(along.y.abs() > 3.0 * along.x.abs(), "{first:?} to {last:?}");
            let middle = hair.widths[hair.widths.len() / 2];
            assert!(hair.widths[0] < 0.5 * middle || hair.nodes.len() < 4);
        }
        let is_inside = |p: Point| beard.clamped(p.x as isize, p.y as isize) > 0.5;
        let inside = hairs.iter().filter(|hair| is_inside(hair.nodes[hair.nodes.len() / 2])).count();
        assert!(10 * inside > 9 * hairs.len(), "{inside} of {}", hairs.len());
    }

    #[test]
    fn lines_of_skin_run_on_beneath_a_dark_beard_thinly_and_not_beneath_a_light_one() {
        let under = |ink: f32| {
            let (beard, beneath, _) = bearded(ink);
            let (x, y) = (beard.width() / 2, (0..beard.height()).filter(|y| beard.get(beard.width() / 2, *y) > 0.5));
            let rows: Vec<usize> = y.collect();
            beneath.get(x, rows[rows.len() / 2])
        };
        assert!((0.1..0.4).contains(&under(0.85)), "{}", under(0.85));
        assert_eq!(under(0.3), 0.0);
    }
}
