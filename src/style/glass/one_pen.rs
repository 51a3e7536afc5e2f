//! One pen: streamline arcs of one width, as close to each other as the tone requires (evenly spaced streamlines after Jobard and Lefer
//! 1997, with the spacing set by measured ink).

mod arcs;
mod coverage;

use super::{Drawer, Ground};
use crate::drawing::{Layer, Mark, Stroke};
use crate::geometry::{Point, Ring, catmull_rom, resample};
use crate::style::{Picture, StyleError};
use arcs::{Arcs, Wanted};
use coverage::Calibration;

/// Rounds of drawing and measuring; each brings the ink of every tone closer to its target.
const ROUNDS: usize = 5;
/// Distance between a curve's nodes in pixels.
const NODE_SPACING: f64 = 2.0;

pub(super) fn layer(drawer: &Drawer<'_>, ground: &Ground) -> Result<Layer, StyleError> {
    let mut layer = drawer.empty_layer("lines");
    let ink = drawer.portrait.ink();
    if ink.pixels().iter().all(|&v| v <= 0.0) {
        return Err(StyleError::NothingToDraw("the picture, or the part inside the subject mask, is white all over".to_owned()));
    }
    drawer.observer.picture("tone", &|| Picture::Grey(ink.map(|v| 1.0 - v)));
    let flow = ground.flow.unframed(ground.margin);
    let width = drawer.pixels(drawer.parameters.line);
    let mut calibration = Calibration::default();
    let mut lines = Vec::new();
    for round in 0..ROUNDS {
        drawer.check()?;
        let spacing = calibration.spacing(&ink, width as f32);
        let wanted = Wanted { flow: &flow, ink: &ink, spacing: &spacing, width, length: drawer.pixels(drawer.parameters.length) };
        lines = Arcs::draw(&wanted, drawer.seed);
        if round + 1 < ROUNDS {
            calibration.learn(&ink, &coverage::coverage(&lines, width, &ink));
        }
        drawer.observer.progress((round + 1) as f64 / ROUNDS as f64);
    }
    layer.marks = lines.iter().filter_map(|line| mark(drawer, line)).collect();
    Ok(layer)
}

/// An arc as a line of constant width; pressure fades at its ends, for machines with pressure.
fn mark(drawer: &Drawer<'_>, line: &[Point]) -> Option<Mark> {
    let nodes: Vec<Point> = resample(line, NODE_SPACING).into_iter().map(|p| drawer.portrait.placement.to_page(p)).collect();
    let stroke = Stroke::even(catmull_rom(&nodes, Ring::Open), drawer.parameters.line.0);
    let last = (nodes.len() - 1) as f64;
    let taper = (0.5 * drawer.parameters.taper).max(1e-6);
    let pressure = |i: usize| (0.25 + 0.75 * (i as f64).min(last - i as f64) / last / taper).min(1.0);
    stroke.with_pressure((0..nodes.len()).map(pressure).collect()).map(Mark::Stroke)
}
