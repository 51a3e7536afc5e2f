//! Feature lines, isophotes and the field between them (Son et al. 2011, section 4).

use super::Drawer;
use crate::drawing::{Colour, Ink, Layer, Mark, Stroke};
use crate::elementary::{Elementary as _, unit_at};
use crate::field::{
    CoherentLine, Curve, DirectionField, FieldParameters, Guides, LineParameters, coherent_lines, detect_isophotes,
    direction_field, edge_tangent_flow, flow_lines,
};
use crate::geometry::{BezPath, Point, Vec2};
use crate::raster::Raster;
use crate::source::MaskRole;
use crate::style::Picture;
use crate::style::jaw::Jaws;
use crate::style::lids::Lids;
use crate::style::mouth::Mouths;
use crate::style::strays::Strays;

/// The lines that steer the grid and their direction field, in working pixels.
pub(super) struct Features {
    /// Lines that were found, strong enough to be drawn.
    pub lines: Vec<CoherentLine>,
    /// Lines long and strong enough to steer the grid.
    pub guides: Vec<Curve>,
    pub field: DirectionField,
}

/// Width of hand-drawn lines and of the subject's border, in pitches.
const PLAIN_WIDTH: f64 = 0.25;
/// Least length of what lids leave of a line, as a share of a line's: sides of irises are short.
const OF_IRIS: f64 = 0.4;

impl Drawer<'_> {
    pub(super) fn features(&self) -> Features {
        self.observer.begin("lines");
        let lightness = self.portrait.on_white(&self.portrait.lightness);
        let lines = match self.portrait.masks.get(&MaskRole::Edges) {
            Some(mask) => self.plain(self.hand_made(mask, self.parameters.smoothing)),
            None => self.with_silhouette(self.found_lines(&lightness)),
        };
        self.observer.begin("isophotes");
        let isophotes = match self.portrait.masks.get(&MaskRole::Isophotes) {
            Some(mask) => self.hand_made(mask, self.parameters.smoothing),
            None => self.found_isophotes(&lightness),
        };
        let guides = self.steering(&lines);
        self.observer.picture("features", &|| {
            self.picture_of(vec![
                self.thin_layer("lines", &guides, Colour { r: 20, g: 20, b: 20 }),
                self.thin_layer("isophotes", &isophotes, Colour { r: 30, g: 90, b: 200 }),
            ])
        });
        let field = self.field(&guides, &isophotes);
        Features { lines, guides, field }
    }

    /// The lines long and strong enough to steer the grid.
    fn steering(&self, lines: &[CoherentLine]) -> Vec<Curve> {
        let least = self.pixels(self.parameters.steer_least);
        let steers = |line: &&CoherentLine| line.curve.length() >= least && line.contrast >= self.parameters.steer_contrast;
        lines.iter().filter(steers).map(|line| line.curve.clone()).collect()
    }

    /// Section 4.2: the directions between the lines.
    fn field(&self, lines: &[Curve], isophotes: &[Curve]) -> DirectionField {
        /// Weight of lines drawn by hand: what was found beside them hardly counts.
        const DRAWN: f32 = 8.0;
        self.observer.begin("field");
        let (width, height) = self.size();
        let drawn = self.drawn_directions().map_or_else(Vec::new, |drawn| drawn.lines);
        let guides = [
            Guides { curves: lines, weight: 1.0 },
            Guides { curves: isophotes, weight: self.parameters.isophote_weight },
            Guides { curves: &drawn, weight: DRAWN },
        ];
        let field = direction_field(&guides, width, height, self.field_parameters());
        self.observer.picture("field", &|| self.picture_of(self.field_layers(&field)));
        field
    }

    fn field_parameters(&self) -> FieldParameters {
        FieldParameters {
            finest: self.pixels(self.parameters.field_detail).max(2.0),
            calm: self.pixels(self.parameters.field_calm),
            beside: self.pixels(self.parameters.field_beside),
        }
    }

    /// Section 4.1: the edge tangent flow and the coherent lines along it.
    fn found_lines(&self, lightness: &Raster<f32>) -> Vec<CoherentLine> {
        let parameters = &self.parameters;
        let reach = self.pixels(parameters.flow_reach).round() as usize;
        let flow = edge_tangent_flow(lightness, reach, parameters.flow_rounds);
        self.observer.picture("edge-tangent-flow", &|| {
            Picture::Grey(flow.tangent.map(|[x, y]| if x == 0.0 && y == 0.0 { 1.0 } else { 0.5 + 0.5 * (x * x - y * y) }))
        });
        let found = flow_lines(lightness, &flow, self.line_parameters());
        self.observer.picture("flow-dog", &|| Picture::Grey(found.response.map(|h| 1.0 + h.min(0.0).hyperbolic_tangent())));
        self.observer.picture("coherent-lines", &|| Picture::Mask(found.line.clone()));
        let steps = coherent_lines(&found, lightness, self.pixels(parameters.smoothing), self.pixels(parameters.line_least));
        self.observer.picture("lines-kept", &|| Picture::Mask(steps.kept.clone()));
        self.observer.picture("lines-skeleton", &|| Picture::Mask(steps.skeleton.clone()));
        let widest = self.pixels(parameters.line_widest);
        let capped = |line: CoherentLine| CoherentLine { widths: line.widths.iter().map(|w| w.min(widest)).collect(), ..line };
        let lines = steps.lines.into_iter().filter(|line| line.contrast >= parameters.draw_contrast).map(capped).collect();
        let lines = Strays::of(self.portrait, lightness, self.pitch()).dropped_from(lines);
        let least = self.pixels(parameters.line_least);
        let lines = Mouths::of(self.portrait, self.pitch()).redrawn(lines, least);
        let lines = Jaws::of(self.portrait, self.pitch()).redrawn(lines, least);
        Lids::of(self.portrait, self.pitch()).redrawn(&lines, OF_IRIS * least)
    }

    fn line_parameters(&self) -> LineParameters {
        LineParameters {
            width: self.pixels(self.parameters.line_width) as f32,
            length: self.pixels(self.parameters.line_length) as f32,
            contrast: self.parameters.line_contrast as f32,
            threshold: self.parameters.line_threshold as f32,
            rounds: self.parameters.line_rounds,
        }
    }

    /// Adds the subject's exact border as a line and removes detected lines beside it, which would double it.
    fn with_silhouette(&self, lines: Vec<CoherentLine>) -> Vec<CoherentLine> {
        let least = self.pixels(self.parameters.line_least);
        let mut silhouette = self.silhouette(self.parameters.smoothing, self.parameters.line_least);
        silhouette.retain(|line| line.points.len() > 2);
        let (width, height) = self.size();
        let Some(border) = crate::field::distance_to_curves(&silhouette, width, height) else { return lines };
        let reach = (0.9 * self.pitch()) as f32;
        let is_apart = |p: &Point| border.distance.sample(p.x, p.y) >= reach;
        let apart = lines
            .into_iter()
            .flat_map(|line| line.runs(&line.curve.points.iter().map(is_apart).collect::<Vec<_>>()))
            .filter(|line| line.curve.length() >= 0.5 * least);
        self.plain(silhouette).into_iter().chain(apart).collect()
    }

    /// Curves as lines of constant width.
    fn plain(&self, curves: Vec<Curve>) -> Vec<CoherentLine> {
        let width = PLAIN_WIDTH * self.pitch();
        curves.into_iter().map(|curve| CoherentLine::plain(curve, width)).collect()
    }

    /// Section 4.1: borders between levels of lightness.
    fn found_isophotes(&self, lightness: &Raster<f32>) -> Vec<Curve> {
        if self.parameters.isophotes < 2 {
            return Vec::new();
        }
        let smoothing = self.pixels(self.parameters.smoothing).clamp(1.0, 6.0) as f32;
        let least = self.pixels(self.parameters.steer_least) as f32;
        let levels = self.parameters.isophotes;
        let steps = detect_isophotes(lightness, levels, levels - 1, smoothing, least);
        self.observer.picture("smoothed", &|| Picture::Grey(steps.smoothed.clone()));
        self.observer.picture("posterised", &|| Picture::Grey(steps.posterised.clone()));
        steps.lines
    }

    /// The field as short strokes two pitches apart, and its singular points as rings, one layer per sign.
    fn field_layers(&self, field: &DirectionField) -> Vec<Layer> {
        let step = 2.0 * self.pitch();
        let ring = |centre: Point| {
            let points = (0..12).map(|k| centre + unit_at(f64::from(k) * std::f64::consts::TAU / 12.0) * step).collect();
            Curve { points, closed: true }
        };
        let singular = |sign: f32| -> Vec<Curve> {
            field.singularities.iter().filter(|s| s.index * sign > 0.0).map(|s| ring(s.position)).collect()
        };
        vec![
            self.thin_layer("field", &self.field_strokes(field, step), Colour { r: 60, g: 60, b: 60 }),
            self.thin_layer("loop-ends", &singular(1.0), Colour { r: 200, g: 30, b: 30 }),
            self.thin_layer("triple-points", &singular(-1.0), Colour { r: 30, g: 90, b: 200 }),
        ]
    }

    fn field_strokes(&self, field: &DirectionField, step: f64) -> Vec<Curve> {
        let mut strokes = Vec::new();
        let (width, height) = self.size();
        for j in 0..(height as f64 / step) as usize {
            for i in 0..(width as f64 / step) as usize {
                let p = Point::new((i as f64 + 0.5) * step, (j as f64 + 0.5) * step);
                let [x, y] = field.tangent.get(p.x as usize, p.y as usize);
                let half = Vec2::new(f64::from(x), f64::from(y)) * (0.42 * step);
                strokes.push(Curve { points: vec![p - half, p + half], closed: false });
            }
        }
        strokes
    }

    /// Curves as thin lines of one colour.
    pub(super) fn thin_layer(&self, name: &str, curves: &[Curve], colour: Colour) -> Layer {
        let mut layer = Layer::new(name, 1);
        layer.ink = Ink::Colour(colour);
        layer.marks = curves
            .iter()
            .filter(|curve| curve.points.len() > 1)
            .map(|curve| {
                let mut path = BezPath::new();
                for (i, p) in curve.points.iter().enumerate() {
                    let p = self.portrait.placement.to_page(*p);
                    if i == 0 { path.move_to(p) } else { path.line_to(p) }
                }
                if curve.closed {
                    path.close_path();
                }
                Mark::Stroke(Stroke::even(path, 0.15 * self.parameters.pitch.0))
            })
            .collect();
        layer
    }
}
