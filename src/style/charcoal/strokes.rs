//! A stroke of the stick: path, pressure and time.

use super::Drawer;
use crate::drawing::{Drawing, Mark, Stroke};
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
        Stroke::swelling(catmull_rom(&page, Ring::Open), widths)?.with_pressure(pressure).map(Mark::Stroke)
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
    let mut hand = Hand { now: 0.0, at: Point::ORIGIN };
    for layer in &mut drawing.layers {
        let marks = std::mem::take(&mut layer.marks).into_iter();
        layer.marks =
            marks.filter_map(|mark| if let Mark::Stroke(stroke) = mark { hand.draw(stroke) } else { Some(mark) }).collect();
    }
}

/// The hand that draws: the time, and where it is.
struct Hand {
    now: f64,
    at: Point,
}

impl Hand {
    /// The stroke with its times.
    fn draw(&mut self, stroke: Stroke) -> Option<Mark> {
        let first = stroke.nodes().next()?;
        self.now += self.at.distance(first) / MOVING_SPEED + LIFT;
        self.at = first;
        let times = stroke.nodes().map(|node| {
            self.now += self.at.distance(node) / DRAWING_SPEED;
            self.at = node;
            self.now
        });
        let times = times.collect();
        stroke.with_times(times).map(Mark::Stroke)
    }
}
