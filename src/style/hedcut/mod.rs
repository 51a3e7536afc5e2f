//! The hedcut: dots in rows along the features, sized so that their ink is exactly the tone (Bruehl 2023, after Kim et al.
//! 2008 and 2010).

mod contest;
mod cost;
mod features;
mod fringe;
mod highlights;
mod locks;
mod outline;
mod parameters;
mod parts;
mod seeds;
mod silhouette;
mod size;

use super::{Cost, Picture, Request, Settings, Style, StyleCard, StyleError};
use crate::drawing::{Dot, Drawing, Layer, Mark};
use crate::field::{Curve, LaneParameters, Lanes, distance_to_curves, offset_lanes};
use crate::geometry::{Point, Rect, blob};
use crate::raster::Raster;
use crate::source::MaskRole;
use crate::style::coverage::covered;
use crate::style::solids::Solids;
use crate::style::teeth::{Gaps, with_whole_teeth};
use features::Features;
use parameters::{CARD, HedcutParameters};
use parts::Parts;
use std::borrow::Cow;

/// Width of outlines in pitches with which lids have their own.
const OUTLINE: f64 = 0.4;

/// The style.
pub(super) struct Hedcut;

impl Style for Hedcut {
    fn card(&self) -> &StyleCard {
        &CARD
    }

    fn pixels_per_mm(&self, settings: &Settings, masks: &[MaskRole]) -> f64 {
        HedcutParameters::new(settings).pixels_per_pitch(masks.contains(&MaskRole::Detail)) / settings.number("pitch")
    }

    fn cost(&self, settings: &Settings, picture: Rect, pixels_per_mm: f64) -> Cost {
        cost::cost(&HedcutParameters::new(settings), picture, pixels_per_mm)
    }

    fn sketch(&self, request: &Request<'_>) -> Result<Drawing, StyleError> {
        request.drawer(HedcutParameters::new(request.settings)).draw()
    }
}

type Drawer<'a> = super::Drawer<'a, HedcutParameters>;

/// A dot in working pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SizedDot {
    centre: Point,
    radius: f64,
}

impl Drawer<'_> {
    /// The parts, each in its own marks: skin in dots, hair in strokes, clothing in hatches.
    fn draw(&self) -> Result<Drawing, StyleError> {
        let parts = self.parts();
        if parts.is_empty() {
            return self.dots(&parts);
        }
        let rest = self.without(&parts);
        let ink = self.portrait.ink();
        let mut solids = Solids::new(self.portrait, &ink, self.pitch());
        if self.has_lids(&parts) {
            solids = solids.with_lids(
                self.portrait,
                self.pitch(),
                self.parameters.outline_width.0 / (OUTLINE * self.parameters.pitch.0),
            );
            solids = solids.with_gaps_of_teeth(self.portrait, self.pitch());
        }
        let mut drawing = match self.on(&rest).dots(&parts) {
            // All of it lies in the other parts.
            Err(StyleError::NothingToDraw(_) | StyleError::NothingLeft { .. }) => {
                Drawing { page: self.page(), layers: Vec::new() }
            }
            dots => dots?,
        };
        let shapes = solids.outline.clone();
        let solids = solids.over(&mut drawing.layers);
        drawing.layers.extend(Some(solids).filter(|layer| !layer.marks.is_empty()));
        self.clear_lights(&mut drawing.layers, &shapes, &ink);
        let hair = self.hair_layer(&parts)?;
        hair.iter().for_each(|hair| self.clear_dots_below(hair, &mut drawing.layers));
        drawing.layers.extend(hair);
        drawing.layers.extend(self.clothing_layer(&parts)?);
        if drawing.layers.is_empty() {
            return Err(StyleError::NothingToDraw(
                "the picture, or the part inside the subject mask, is white all over".to_owned(),
            ));
        }
        Ok(drawing)
    }

    /// Takes away the dots of skin that strands of hair run over.
    fn clear_dots_below(&self, hair: &Layer, layers: &mut [Layer]) {
        let strands = covered(&hair.marks, &self.portrait.placement);
        let is_below = |p: Point| {
            let p = self.portrait.placement.to_grid(p);
            strands.sample(p.x, p.y) > 0.5
        };
        for layer in layers {
            layer.marks.retain(|mark| !matches!(mark, Mark::Dot(dot) if is_below(dot.centre)));
        }
    }

    /// The thesis' steps in order.
    fn dots(&self, parts: &Parts) -> Result<Drawing, StyleError> {
        let ink = self.portrait.ink();
        let ink = if self.has_lids(parts) { with_whole_teeth(self.portrait, ink, Gaps::Drawn) } else { ink };
        self.observer.picture("tone", &|| Picture::Grey(ink.map(|v| 1.0 - v)));
        if ink.pixels().iter().all(|&v| v <= 0.0) {
            return Err(StyleError::NothingToDraw(
                "the picture, or the part inside the subject mask, is white all over".to_owned(),
            ));
        }
        let features = self.features(parts);
        let lanes = self.lanes(&features);
        let sites = seeds::relaxed_seeds(self, &lanes)?;
        let ink = highlights::fade_ink(self, &ink, &features);
        let size::Sized { dots, reversed } = match self.parameters.size {
            parameters::SizeRule::Exact => size::exact(self, &sites, &ink),
            parameters::SizeRule::Paper => size::paper(self, &sites, &ink),
        };
        let mut dots = highlights::thin_out(self, dots, &features);
        if !dots.iter().any(|dot| !parts.hold(dot.centre)) && reversed.is_empty() {
            let why = "all of it is as light as the highlights, which stay bare";
            return Err(StyleError::NothingLeft { why, setting: "highlights=off" });
        }
        dots = highlights::without_crumbs(self, dots);
        dots.retain(|dot| !parts.hold(dot.centre));
        let mut layer = self.dot_layer(&dots);
        layer.marks.extend(reversed);
        let mut drawing = Drawing { page: self.page(), layers: vec![layer] };
        if self.parameters.has_outline {
            self.observer.begin("outline");
            drawing.layers.push(outline::layer(self, &features, parts));
        }
        Ok(drawing)
    }

    /// Steps 3 and 4: distance maps and offset lanes.
    fn lanes(&self, features: &Features) -> Lanes {
        self.observer.begin("lanes");
        let size = self.size();
        let edges: Cow<'_, [Curve]> = match self.drawn_directions() {
            Some(drawn) => Cow::Owned([&features.edges[..], &drawn.lines[..]].concat()),
            None => Cow::Borrowed(&features.edges),
        };
        let edges = distance_to_curves(&edges, size.0, size.1);
        let isophotes = distance_to_curves(&features.isophotes, size.0, size.1);
        for (name, field) in [("distance-to-edges", &edges), ("distance-to-isophotes", &isophotes)] {
            if let Some(field) = field {
                let reach = 10.0 * self.pitch() as f32;
                self.observer.picture(name, &|| Picture::Grey(field.distance.map(|d| (d / reach).min(1.0))));
            }
        }
        let parameters = LaneParameters {
            pitch: self.pitch() as f32,
            detail_pitch: (self.pitch() / self.parameters.detail_lanes().unwrap_or(1.0)) as f32,
            edge_weight: self.parameters.edge_weight,
            isophote_weight: self.parameters.isophote_weight,
        };
        let lanes = offset_lanes(edges.as_ref(), isophotes.as_ref(), self.detail(), size, parameters);
        self.observer.picture("lanes", &|| Picture::Labels(lanes.lane.clone()));
        self.observer.picture("offset-lines", &|| Picture::Mask(lanes.line.clone()));
        lanes
    }

    /// Step 11 and the conversion from pixels to millimetres.
    fn dot_layer(&self, dots: &[SizedDot]) -> Layer {
        self.observer.begin("dots");
        let scale = self.portrait.placement.mm_per_pixel();
        let mut layer = Layer::new("dots", 1);
        layer.marks = dots
            .iter()
            .enumerate()
            .map(|(i, dot)| {
                let centre = self.portrait.placement.to_page(dot.centre);
                let radius = dot.radius * scale;
                let outline = (self.parameters.blob > 0.0).then(|| {
                    let mut random = super::random::stream(self.seed, "blobs", i as u64);
                    Box::new(blob(centre, radius, self.parameters.blob, &mut random))
                });
                Mark::Dot(Dot { centre, radius, outline, colour: None })
            })
            .collect();
        layer
    }

    fn detail(&self) -> Option<&Raster<f32>> {
        self.portrait.masks.get(&MaskRole::Detail).filter(|_| self.parameters.detail_lanes().is_some())
    }
}
