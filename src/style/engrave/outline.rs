//! Coherent lines on top of the engraving (Galarza 2017, section 5.2; Kang, Lee and Chui 2007).

use super::Drawer;
use crate::drawing::{Layer, Mark, Stroke};
use crate::elementary::Elementary as _;
use crate::field::{Curve, LineParameters, edge_tangent_flow, flow_lines, lines_of};
use crate::geometry::{Ring, catmull_rom, resample};
use crate::raster::{gaussian_blur, thin};

/// Kang's window radius and number of rounds.
const FLOW_RADIUS: usize = 5;
const FLOW_ROUNDS: u32 = 3;
/// Minimum length of an outline and the distance of its nodes, in pitches.
const LEAST_LENGTH: f64 = 5.0;
const NODE_SPACING: f64 = 1.5;

impl Drawer<'_> {
    pub(super) fn outlines(&self) -> Layer {
        self.observer.begin("outlines");
        let pitch = self.pitch();
        let grey = gaussian_blur(&self.portrait.on_white(&self.portrait.lightness), (0.2 * pitch) as f32);
        let flow = edge_tangent_flow(&grey, FLOW_RADIUS, FLOW_ROUNDS);
        let parameters = LineParameters { width: 1.0, length: 3.0, contrast: 0.99, threshold: 0.5, rounds: 2 };
        let found = flow_lines(&grey, &flow, parameters);
        self.observer.picture("coherent-lines", &|| crate::style::Picture::Mask(found.line.clone()));
        let mut layer = Layer::new("outline", 1);
        let lines = lines_of(&thin(&found.line), (0.5 * pitch) as f32, (LEAST_LENGTH * pitch) as f32);
        layer.marks = lines.iter().filter_map(|line| self.outline(line)).collect();
        layer
    }

    fn outline(&self, line: &Curve) -> Option<Mark> {
        let mut nodes = line.points.clone();
        nodes.extend(line.points.first().filter(|_| line.closed).copied());
        let nodes = resample(&nodes, NODE_SPACING * self.pitch());
        if nodes.len() < 3 {
            return None;
        }
        let page: Vec<_> = nodes.iter().map(|p| self.portrait.placement.to_page(*p)).collect();
        let swell = |i: usize| (std::f64::consts::PI * i as f64 / (page.len() - 1) as f64).sine().max(0.0).sqrt();
        let widths = (0..page.len()).map(|i| self.parameters.outline_width.0 * swell(i)).collect();
        Stroke::swelling(catmull_rom(&page, Ring::Open), widths).map(Mark::Stroke)
    }
}
