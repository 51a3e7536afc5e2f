//! Steps 1, 2 and 12: edges and isophotes, detected or drawn by hand.

use super::Drawer;
use super::parameters::Lines;
use super::parts::Parts;
use crate::field::{
    CoherentLine, Curve, EdgeParameters, LineParameters, coherent_lines, detect_edges, detect_isophotes, distance_to_curves,
    edge_tangent_flow, flow_lines, lines_of,
};
use crate::raster::{Raster, bilateral};
use crate::source::MaskRole;
use crate::style::Picture;
use crate::style::jaw::Jaws;
use crate::style::lids::Lids;
use crate::style::mouth::Mouths;
use crate::style::strays::Strays;
use crate::style::under_eyes::without_folds_under_eyes;

/// The lines that steer the dots, in working pixels.
pub(super) struct Features {
    pub edges: Vec<Curve>,
    /// The coherent lines with their widths; empty if edges come from another source.
    pub drawn: Vec<CoherentLine>,
    pub isophotes: Vec<Curve>,
    /// Lightness of the subject on white, smoothed within regions.
    pub smoothed: Raster<f32>,
}

/// Kang's values for the edge tangent flow: window radius in pixels, and rounds.
const FLOW_RADIUS: usize = 5;
const FLOW_ROUNDS: u32 = 3;
/// Kang's `sigma_m` as a multiple of `sigma_c`.
const LINE_LENGTH: f32 = 3.0;
/// Coherent lines shorter than this, in pitches, are specks; an eyelid is three long.
const LEAST_LINE: f64 = 2.0;

/// Length from which what lids leave of a line is kept, in widths of an eye: shorter are crow's feet and bags, as wires (12).
const BEYOND_LIDS: f64 = 1.5;

impl Drawer<'_> {
    pub(super) fn features(&self, parts: &Parts) -> Features {
        self.observer.begin("edges");
        // The background is removed first, so that the silhouette is an edge and nothing beyond it is.
        let lightness = self.portrait.on_white(&self.portrait.lightness);
        let (edges, drawn) = match self.portrait.masks.get(&MaskRole::Edges) {
            Some(mask) => (self.hand_made(mask, self.parameters.smoothing), Vec::new()),
            None if self.parameters.lines == Lines::Coherent => self.coherent_edges(&lightness, parts),
            None => (self.with_silhouette(self.found_edges(&lightness)), Vec::new()),
        };
        self.observer.begin("isophotes");
        let (isophotes, smoothed) = match self.portrait.masks.get(&MaskRole::Isophotes) {
            Some(mask) => (self.hand_made(mask, self.parameters.smoothing), bilateral(&lightness, 2.0, 0.08)),
            None if self.portrait.masks.contains_key(&MaskRole::Edges) && self.parameters.isophotes == 0 => {
                (Vec::new(), bilateral(&lightness, 2.0, 0.08))
            }
            None => self.found_isophotes(&lightness),
        };
        self.observer.picture("features", &|| Picture::Drawing(Box::new(self.line_drawing(&edges, &isophotes))));
        Features { edges, drawn, isophotes, smoothed }
    }

    /// True if lids are lines of their own: where all is dots, they are found lines as others.
    pub(super) fn has_lids(&self, parts: &Parts) -> bool {
        !parts.is_empty() && self.parameters.has_outline && self.has_coherent_lines()
    }

    /// True if edges are coherent lines, not Canny's and not drawn by hand.
    pub(super) fn has_coherent_lines(&self) -> bool {
        self.parameters.lines == Lines::Coherent && !self.portrait.masks.contains_key(&MaskRole::Edges)
    }

    fn found_edges(&self, lightness: &Raster<f32>) -> Vec<Curve> {
        let parameters = EdgeParameters {
            blur: self.pixels(self.parameters.edge_blur) as f32,
            thresholds: self.thresholds(self.parameters.edge_low, self.parameters.edge_high),
            least_length: self.pixels(self.parameters.edge_length) as f32,
            smoothing: self.pixels(self.parameters.smoothing) as f32,
        };
        let steps = detect_edges(lightness, parameters);
        self.observer.picture("blurred", &|| Picture::Grey(steps.blurred.clone()));
        self.observer.picture("canny", &|| Picture::Mask(steps.canny.clone()));
        self.observer.picture("edges-thickened", &|| Picture::Mask(steps.thickened.clone()));
        self.observer.picture("edges-kept", &|| Picture::Mask(steps.kept.clone()));
        self.observer.picture("edges-skeleton", &|| Picture::Mask(steps.skeleton.clone()));
        lines_of(&steps.skeleton, parameters.smoothing, 0.5 * parameters.least_length)
    }

    /// Coherent lines instead of Canny's edges (suggested in Bruehl 2023, section 4.3.1): the lines long enough to steer, and all lines,
    /// of which the outline takes the longest.
    fn coherent_edges(&self, lightness: &Raster<f32>, parts: &Parts) -> (Vec<Curve>, Vec<CoherentLine>) {
        let width = self.pixels(self.parameters.line_width) as f32;
        let flow = edge_tangent_flow(lightness, FLOW_RADIUS, FLOW_ROUNDS);
        let parameters = LineParameters { width, length: LINE_LENGTH * width, contrast: 0.99, threshold: 0.5, rounds: 2 };
        let found = flow_lines(lightness, &flow, parameters);
        self.observer.picture("coherent-lines", &|| Picture::Mask(found.line.clone()));
        let least = LEAST_LINE * self.pitch();
        let mut lines = coherent_lines(&found, lightness, self.pixels(self.parameters.smoothing), least).lines;
        lines.retain(|line| line.contrast >= self.parameters.line_contrast);
        let lines = Strays::of(self.portrait, lightness, self.pitch()).dropped_from(lines);
        let lines = Mouths::of(self.portrait, self.pitch()).redrawn(lines, least);
        let lines = Jaws::of(self.portrait, self.pitch()).redrawn(lines, least);
        let lids = if self.has_lids(parts) { Lids::of(self.portrait, self.pitch()) } else { Lids::none() };
        let lines = lids.cut_from(&lines, |eye| least.max(BEYOND_LIDS * eye));
        let steering = self.pixels(self.parameters.edge_length);
        let steers = lines.iter().map(|line| &line.curve).cloned().chain(lids.curves());
        let long = steers.filter(|curve| curve.length() >= steering).collect();
        let width = self.pixels(self.parameters.outline_width);
        let outline = self.with_silhouette(Vec::new()).into_iter().map(|curve| CoherentLine::plain(curve, width));
        let drawn = outline.chain(without_folds_under_eyes(self.portrait, lines, least)).collect();
        (self.with_silhouette(long), drawn)
    }

    /// Adds the subject's exact border as an edge. Detected edges beside it (a pixel or two off) would leave a strip too narrow for a
    /// row of dots, so those parts are removed.
    fn with_silhouette(&self, edges: Vec<Curve>) -> Vec<Curve> {
        let least = self.pixels(self.parameters.edge_length);
        let (width, height) = self.size();
        let silhouette = self.silhouette(self.parameters.smoothing, self.parameters.edge_length);
        let Some(field) = distance_to_curves(&silhouette, width, height) else { return edges };
        let reach = (0.9 * self.pitch()) as f32;
        let apart = edges.iter().flat_map(|edge| {
            edge.points
                .split(|p| field.distance.sample(p.x, p.y) < reach)
                .filter(|run| run.len() > 1)
                .map(|run| Curve { points: run.to_vec(), closed: edge.closed && run.len() == edge.points.len() })
        });
        let kept: Vec<Curve> = apart.filter(|line| line.length() >= 0.5 * least).collect();
        silhouette.into_iter().chain(kept).collect()
    }

    fn found_isophotes(&self, lightness: &Raster<f32>) -> (Vec<Curve>, Raster<f32>) {
        let smoothing = self.pixels(self.parameters.smoothing).clamp(1.0, 6.0) as f32;
        let least = self.pixels(self.parameters.edge_length) as f32;
        let steps = detect_isophotes(lightness, self.parameters.levels, self.parameters.isophotes, smoothing, least);
        self.observer.picture("smoothed", &|| Picture::Grey(steps.smoothed.clone()));
        self.observer.picture("posterised", &|| Picture::Grey(steps.posterised.clone()));
        (steps.lines, steps.smoothed)
    }

    /// Edges and isophotes as a drawing, for `stages`.
    fn line_drawing(&self, edges: &[Curve], isophotes: &[Curve]) -> crate::drawing::Drawing {
        use crate::drawing::{Colour, Drawing, Ink, Layer};
        let mut drawing = Drawing { page: self.page(), layers: Vec::new() };
        for (name, curves, colour) in
            [("edges", edges, Colour { r: 200, g: 30, b: 30 }), ("isophotes", isophotes, Colour { r: 30, g: 90, b: 200 })]
        {
            let mut layer = Layer::new(name, drawing.layers.len() as u32 + 1);
            layer.ink = Ink::Colour(colour);
            layer.marks = curves.iter().map(|curve| self.thin_line(curve)).collect();
            drawing.layers.push(layer);
        }
        drawing
    }

    fn thin_line(&self, curve: &Curve) -> crate::drawing::Mark {
        use crate::drawing::{Mark, Stroke};
        let mut path = crate::geometry::BezPath::new();
        for (i, p) in curve.points.iter().enumerate() {
            let p = self.portrait.placement.to_page(*p);
            if i == 0 { path.move_to(p) } else { path.line_to(p) }
        }
        if curve.closed {
            path.close_path();
        }
        Mark::Stroke(Stroke::even(path, 0.2 * self.parameters.pitch.0))
    }
}
