//! A photograph placed on a page, at a style's working resolution.

use super::colour::{lightness, luminance};
use super::decode::Photograph;
use super::depth::{DepthSense, read_depth};
use super::error::SourceError;
use super::landmarks::Landmarks;
use super::mask_role::MaskRole;
use super::placement::{Crop, Placement, crop_on_grid};
use super::prepared::Prepared;
use super::resample::{resample, resample_grey};
use super::scribbles::Scribbles;
use crate::drawing::Page;
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect};
use crate::raster::{Raster, gaussian_blur};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

/// The mesh's point on the tip of the nose, the middle of a face.
const NOSE_TIP: usize = 1;

/// The measure of tone that the ink must match.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneTarget {
    /// CIE L*/100: equal steps look equal.
    #[default]
    Lightness,
    /// Luminance Y: the light that the sheet reflects.
    Linear,
}

/// Levels, then power: `((t - black) / (white - black)) ^ (1 / gamma)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneCurve {
    /// Tones up to this become 0, full ink; from 0 to below `white`.
    pub black: f32,
    /// Tones from this become 1, bare paper; up to 1.
    pub white: f32,
    /// Above 1 lightens the middle tones; above 0.
    pub gamma: f32,
}

impl Default for ToneCurve {
    fn default() -> Self {
        Self { black: 0.0, white: 1.0, gamma: 1.0 }
    }
}

impl ToneCurve {
    fn apply(self, tone: f32) -> f32 {
        let level = ((tone - self.black) / (self.white - self.black)).clamp(0.0, 1.0);
        if (self.gamma - 1.0).abs() < 1e-6 { level } else { level.power(1.0 / self.gamma) }
    }
}

/// A photograph ready to be drawn: linear light, the tone that ink must match, masks, all on one pixel grid.
#[derive(Clone, Debug)]
pub struct Portrait {
    /// The sheet that it is drawn on.
    pub page: Page,
    /// Where the working raster lies on the page.
    pub placement: Placement,
    /// Linear sRGB light, composited on white.
    pub light: Raster<[f32; 3]>,
    /// Target tone as the fraction of white paper, 0 to 1.
    pub tone: Raster<f32>,
    /// CIE L*/100 before the tone curve; features are detected in it.
    pub lightness: Raster<f32>,
    /// How much of each pixel belongs to the subject, 0 to 1.
    pub subject: Raster<f32>,
    /// Whether the tone was made for faces.
    has_portrait_tone: bool,
    /// The people, if their background is drawn too.
    people: Option<Raster<f32>>,
    /// True if `subject` is the photograph's own alpha, so that `light` is already composited on white.
    is_on_white: bool,
    /// Other masks, 0 to 1.
    pub masks: BTreeMap<MaskRole, Raster<f32>>,
    /// Nearness, 1 nearest and towards 0 far; 0 where unknown or background.
    pub depth: Option<Raster<f32>>,
    /// Whether the depth was estimated from the photograph.
    is_depth_found: bool,
    /// The detected faces, in working pixels, largest first.
    pub faces: Vec<Landmarks>,
    /// Regions marked by hand.
    pub scribbles: Option<Scribbles>,
    /// What the style that draws it has prepared.
    pub(crate) prepared: Prepared,
}

impl Portrait {
    /// Resamples the crop of a photograph to its placement, once, by Lanczos 3 in linear light.
    pub fn new(
        photograph: &Photograph,
        crop: Crop,
        page: Page,
        placement: Placement,
        target: ToneTarget,
        curve: ToneCurve,
    ) -> Result<Self, SourceError> {
        let planes = resample(photograph, crop.within(photograph)?, placement)?;
        let unit = |v: f32| v.clamp(0.0, 1.0);
        let light = planes.map(|[r, g, b, _]| [unit(r), unit(g), unit(b)]);
        let subject = planes.map(|[_, _, _, alpha]| unit(alpha));
        drop(planes);
        let lightness = light.map(|rgb| lightness(luminance(rgb)));
        let tone = match target {
            ToneTarget::Lightness => lightness.map(|t| curve.apply(t)),
            ToneTarget::Linear => light.map(|rgb| curve.apply(luminance(rgb))),
        };
        Ok(Self {
            page,
            placement,
            light,
            tone,
            lightness,
            subject,
            has_portrait_tone: false,
            people: None,
            is_on_white: true,
            masks: BTreeMap::new(),
            depth: None,
            is_depth_found: false,
            faces: Vec::new(),
            scribbles: None,
            prepared: Prepared::default(),
        })
    }

    /// Adds a mask, resampled like the photograph. It lies on the photograph's pixel grid or one of the same proportions. Its
    /// encoded brightness (not its light) is the coverage: 0.5 grey is half in. A `Subject` mask replaces the photograph's alpha.
    pub fn add_mask(
        &mut self,
        role: MaskRole,
        mask: &Photograph,
        photograph: &Photograph,
        crop: Crop,
    ) -> Result<(), SourceError> {
        let crop = crop_on_grid(mask, photograph, crop.within(photograph)?)?;
        if role == MaskRole::Scribbles {
            self.scribbles = Some(Scribbles::read(mask, crop, self.placement)?);
            return Ok(());
        }
        let region = region(mask, crop, self.placement)?;
        if role == MaskRole::Subject {
            self.subject = region;
            self.is_on_white = false;
        } else {
            self.masks.insert(role, region);
        }
        Ok(())
    }

    /// Adds a mask of the people for a picture whose background is drawn too.
    pub fn add_people(&mut self, mask: &Photograph, photograph: &Photograph, crop: Crop) -> Result<(), SourceError> {
        let crop = crop_on_grid(mask, photograph, crop.within(photograph)?)?;
        self.people = Some(region(mask, crop, self.placement)?);
        Ok(())
    }

    /// The mask of the people if one was added, else the subject; 0 to 1.
    pub fn people(&self) -> &Raster<f32> {
        self.people.as_ref().unwrap_or(&self.subject)
    }

    /// Replaces the tone by one made for its faces, 0 to 1, after applying the curve.
    pub fn set_portrait_tone(&mut self, tone: &Raster<f32>, curve: ToneCurve) {
        self.tone = tone.map(|t| curve.apply(t));
        self.has_portrait_tone = true;
    }

    /// Lightens the tone to paper where the mask of highlights says so. Light and lightness stay: regions and lines are found in them.
    pub fn open_highlights(&mut self) {
        let Some(highlights) = self.masks.get(&MaskRole::Highlights) else { return };
        self.tone = self.tone.zip_map(highlights, lighter);
    }

    /// Linear light as it is painted: white where the mask of highlights opens the paper.
    pub(crate) fn painted_light(&self) -> Cow<'_, Raster<[f32; 3]>> {
        match self.masks.get(&MaskRole::Highlights) {
            Some(highlights) => Cow::Owned(self.light.zip_map(highlights, |rgb, open| rgb.map(|v| lighter(v, open)))),
            None => Cow::Borrowed(&self.light),
        }
    }

    /// Ink with none where the mask of highlights opens the paper, for styles that smooth the tone.
    pub(crate) fn opened(&self, ink: Raster<f32>) -> Raster<f32> {
        match self.masks.get(&MaskRole::Highlights) {
            Some(highlights) => ink.zip_map(highlights, |ink, open| ink * (1.0 - open)),
            None => ink,
        }
    }

    /// Whether the tone was made for its faces; its whites are then intended.
    pub const fn has_portrait_tone(&self) -> bool {
        self.has_portrait_tone
    }

    /// Adds a depth map, resampled like the photograph, on its pixel grid or one of the same proportions.
    pub fn add_depth(
        &mut self,
        depth: &Photograph,
        sense: DepthSense,
        photograph: &Photograph,
        crop: Crop,
    ) -> Result<(), SourceError> {
        let crop = crop_on_grid(depth, photograph, crop.within(photograph)?)?;
        self.depth = Some(read_depth(depth, sense, crop, self.placement));
        Ok(())
    }

    /// Says that the depth was estimated from the photograph: styles that know better may do without it.
    pub const fn set_depth_found(&mut self) {
        self.is_depth_found = true;
    }

    /// Whether a depth map was given, not estimated.
    pub const fn has_given_depth(&self) -> bool {
        self.depth.is_some() && !self.is_depth_found
    }

    /// Adds faces detected in the photograph, in its pixels, largest first. Faces whose middle (tip of the nose) lies outside the
    /// crop are dropped.
    pub fn add_faces(&mut self, faces: &[Landmarks], photograph: &Photograph, crop: Crop) -> Result<(), SourceError> {
        let crop = crop.within(photograph)?;
        let (x, y) = (self.placement.columns as f64 / crop.width, self.placement.rows as f64 / crop.height);
        let place = |p: Point| Point::new((p.x - crop.x) * x, (p.y - crop.y) * y);
        let picture = Rect::new(0.0, 0.0, self.placement.columns as f64, self.placement.rows as f64);
        let placed = faces.iter().map(|face| face.placed(place, (x * y).sqrt()));
        self.faces = placed.filter(|face| picture.contains(face.point(NOSE_TIP))).collect();
        Ok(())
    }

    /// The same portrait on some of its columns and rows. Faces stay, also outside of them.
    #[must_use]
    pub fn part(&self, columns: &Range<usize>, rows: &Range<usize>) -> Self {
        let of = |raster: &Raster<f32>| raster.part(columns, rows);
        let place = |p: Point| Point::new(p.x - columns.start as f64, p.y - rows.start as f64);
        Self {
            page: self.page,
            placement: self.placement.part(columns, rows),
            light: self.light.part(columns, rows),
            tone: of(&self.tone),
            lightness: of(&self.lightness),
            subject: of(&self.subject),
            has_portrait_tone: self.has_portrait_tone,
            people: self.people.as_ref().map(of),
            is_on_white: self.is_on_white,
            masks: self.masks.iter().map(|(role, mask)| (*role, of(mask))).collect(),
            depth: self.depth.as_ref().map(of),
            is_depth_found: self.is_depth_found,
            faces: self.faces.iter().map(|face| face.placed(place, 1.0)).collect(),
            scribbles: self.scribbles.as_ref().map(|scribbles| scribbles.part(columns, rows)),
            prepared: Prepared::default(),
        }
    }

    /// Target ink of each pixel, 0 to 1; 0 outside the subject.
    pub fn ink(&self) -> Raster<f32> {
        self.on_white(&self.tone).map(|tone| 1.0 - tone)
    }

    /// Linear light of the subject alone: none of its background's colour shows at its border. All of it if nothing is left out.
    pub fn subject_light(&self) -> Raster<[f32; 3]> {
        let is_whole = self.subject.pixels().iter().all(|v| *v >= 1.0);
        let light = self.painted_light();
        if is_whole || self.is_on_white { light.into_owned() } else { without_fringe(&light, &self.subject) }
    }

    /// A raster of tone or lightness with white outside the subject. A picture already composited on white by its alpha is not
    /// faded again.
    pub fn on_white(&self, tone: &Raster<f32>) -> Raster<f32> {
        if self.is_on_white { tone.clone() } else { tone.zip_map(&self.subject, |tone, subject| 1.0 - (1.0 - tone) * subject) }
    }
}

/// A value of 0 to 1 lightened towards white.
fn lighter(v: f32, open: f32) -> f32 {
    v + open * (1.0 - v)
}

/// Reach of a background's colour across the subject's border and of the colours that replace it there, in pixels.
const BLEEDS: f32 = 1.5;
const REPLACED: f32 = 4.0;

/// The light with the subject's border, where the background shows through, in the colours beside it inside the subject.
fn without_fringe(light: &Raster<[f32; 3]>, subject: &Raster<f32>) -> Raster<[f32; 3]> {
    let inner = gaussian_blur(subject, BLEEDS).map(|v| ((v - 0.8) / 0.19).clamp(0.0, 1.0));
    let weight = gaussian_blur(&inner, REPLACED);
    let inside = |channel: usize| gaussian_blur(&light.zip_map(&inner, |rgb, inner| rgb[channel] * inner), REPLACED);
    let [red, green, blue] = [0, 1, 2].map(inside);
    Raster::from_fn(light.width(), light.height(), |x, y| {
        let (own, w, t) = (light.get(x, y), weight.get(x, y), inner.get(x, y));
        // Thin strands have no inside.
        let t = if w < 1e-3 { 1.0 } else { t };
        let beside = [red.get(x, y), green.get(x, y), blue.get(x, y)].map(|sum| sum / w.max(1e-3));
        std::array::from_fn(|i| own[i] * t + beside[i] * (1.0 - t))
    })
}

/// How much of each pixel of a grid a mask covers, 0 to 1; the mask has the photograph's proportions.
pub fn mask_on(mask: &Photograph, photograph: &Photograph, crop: Crop, placement: Placement) -> Result<Raster<f32>, SourceError> {
    let crop = crop_on_grid(mask, photograph, crop.within(photograph)?)?;
    region(mask, crop, placement)
}

/// The fraction of each working pixel that a mask covers.
fn region(mask: &Photograph, crop: Crop, placement: Placement) -> Result<Raster<f32>, SourceError> {
    if mask.lineariser.has_plain_grey(&mask.pixels) {
        return Ok(resample_grey(mask, crop, placement)?.map(lightness));
    }
    // L* is close to linear in the encoded grey, and 50 % grey of a mask means half.
    Ok(resample(mask, crop, placement)?.map(|[r, g, b, alpha]| {
        let on_white = luminance([r, g, b]);
        let on_black = (on_white - (1.0 - alpha)).max(0.0);
        lightness(on_black)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_subject_has_its_own_colour_up_to_its_border() {
        let (red, blue) = ([0.6, 0.1, 0.1], [0.1, 0.1, 0.8]);
        let subject = Raster::from_fn(60, 40, |x, _| ((30.0 - x as f32) / 4.0 + 0.5).clamp(0.0, 1.0));
        let light = subject.map(|share| std::array::from_fn(|i| red[i] * share + blue[i] * (1.0 - share)));
        let clean = without_fringe(&light, &subject);
        for x in 0..32 {
            let [r, _, b] = clean.get(x, 20);
            assert!((r - 0.6).abs() < 0.02 && (b - 0.1).abs() < 0.02, "{x}: {r} {b}");
        }
    }
}
