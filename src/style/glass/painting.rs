//! The painting: the ribbons of the pattern as opaque strokes in the smoothed picture's colours (Papari 2009, section 7.3).

use super::body::Body;
use super::people::People;
use super::visible::{Canvas, Shown};
use super::{Drawer, Ground, colour, detail, hairs, noise, underpainting};
use crate::drawing::{Layer, Mark, Mixing};
use crate::field::{Flow, GlassLevels, Ribbon, RibbonFit, glass_pattern, glass_ribbons};
use crate::geometry::{Point, Vec2};
use crate::parallel::mapped;
use crate::raster::Raster;
use crate::style::StyleError;

/// Minimum visible area of a stroke, in working pixels: smaller flecks cannot be seen and make up half of the strokes.
const LEAST_SHOWN: f64 = 1.0;

/// Grain of the background behind people, in that of their faces.
const BROAD: f32 = 1.8;

pub(super) fn layers(drawer: &Drawer<'_>, ground: &Ground) -> Result<Vec<Layer>, StyleError> {
    drawer.observer.begin("pattern");
    let sigma = drawer.pixels(drawer.parameters.grain) as f32;
    let (width, height) = (ground.subject.width(), ground.subject.height());
    let fine = noise::noise(width, height, sigma, drawer.seed, "noise");
    let noise = match &ground.people {
        Some(people) => {
            let broad = noise::noise(width, height, BROAD * sigma, drawer.seed, "broad noise");
            noise::mixed(&fine, &broad, BROAD, &people.broad.framed(ground.margin))
        }
        None => fine,
    };
    drawer.show_patterns(ground, &noise);
    let length = drawer.pixels(drawer.parameters.length);
    let framed = glass_pattern(&noise, &ground.flow, length as f32);
    let pattern = framed.unframed(ground.margin);
    drawer.check()?;
    let mut layer = drawer.empty_layer("strokes");
    layer.mixing = Mixing::Paint;
    let levels = GlassLevels::new(&pattern, drawer.parameters.ribbons as usize);
    let ribbons = glass_ribbons(&noise, &framed, &ground.flow, length, RibbonFit::Brush, |height| levels.of(height));
    drawer.check()?;
    layer.marks = Painter { drawer, ground, levels: &levels }.paint(&ribbons);
    let mut layers = vec![layer];
    if drawer.parameters.hairs > 0.0 {
        layers.push(hairs::layer(drawer, ground, &pattern));
    }
    Ok(layers)
}

/// A single-coloured part of a stroke: its nodes and its visible part.
struct Part {
    first: usize,
    last: usize,
    shown: Shown,
}

struct Painter<'a> {
    drawer: &'a Drawer<'a>,
    ground: &'a Ground,
    levels: &'a GlassLevels,
}

impl Painter<'_> {
    /// Works from the top down, so that hidden strokes are never kept; then puts the marks in painting order, with the fine strokes on
    /// top.
    fn paint(&self, ribbons: &[Ribbon]) -> Vec<Mark> {
        let bodies: Vec<Body> = mapped(ribbons, &|ribbon| Body::of_ribbon(ribbon, self.drawer.parameters.taper));
        let mut canvas = Canvas::new(&pictured(self.ground), self.ground.margin);
        let mut colours = Vec::new();
        let mut kept: Vec<(usize, Part)> = Vec::new();
        for (i, body) in bodies.iter().enumerate().rev() {
            for part in cover(&mut canvas, body, &self.ground.smoothed, &mut colours) {
                kept.push((i, part));
            }
        }
        let mut marks = underpainting::marks(self.drawer, self.ground);
        marks.extend(self.filling(&mut canvas, &mut colours));
        let strokes = mapped(&kept, &|(i, part)| {
            let shift = self.drawer.parameters.contrast * self.levels.value(&ribbons[*i]);
            self.mark(&bodies[*i], part, shift)
        });
        marks.extend(strokes.into_iter().rev().flatten());
        marks.extend(detail::marks(self.drawer, self.ground, &canvas, &colours));
        marks
    }

    /// Strokes under all others where these leave the canvas bare: at saddles of the noise and where the flow begins.
    fn filling(&self, canvas: &mut Canvas, colours: &mut Vec<[f32; 3]>) -> Vec<Mark> {
        /// Width of the filling strokes in places that the pattern leaves bare, in grains.
        const FILLING_WIDTH: f64 = 4.0;
        /// Their value, that of the pattern's lowest third: if darker, they stand out as cracks and the painting becomes too
        /// dark.
        const FILLING_VALUE: f32 = -0.35;
        /// Their length as a share of the other strokes'.
        const FILLING_LENGTH: f64 = 0.5;
        let width = FILLING_WIDTH * self.drawer.pixels(self.drawer.parameters.grain);
        let length = FILLING_LENGTH * self.drawer.pixels(self.drawer.parameters.length);
        let flow = &self.ground.flow;
        let mut marks = Vec::new();
        for y in 0..canvas.rows() {
            let bare: Vec<Point> = canvas.bare(y).collect();
            for p in bare {
                if !canvas.is_bare(p) || !self.ground.holds(p, 0.5 * width) {
                    continue;
                }
                let nodes = filling_line(flow, p, 0.5 * length);
                let widths = vec![width; nodes.len()];
                let body = Body::new(nodes, widths);
                let (fresh, shown) = canvas.cover(&body, &self.ground.smoothed);
                canvas.settle(&fresh, |_| Some(colours.len()));
                let shown = shown.iter().fold(Shown::default(), |sum, shown| sum.with(shown));
                // At the picture's corners nothing of it may be inside, and it would have no colour.
                if shown.area() <= 0.0 {
                    continue;
                }
                colours.push(shown.colour());
                let part = Part { first: 0, last: body.stretches(), shown };
                marks.extend(self.mark(&body, &part, FILLING_VALUE * self.drawer.parameters.contrast));
            }
        }
        marks.reverse();
        marks
    }

    fn mark(&self, body: &Body, part: &Part, shift: f32) -> Option<Mark> {
        let scale = self.drawer.portrait.placement.mm_per_pixel();
        let stroke = body.stroke(part.first, part.last, scale, |p| self.drawer.to_page(self.ground, p))?;
        let margin = self.ground.margin as f64;
        let contrast = |people: &People| people.contrast(body.nodes[part.first] - Vec2::new(margin, margin));
        let shift = shift * self.ground.people.as_ref().map_or(1.0, contrast);
        let colour = Some(colour::shifted(part.shown.colour(), shift));
        Some(Mark::Stroke(stroke.with_colour(colour).in_group(Some(0))))
    }
}

/// Cosine of the maximum angle by which filling strokes turn away from their middle.
const MOST_FILLING_TURN: f64 = 0.7;

/// Follows the flow both ways as long as it roughly keeps its direction, so that the stroke is sure to cover the place.
fn filling_line(flow: &Flow, p: Point, reach: f64) -> Vec<Point> {
    let along = flow.at(p);
    let half = |length: f64| {
        let line = flow.streamline(p, length, 2.0);
        let keeps_on = |pair: &[Point]| (pair[1] - pair[0]).normalize().dot(along) * length.signum() > MOST_FILLING_TURN;
        let count = line.windows(2).take_while(|pair| keeps_on(pair)).count();
        line[1..=count].to_vec()
    };
    let mut nodes = half(-reach);
    nodes.reverse();
    nodes.push(p);
    nodes.extend(half(reach));
    if nodes.len() < 2 { vec![p, p + Vec2::new(0.1, 0.0)] } else { nodes }
}

/// Covers the canvas with a stroke and returns its visible parts; each part owns its sub-pixels under the number of its colour.
fn cover(canvas: &mut Canvas, body: &Body, planes: &[Raster<f32>], colours: &mut Vec<[f32; 3]>) -> Vec<Part> {
    let (fresh, shown) = canvas.cover(body, planes);
    let parts = parts(&shown);
    let first = colours.len();
    canvas.settle(&fresh, |stretch| parts.iter().position(|part| (part.first..part.last).contains(&stretch)).map(|i| first + i));
    colours.extend(parts.iter().map(|part| part.shown.colour()));
    parts
}

/// Joins visible stretches to parts of similar colour, from the downstream end, where the brush is set down.
fn parts(shown: &[Shown]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for (i, stretch) in shown.iter().enumerate().filter(|(_, stretch)| stretch.area() > 0.0) {
        match parts.last_mut() {
            Some(part) if is_alike(&part.shown, stretch) => {
                part.last = i + 1;
                part.shown = part.shown.with(stretch);
            }
            _ => parts.push(Part { first: i, last: i + 1, shown: *stretch }),
        }
    }
    parts.retain(|part| part.shown.area() >= LEAST_SHOWN);
    parts
}

/// Change of colour along a stroke (root of the channels' summed squares, of values 0 to 1) at which a new one begins. At 0.05 skin
/// breaks into scales, at 0.2 eyes and lips smear over the face (judged on the astronaut and Grace Hopper).
const COLOUR_CHANGE: f32 = 0.1;

fn is_alike(a: &Shown, b: &Shown) -> bool {
    let (ca, cb) = (a.colour(), b.colour());
    let squares: f32 = ca.iter().zip(cb).map(|(a, b)| (a - b) * (a - b)).sum();
    b.area() < LEAST_SHOWN || squares < COLOUR_CHANGE * COLOUR_CHANGE
}

/// The subject, without the frame.
fn pictured(ground: &Ground) -> Raster<f32> {
    let (width, height, margin) = (ground.subject.width(), ground.subject.height(), ground.margin);
    Raster::from_fn(width, height, |x, y| {
        let is_inside = x >= margin && y >= margin && x < width - margin && y < height - margin;
        if is_inside { ground.subject.get(x, y) } else { 0.0 }
    })
}
