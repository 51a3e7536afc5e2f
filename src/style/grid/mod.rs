//! The structure grid: dots lined up along and across the features, turning into hatching where it is dark (Son et al. 2011).

mod cells;
mod cost;
mod darks;
mod dots;
mod features;
mod hatching;
mod lines;
mod mixing;
mod parameters;
mod shape;
mod structure;
mod tiles;

use super::drawer::Pitched;
use super::{Cost, Picture, Request, Settings, Style, StyleCard, StyleError};
use crate::drawing::{Drawing, Layer, Mark, Page};
use crate::geometry::{Millimetres, Rect};
use crate::raster::{Raster, gaussian_blur};
use crate::source::MaskRole;
use crate::style::solids::Solids;
use crate::style::teeth::{Gaps, with_whole_teeth};
use cells::Cell;
use darks::Darks;
use parameters::{CARD, Detail, GridParameters, Primitive};
use structure::StructureGrid;

/// Working pixels above which detail regions get the resolution of the rest: an A1 face at the default pitch would otherwise exceed a
/// drawing's limit of 4 GB.
const MOST_DETAILED_PIXELS: f64 = 25e6;

/// The style.
pub(super) struct Grid;

impl Style for Grid {
    fn card(&self) -> &StyleCard {
        &CARD
    }

    fn pixels_per_mm(&self, settings: &Settings, masks: &[MaskRole]) -> f64 {
        GridParameters::new(settings).pixels_per_pitch(masks.contains(&MaskRole::Detail)) / settings.number("pitch")
    }

    fn resolution(&self, settings: &Settings, masks: &[MaskRole], picture: Rect) -> f64 {
        let detailed = self.pixels_per_mm(settings, masks);
        let is_poster = picture.area() * detailed * detailed > MOST_DETAILED_PIXELS;
        if is_poster { self.pixels_per_mm(settings, &[]) } else { detailed }
    }

    fn cost(&self, settings: &Settings, picture: Rect, pixels_per_mm: f64) -> Cost {
        cost::cost(&GridParameters::new(settings), picture, pixels_per_mm)
    }

    fn sketch(&self, request: &Request<'_>) -> Result<Drawing, StyleError> {
        request.drawer(GridParameters::new(request.settings)).draw(LineEnds::Blunt)
    }
}

type Drawer<'a> = super::Drawer<'a, GridParameters>;

/// The ends of hatching lines where they have ink.
#[derive(Clone, Copy, PartialEq)]
enum LineEnds {
    /// As the line ends. The grid's own: the tone of its fields is exact to 0.015 with them.
    Blunt,
    /// Running out beyond the line's end, so that dark cloth has no white nicks.
    Pointed,
}

/// Settings with which all ink lies in hatches along the features.
const HATCHES: &[(&str, &str)] =
    &[("size_max", "0mm"), ("hatching", "along"), ("lines", "off"), ("reversed_from", "1"), ("isophotes", "0")];
/// Hatches run long and nearly parallel, as an engraver's, and along the edges of lapels: least length of the lines that steer them, the
/// field's finest cell, its calming and the distance from the lines with less of it, in pitches; and the lines' least contrast. Chosen on the
/// clothing of sixteen portraits and two samples: with the grid's own values rows ring around every pocket and lapel. Calmed up to the lines
/// they cross the edges of lapels, badges and microphones, whose borders are frayed; calmed from four pitches off on, rows ring again.
const STEERING_LEAST: f64 = 8.0;
const FINEST: f64 = 4.0;
const CALM: f64 = 8.0;
const BESIDE: f64 = 2.0;
const STEERING_CONTRAST: f64 = 0.1;

/// Hatches along the features with the tone's width, for a style of another kind at its pitch.
pub(super) fn hatches(drawer: &super::Drawer<'_, impl Pitched>) -> Result<Vec<Mark>, StyleError> {
    let pitch = drawer.parameters.pitch();
    let pitches = |count: f64| Millimetres(count * pitch.0);
    let parameters = GridParameters {
        steer_least: pitches(STEERING_LEAST),
        field_detail: pitches(FINEST),
        field_calm: pitches(CALM),
        field_beside: pitches(BESIDE),
        steer_contrast: STEERING_CONTRAST,
        ..GridParameters::new(&CARD.settings_at(pitch, HATCHES)?)
    };
    match drawer.in_style(parameters).draw(LineEnds::Pointed) {
        // Single dots fill holes of the hatching.
        Ok(drawing) => {
            Ok(drawing.layers.into_iter().flat_map(|layer| layer.marks).filter(|m| !matches!(m, Mark::Dot(_))).collect())
        }
        Err(StyleError::NothingToDraw(_)) => Ok(Vec::new()),
        Err(error) => Err(error),
    }
}

/// Blur of the tone that sets line widths, in pitches: a width cannot show finer detail.
const TONE_BLUR: f32 = 0.3;

impl Drawer<'_> {
    /// The paper's steps in order.
    fn draw(&self, ends: LineEnds) -> Result<Drawing, StyleError> {
        let ink = self.portrait.ink();
        let ink = if self.parameters.has_lines { with_whole_teeth(self.portrait, ink, Gaps::Faint) } else { ink };
        self.observer.picture("tone", &|| Picture::Grey(ink.map(|v| 1.0 - v)));
        if ink.pixels().iter().all(|&v| v <= 0.0) {
            let why = "the picture, or the part inside the subject mask, is white all over";
            return Err(StyleError::NothingToDraw(why.to_owned()));
        }
        let features = self.features();
        self.check()?;
        let grid = self.structure(&features, &ink);
        self.check()?;
        let lines = self.parameters.has_lines.then(|| lines::layer(self, &features)).transpose()?;
        let cells = cells::cells(self, &grid, &ink, lines.as_ref().map_or(&[], |lines| &lines.marks));
        let mut layers = match self.parameters.primitive {
            Primitive::Mixed => self.mixed_layers(&grid, &cells, &ink, ends),
            Primitive::Tile => vec![tiles::layer(self, &cells)],
            Primitive::TileLines => vec![tiles::line_layer(self, &cells)],
        };
        layers.retain(|layer| !layer.marks.is_empty());
        if layers.is_empty() {
            let why = "the subject is smaller than one dot; use a smaller pitch or a whiter mask";
            return Err(StyleError::NothingToDraw(why.to_owned()));
        }
        if let Some(mut lines) = lines {
            lines.marks.extend(self.solids(&mut layers, &ink));
            layers.push(lines);
        }
        for (layer, pen) in layers.iter_mut().zip(1..) {
            layer.pen = pen;
        }
        Ok(Drawing { page: self.portrait.page, layers })
    }

    /// Pupils, lashes and nostrils of faces in place of the dots there, and no dots in their lights: cells are too coarse for them.
    fn solids(&self, layers: &mut [Layer], ink: &Raster<f32>) -> Vec<Mark> {
        if self.portrait.faces.is_empty() {
            return Vec::new();
        }
        let solids = Solids::of_features(self.portrait, ink, self.pitch()).with_gaps_of_teeth(self.portrait, self.pitch());
        let outline = solids.outline.clone();
        let marks = solids.over(layers).marks;
        self.clear_lights(layers, &outline, ink);
        marks
    }

    /// Section 6: lines and dots; reversed areas join the lines, or the dots if there are no lines.
    fn mixed_layers(&self, grid: &StructureGrid, cells: &[Cell], ink: &Raster<f32>, ends: LineEnds) -> Vec<Layer> {
        let darks = Darks::new(self, grid, ink);
        let blurred = gaussian_blur(ink, TONE_BLUR * self.pitch() as f32);
        let mut lines = hatching::layer(self, grid, &darks, &blurred, ends);
        let mut dots = dots::layer(self, grid, cells, &darks, &blurred);
        let first = if lines.marks.is_empty() { &mut dots } else { &mut lines };
        first.marks.extend(darks.areas);
        vec![lines, dots]
    }

    /// A drawing of one or more layers on the portrait's page, for `stages`.
    fn picture_of(&self, layers: Vec<Layer>) -> Picture {
        let page: Page = self.portrait.page;
        Picture::Drawing(Box::new(Drawing { page, layers }))
    }

    /// Where dots and lines stand closer.
    fn detail(&self) -> Option<&Raster<f32>> {
        self.portrait.masks.get(&MaskRole::Detail).filter(|_| self.parameters.detail == Detail::Auto)
    }
}
