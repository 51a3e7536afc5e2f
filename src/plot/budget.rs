//! What a plot may cost, reckoned before the work is begun.

use super::lower::{InkModel, Nibs};
use super::occlude::Hides;
use crate::drawing::{Drawing, Mark, Stroke};
use crate::geometry::{BezPath, Point, Thread, flatten, simplify, tangles};
use crate::interrupt::{Interrupt, Interrupted};
use thiserror::Error;

/// Crossings of one mark's borders up to which it is filled: two million take about a gigabyte and some seconds.
const MOST_IN_A_MARK: f64 = 2e6;
/// The same of all marks together, where they are cut by one another.
const MOST_IN_ALL: f64 = 1e7;
/// Length of all lines, in widths of their nibs: 6 km with a nib of 0.3 mm, two days of a plotter's work and a gigabyte.
const MOST_NIBS: f64 = 2e7;
/// Vertices of curves lie this near to them, in millimetres: crossings are counted, not placed.
const COARSE: f64 = 0.05;
/// The share of its width by which a wide line's middle may be off where its coverings of itself are counted. Lines that follow one
/// another within its width would count as such else.
const OFF: f64 = 0.1;

/// Why a drawing is not plotted as it is.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TooMuch {
    /// Borders that cross, or wide lines that cover one another, more often than can be worked on.
    #[error(
        "its outlines cross or cover one another about {crossings:.0} times, and at most {most:.0} times can be worked on: draw the \
         lines alone (--ink-model lines), leave out --occlude, or draw it in parts"
    )]
    Crossings {
        /// How often, within a tenth.
        crossings: f64,
        /// The limit.
        most: f64,
    },
    /// More line than a plotter draws in days.
    #[error(
        "its ink is about {metres:.0} m of line, and at most {most:.0} m can be worked on: take a wider pen (--pen), make it smaller \
         (--scale), or draw it in parts (--layers)"
    )]
    Length {
        /// Metres.
        metres: f64,
        /// The limit with the same nibs.
        most: f64,
    },
    /// The work was stopped.
    #[error("interrupted")]
    Interrupted,
}

impl From<Interrupted> for TooMuch {
    fn from(_: Interrupted) -> Self {
        Self::Interrupted
    }
}

/// Whether a drawing can be lowered, and before that occluded, within two gigabytes and some twenty seconds.
pub fn check_work(
    drawing: &Drawing,
    model: InkModel,
    nibs: &Nibs,
    hides: Option<Hides>,
    interrupt: &Interrupt,
) -> Result<(), TooMuch> {
    check_length(drawing, model, nibs)?;
    let mut all = Vec::new();
    for layer in &drawing.layers {
        let nib = nibs.of(layer.pen);
        for mark in &layer.marks {
            interrupt.check()?;
            let threads = threads(mark);
            let is_outlined = match mark {
                Mark::Stroke(stroke) => stroke.widest() > nib,
                Mark::Dot(_) | Mark::Area(_) => true,
            };
            if model == InkModel::Ink && is_outlined {
                refuse_above(MOST_IN_A_MARK, &threads)?;
            }
            if hides.is_some() {
                all.extend(threads);
            }
        }
    }
    refuse_above(MOST_IN_ALL, &all)
}

fn refuse_above(most: f64, threads: &[Thread]) -> Result<(), TooMuch> {
    let crossings = tangles(threads);
    if crossings > most { Err(TooMuch::Crossings { crossings, most }) } else { Ok(()) }
}

fn check_length(drawing: &Drawing, model: InkModel, nibs: &Nibs) -> Result<(), TooMuch> {
    let (mut metres, mut in_nibs) = (0.0, 0.0);
    for layer in &drawing.layers {
        let nib = nibs.of(layer.pen);
        let length: f64 = layer.marks.iter().map(|mark| length_of(mark, model, nib)).filter(|length| length.is_finite()).sum();
        metres += length / 1000.0;
        in_nibs += length / nib;
    }
    if in_nibs > MOST_NIBS {
        return Err(TooMuch::Length { metres, most: metres * MOST_NIBS / in_nibs });
    }
    Ok(())
}

/// About how long the lines are that draw a mark, in millimetres.
fn length_of(mark: &Mark, model: InkModel, nib: f64) -> f64 {
    match (mark, model) {
        (Mark::Stroke(stroke), InkModel::Lines) => stroke.length(),
        (Mark::Stroke(stroke), InkModel::Ink) => stroke.length() * (stroke.widest() / nib).max(1.0),
        (_, InkModel::Lines) => 0.0,
        (_, InkModel::Ink) => mark.area() / nib,
    }
}

/// A mark's borders, or its wide line.
fn threads(mark: &Mark) -> Vec<Thread> {
    match mark {
        Mark::Dot(_) => Vec::new(),
        Mark::Area(area) => lines(&area.outline).into_iter().flat_map(|line| threads_along(&line, 0.0)).collect(),
        Mark::Stroke(stroke) => lines(&stroke.curve).into_iter().flat_map(|line| threads_of_line(&line, stroke)).collect(),
    }
}

fn lines(curve: &BezPath) -> Vec<Vec<Point>> {
    let closed = |(mut points, is_closed): (Vec<Point>, bool)| {
        points.extend(is_closed.then(|| points[0]));
        points.retain(|p| p.is_finite());
        points
    };
    flatten(curve, COARSE).into_iter().map(closed).collect()
}

fn threads_of_line(line: &[Point], stroke: &Stroke) -> Vec<Thread> {
    let half_width = 0.5 * stroke.widest();
    threads_along(&simplify(line, OFF * 2.0 * half_width), half_width)
}

fn threads_along(line: &[Point], half_width: f64) -> Vec<Thread> {
    line.windows(2).map(|pair| Thread { from: pair[0], to: pair[1], half_width }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Area, Layer, Page, Width};

    fn check(marks: Vec<Mark>, hides: Option<Hides>) -> Result<(), TooMuch> {
        let drawing = Drawing { page: Page::new(200.0, 200.0), layers: vec![Layer { marks, ..Layer::new("x", 1) }] };
        check_work(&drawing, InkModel::Ink, &Nibs::all(0.3), hides, &Interrupt::never())
    }

    fn path(points: impl Iterator<Item = Point>) -> BezPath {
        let mut path = BezPath::new();
        points.enumerate().for_each(|(i, p)| if i == 0 { path.move_to(p) } else { path.line_to(p) });
        path
    }

    #[test]
    fn a_polygon_that_crosses_itself_everywhere_is_refused_and_a_fine_one_is_not() {
        let place = |i: u32, step: f64| 200.0 * (f64::from(i * i % 9_973) * step).fract();
        let wild = path((0..20_000).map(|i| Point::new(place(i, 0.754_877), place(i, 0.569_840))));
        let refused = check(vec![Mark::Area(Area { outline: wild, colour: None })], None).unwrap_err();
        assert!(matches!(refused, TooMuch::Crossings { crossings, .. } if crossings > 1e7), "{refused}");
        assert!(refused.to_string().contains("--ink-model lines"));
        let fine = path((0..200_000).map(|i| {
            let angle = f64::from(i) * std::f64::consts::TAU / 200_000.0;
            Point::new(100.0 + 90.0 * angle.cos(), 100.0 + 90.0 * angle.sin())
        }));
        assert_eq!(check(vec![Mark::Area(Area { outline: fine.clone(), colour: None })], None), Ok(()));
        // A wide line of short legs follows itself, but does not cover itself.
        let wide = Stroke::new(fine, Width::Constant(5.0));
        assert_eq!(check(vec![Mark::Stroke(wide)], Some(Hides::OtherColours)), Ok(()));
    }

    #[test]
    fn a_hundred_kilometres_are_refused() {
        let zigzag = path((0..500_000).map(|i| Point::new(0.0004 * f64::from(i), f64::from(i % 2) * 180.0)));
        let refused = check(vec![Mark::Stroke(Stroke::new(zigzag, Width::Constant(0.3)))], None).unwrap_err();
        assert!(matches!(refused, TooMuch::Length { metres, most } if metres > 80_000.0 && most < 7000.0), "{refused}");
    }
}
