//! Lines that follow the form of a face, as engravers of banknotes lay them: one family over the surface, a second and a third across
//! it where it is darker, dots in line where light breaks it.
//!
//! ```text
//!   surfaces     skin, hair, cloth: each has lines of its own, which end at its border
//!   directions   from the face's mesh, along locks, along folds
//!   families     even lines along the directions, and turned from them
//!   shares       ink of each family for the tone
//!   runs         pieces of lines with their widths
//!   tone         widths corrected until the ink drawn is the ink wanted
//! ```

mod canonical;
mod directions;
mod families;
mod head;
mod runs;
mod shares;
mod surfaces;

use super::Drawer;
use super::parameters::{Division, GroundColour, Look, ToneFrom, Way};
use crate::drawing::{Drawing, Layer, Mark, Stroke, Width};
use crate::field::contours;
use crate::geometry::{Ring, catmull_rom, resample};
use crate::raster::{Raster, gaussian_blur};
use crate::source::MaskRole;
use crate::style::coverage::covered;
use crate::style::{Picture, StyleError};
use directions::Directions;
use families::{Extent, FINE, Family};
use rayon::prelude::*;
use runs::{Course, Piece};
use surfaces::{Surface, Surfaces};

/// The turns of the second and the third family in degrees. At -60 the third makes honeycombs with the second.
const TURNS: [f64; 3] = [0.0, 60.0, -37.0];
/// In hair lines cross at half the angle: steeper ones look woven.
const HAIR_TURN: f64 = 0.5;
/// Lines of hair stand this much closer.
const HAIR_CLOSENESS: f32 = 1.08;
/// Reach of the mean from which locks of hair differ, in pitches, and how much their difference grows in half tones.
const LOCK: f64 = 6.0;
const LOCK_CONTRAST: f32 = 0.7;
/// Reach of a detail region's finer lines, in pitches.
const DETAIL_BLUR: f64 = 1.0;
/// Blur of the tone in pitches: grain makes lines shake. Details keep theirs, and are sharpened by this share.
const TONE_BLUR: f64 = 0.22;
const SHARPEN: f32 = 0.6;
/// Rounds of the tone's correction, its reach in pitches, and the greatest change of a width in one round.
const TONE_ROUNDS: usize = 2;
const TONE_REACH: f64 = 1.6;
const TONE_STEP: [f32; 2] = [0.6, 1.6];
/// Ink that is as good as none.
const LEAST_INK: f32 = 0.01;
/// Width of the contour in pitches where the subject is light, half dark and dark, and the distance of its nodes. In the dark it covers
/// the ends of thick lines, which would be teeth.
const CONTOUR: [f64; 3] = [0.2, 0.12, 0.4];
const CONTOUR_NODE: f64 = 1.0;
/// Share of a surface from which it has lines.
const LEAST_SHARE: f32 = 0.02;

/// The pieces of the three families.
type Pieces = [Vec<Piece>; 3];

impl Drawer<'_> {
    /// True if the lines follow the form: a face is known, and nothing asks for lines of another kind.
    pub(super) fn follows_form(&self) -> bool {
        let p = &self.parameters;
        !self.portrait.faces.is_empty()
            && p.way == Way::Form
            && p.regions == Division::Auto
            && self.portrait.scribbles.is_none()
            && matches!(p.look, Look::Crosshatch | Look::Hatch)
            && p.ground == GroundColour::White
            && p.tone_from == ToneFrom::Photo
    }

    pub(super) fn draw_form(&self) -> Result<Drawing, StyleError> {
        let detail = self.detail_zone();
        let ink = self.form_ink(&detail);
        self.observer.picture("tone", &|| Picture::Grey(ink.map(|v| 1.0 - v)));
        if ink.pixels().iter().all(|&v| v <= 0.0) {
            let why = "the picture, or the part inside the subject mask, needs no ink anywhere";
            return Err(StyleError::NothingToDraw(why.to_owned()));
        }
        self.observer.begin("directions");
        let surfaces = self.surfaces(&self.portrait.subject);
        let ink = self.with_locks(&ink, &surfaces.hair);
        let directions = self.directions(&surfaces);
        self.check()?;
        self.observer.begin("lines");
        let mut pieces: Pieces = Default::default();
        for surface in [Surface::Skin, Surface::Hair, Surface::Cloth] {
            let own = self.lines_over(surface, &surfaces, &directions, &detail, &ink);
            pieces.iter_mut().zip(own).for_each(|(all, own)| all.extend(own));
            self.check()?;
        }
        self.observer.begin("widths");
        for _ in 0..TONE_ROUNDS {
            self.correct(&mut pieces, &ink);
            self.check()?;
        }
        Ok(self.form_drawing(&pieces, &ink))
    }

    /// Where lines are finer, 0 to 1.
    fn detail_zone(&self) -> Raster<f32> {
        let pitch = self.pixels(self.parameters.pitch);
        let mask = self.portrait.masks.get(&MaskRole::Detail);
        mask.map_or_else(
            || self.portrait.subject.map(|_| 0.0),
            |mask| gaussian_blur(mask, (DETAIL_BLUR * pitch) as f32).map(|v| (1.3 * v).min(1.0)),
        )
    }

    /// The ink wanted: without grain, and sharper in detail.
    fn form_ink(&self, detail: &Raster<f32>) -> Raster<f32> {
        let sigma = (TONE_BLUR * self.pixels(self.parameters.pitch)) as f32;
        let ink = self.portrait.ink();
        let (smooth, wide) = (gaussian_blur(&ink, sigma), gaussian_blur(&ink, 2.0 * sigma));
        let sharp = ink.zip_map(&wide, |ink, wide| ink + SHARPEN * (ink - wide));
        let mixed = smooth.zip_map(&sharp, |smooth, sharp| (smooth, sharp));
        let mixed = mixed.zip_map(detail, |(smooth, sharp), detail| smooth + (sharp - smooth) * detail);
        mixed.zip_map(&self.portrait.subject, |ink, subject| if subject > LEAST_SHARE { ink.clamp(0.0, 1.0) } else { 0.0 })
    }

    /// More contrast between the locks of hair, whose mean tone stays.
    fn with_locks(&self, ink: &Raster<f32>, hair: &Raster<f32>) -> Raster<f32> {
        let reach = (LOCK * self.pixels(self.parameters.pitch)) as f32;
        let around = gaussian_blur(&ink.zip_map(hair, |ink, hair| ink * hair), reach);
        let mean = around.zip_map(&gaussian_blur(hair, reach), |ink, hair| ink / hair.max(1e-3));
        let apart = ink.zip_map(&mean, |ink, mean| LOCK_CONTRAST * (ink - mean) * (4.0 * mean * (1.0 - mean)).max(0.0));
        ink.zip_map(&apart.zip_map(hair, |apart, hair| apart * hair), |ink, apart| (ink + apart).clamp(0.0, 1.0))
    }

    fn lines_over(
        &self,
        surface: Surface,
        surfaces: &Surfaces,
        directions: &Directions,
        detail: &Raster<f32>,
        ink: &Raster<f32>,
    ) -> Pieces {
        let (share, pitch) = (surfaces.of(surface), self.pixels(self.parameters.pitch));
        let Some(extent) = Extent::of(share, LEAST_SHARE, (3.0 * pitch) as usize) else { return Pieces::default() };
        let hair = surface == Surface::Hair;
        let closeness = |x: usize, y: usize| (if hair { HAIR_CLOSENESS } else { 1.0 }) / (1.0 - FINE * detail.get(x, y));
        let most = if self.parameters.look == Look::Hatch { 1 } else { 3 };
        let shares = [0, 1, 2].map(|family| {
            if most == 1 {
                if family == 0 { ink.clone() } else { ink.map(|_| 0.0) }
            } else {
                shares::share_of(ink, surface, family)
            }
        });
        let room = (3.0 * pitch) as usize;
        let families: Vec<Option<Family>> = (0..3)
            .into_par_iter()
            .map(|family| {
                // The second family also breaks the first in the lights.
                let extent =
                    if family < 2 { extent.clone() } else { Extent::of(&shares[2].zip_map(share, f32::min), 0.0, room)? };
                let turn = TURNS[family].to_radians() * if hair { HAIR_TURN } else { 1.0 };
                let name = format!("{surface:?} {family}");
                Some(self.even_lines(&extent, directions.of(surface), turn, &closeness, &name))
            })
            .collect();
        let pieces = |family: usize| {
            let Some(own) = &families[family] else { return Vec::new() };
            let course = Course {
                family: own,
                ink: &shares[family],
                region: share,
                breaks: if family == 0 { families[1].as_ref() } else { None },
                thinnest: self.parameters.thinnest / self.parameters.pitch,
                dot_min: self.pixels(self.parameters.dot_min),
                pitch,
            };
            course.pieces()
        };
        [pieces(0), pieces(1), pieces(2)]
    }

    /// Makes lines wider or thinner by the ratio of the ink wanted around each node to the ink drawn there.
    fn correct(&self, pieces: &mut Pieces, ink: &Raster<f32>) {
        let placement = &self.portrait.placement;
        let reach = (TONE_REACH * self.pixels(self.parameters.pitch)) as f32;
        let drawn = gaussian_blur(&covered(&marks(pieces.iter().flatten(), placement), placement), reach);
        let wanted = gaussian_blur(ink, reach);
        let ratio = wanted
            .zip_map(&drawn, |wanted, drawn| ((wanted + LEAST_INK) / (drawn + LEAST_INK)).clamp(TONE_STEP[0], TONE_STEP[1]));
        for piece in pieces.iter_mut().flatten() {
            for ((width, ceiling), node) in piece.widths.iter_mut().zip(&piece.ceilings).zip(&piece.nodes) {
                *width = (*width * f64::from(ratio.sample(node.x, node.y))).min(*ceiling);
            }
        }
    }

    fn form_drawing(&self, pieces: &Pieces, ink: &Raster<f32>) -> Drawing {
        let names = ["lines", "cross lines", "third lines"];
        let mut layers: Vec<Layer> = Vec::new();
        for (name, pieces) in names.into_iter().zip(pieces) {
            let mut layer = Layer::new(name, 1);
            layer.marks = marks(pieces.iter(), &self.portrait.placement);
            layers.push(layer);
        }
        layers.push(self.contour(ink));
        layers.retain(|layer| !layer.marks.is_empty());
        if self.parameters.has_outline {
            layers.push(self.outlines());
        }
        Drawing { page: self.portrait.page, layers }
    }

    /// The silhouette in a thin line, thicker where the subject is light.
    fn contour(&self, ink: &Raster<f32>) -> Layer {
        let (placement, pitch) = (&self.portrait.placement, self.parameters.pitch.0);
        // The ink of the subject alone.
        let blur = |raster: &Raster<f32>| gaussian_blur(raster, self.pixels(self.parameters.pitch) as f32);
        let dark = blur(ink).zip_map(&blur(&self.portrait.subject), |ink, subject| ink / subject.max(0.05));
        let mut layer = Layer::new("contour", 1);
        let (columns, rows) = self.size();
        let is_inside =
            |p: &crate::geometry::Point| p.x > 1.0 && p.y > 1.0 && p.x < columns as f64 - 1.0 && p.y < rows as f64 - 1.0;
        for curve in contours(&gaussian_blur(&self.portrait.subject, 1.5), 0.5) {
            let mut points = curve.points;
            if curve.closed {
                points.push(points[0]);
            }
            let nodes = resample(&points, CONTOUR_NODE * self.pixels(self.parameters.pitch));
            for run in nodes.chunk_by(|a, b| is_inside(a) == is_inside(b)).filter(|run| is_inside(&run[0]) && run.len() > 2) {
                let width = |p: &crate::geometry::Point| {
                    let along = 2.0 * f64::from(dark.sample(p.x, p.y)).clamp(0.0, 0.999);
                    let (i, t) = (along as usize, along.fract());
                    pitch * (CONTOUR[i] + (CONTOUR[i + 1] - CONTOUR[i]) * t)
                };
                let places: Vec<crate::geometry::Point> = run.iter().map(|p| placement.to_page(*p)).collect();
                let widths = run.iter().map(width).collect();
                layer.marks.push(Mark::Stroke(Stroke::new(catmull_rom(&places, Ring::Open), Width::Along(widths))));
            }
        }
        layer
    }
}

fn marks<'a>(pieces: impl Iterator<Item = &'a Piece>, placement: &crate::source::Placement) -> Vec<Mark> {
    pieces.filter_map(|piece| piece.mark(placement)).collect()
}
