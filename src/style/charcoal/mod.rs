//! The charcoal portrait (Wong 1999): smudged tone, sketchy contours, flowing hair, clothing and background shaded by hand.
//!
//! ```text
//!   regions -> hair -> features -> edges -> shading -> modelling -> tone   the order of processing: each region is visited once
//!   tone, shading, edges, hair, features with modelling, background       the order of drawing: one layer each
//! ```
//!
//! The sum is the tone: the grain of the smudge adds, place by place, what the strokes leave of the ink that is asked for.

mod coherence;
mod cost;
mod curls;
mod edges;
mod feature_tones;
mod features;
mod hair;
mod modelling;
mod paper;
mod parameters;
mod patch;
mod regions;
mod seen_face;
mod shading;
mod skin;
mod strokes;
mod tone;

use super::coverage::covered;
use super::drawer::Pitched;
use super::solids::{Solids, detail_zone};
use super::{Cost, Observer, Picture, Request, Settings, Style, StyleCard, StyleError};
use crate::drawing::{Drawing, Layer, Mark};
use crate::field::OrientationField;
use crate::geometry::Rect;
use crate::raster::{Raster, gaussian_blur};
use crate::source::{MaskRole, Portrait, Prepared};
pub(super) use hair::Hairs;
use hair::Strands;
use paper::Sheet;
use parameters::{CARD, CharcoalParameters};
use regions::Regions;
use std::sync::Arc;
use tone::Laid;

/// Pixels of the picture's short side at which the thesis works (chapter 7: 500 x 600 to 600 x 800).
const SHORT_SIDE: f64 = 600.0;
/// Maximum working pixels: those of a picture twice as long as wide. A strip whose short side is scaled up to 600 would take minutes.
const MOST_PIXELS: f64 = 2.0 * SHORT_SIDE * SHORT_SIDE;
/// Maximum working pixels per pitch in small pictures, whose marks show no more, and the short side that they get at least.
const MOST_PIXELS_PER_PITCH: f64 = 8.0;
const LEAST_SHORT_SIDE: f64 = 0.5 * SHORT_SIDE;
/// Share of the hair's ink that its strokes make where grain makes the rest.
const HAIR_SHARE: f32 = 0.45;

/// The style.
pub(super) struct Charcoal;

impl Style for Charcoal {
    fn card(&self) -> &StyleCard {
        &CARD
    }

    fn pixels_per_mm(&self, settings: &Settings, _: &[MaskRole]) -> f64 {
        // Four pixels per pitch: the thesis's 600 pixels on the default 90 mm.
        4.0 / settings.number("pitch")
    }

    fn resolution(&self, settings: &Settings, _: &[MaskRole], picture: Rect) -> f64 {
        let short = picture.width().min(picture.height());
        let fine = (MOST_PIXELS_PER_PITCH / settings.number("pitch")).max(LEAST_SHORT_SIDE / short);
        (SHORT_SIDE / short).min((MOST_PIXELS / picture.area()).sqrt()).min(fine)
    }

    fn draws_ground(&self) -> bool {
        true
    }

    fn cost(&self, settings: &Settings, picture: Rect, pixels_per_mm: f64) -> Cost {
        cost::cost(&CharcoalParameters::new(settings), picture, pixels_per_mm)
    }

    fn prepare(&self, portrait: &mut Portrait, settings: &Settings, seed: u64, observer: &dyn Observer) {
        let request = Request { portrait, settings, seed, observer };
        let drawer = request.drawer(CharcoalParameters::new(settings));
        portrait.prepared = Prepared::new(ForPens { sheet: drawer.paper_for_pens(), regions: Arc::new(drawer.new_regions()) });
    }

    fn sketch(&self, request: &Request<'_>) -> Result<Drawing, StyleError> {
        request.drawer(CharcoalParameters::new(request.settings)).draw()
    }
}

/// What all pens share: the sheet of paper, and what is where.
struct ForPens {
    sheet: Sheet,
    regions: Arc<Regions>,
}

type Drawer<'a> = super::Drawer<'a, CharcoalParameters>;

/// The strokes of hair inside a region, 0 to 1, for a style of another kind at its pitch, with a least ink.
pub(super) fn hair_strokes(
    drawer: &super::Drawer<'_, impl Pitched>,
    hair: &Raster<f32>,
    least: &Raster<f32>,
) -> Result<Vec<Mark>, StyleError> {
    /// Strands to a pitch of the dots around them: at 1 locks, braids and earrings are lost in wide strands, below 0.6 hair is grey
    /// (portraits 03, 13 and 15).
    const FINER: f64 = 0.65;
    /// Their length and the smoothing of their direction to those of charcoal: shorter ones are dashes, twice as long ones lose the
    /// light and shade of waves (15); smooth ones cut across curls, less smooth ones make false whorls (13).
    const LENGTH: f64 = 1.27;
    const SMOOTH: f64 = 0.45;
    let mut strands = CharcoalParameters::new(&CARD.settings_at(drawer.parameters.pitch(), &[])?);
    strands.hair_length = LENGTH * strands.hair_length;
    strands.hair_smoothing = SMOOTH * strands.hair_smoothing;
    Ok(drawer.in_style(strands).hair(hair, 1.0, Strands::Fine(FINER), least))
}

/// Strokes along a field that make an ink inside a region, for a style of another kind at its pitch.
pub(super) fn strokes_along(
    drawer: &super::Drawer<'_, impl Pitched>,
    field: &OrientationField,
    (region, ink): (&Raster<f32>, &Raster<f32>),
    hairs: Hairs,
) -> Result<Vec<Mark>, StyleError> {
    let settings = CARD.settings_at(drawer.parameters.pitch(), &[])?;
    Ok(drawer.in_style(CharcoalParameters::new(&settings)).hairs(field, region, ink, hairs))
}

/// Widths of the lines of mouths and lids, as a share: in full they are ink among charcoal.
const MOUTH: f64 = 0.72;
const LIDS: f64 = 0.6;

impl Drawer<'_> {
    /// The five steps of the thesis in the order of section 3.1, then its layers in the order of section 6.3.
    fn draw(&self) -> Result<Drawing, StyleError> {
        if self.portrait.lightness.pixels().iter().all(|&v| v >= 1.0) {
            return Err(StyleError::NothingToDraw("the picture is white all over".to_owned()));
        }
        let shared = self.portrait.prepared.get::<ForPens>().map(|shared| shared.regions.clone());
        let regions = &*shared.unwrap_or_else(|| Arc::new(self.new_regions()));
        self.check()?;
        let hair = self.hair(&regions.hair, HAIR_SHARE, Strands::Curled, &self.rim_of_light_hair(regions));
        self.check()?;
        let features = self.features(regions);
        self.check()?;
        let edges = self.edges(regions, &features);
        self.check()?;
        let detail = detail_zone(self.portrait, self.pitch());
        let sharp = self.sharp_zone(&detail);
        let model = self.model(regions, &detail);
        let smooth = self.wanted(regions, &sharp, &detail);
        let wanted = if let Some(model) = &model { self.modelled(&smooth, model) } else { smooth };
        let shading = self.shading(regions, &features, &wanted);
        self.check()?;
        let behind = self.background_pressure(regions);
        let modelling = model.as_ref().map_or_else(Vec::new, |model| self.modelling(regions, &wanted, model));
        self.check()?;
        let strokes = covered(hair.iter().chain(&shading).chain(&modelling), &self.portrait.placement);
        let strokes = gaussian_blur(&strokes, self.pitch() as f32);
        let tone = self.tone(&Laid {
            regions,
            features: &features,
            wanted: &wanted,
            strokes: &strokes,
            sharp: &sharp,
            background: &behind,
        });
        self.check()?;
        let mut face = modelling;
        face.extend(self.draw_features(&features));
        if self.parameters.has_features {
            let solids = Solids::of_darkest(self.portrait, &self.darkness(), self.pitch());
            let solids = solids.with_mouths(self.portrait, self.pitch(), MOUTH);
            face.extend(solids.with_lids(self.portrait, self.pitch(), LIDS).layer().marks);
        }
        let background = self.background(regions, &behind);
        let layers = [
            ("tone", tone),
            ("shading", shading),
            ("edges", edges),
            ("hair", hair),
            ("features", face),
            ("background", background),
        ];
        let mut drawing = Drawing { page: self.portrait.page, layers: Self::layers(layers) };
        strokes::time(&mut drawing);
        if drawing.marks().next().is_none() {
            return Err(StyleError::NothingToDraw("nothing in the picture is dark enough for a mark".to_owned()));
        }
        Ok(drawing)
    }

    /// A layer and a pen for each part that has marks.
    fn layers<const N: usize>(parts: [(&str, Vec<Mark>); N]) -> Vec<Layer> {
        let numbered = parts.into_iter().zip(1..).filter(|((_, marks), _)| !marks.is_empty());
        numbered
            .map(|((name, marks), pen)| {
                let mut layer = Layer::new(name, pen);
                layer.marks = marks;
                layer
            })
            .collect()
    }

    /// Target ink, 0 to 1, over all regions.
    fn darkness(&self) -> Raster<f32> {
        self.portrait.tone.map(|tone| 1.0 - tone)
    }

    fn show(&self, name: &str, region: &Raster<f32>) {
        self.observer.picture(name, &|| Picture::Grey(region.clone()));
    }
}
