//! Faces modelled over the even smudge, as a portraitist does.
//!
//! ```text
//!   broad side   the smudge of skin varies along the form, as the stick's broad side leaves it
//!   teeth        shaded towards the corners of the mouth
//!   shade        fine strokes along the form where a face is dark
//!   brows        strokes along their hairs
//! ```
//! Strokes take a share of the ink that is wanted, the grain keeps the rest. The constants were tuned on sixteen portraits of light to dark
//! skin: as strokes twice as broad and in lighter places, shade reads as wrinkles and scars on fair skin; without it faces are grain alone.

use super::regions::Regions;
use super::{Drawer, Hairs};
use crate::drawing::Mark;
use crate::elementary::Elementary as _;
use crate::field::OrientationField;
use crate::geometry::Point;
use crate::raster::{Raster, fast_gaussian, gaussian_blur, median};
use crate::source::{Landmarks, outlines};
use crate::style::declaration::Radians;
use crate::style::solids::inside_outlines;
use crate::style::streaks::Streaks;

/// The share of a brow's ink that its strokes make: with six tenths brows are scribbled over, without strokes they are blots.
const BROW_SHARE: f32 = 0.42;
/// Width of a brow's hair, as a share of that in a hedcut.
const BROW_WIDTH: f64 = 0.75;
/// Ink over that of a face's median from which its shade is modelled, the range over which strokes set in, and their share of the ink there.
const SHADE: f32 = 0.1;
/// Least ink of shade: fair skin has none, where strokes would be wrinkles.
const LEAST_SHADE: f32 = 0.42;
const SETS_IN: f32 = 0.3;
const SHADE_SHARE: f32 = 0.45;
/// Blur of the shade, so that strokes model form and not spots; the width of a stroke as a share of the stick's; its mean length; in pitches.
const SHADE_BLUR: f64 = 2.0;
const WIDTH: f64 = 0.34;
const LENGTH: f64 = 9.0;
/// Maximum angle to the form, in degrees.
const TURN: f64 = 9.0;

/// Width and length of the marks of the stick's broad side in pitches, and how much more or less ink they have, as a share of it: with more
/// skin is striped.
const BROAD: [f64; 2] = [2.6, 16.0];
const BROAD_SPREAD: f32 = 0.9;
/// Ink on teeth in the middle of a mouth, by how much more they have in its corners, and the blur of their border in widths of the face. As
/// white as paper they are the lightest place of the sheet.
const TEETH: [f32; 2] = [0.03, 0.26];
const TEETH_BLUR: f64 = 0.006;

/// The skin of the faces that were found, outside their features, and the direction of its form in radians on the page.
pub(super) struct Model {
    skin: Raster<f32>,
    angles: Raster<f32>,
}

impl Drawer<'_> {
    /// None without faces; `detail` is where features are.
    pub(super) fn model(&self, regions: &Regions, detail: &Raster<f32>) -> Option<Model> {
        if !self.parameters.has_features || self.portrait.faces.is_empty() {
            return None;
        }
        let skin = regions.skin().zip_map(detail, |skin, detail| (skin * (1.0 - detail)).clamp(0.0, 1.0));
        Some(Model { skin, angles: self.directions_on_skin() })
    }

    /// The ink that is wanted, with the marks of the broad side in skin and with shaded teeth.
    pub(super) fn modelled(&self, wanted: &Raster<f32>, model: &Model) -> Raster<f32> {
        let [width, length] = BROAD.map(|pitches| pitches * self.pitch());
        let streaks = Streaks::new(width, length, self.seed ^ 0xb0ad);
        let teeth = self.teeth();
        Raster::from_fn(wanted.width(), wanted.height(), |x, y| {
            let (ink, skin) = (wanted.get(x, y), model.skin.get(x, y));
            // Neither lights nor blacks vary.
            let more = 4.0 * ink * (1.0 - ink) * skin * BROAD_SPREAD * streaks.at(x, y, model.angles.get(x, y));
            (ink * (1.0 + more) + teeth.get(x, y)).clamp(0.0, 1.0)
        })
    }

    /// The ink that is laid over teeth.
    fn teeth(&self) -> Raster<f32> {
        let (width, height) = self.size();
        let mut ink = Raster::filled(width, height, 0.0_f32);
        for face in &self.portrait.faces {
            let [right, left] = [outlines::MOUTH[0], outlines::MOUTH[10]].map(|corner| face.point(corner));
            let (middle, half) = (right.midpoint(left), 0.5 * (left - right));
            let along = |p: Point| ((p - middle).dot(half) / half.hypot2().max(1e-9)).clamp(-1.0, 1.0);
            let inside = inside_outlines(std::slice::from_ref(face), [&outlines::MOUTH, &outlines::MOUTH], (width, height));
            let inside = fast_gaussian(&inside, (TEETH_BLUR * Landmarks::width(face)) as f32);
            let own = Raster::from_fn(width, height, |x, y| {
                let away = along(Point::new(x as f64 + 0.5, y as f64 + 0.5)) as f32;
                inside.get(x, y) * (TEETH[0] + TEETH[1] * away * away)
            });
            ink = ink.zip_map(&own, f32::max);
        }
        ink
    }

    /// Strokes of the faces: brows, and their shade along the form.
    pub(super) fn modelling(&self, regions: &Regions, wanted: &Raster<f32>, model: &Model) -> Vec<Mark> {
        self.observer.begin("modelling");
        let mut marks = self.brow_strokes(regions, wanted);
        marks.extend(self.shade_strokes(wanted, model));
        marks
    }

    fn brow_strokes(&self, regions: &Regions, wanted: &Raster<f32>) -> Vec<Mark> {
        let Some(brows) = self.brows(Some(&regions.hair)) else { return Vec::new() };
        let ink = wanted.map(|ink| BROW_SHARE * ink);
        let sizes = Hairs { width: BROW_WIDTH * brows.sizes.width, ..brows.sizes };
        self.hairs(&brows.hairs, &brows.region, &ink, sizes)
    }

    /// Strokes along the form where a face is darker than most of it.
    fn shade_strokes(&self, wanted: &Raster<f32>, Model { skin, angles }: &Model) -> Vec<Mark> {
        let soft = gaussian_blur(wanted, self.pixels(SHADE_BLUR * self.parameters.pitch) as f32);
        let within = soft.pixels().iter().zip(skin.pixels()).filter(|(_, skin)| **skin > 0.5).map(|(ink, _)| *ink);
        let Some(usual) = median(within.collect()) else { return Vec::new() };
        let least = (usual + SHADE).max(LEAST_SHADE);
        let shade = soft.zip_map(skin, |ink, skin| skin * ((ink - least) / SETS_IN).clamp(0.0, 1.0));
        self.show("shade", &shade);
        let field = OrientationField::new(angles.map(|angle| [(2.0 * angle).cosine(), (2.0 * angle).sine()]));
        let ink = soft.zip_map(&shade, |ink, shade| SHADE_SHARE * shade * ink);
        let sizes = Hairs {
            pitch: self.parameters.pitch,
            width: WIDTH * self.parameters.stroke_width,
            length: LENGTH * self.parameters.pitch,
            turn: Radians(TURN.to_radians()),
            combed: 1.0,
            in_beards: 1.0,
        };
        self.hairs(&field, &shade.map(|shade| (4.0 * shade).min(1.0)), &ink, sizes)
    }
}

#[cfg(test)]
mod tests {
    use super::super::parameters::{CARD, CharcoalParameters};
    use super::*;
    use crate::source::Portrait;
    use crate::style::Silent;
    use crate::style::form::mean_portrait;

    fn drawer(portrait: &Portrait) -> Drawer<'_> {
        let settings = CARD.settings_at(crate::geometry::Millimetres(0.6), &[]).unwrap();
        Drawer { portrait, parameters: CharcoalParameters::new(&settings), seed: 0, observer: &Silent }
    }

    fn model(drawer: &Drawer<'_>) -> Model {
        Model { skin: drawer.portrait.lightness.map(|_| 1.0), angles: drawer.directions_on_skin() }
    }

    #[test]
    fn strokes_model_the_dark_side_alone() {
        let portrait = mean_portrait(6.0, 0.0, |_| 140);
        let drawer = drawer(&portrait);
        let (width, height) = drawer.size();
        let wanted = Raster::from_fn(width, height, |x, _| if 5 * x < 2 * width { 0.75 } else { 0.25 });
        let strokes = drawer.shade_strokes(&wanted, &model(&drawer));
        assert!(strokes.len() > 50, "{}", strokes.len());
        // The border is at 24 mm, and soft.
        let nodes =
            strokes.iter().flat_map(|mark| if let Mark::Stroke(stroke) = mark { stroke.nodes().collect() } else { Vec::new() });
        let rightmost = nodes.map(|node| node.x).fold(0.0, f64::max);
        assert!(rightmost < 27.0, "{rightmost}");
    }

    #[test]
    fn the_broad_side_leaves_marks_and_keeps_the_tone() {
        let portrait = mean_portrait(6.0, 0.0, |_| 140);
        let drawer = drawer(&portrait);
        let wanted = portrait.lightness.map(|_| 0.4);
        let ink = drawer.modelled(&wanted, &model(&drawer));
        let mean = |of: &dyn Fn(f32) -> f32| ink.pixels().iter().map(|ink| of(*ink)).sum::<f32>() / ink.len() as f32;
        let (tone, spread) = (mean(&|ink| ink), mean(&|ink| (ink - 0.4).powi(2)).sqrt());
        assert!((tone - 0.4).abs() < 0.01 && (0.01..0.12).contains(&spread), "{tone} {spread}");
    }
}
