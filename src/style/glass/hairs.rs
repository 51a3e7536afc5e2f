//! Bristle marks: fine lines on top of the strokes, along the same flow (Papari 2009, figures 7.15 and 7.16).

use super::{Drawer, Ground, colour, noise};
use crate::drawing::{Layer, Mark, Mixing, Stroke};
use crate::field::line_integral_convolution;
use crate::geometry::{Point, Ring, catmull_rom, resample};
use crate::parallel::collected;
use crate::raster::{Raster, equalised};
use crate::style::random;
use rand::RngExt;

/// A hair's width in grains (figure 7.15: `sigma_z` falls from 3 to 0.6).
const WIDTH: f64 = 0.3;
/// A hair's length as a share of the strokes' length (figure 7.15: a falls from 24 to 6).
const LENGTH: f64 = 0.4;
/// Distance of hairs across the stroke, in their widths; at 2 they cover the strokes and hide their edges, at 5 they look stray.
const SPACING: f64 = 3.0;
/// Minimum magnitude of the finer pattern that shows as a hair; smaller values would be the stroke's own colour.
const LEAST_VALUE: f32 = 0.15;

pub(super) fn layer(drawer: &Drawer<'_>, ground: &Ground, pattern: &Raster<f32>) -> Layer {
    let mut layer = drawer.empty_layer("hairs");
    layer.mixing = Mixing::Paint;
    let grain = drawer.pixels(drawer.parameters.grain);
    let length = LENGTH * drawer.pixels(drawer.parameters.length);
    let (width, height) = (ground.subject.width(), ground.subject.height());
    let fine = noise::noise(width, height, 0.6, drawer.seed, "hairs");
    let values = equalised(&line_integral_convolution(&fine, &ground.flow, length as f32));
    drawer.observer.picture("hair-pattern", &|| super::Picture::Grey(values.unframed(ground.margin).map(|v| v + 0.5)));
    let below = equalised(pattern).framed(ground.margin);
    let hairs = Hairs { drawer, ground, values: &values, below: &below, length, width: WIDTH * grain };
    let (margin, across) = (ground.margin as f64, SPACING * hairs.width);
    // One random seed per cell; a cell has the area of a hair's length times its spacing.
    let side = (across * length).sqrt();
    let columns = ((width as f64 - 2.0 * margin) / side).ceil() as usize;
    let rows = ((height as f64 - 2.0 * margin) / side).ceil() as usize;
    let of_cell = |cell: usize| {
        let mut random = random::stream(drawer.seed, "hair seeds", cell as u64);
        let (dx, dy): (f64, f64) = (random.random(), random.random());
        let (column, row) = ((cell % columns) as f64, (cell / columns) as f64);
        hairs.hair(Point::new(margin + (column + dx) * side, margin + (row + dy) * side))
    };
    layer.marks = collected(columns * rows, &of_cell).into_iter().flatten().collect();
    layer
}

struct Hairs<'a> {
    drawer: &'a Drawer<'a>,
    ground: &'a Ground,
    values: &'a Raster<f32>,
    below: &'a Raster<f32>,
    length: f64,
    width: f64,
}

impl Hairs<'_> {
    fn hair(&self, middle: Point) -> Option<Mark> {
        let value = self.values.sample(middle.x, middle.y);
        if value.abs() < LEAST_VALUE || self.ground.subject.sample(middle.x, middle.y) < 0.5 {
            return None;
        }
        let flow = &self.ground.flow;
        let mut line = flow.streamline(middle, -0.5 * self.length, 1.0);
        line.reverse();
        line.extend_from_slice(&flow.streamline(middle, 0.5 * self.length, 1.0)[1..]);
        if line.len() < 3 {
            return None;
        }
        let page: Vec<Point> = resample(&line, 3.0).into_iter().map(|p| self.drawer.to_page(self.ground, p)).collect();
        let rgb: Vec<f32> = self.ground.smoothed.iter().map(|plane| plane.sample(middle.x, middle.y)).collect();
        let shift =
            self.drawer.parameters.contrast * (self.below.sample(middle.x, middle.y) + self.drawer.parameters.hairs * value);
        let width = self.width * self.drawer.portrait.placement.mm_per_pixel();
        let colour = colour::shifted([rgb[0], rgb[1], rgb[2]], shift);
        Some(Mark::Stroke(Stroke::even(catmull_rom(&page, Ring::Open), width).with_colour(Some(colour)).in_group(Some(1))))
    }
}
