//! Step 5: smudged tone (sections 3.1.5 and 6.3.1), as grains on the tooth of the paper.

use super::Drawer;
use super::features::Features;
use super::paper::PIXELS_A_GRAIN;
use super::regions::Regions;
use crate::drawing::{Area, Mark};
use crate::elementary::{Elementary as _, unit_at};
use crate::field::{Curve, grain_areas};
use crate::geometry::{BezPath, Point, Vec2, simplify};
use crate::parallel::mapped;
use crate::raster::{Raster, fast_gaussian, gaussian_blur, paper_texture, self_guided};
use crate::source::{Landmarks, outlines};
use crate::style::rubbing::rubbed;
use crate::style::solids::{eyes_and_mouths, inside_outlines};
use crate::style::teeth::{Gaps, with_whole_teeth};
use kurbo::{Line, ParamCurveNearest};
use std::f32::consts::PI;

/// What the grain is drawn under and beside, on the working grid.
pub(super) struct Laid<'a> {
    pub regions: &'a Regions,
    pub features: &'a Features,
    /// Ink that is wanted, and ink of the strokes of hair and clothing, blurred over their distances; 0 to 1.
    pub wanted: &'a Raster<f32>,
    pub strokes: &'a Raster<f32>,
    /// Where detail is kept.
    pub sharp: &'a Raster<f32>,
    /// Pressure of the background's strokes.
    pub background: &'a Raster<f32>,
}

impl Drawer<'_> {
    /// Grain that makes the tone together with what else is drawn.
    pub(super) fn tone(&self, parts: &Laid<'_>) -> Vec<Mark> {
        /// Tolerance of a grain's outline, in grains.
        const OUTLINE_TOLERANCE: f64 = 0.04;
        /// Ink below which paper is left clean, as smudging does; half a grain in a hundred would look like dust.
        const CLEAN: f32 = 0.012;
        self.observer.begin("tone");
        let smudged = self.smudged(parts);
        self.show("smudged", &smudged);
        let picture = self.portrait.placement.picture;
        let (tooth, clumps) = self.paper();
        let (width, height) = (tooth.width(), tooth.height());
        let tooth = self.finer_in_faces(tooth, &parts.sharp.zip_map(&parts.regions.skin(), f32::max));
        let (fx, fy) = (smudged.width() as f64 / width as f64, smudged.height() as f64 / height as f64);
        let wanted = Raster::from_fn(width, height, |x, y| {
            let s = smudged.sample((x as f64 + 0.5) * fx, (y as f64 + 0.5) * fy);
            if s > 1.0 - CLEAN { 1.0 } else { on_texture(s, clumps.get(x, y), self.parameters.texture_bias) }
        });
        let place = |p: &Point| {
            let (tx, ty) = (p.x / width as f64, p.y / height as f64);
            Point::new(picture.x0 + tx * picture.width(), picture.y0 + ty * picture.height())
        };
        let grains = grain_areas(&wanted, &tooth);
        let marks = mapped(&grains, &|outlines| area(outlines, OUTLINE_TOLERANCE * PIXELS_A_GRAIN, place));
        marks.into_iter().flatten().collect()
    }

    /// Tone of the grain (section 3.1.5): what strokes leave of the ink that is wanted, and a smudge behind the subject.
    fn smudged(&self, parts: &Laid<'_>) -> Raster<f32> {
        /// Smudge in the background at full pressure, in shares of its strokes' ink, and its blur in shares of the smudge's.
        const BEHIND: f32 = 1.5;
        const BEHIND_BLUR: f64 = 4.0;
        /// Margin of the picture in which the background's smudge fades to nothing, as a share of its short side: it is clean for
        /// half of this and full at one and a half. Scattered grains look like dust.
        const CLEAN_MARGIN: f64 = 0.07;
        let blur =
            |length: f64, raster: &Raster<f32>| gaussian_blur(raster, (length * self.pixels(self.parameters.smudge)) as f32);
        let left = parts.wanted.zip_map(parts.strokes, |wanted, laid| ((wanted - laid) / (1.0 - laid).max(0.05)).clamp(0.0, 1.0));
        // Features that are drawn by strokes have no grain; the eyes' whites stay clean.
        let left = left.zip_map(&parts.features.tones.share, |ink, theirs| ink * (1.0 - theirs));
        let smudge = BEHIND * self.parameters.background_ink as f32;
        let behind = blur(BEHIND_BLUR, parts.background);
        let behind = behind.zip_map(&parts.regions.subject, |behind, subject| smudge * behind * (1.0 - subject));
        let behind = behind.zip_map(&self.broad_strokes(), |behind, stroke| behind * stroke);
        let (width, height) = self.size();
        let margin = (CLEAN_MARGIN * width.min(height) as f64) as f32;
        let behind = Raster::from_fn(width, height, |x, y| {
            let edge = x.min(y).min(width - 1 - x).min(height - 1 - y) as f32;
            behind.get(x, y) * (edge / margin - 0.5).clamp(0.0, 1.0)
        });
        left.zip_map(&parts.regions.subject, |ink, subject| ink * subject).zip_map(&behind, |ink, behind| 1.0 - ink - behind)
    }

    /// Pressure of the stick's broad side, drawn to and fro in the direction of the shading: 1 in the mean.
    fn broad_strokes(&self) -> Raster<f32> {
        /// Width of the broad strokes in the background, in pitches.
        const BROAD: f64 = 7.0;
        /// Their least pressure, and by how much more they press at most.
        const BROAD_SPREAD: (f32, f32) = (0.45, 1.1);
        let (width, height) = self.size();
        let (long, across) = (self.pixels(self.parameters.arc_length), self.pixels(BROAD * self.parameters.pitch));
        let diagonal = (width as f64).hypotenuse(height as f64);
        let texture =
            paper_texture((diagonal / long) as usize * 8 + 24, (diagonal / across) as usize * 8 + 24, 8.0, self.seed ^ 0xb40d);
        let along = unit_at(self.parameters.arc_orient.0);
        Raster::from_fn(width, height, |x, y| {
            let p = Vec2::new(x as f64 - 0.5 * width as f64, y as f64 - 0.5 * height as f64);
            let (u, v) = (p.dot(along) / long, p.cross(along) / across);
            let (tx, ty) = (0.5 * texture.width() as f64 + 8.0 * u, 0.5 * texture.height() as f64 + 8.0 * v);
            BROAD_SPREAD.0 + BROAD_SPREAD.1 * texture.sample(tx, ty)
        })
    }

    /// Ink that strokes and grain make together: smooth on skin and cloth, sharp at borders, and as it is in the faces' features.
    pub(super) fn wanted(&self, regions: &Regions, sharp: &Raster<f32>, detail: &Raster<f32>) -> Raster<f32> {
        /// How much firmer thin dark lines are than their tone: lines of a grain's width, as rims of spectacles, would break up.
        const FIRMER: f32 = 1.0;
        /// Reaches over which half tones are rubbed into the lights of skin, in shares of the smudge's blur: at their borders,
        /// and over foreheads.
        const STUMP: [f64; 2] = [4.0, 12.0];
        /// Blur in a face's features, as a share of the smudge's; and the square of the step of ink from which a border stays
        /// sharp.
        const FINE: f64 = 0.12;
        const SMUDGED_STEP: f32 = 0.09 * 0.09;
        let gain = self.parameters.hair_ink - 1.0;
        let ink = self.darkness().zip_map(&regions.hair, |ink, hair| (self.washed(ink) * (1.0 + gain * hair)).clamp(0.0, 1.0));
        let ink = with_whole_teeth(self.portrait, ink, Gaps::Faint);
        let blur = self.pixels(self.parameters.smudge);
        let fine = self.pressed_features(&gaussian_blur(&ink, (FINE * blur) as f32), &regions.hair, detail);
        let smooth = self_guided(&ink, (1.4 * blur).round().max(1.0) as usize, SMUDGED_STEP);
        let smudged = Raster::from_fn(ink.width(), ink.height(), |x, y| {
            let t = sharp.get(x, y);
            fine.get(x, y) * t + smooth.get(x, y) * (1.0 - t)
        });
        let around = gaussian_blur(&smudged, self.pixels(self.parameters.grain) as f32);
        let firm = smudged.zip_map(&around, |ink, around| (ink + FIRMER * (ink - around)).clamp(0.0, 1.0));
        let features = eyes_and_mouths(self.portrait, self.pitch());
        let skin = regions.skin().zip_map(&features, |skin, features| skin * (1.0 - features));
        let rub = |firm: Raster<f32>, reach: &f64| rubbed(&firm, &skin, self.pixels(*reach * self.parameters.smudge) as f32);
        self.portrait.opened(STUMP.iter().fold(firm, rub))
    }

    /// Ink with the features of faces pressed: what is darker than its surroundings is darker still, so that lips, nostrils and the wings
    /// of a nose do not fade into the grain.
    fn pressed_features(&self, ink: &Raster<f32>, hair: &Raster<f32>, detail: &Raster<f32>) -> Raster<f32> {
        /// Reach of the surroundings, in widths of a face; by how much features differ more from them, and at most. Without a limit
        /// nostrils are black holes.
        const AROUND: f64 = 0.05;
        const PRESSED: f32 = 0.9;
        const MOST: f32 = 0.13;
        /// How much ink is lifted at most: places between the hairs of a moustache would be flecks.
        const LIFTED: f32 = 0.03;
        /// By how much less in eyes.
        const EYES: f32 = 0.8;
        let Some(widest) = self.portrait.faces.iter().map(Landmarks::width).reduce(f64::max) else { return ink.clone() };
        let around = fast_gaussian(ink, (AROUND * widest) as f32);
        let pressed =
            ink.zip_map(&around, |ink, around| (MOST * (PRESSED * (ink - around) / MOST).hyperbolic_tangent()).max(-LIFTED));
        // Brows and moustaches are strokes of hair, firm enough; and eyes are dark enough as they are.
        let brows = inside_outlines(&self.portrait.faces, [&outlines::LEFT_BROW, &outlines::RIGHT_BROW], self.size());
        let brows = gaussian_blur(&brows, self.pitch() as f32);
        let eyes = inside_outlines(&self.portrait.faces, [&outlines::LEFT_EYE, &outlines::RIGHT_EYE], self.size());
        let eyes = gaussian_blur(&eyes, self.pitch() as f32);
        let zone = detail
            .zip_map(&brows, |detail, brow| detail * (1.0 - brow))
            .zip_map(&eyes, |zone, eye| zone * (1.0 - EYES * eye))
            .zip_map(hair, |zone, hair| zone * (1.0 - hair));
        ink.zip_map(&pressed.zip_map(&zone, |pressed, zone| pressed * zone), |ink, more| (ink + more).clamp(0.0, 1.0))
    }

    /// Where the photograph's own detail is kept, 0 to 1: features of known faces, and around their eyes, where spectacles are.
    pub(super) fn sharp_zone(&self, detail: &Raster<f32>) -> Raster<f32> {
        /// Distance from the line between the pupils, in eye distances, within which detail is kept, and at which it no longer
        /// is.
        const AROUND_EYES: (f64, f64) = (0.5, 0.75);
        let faces = &self.portrait.faces;
        Raster::from_fn(detail.width(), detail.height(), |x, y| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let near = |face: &Landmarks| {
                let [right, left] = face.irises.map(|iris| iris.centre);
                let away = Line::new(right, left).nearest(p, 1e-3).distance_sq.sqrt() / face.eye_distance().max(1.0);
                ((AROUND_EYES.1 - away) / (AROUND_EYES.1 - AROUND_EYES.0)).clamp(0.0, 1.0)
            };
            faces.iter().map(near).fold(f64::from(detail.get(x, y)), f64::max) as f32
        })
    }

    /// Brightened ink of the smudge.
    pub(super) fn washed(&self, ink: f32) -> f32 {
        /// Maximum effect of `brighten`: ink removed everywhere, so that lit skin is bare paper, and a share of the rest. Tuned
        /// on the busts: with less lifted, light skin is grey all over; with more, dark skin is washed out.
        const LIFTED: f32 = 0.3;
        const THINNED: f32 = 0.4;
        let wash = self.parameters.brighten;
        (ink - LIFTED * wash).max(0.0) * (1.0 - THINNED * wash)
    }
}

/// The tone `d(s, t)` of section 6.3.1, with the texture shifted so that its mean, and with it the mean of `d`, is `s` (errata).
fn on_texture(s: f32, t: f32, bias: f32) -> f32 {
    let weight = f32::midpoint(1.0, (2.0 * PI * (s - 0.5)).cosine());
    let t = t - 0.5 + s;
    ((t * weight + s * (1.0 - weight) + bias * s) / (bias + 1.0)).clamp(0.0, 1.0)
}

/// One grain on the page: its border and its holes.
fn area(outlines: &[Curve], tolerance: f64, place: impl Fn(&Point) -> Point) -> Option<Mark> {
    let mut outline = BezPath::new();
    for curve in outlines {
        // The first point is repeated so that the simplification keeps the whole ring.
        let mut ring = curve.points.clone();
        ring.push(*curve.points.first()?);
        let mut ring = simplify(&ring, tolerance);
        ring.pop();
        if ring.len() < 3 {
            continue;
        }
        outline.move_to(place(&ring[0]));
        ring[1..].iter().for_each(|p| outline.line_to(place(p)));
        outline.close_path();
    }
    (!outline.is_empty()).then_some(Mark::Area(Area { outline, colour: None }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_blend_keeps_the_mean_and_is_rough_in_the_middle() {
        for s in [0.0_f32, 0.1, 0.3, 0.5, 0.8, 1.0] {
            let values: Vec<f32> = (0..1000).map(|i| on_texture(s, (i as f32 + 0.5) / 1000.0, 1.0)).collect();
            let mean = values.iter().sum::<f32>() / 1000.0;
            assert!((mean - s).abs() < 1e-3, "{mean} for {s}");
        }
        let spread = |s| on_texture(s, 1.0, 1.0) - on_texture(s, 0.0, 1.0);
        assert!(spread(0.5) > 0.45 && spread(0.05) < 0.03 && spread(0.95) < 0.03);
    }
}
