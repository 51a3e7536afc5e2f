//! The parts of a complete hedcut (Bruehl 2023, section 0.1.1): skin in dots, hair in flowing strokes, clothing in hatch lines
//! whose width is the tone.
//!
//! ```text
//!   hair ----> strokes along it          each part is drawn with the tone of its own region and white elsewhere,
//!   clothing -> hatches along its folds   so that marks end at the borders and the tone is the same across them
//!   the rest -> dots
//! ```

use super::Drawer;
use super::contest::contest;
use super::parameters::PartsRule;
use crate::drawing::{Layer, Mark, Stroke, Width};
use crate::field::OrientationField;
use crate::geometry::Point;
use crate::raster::{Raster, fast_gaussian, gaussian_blur};
use crate::source::{MaskRole, Portrait};
use crate::style::brows::{self, Brows};
use crate::style::coverage::covered;
use crate::style::rim::rim;
use crate::style::{StyleError, charcoal, grid};
use std::ops::Range;

/// Where the parts lie, each 0 to 1; they do not overlap.
pub(super) struct Parts {
    hair: Option<Raster<f32>>,
    /// The hair of heads with a band around it, 0 or 1.
    beside_hair: Option<Raster<f32>>,
    /// 1 in slivers of skin, which get no dots: wisps of hair on paper, and seams beside cloth.
    slivers: Option<Raster<f32>>,
    brows: Option<Brows>,
    /// Clothing and headwear, which often lie far apart.
    cloths: Vec<Raster<f32>>,
}

/// Rounds in which strokes of hair get the width of their tone, the reach around a node in pitches over which ink is compared,
/// and the range of one round's change. A shorter reach would take the strands' contrast away.
const TONE_ROUNDS: usize = 3;
const TONE_REACH: f64 = 2.0;
const TONE_STEP: [f32; 2] = [0.6, 1.4];

impl Drawer<'_> {
    /// The parts that are not drawn in dots; none without their masks.
    pub(super) fn parts(&self) -> Parts {
        if self.parameters.parts == PartsRule::Dots {
            return Parts { hair: None, beside_hair: None, slivers: None, brows: None, cloths: Vec::new() };
        }
        let masks = &self.portrait.masks;
        let union = |roles: [MaskRole; 2]| {
            let given = roles.into_iter().filter_map(|role| masks.get(&role).cloned());
            given.reduce(|a, b| a.zip_map(&b, f32::max))
        };
        let hair = union([MaskRole::Hair, MaskRole::FacialHair]);
        let mut claims = [hair, masks.get(&MaskRole::Clothing).cloned(), masks.get(&MaskRole::Headwear).cloned()];
        contest(&self.portrait.subject, &mut claims);
        let [hair, clothing, headwear] = claims.map(|part| part.and_then(|part| self.part(&part)));
        let cloths: Vec<_> = [clothing, headwear].into_iter().flatten().collect();
        let brows = self.brows(hair.as_ref());
        let drawn = masks.get(&MaskRole::Hair).filter(|own| hair.is_some() && self.part(own).is_some());
        let beside_hair = drawn.map(|hair| self.beside(hair));
        let slivers = self.slivers(hair.as_ref(), &cloths);
        Parts { hair, beside_hair, slivers, brows, cloths }
    }

    /// Where little is left of the subject besides hair and cloth: wisps at the silhouette, and seams.
    fn slivers(&self, hair: Option<&Raster<f32>>, cloths: &[Raster<f32>]) -> Option<Raster<f32>> {
        /// The blur, in pitches: slivers are narrower. And the share of skin around a place up to which it is a sliver: at a
        /// straight border it is half.
        const AROUND: f64 = 1.0;
        const SLIVER: f32 = 0.4;
        /// The blur of the hair, in pitches, and the least share of it: wisps stand off.
        const HAIR_AROUND: f64 = 3.0;
        const LEAST_HAIR: f32 = 0.06;
        /// The share of the subject around a place from which it is inside.
        const INSIDE: f32 = 0.9;
        /// The share of cloth around a place from which a sliver is a seam: neck and collar meet in one that is hatched.
        const LEAST_CLOTH: f32 = 0.25;
        let around = |raster: &Raster<f32>, pitches: f64| fast_gaussian(raster, (pitches * self.pitch()) as f32);
        let subject = around(&self.portrait.subject, AROUND);
        let edge = |near: Raster<f32>| {
            near.zip_map(&subject, |hair, subject| f32::from(u8::from(hair > LEAST_HAIR && subject < INSIDE)))
        };
        let beside_hair = hair.map(|hair| edge(around(hair, HAIR_AROUND)));
        let beside_cloths =
            cloths.iter().map(|cloth| around(cloth, AROUND).map(|cloth| f32::from(u8::from(cloth > LEAST_CLOTH))));
        let beside = beside_cloths.chain(beside_hair).reduce(|a, b| a.zip_map(&b, f32::max))?;
        let without = |rest: Raster<f32>, part: &Raster<f32>| rest.zip_map(part, |rest, part| (rest - part).max(0.0));
        let rest = hair.into_iter().chain(cloths).fold(self.portrait.subject.clone(), without);
        Some(around(&rest, AROUND).zip_map(&beside, |rest, beside| if rest < SLIVER { beside } else { 0.0 }))
    }

    /// The hair of a head with a band around it.
    fn beside(&self, hair: &Raster<f32>) -> Raster<f32> {
        /// The blur of the hair, in pitches, and the share of it around a place that is beside it.
        const AROUND: f64 = 2.0;
        const LEAST_HAIR: f32 = 0.2;
        fast_gaussian(hair, (AROUND * self.pitch()) as f32).map(|hair| f32::from(u8::from(hair > LEAST_HAIR)))
    }

    /// A mask as a part with a smooth border; none if it is too small.
    fn part(&self, mask: &Raster<f32>) -> Option<Raster<f32>> {
        /// Blur of the regions in pitches, and the gain of their edges: borders as smooth as the marks, without steps.
        const SMOOTH: f64 = 0.6;
        const SHARP: f32 = 3.0;
        /// Least area of a part in square pitches: what is smaller stays in dots.
        const LEAST_AREA: f64 = 60.0;
        let soft = gaussian_blur(mask, (SMOOTH * self.pitch()) as f32);
        let part = soft.map(|v| ((v - 0.5) * SHARP + 0.5).clamp(0.0, 1.0));
        let area: f64 = part.pixels().iter().map(|v| f64::from(*v)).sum();
        (area >= LEAST_AREA * self.pitch().powi(2)).then_some(part)
    }

    /// The portrait with white paper outside a region.
    fn only(&self, region: &Raster<f32>) -> Portrait {
        let mut portrait = self.portrait.clone();
        portrait.tone = portrait.tone.zip_map(region, |tone, share| 1.0 - (1.0 - tone) * share);
        portrait
    }

    /// The portrait with white paper where another part is drawn.
    pub(super) fn without(&self, parts: &Parts) -> Portrait {
        let others = parts.hair.iter().chain(&parts.cloths);
        let rest =
            others.fold(self.portrait.tone.map(|_| 1.0), |rest, part| rest.zip_map(part, |rest, part| rest * (1.0 - part)));
        let rest = match &parts.brows {
            Some(brows) => rest.zip_map(&brows.region, |rest, brow| rest * (1.0 - (1.0 - brows::DOTS) * brow)),
            None => rest,
        };
        self.only(&rest)
    }

    /// Hair in strokes.
    pub(super) fn hair_layer(&self, parts: &Parts) -> Result<Option<Layer>, StyleError> {
        let mut marks = Vec::new();
        if let Some((hair, mut portrait, at)) = parts.hair.as_ref().and_then(|hair| self.boxed(hair)) {
            portrait.tone = self.with_locks(&portrait.tone, &hair);
            let rim = self.rim_of(parts, &portrait.subject, &at);
            let strokes = charcoal::hair_strokes(&self.on(&portrait), &hair, &rim)?;
            portrait.tone = portrait.tone.zip_map(&rim, |tone, rim| tone.min(1.0 - rim));
            marks = self.with_fringe(self.on(&portrait).toned(strokes, &hair)?, parts);
        }
        if let Some(brows) = &parts.brows
            && let Some((region, mut portrait, [columns, rows])) = self.boxed(&brows.region)
        {
            portrait.tone = portrait.tone.map(brows::tone_over_dots);
            let drawer = self.on(&portrait);
            let hairs = OrientationField::new(brows.hairs.doubled().part(&columns, &rows));
            let strokes = charcoal::strokes_along(&drawer, &hairs, (&region, &portrait.ink()), brows.sizes)?;
            marks.extend(drawer.toned(strokes, &region)?);
        }
        Ok(layer("hair", marks))
    }

    /// The ink of the hair's rim in its box, where it has no outline.
    fn rim_of(&self, parts: &Parts, subject: &Raster<f32>, [columns, rows]: &[Range<usize>; 2]) -> Raster<f32> {
        /// Ink at the silhouette. Looked at on portraits 07, 12, 13 and 15: with 0.45 the edge of white hair is faint, and more would be a
        /// second outline.
        const RIM: f32 = 0.6;
        /// How far the shade reaches inside, as a blur of the subject in pitches.
        const REACH: f64 = 1.5;
        match &parts.beside_hair {
            Some(beside) if self.has_coherent_lines() => {
                rim(subject, REACH * self.pitch(), RIM).zip_map(&beside.part(columns, rows), |rim, beside| rim * beside)
            }
            _ => subject.map(|_| 0.0),
        }
    }

    /// Strokes with the tone of their region.
    fn toned(&self, marks: Vec<Mark>, region: &Raster<f32>) -> Result<Vec<Mark>, StyleError> {
        (0..TONE_ROUNDS).try_fold(marks, |marks, _| {
            self.check()?;
            Ok(self.with_tone(marks, region))
        })
    }

    /// A part and the portrait within the part's own box.
    fn boxed(&self, part: &Raster<f32>) -> Option<(Raster<f32>, Portrait, [Range<usize>; 2])> {
        /// Room around a part in its own box, in pitches: beyond it there is no hair to take directions from.
        const ROOM: f64 = 8.0;
        let room = (ROOM * self.pitch()).ceil() as usize;
        let [columns, rows] = part.extent_with_room(0.0, room)?;
        Some((part.part(&columns, &rows), self.portrait.part(&columns, &rows), [columns, rows]))
    }

    /// Strokes of hair, wider or thinner by the ratio of the ink asked for around each node to the ink drawn there.
    fn with_tone(&self, marks: Vec<Mark>, hair: &Raster<f32>) -> Vec<Mark> {
        /// Ink up to which strokes are not made wider, and from which they are made as much wider as a round allows: white and
        /// blond hair is a few thin lines, and its short ones would become blots.
        const LIGHT_HAIR: [f32; 2] = [0.35, 0.6];
        /// Ink that is as good as none, so that bare paper is not compared.
        const LEAST_INK: f32 = 0.01;
        let placement = &self.portrait.placement;
        let around =
            |ink: &Raster<f32>| gaussian_blur(&ink.zip_map(hair, |ink, hair| ink * hair), (TONE_REACH * self.pitch()) as f32);
        let drawn = around(&covered(&marks, placement));
        let asked = around(&self.portrait.ink());
        let within = gaussian_blur(hair, (TONE_REACH * self.pitch()) as f32);
        let most = asked.zip_map(&within, |asked, within| {
            let ink = asked / within.max(LEAST_INK);
            1.0 + (TONE_STEP[1] - 1.0) * ((ink - LIGHT_HAIR[0]) / (LIGHT_HAIR[1] - LIGHT_HAIR[0])).clamp(0.0, 1.0)
        });
        let ratio = asked.zip_map(&drawn, |asked, drawn| (asked + LEAST_INK) / (drawn + LEAST_INK));
        let ratio = ratio.zip_map(&most, |ratio, most| ratio.clamp(TONE_STEP[0], most));
        let toned = |stroke: Stroke| {
            let places: Vec<Point> = stroke.nodes().map(|node| placement.to_grid(node)).collect();
            let mut ratios = places.iter().map(|p| f64::from(ratio.sample(p.x, p.y)));
            stroke.map_widths(|width| ratios.next().map_or(width, |ratio| width * ratio))
        };
        let is_swelling = |stroke: &Stroke| matches!(stroke.width(), Width::Along(_));
        let of_mark = |mark| match mark {
            Mark::Stroke(stroke) if is_swelling(&stroke) => Mark::Stroke(toned(stroke)),
            other => other,
        };
        marks.into_iter().map(of_mark).collect()
    }

    /// Clothing in hatches.
    pub(super) fn clothing_layer(&self, parts: &Parts) -> Result<Option<Layer>, StyleError> {
        let mut marks = Vec::new();
        for (cloth, portrait, _) in parts.cloths.iter().filter_map(|cloth| self.boxed(cloth)) {
            let mut worn = self.on(&portrait).only(&cloth);
            worn.masks.clear();
            marks.extend(grid::hatches(&self.on(&worn))?);
        }
        Ok(layer("clothing", marks))
    }
}

impl Parts {
    /// True if all of it is drawn in dots.
    pub(super) fn is_empty(&self) -> bool {
        self.hair.is_none() && self.brows.is_none() && self.cloths.is_empty()
    }

    /// True if a place lies deep in another part, where a large cell at the border may have its dot, or in a sliver.
    pub(super) fn hold(&self, p: Point) -> bool {
        /// From this value on a place is deep in a part.
        const DEEP: f32 = 0.95;
        self.hair.iter().chain(&self.cloths).any(|part| part.sample(p.x, p.y) > DEEP)
            || self.slivers.as_ref().is_some_and(|slivers| slivers.sample(p.x, p.y) > 0.5)
    }

    /// True for a place in the hair of a head or beside it.
    pub(super) fn is_beside_hair(&self, p: Point) -> bool {
        self.beside_hair.as_ref().is_some_and(|beside| beside.sample(p.x, p.y) > 0.5)
    }

    /// How far a place lies in clothing or headwear, 0 to 1; in working pixels.
    pub(super) fn cloth_at(&self, p: Point) -> f32 {
        self.cloths.iter().map(|cloth| cloth.sample(p.x, p.y)).fold(0.0, f32::max)
    }

    /// How far a place lies in hair or in a brow, 0 to 1; in working pixels.
    pub(super) fn hair_at(&self, p: Point) -> f32 {
        let hairs = self.hair.iter().chain(self.brows.iter().map(|brows| &brows.region));
        hairs.map(|hair| hair.sample(p.x, p.y)).fold(0.0, f32::max)
    }
}

fn layer(name: &str, marks: Vec<Mark>) -> Option<Layer> {
    let mut layer = Layer::new(name, 1);
    layer.marks = marks;
    (!layer.marks.is_empty()).then_some(layer)
}
