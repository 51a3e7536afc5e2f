//! Fine strokes on top where the broad ones miss the picture: eyes, lips, the rim of a cup.

use super::body::Body;
use super::visible::Canvas;
use super::{Drawer, Ground, colour};
use crate::drawing::Mark;
use crate::geometry::{Point, Vec2};
use crate::raster::Raster;

/// Width of a fine stroke in grains: two thirds of a broad one's.
const WIDTH: f64 = 2.0;
/// Its maximum length as a share of a broad one's.
const LENGTH: f64 = 0.4;
/// Share of its width and of the least difference left in the middle of eyes and mouths.
const FINER: f32 = 0.4;
/// Change of colour at which it ends, as a share of the difference that triggered it.
const COLOUR_CHANGE: f32 = 0.5;

/// Strokes where the painting's colours (`colours`, by owner of the canvas) differ from the picture's by more than the parameter
/// `detail`; the largest differences on top.
pub(super) fn marks(drawer: &Drawer<'_>, ground: &Ground, canvas: &Canvas, colours: &[[f32; 3]]) -> Vec<Mark> {
    let finer = finer(ground);
    let least = finer.map(|finer| finer * drawer.parameters.detail);
    let picture = |x: usize, y: usize| [0, 1, 2].map(|i| ground.smoothed[i].get(x, y));
    let (width, height) = (ground.subject.width(), ground.subject.height());
    let missing = Raster::from_fn(width, height, |x, y| canvas.colour(x, y, colours).map_or(0.0, |c| distance(c, picture(x, y))));
    let mut seeds: Vec<usize> = (0..missing.len()).filter(|&i| missing.pixels()[i] > least.pixels()[i]).collect();
    seeds.sort_unstable_by(|a, b| missing.pixels()[*b].total_cmp(&missing.pixels()[*a]).then(a.cmp(b)));
    let widest = WIDTH * drawer.pixels(drawer.parameters.grain);
    let scale = drawer.portrait.placement.mm_per_pixel();
    let mut done = Raster::filled(width, height, false);
    let mut marks = Vec::new();
    for seed in seeds {
        let (x, y) = (seed % width, seed / width);
        let touch = widest * f64::from(finer.get(x, y));
        if done.get(x, y) || !ground.holds(Point::new(x as f64 + 0.5, y as f64 + 0.5), 0.5 * touch) {
            continue;
        }
        let line = arc(drawer, ground, &Missing { by: &missing, least: &least }, Point::new(x as f64 + 0.5, y as f64 + 0.5));
        let mut sum = [0.0; 3];
        for p in &line {
            sum.iter_mut().zip(picture(p.x as usize, p.y as usize)).for_each(|(sum, v)| *sum += v / line.len() as f32);
            mark_done(&mut done, *p, 0.5 * touch);
        }
        let mut nodes: Vec<Point> = line.iter().step_by(2).copied().collect();
        if nodes.len() < 2 {
            let along = ground.fine_flow.at(line[0]) * (0.3 * touch) + Vec2::new(1e-3, 0.0);
            nodes = vec![line[0] - along, line[0] + along];
        }
        let mut widths = vec![touch; nodes.len()];
        widths[0] *= 0.6;
        let body = Body::new(nodes, widths);
        let stroke = body.stroke(0, body.stretches(), scale, |p| drawer.to_page(ground, p));
        let colour = Some(colour::shifted(sum, 0.0));
        marks.extend(stroke.map(|stroke| Mark::Stroke(stroke.with_colour(colour).in_group(Some(0)))));
    }
    marks.reverse();
    marks
}

/// What is left of the width and of the least difference at each place.
fn finer(ground: &Ground) -> Raster<f32> {
    match &ground.people {
        Some(people) => people.detail.framed(ground.margin).map(|detail| 1.0 - FINER * detail),
        None => ground.subject.map(|_| 1.0),
    }
}

/// The difference between painting and picture, and that from which strokes are needed.
struct Missing<'a> {
    by: &'a Raster<f32>,
    least: &'a Raster<f32>,
}

/// Points one pixel apart through a seed, as long as the colour holds and a stroke is needed.
fn arc(drawer: &Drawer<'_>, ground: &Ground, missing: &Missing<'_>, seed: Point) -> Vec<Point> {
    let reach = 0.5 * LENGTH * drawer.pixels(drawer.parameters.length);
    let at = |p: Point| [0, 1, 2].map(|i: usize| ground.smoothed[i].get(p.x as usize, p.y as usize));
    let start = at(seed);
    let called = missing.by.get(seed.x as usize, seed.y as usize);
    let goes_on = |p: &Point| {
        distance(at(*p), start) < COLOUR_CHANGE * called
            && missing.by.get(p.x as usize, p.y as usize) > 0.5 * missing.least.get(p.x as usize, p.y as usize)
    };
    let mut line: Vec<Point> = ground.fine_flow.streamline(seed, -reach, 1.0)[1..].iter().copied().take_while(goes_on).collect();
    line.reverse();
    line.push(seed);
    line.extend(ground.fine_flow.streamline(seed, reach, 1.0)[1..].iter().copied().take_while(goes_on));
    line
}

fn mark_done(done: &mut Raster<bool>, p: Point, radius: f64) {
    let range = |at: f64, most: usize| (at - radius).max(0.0) as usize..((at + radius) as usize + 1).min(most);
    for y in range(p.y, done.height()) {
        for x in range(p.x, done.width()) {
            if Point::new(x as f64 + 0.5, y as f64 + 0.5).distance(p) <= radius {
                done.set(x, y, true);
            }
        }
    }
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f32>().sqrt()
}
