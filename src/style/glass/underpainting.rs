//! Flat strokes under all others, so that no paper shows through the slivers between them.

use super::{Drawer, Ground, colour};
use crate::drawing::{Mark, Stroke};
use crate::geometry::{Ends, Point, Ring, catmull_rom};
use crate::parallel::mapped;

/// Width of a stroke in grains.
const WIDTH: f64 = 4.0;
/// Change of colour (root of the channels' summed squares, of values 0 to 1) at which a new stroke begins.
const COLOUR_CHANGE: f32 = 0.1;
/// Overlap of neighbouring strokes in pixels: where they only touch, renderers let the paper show through.
const OVERLAP: f64 = 0.5;

/// Strokes in rows, wherever a row is fully inside the subject.
pub(super) fn marks(drawer: &Drawer<'_>, ground: &Ground) -> Vec<Mark> {
    let rows = (WIDTH * drawer.pixels(drawer.parameters.grain)).round().max(2.0) as usize;
    let last = ground.subject.height() - ground.margin;
    let tops: Vec<usize> = (ground.margin..last).step_by(rows).collect();
    let of_rows = |top: &usize| {
        let bottom = (*top + rows).min(last);
        runs(ground, *top, bottom).iter().map(|run| mark(drawer, ground, run, *top, bottom)).collect()
    };
    let marks: Vec<Vec<Mark>> = mapped(&tops, &of_rows);
    marks.into_iter().flatten().collect()
}

/// Columns of one row with similar colour.
struct Run {
    first: usize,
    last: usize,
    sum: [f32; 3],
}

impl Run {
    fn colour(&self) -> [f32; 3] {
        self.sum.map(|v| v / (self.last - self.first) as f32)
    }
}

fn runs(ground: &Ground, top: usize, bottom: usize) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for x in ground.margin..ground.subject.width() - ground.margin {
        if (top - 1..=bottom).any(|y| ground.subject.get(x, y) < 0.5) {
            continue;
        }
        let count = (bottom - top) as f32;
        let here = [0, 1, 2].map(|i| (top..bottom).map(|y| ground.smoothed[i].get(x, y)).sum::<f32>() / count);
        let differs = |run: &Run| {
            let squares: f32 = run.colour().iter().zip(here).map(|(a, b)| (a - b) * (a - b)).sum();
            squares > COLOUR_CHANGE * COLOUR_CHANGE
        };
        match runs.last_mut() {
            Some(run) if run.last == x && !differs(run) => {
                run.last = x + 1;
                run.sum.iter_mut().zip(here).for_each(|(sum, v)| *sum += v);
            }
            _ => runs.push(Run { first: x, last: x + 1, sum: here }),
        }
    }
    runs
}

fn mark(drawer: &Drawer<'_>, ground: &Ground, run: &Run, top: usize, bottom: usize) -> Mark {
    let middle = 0.5 * (top + bottom) as f64;
    let ends = [run.first as f64 - OVERLAP, run.last as f64 + OVERLAP].map(|x| drawer.to_page(ground, Point::new(x, middle)));
    let width = ((bottom - top) as f64 + 2.0 * OVERLAP) * drawer.portrait.placement.mm_per_pixel();
    let stroke = Stroke::even(catmull_rom(&ends, Ring::Open), width).with_ends(Ends::Flat);
    Mark::Stroke(stroke.with_colour(Some(colour::shifted(run.colour(), 0.0))).in_group(Some(0)))
}
