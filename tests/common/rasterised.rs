//! A drawing's ink as pixels, straight from the model: each mark's outline by scan lines, in painting order. It shares no code
//! with the writers and readers.

use super::any_style::ink_outline;
use drypoint::drawing::{Colour, Drawing, Painted};
use drypoint::geometry::{BezPath, Point};
use kurbo::PathEl;

/// Scan lines per pixel; along them coverage is exact.
const SUB: usize = 8;

/// Red, green and blue from 0 to 1, row by row.
pub struct Pixels {
    pub width: usize,
    pub height: usize,
    pub rgb: Vec<[f32; 3]>,
}

fn rgb(colour: Colour) -> [f32; 3] {
    [colour.r, colour.g, colour.b].map(|v| f32::from(v) / 255.0)
}

pub fn rasterised(drawing: &Drawing, pixels_per_mm: f64) -> Pixels {
    let count = |mm: f64| (mm * pixels_per_mm).round() as usize;
    let (width, height) = (count(drawing.page.width), count(drawing.page.height));
    let mut pixels = Pixels { width, height, rgb: vec![rgb(drawing.page.paper); width * height] };
    for painted in drawing.painting_order() {
        let Painted::Mark { layer, mark } = painted else { continue };
        let layer = &drawing.layers[layer];
        let mark = &layer.marks[mark];
        let colour = rgb(mark.colour().unwrap_or(layer.ink.colour()));
        pixels.paint(&ink_outline(mark, 0.001), pixels_per_mm, colour);
    }
    pixels
}

impl Pixels {
    fn paint(&mut self, outline: &BezPath, scale: f64, colour: [f32; 3]) {
        let polygons = polygons(outline, scale);
        let rows = polygons.iter().flatten().map(|p| p.y);
        let (low, high) = rows.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        let first = low.floor().max(0.0) as usize;
        let end = (high.ceil().max(0.0) as usize).min(self.height);
        if first >= end {
            return;
        }
        let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); (end - first) * SUB];
        for polygon in &polygons {
            for (i, &a) in polygon.iter().enumerate() {
                cross(&mut crossings, first, a, polygon[(i + 1) % polygon.len()]);
            }
        }
        for (row, lines) in crossings.chunks_mut(SUB).enumerate() {
            let mut cover = vec![0.0_f32; self.width];
            lines.iter_mut().for_each(|line| cover_line(&mut cover, line));
            for (pixel, cover) in self.rgb[(first + row) * self.width..].iter_mut().zip(cover) {
                let cover = cover.min(1.0);
                pixel.iter_mut().zip(colour).for_each(|(v, ink)| *v += (ink - *v) * cover);
            }
        }
    }
}

fn polygons(outline: &BezPath, scale: f64) -> Vec<Vec<Point>> {
    let mut polygons: Vec<Vec<Point>> = Vec::new();
    kurbo::flatten(outline, 0.002, |element| match element {
        PathEl::MoveTo(p) => polygons.push(vec![Point::new(p.x * scale, p.y * scale)]),
        PathEl::LineTo(p) => polygons.last_mut().unwrap().push(Point::new(p.x * scale, p.y * scale)),
        _ => {}
    });
    polygons
}

/// The points where a side crosses the middles of scan lines.
fn cross(crossings: &mut [Vec<(f64, i32)>], first: usize, a: Point, b: Point) {
    let (top, bottom, winding) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
    let line = |y: f64| ((y - first as f64) * SUB as f64 - 0.5).ceil().max(0.0) as usize;
    for i in line(top.y)..line(bottom.y).min(crossings.len()) {
        let y = first as f64 + (i as f64 + 0.5) / SUB as f64;
        crossings[i].push((top.x + (bottom.x - top.x) * (y - top.y) / (bottom.y - top.y), winding));
    }
}

/// Adds the coverage of each pixel by one scan line, by the nonzero rule.
fn cover_line(cover: &mut [f32], crossings: &mut [(f64, i32)]) {
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut winding, mut from) = (0, 0.0);
    for &(x, turn) in crossings.iter() {
        if winding == 0 {
            from = x;
        }
        winding += turn;
        if winding == 0 {
            let (from, to) = (from.clamp(0.0, cover.len() as f64), x.clamp(0.0, cover.len() as f64));
            for (pixel, cover) in cover.iter_mut().enumerate().take(to.ceil() as usize).skip(from as usize) {
                let part = (to.min(pixel as f64 + 1.0) - from.max(pixel as f64)).max(0.0);
                *cover += part as f32 / SUB as f32;
            }
        }
    }
}
