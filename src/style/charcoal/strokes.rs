//! A stroke of the stick: path, pressure and time.

use super::Drawer;
use crate::drawing::{Drawing, Mark, Stroke, Width};
use crate::geometry::{Millimetres, Point, Ring, catmull_rom, polyline_length, resample};

/// Width at zero pressure as a share of that at full pressure: a stick never draws a hairline.
const LIGHTEST: f64 = 0.3;
/// Speed of a sketching hand in millimetres per second while drawing and between strokes; seconds to lift and set down.
const DRAWING_SPEED: f64 = 80.0;
const MOVING_SPEED: f64 = 250.0;
const LIFT: f64 = 0.15;

/// Pressure along one stroke.
#[derive(Clone, Copy)]
pub(super) struct Touch {
    /// Width at full pressure in millimetres.
    pub width: Millimetres,
    /// Maximum pressure, 0 to 1.
    pub pressure: f64,
    /// Share of the stroke at either end over which the pressure grows or falls.
    pub taper: f64,
    /// Distance of the spline's nodes in millimetres.
    pub node: Millimetres,
}

impl Drawer<'_> {
    /// A stroke along working pixels; `local` scales the pressure at a place (working pixels), 0 to 1.
    pub(super) fn stroke(&self, points: &[Point], touch: Touch, local: impl Fn(Point) -> f64) -> Option<Mark> {
        let spacing = self.pixels(touch.node).min(0.25 * polyline_length(points)).max(1e-3);
        let nodes = resample(points, spacing);
        if nodes.len() < 2 {
            return None;
        }
        let last = (nodes.len() - 1) as f64;
        let pressure: Vec<f64> = nodes
            .iter()
            .enumerate()
            .map(|(i, p)| (touch.pressure * swell(i as f64 / last, touch.taper) * local(*p)).clamp(0.0, 1.0))
            .collect();
        let page: Vec<Point> = nodes.iter().map(|p| self.portrait.placement.to_page(*p)).collect();
        let widths = pressure.iter().map(|p| touch.width.0 * (LIGHTEST + (1.0 - LIGHTEST) * p)).collect();
        let mut stroke = Stroke::new(catmull_rom(&page, Ring::Open), Width::Along(widths));
        stroke.pressure = Some(pressure);
        Some(Mark::Stroke(stroke))
    }
}

/// The pressure at which a stroke has this share of its full width; below 0 if the width is smaller than at zero pressure.
pub(super) fn pressure_for(width: f64) -> f64 {
    (width - LIGHTEST) / (1.0 - LIGHTEST)
}

/// Pressure along a stroke, 0 to 1: start, swell and lift; the start is firmer than the lift.
fn swell(along: f64, taper: f64) -> f64 {
    let ramp = |distance: f64, least: f64| {
        let t = (distance / taper.max(1e-6)).min(1.0);
        least + (1.0 - least) * t * t * (3.0 - 2.0 * t)
    };
    ramp(along, 0.35).min(ramp(1.0 - along, 0.05))
}

/// Sets the times at the nodes of every stroke, in drawing order.
pub(super) fn time(drawing: &mut Drawing) {
    let (mut now, mut at) = (0.0, Point::ORIGIN);
    for stroke in drawing.layers.iter_mut().flat_map(|layer| &mut layer.marks) {
        let Mark::Stroke(stroke) = stroke else { continue };
        let nodes = nodes(stroke);
        let Some(&first) = nodes.first() else { continue };
        now += at.distance(first) / MOVING_SPEED + LIFT;
        at = first;
        let times = nodes.iter().map(|node| {
            now += at.distance(*node) / DRAWING_SPEED;
            at = *node;
            now
        });
        stroke.times = Some(times.collect());
    }
}

/// The start and the end of each segment.
fn nodes(stroke: &Stroke) -> Vec<Point> {
    stroke.curve.elements().iter().filter_map(kurbo::PathEl::end_point).collect()
}
