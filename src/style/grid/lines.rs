//! The feature lines on top, as wide as they were found (Son et al. 2011, section 3).

use super::Drawer;
use super::features::Features;
use crate::drawing::{Layer, Mark, Stroke, Width};
use crate::field::CoherentLine;
use crate::geometry::catmull_rom;

/// Every so many points of a line become a node of its stroke: 4.5 pixels, less than a pitch.
const STRIDE: usize = 3;
/// Share of a line at each end over which it tapers, and the most that is, in pitches.
const TAPER: f64 = 0.25;
const LONGEST_TAPER: f64 = 4.0;

pub(super) fn layer(drawer: &Drawer<'_>, features: &Features) -> Layer {
    drawer.observer.begin("feature lines");
    let mut layer = Layer::new("lines", 1);
    layer.marks = features.lines.iter().filter_map(|line| stroke(drawer, line)).collect();
    layer
}

fn stroke(drawer: &Drawer<'_>, line: &CoherentLine) -> Option<Mark> {
    let placement = &drawer.portrait.placement;
    let count = line.curve.points.len();
    let mut picked: Vec<usize> = (0..count).step_by(STRIDE).collect();
    if !line.curve.closed && picked.last() != Some(&(count - 1)) {
        picked.push(count - 1);
    }
    if picked.len() < 3 {
        return None;
    }
    let page: Vec<_> = picked.iter().map(|&i| placement.to_page(line.curve.points[i])).collect();
    let scale = placement.mm_per_pixel();
    let length = line.curve.length();
    let taper = (TAPER * length).min(LONGEST_TAPER * drawer.pitch());
    let mut widths: Vec<f64> = picked
        .iter()
        .map(|&i| {
            let along = length * i as f64 / (count - 1) as f64;
            let share = if line.curve.closed { 1.0 } else { (along.min(length - along) / taper).clamp(0.0, 1.0).sqrt() };
            line.widths[i] * scale * share
        })
        .collect();
    if line.curve.closed {
        widths.push(widths[0]);
    }
    Some(Mark::Stroke(Stroke::new(catmull_rom(&page, line.curve.closed), Width::Along(widths))))
}
