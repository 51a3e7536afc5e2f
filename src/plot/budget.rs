//! Limits on the work of a plot, estimated before it begins.

use super::lower::{InkModel, Nibs, turns_sharply};
use super::occlude::Hides;
use crate::drawing::{Colour, Drawing, Mark};
use crate::geometry::{BezPath, Point, WideSegment, estimated_crossings, estimated_crossings_among, flatten, simplify};
use crate::interrupt::{Interrupt, Interrupted};
use thiserror::Error;

/// Why a drawing is too much work to plot.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TooMuch {
    /// Too many crossings of borders, or overlaps of wide lines.
    #[error("its outlines cross or overlap about {crossings:.0} times; at most {most:.0} can be processed")]
    Crossings {
        /// Estimated number of crossings, within a tenth.
        crossings: f64,
        /// The limit.
        most: f64,
    },
    /// More line than a plotter draws in two days.
    #[error("its ink needs about {metres:.0} m of line; at most {most:.0} m can be plotted with these nibs")]
    Length {
        /// Length of line in metres.
        metres: f64,
        /// The limit in metres with the same nibs.
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

/// Maximum crossings of one mark's borders that are filled: two million take about a gigabyte and some seconds.
const MOST_IN_A_MARK: f64 = 2e6;
/// Maximum pairs of a mark's borders closer than the nib's width, or than a wide line's: each pair gives about six crossings of
/// the nib's paths along them, at their rounded corners.
const MOST_NEAR_IN_A_MARK: f64 = 4e5;
/// Maximum crossings of all marks together, where they cut one another.
const MOST_IN_ALL: f64 = 1e7;

/// Checks that a drawing can be occluded and lowered within two gigabytes and about twenty seconds.
pub fn check_work(
    drawing: &Drawing,
    model: InkModel,
    nibs: &Nibs,
    hides: Option<Hides>,
    interrupt: &Interrupt,
) -> Result<(), TooMuch> {
    check_length(drawing, model, nibs)?;
    let mut cut = Cut::default();
    for layer in &drawing.layers {
        let nib = nibs.of(layer.pen);
        for mark in &layer.marks {
            interrupt.check()?;
            if model == InkModel::Ink && is_outlined(mark, nib) {
                refuse_tangled(&threads(mark, 0.0), MOST_IN_A_MARK)?;
                refuse_tangled(&threads(mark, nib), MOST_NEAR_IN_A_MARK)?;
            }
            if hides.is_some() {
                cut.add(mark, mark.colour().unwrap_or(layer.ink.colour()));
            }
        }
    }
    hides.map_or(Ok(()), |hides| refuse_above(MOST_IN_ALL, cut.crossings(hides)))
}

/// Marks that are cut by one another.
#[derive(Default)]
struct Cut {
    threads: Vec<WideSegment>,
    /// For each line, the index of its mark.
    owner: Vec<u32>,
    /// For each mark, its colour and whether it is a stroke.
    marks: Vec<(Colour, bool)>,
}

impl Cut {
    fn add(&mut self, mark: &Mark, colour: Colour) {
        let threads = threads(mark, 0.0);
        self.owner.extend(threads.iter().map(|_| self.marks.len() as u32));
        self.threads.extend(threads);
        self.marks.push((colour, matches!(mark, Mark::Stroke(_))));
    }

    /// Estimated number of pairs of lines that cut one another.
    fn crossings(&self, hides: Hides) -> f64 {
        estimated_crossings_among(&self.threads, |i, j| {
            let (a, b) = (self.owner[i] as usize, self.owner[j] as usize);
            let ((colour, is_line), (other, is_other_line)) = (self.marks[a], self.marks[b]);
            a != b
                && match hides {
                    Hides::AllLines => !is_line || !is_other_line,
                    Hides::OtherColours | Hides::PaintOnOtherColours => colour != other,
                }
        })
    }
}

/// True if the mark is filled from its outline.
fn is_outlined(mark: &Mark, nib: f64) -> bool {
    match mark {
        Mark::Stroke(stroke) => turns_sharply(stroke, nib),
        Mark::Dot(_) | Mark::Area(_) => true,
    }
}

/// Refuses lines that cross more than `most` times. Too few lines to reach the limit are not examined.
fn refuse_tangled(threads: &[WideSegment], most: f64) -> Result<(), TooMuch> {
    let pairs = 0.5 * (threads.len() as f64).powi(2);
    if pairs > most { refuse_above(most, estimated_crossings(threads)) } else { Ok(()) }
}

fn refuse_above(most: f64, crossings: f64) -> Result<(), TooMuch> {
    if crossings > most { Err(TooMuch::Crossings { crossings, most }) } else { Ok(()) }
}

/// Maximum length of all lines, in nib widths: 6 km with a nib of 0.3 mm, two days of plotting and a gigabyte.
const MOST_NIBS: f64 = 2e7;

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

/// Estimated length of the lines that draw a mark, in millimetres.
fn length_of(mark: &Mark, model: InkModel, nib: f64) -> f64 {
    match (mark, model) {
        (Mark::Stroke(stroke), InkModel::Lines) => stroke.length(),
        (Mark::Stroke(stroke), InkModel::Ink) => stroke.length() * (stroke.widest() / nib).max(1.0),
        (_, InkModel::Lines) => 0.0,
        (_, InkModel::Ink) => mark.area() / nib,
    }
}

/// Tolerance of a wide line's centre line, as a share of its width, when its overlaps with itself are counted. Without it,
/// consecutive segments within the line's width would count as overlaps.
const OFF: f64 = 0.1;

/// A mark's borders with the nib's width, or its wide line.
fn threads(mark: &Mark, nib: f64) -> Vec<WideSegment> {
    let (curve, half_width) = match mark {
        Mark::Dot(_) => return Vec::new(),
        Mark::Area(area) => (&area.outline, 0.5 * nib),
        Mark::Stroke(stroke) => (stroke.curve(), 0.5 * stroke.widest()),
    };
    let coarse = |line: Vec<Point>| simplify(&line, OFF * 2.0 * half_width);
    lines(curve).into_iter().map(coarse).flat_map(|line| threads_along(&line, half_width)).collect()
}

/// Flattening tolerance in millimetres: crossings are only counted, not located.
const FLATTENING_TOLERANCE: f64 = 0.05;

fn lines(curve: &BezPath) -> Vec<Vec<Point>> {
    let closed = |(mut points, is_closed): (Vec<Point>, bool)| {
        points.extend(is_closed.then(|| points[0]));
        points.retain(|p| p.is_finite());
        points
    };
    flatten(curve, FLATTENING_TOLERANCE).into_iter().map(closed).collect()
}

fn threads_along(line: &[Point], half_width: f64) -> Vec<WideSegment> {
    line.windows(2).map(|pair| WideSegment { from: pair[0], to: pair[1], half_width }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Area, Layer, Page, Stroke};
    use crate::elementary::Elementary as _;

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
        let fine = path((0..200_000).map(|i| {
            let angle = f64::from(i) * std::f64::consts::TAU / 200_000.0;
            Point::new(100.0 + 90.0 * angle.cosine(), 100.0 + 90.0 * angle.sine())
        }));
        assert_eq!(check(vec![Mark::Area(Area { outline: fine.clone(), colour: None })], None), Ok(()));
        // A wide line of short legs follows itself, but does not cover itself.
        let wide = Stroke::even(fine, 5.0);
        assert_eq!(check(vec![Mark::Stroke(wide)], Some(Hides::OtherColours)), Ok(()));
    }

    #[test]
    fn a_hundred_kilometres_are_refused() {
        let zigzag = path((0..500_000).map(|i| Point::new(0.0004 * f64::from(i), f64::from(i % 2) * 180.0)));
        let refused = check(vec![Mark::Stroke(Stroke::even(zigzag, 0.3))], None).unwrap_err();
        assert!(matches!(refused, TooMuch::Length { metres, most } if metres > 80_000.0 && most < 7000.0), "{refused}");
    }
}
