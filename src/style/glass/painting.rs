//! The painting: the ribbons of the pattern as opaque strokes in the smoothed picture's colours (Papari 2009, section 7.3).

use super::visible::{Canvas, Shown};
use super::{Drawer, Ground, colour, hairs, noise};
use crate::drawing::{Layer, Mark, Mixing, Stroke, Width};
use crate::field::{Ribbon, glass_pattern, glass_ribbons};
use crate::geometry::{BezPath, Point, catmull_rom};
use crate::raster::{Raster, sorted};
use crate::style::StyleError;
use rayon::prelude::*;

/// Least area of a stroke that shows, in working pixels.
const LEAST_SHOWN: f64 = 0.5;

pub(super) fn layers(drawer: &Drawer<'_>, ground: &Ground) -> Result<Vec<Layer>, StyleError> {
    drawer.observer.begin("pattern");
    let sigma = drawer.pixels(drawer.parameters.grain_mm) as f32;
    let (width, height) = (ground.subject.width(), ground.subject.height());
    let noise = noise::noise(width, height, sigma, drawer.seed, "noise");
    drawer.show_patterns(ground, &noise);
    let length = drawer.pixels(drawer.parameters.length_mm);
    let pattern = glass_pattern(&noise, &ground.flow, length as f32).unframed(ground.margin);
    drawer.check()?;
    let mut layer = drawer.empty_layer("strokes");
    layer.mixing = Mixing::Paint;
    let levels = Levels::new(&pattern, drawer.parameters.ribbons);
    let ribbons = glass_ribbons(&noise, &ground.flow, length, |height| levels.below(height));
    drawer.check()?;
    layer.marks = marks(drawer, ground, &ribbons, &levels);
    let mut layers = vec![layer];
    if drawer.parameters.hairs > 0.0 {
        layers.push(hairs::layer(drawer, ground, &pattern));
    }
    Ok(layers)
}

/// The noise levels between equal shares of the pattern.
struct Levels {
    /// Lower bounds, ascending; the first lies below all noise.
    bounds: Vec<f32>,
}

impl Levels {
    fn new(pattern: &Raster<f32>, count: usize) -> Self {
        let sorted = sorted(pattern);
        let bound = |i: usize| if i == 0 { f32::MIN } else { sorted[i * sorted.len() / count] };
        Self { bounds: (0..count).map(bound).collect() }
    }

    /// Those that a maximum of this height rises above.
    fn below(&self, height: f32) -> Vec<f32> {
        self.bounds.iter().copied().filter(|level| *level < height).collect()
    }

    /// The equalised value of a level's share, -1/2 to 1/2.
    fn value(&self, level: f32) -> f32 {
        let i = self.bounds.partition_point(|bound| *bound < level);
        (i as f32 + 0.5) / self.bounds.len() as f32 - 0.5
    }
}

fn marks(drawer: &Drawer<'_>, ground: &Ground, ribbons: &[Ribbon], levels: &Levels) -> Vec<Mark> {
    let strokes: Vec<Stroke> = ribbons.par_iter().map(|ribbon| stroke(drawer, ribbon)).collect();
    let mut canvas = Canvas::new(&pictured(ground));
    let mut kept: Vec<(usize, Shown)> = Vec::new();
    for (i, stroke) in strokes.iter().enumerate().rev() {
        let shown = canvas.cover(stroke, &ground.smoothed);
        if shown.area >= LEAST_SHOWN {
            kept.push((i, shown));
        }
    }
    kept.reverse();
    kept.par_iter()
        .map(|&(i, shown)| {
            let shift = drawer.parameters.contrast * levels.value(ribbons[i].level);
            let mut stroke = on_page(drawer, ground, &strokes[i]);
            stroke.colour = Some(colour::shifted(shown.colour(), shift));
            stroke.group = Some(0);
            Mark::Stroke(stroke)
        })
        .collect()
}

/// The subject, without the frame.
fn pictured(ground: &Ground) -> Raster<f32> {
    let (width, height, margin) = (ground.subject.width(), ground.subject.height(), ground.margin);
    Raster::from_fn(width, height, |x, y| {
        let is_inside = x >= margin && y >= margin && x < width - margin && y < height - margin;
        if is_inside { ground.subject.get(x, y) } else { 0.0 }
    })
}

/// A ribbon as a stroke in framed pixels, its upstream end run out to a tip.
fn stroke(drawer: &Drawer<'_>, ribbon: &Ribbon) -> Stroke {
    let length: f64 = ribbon.nodes.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let taper = drawer.parameters.taper * length;
    let mut left = 0.0;
    let mut widths = ribbon.widths.clone();
    for i in (0..widths.len()).rev() {
        if left < taper {
            widths[i] *= (0.25 + 0.75 * left / taper).min(1.0);
        }
        if i > 0 {
            left += ribbon.nodes[i].distance(ribbon.nodes[i - 1]);
        }
    }
    Stroke::new(catmull_rom(&ribbon.nodes, false), Width::Along(widths))
}

fn on_page(drawer: &Drawer<'_>, ground: &Ground, stroke: &Stroke) -> Stroke {
    let scale = drawer.portrait.placement.mm_per_pixel();
    let mut moved = stroke.clone();
    moved.curve = mapped(&stroke.curve, |p| drawer.to_page(ground, p));
    if let Width::Along(widths) = &mut moved.width {
        widths.iter_mut().for_each(|w| *w *= scale);
    }
    moved
}

fn mapped(curve: &BezPath, place: impl Fn(Point) -> Point) -> BezPath {
    use kurbo::PathEl;
    curve
        .iter()
        .map(|element| match element {
            PathEl::MoveTo(p) => PathEl::MoveTo(place(p)),
            PathEl::LineTo(p) => PathEl::LineTo(place(p)),
            PathEl::QuadTo(a, p) => PathEl::QuadTo(place(a), place(p)),
            PathEl::CurveTo(a, b, p) => PathEl::CurveTo(place(a), place(b), place(p)),
            PathEl::ClosePath => PathEl::ClosePath,
        })
        .collect()
}
