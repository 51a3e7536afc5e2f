//! Where to continue: the journal says what is certainly drawn, the machine where its pen stopped.
//!
//! `ok` means planned, not drawn. After a crash of the sender the machine still draws what it had taken. So the pen stands at the end
//! of some line between the last that is certainly drawn and the last that was sent, or, after a stop, in the middle of one. Of several
//! such places the first is taken: something may be drawn twice, nothing may be left out.

use super::journal::Record;
use super::program::{Place, Program};
use crate::geometry::Point;
use crate::plot::Act;
use std::ops::Range;

/// Where a pen was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Its position, in machine units.
    pub at: [f64; 3],
    /// Whether it was down, if that is known.
    pub is_down: Option<bool>,
}

/// What a place to continue was concluded from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// The pen stands on the drawing.
    Pen,
    /// Only what is certainly drawn.
    Journal,
}

/// Lines that may have been sent and taken after the last record: those of a line buffer and of a quarter of a second.
const UNRECORDED: usize = 400;
/// The pen stands at a line's end if it is within this distance, in machine units: two steps and the rounding of a report.
const AT_END: f64 = 0.04;
/// The pen stands on a stroke if it is within this distance: a chord of an arc and two steps.
const ON_STROKE: f64 = 0.06;

/// Where to continue; `None` if all is drawn. `overlap` is the length of line that is drawn again; without it the whole path is.
pub fn place_to_continue(
    program: &Program,
    record: &Record,
    found: Option<Found>,
    overlap: Option<f64>,
) -> Option<(Place, Evidence)> {
    if record.is_done {
        return None;
    }
    let line = |number: usize| program.lines.partition_point(|line| line.number < number);
    let window = line(record.drawn)..(line(record.sent) + UNRECORDED).min(program.lines.len());
    let seen = found.and_then(|found| under_the_pen(program, &window, found));
    let (place, evidence) =
        seen.map_or_else(|| (certain(program, window.start), Evidence::Journal), |place| (place, Evidence::Pen));
    if place.path >= program.paths.len() {
        return None;
    }
    let along = overlap.map_or(0.0, |overlap| {
        // The overlap ends at the last pass where the pen may be, and begins before the first.
        let pen =
            found.filter(|_| evidence == Evidence::Pen && place.along > 0.0).map(|found| Point::new(found.at[0], found.at[1]));
        let last = pen.and_then(|pen| program.last_near(place.path, pen, ON_STROKE, place.along + overlap));
        (last.unwrap_or(place.along).max(place.along) - overlap).max(0.0)
    });
    Some((Place { along, ..place }, evidence))
}

/// The first place where the machine may be if only what is proved is drawn.
fn certain(program: &Program, drawn: usize) -> Place {
    let path = program.path_of(drawn);
    let along = match program.paths.get(path) {
        Some(lines) if drawn > lines.draw => program.along(path, drawn - 1),
        _ => 0.0,
    };
    Place { path, along }
}

fn under_the_pen(program: &Program, window: &Range<usize>, found: Found) -> Option<Place> {
    let pen = Point::new(found.at[0], found.at[1]);
    // A machine that has just started says that it stands at zero, wherever it is.
    if found.is_down.is_none() && pen.distance(Point::ORIGIN) <= AT_END {
        return None;
    }
    let ends_here = |i: &usize| {
        let [x, y, _] = program.lines[*i].at;
        pen.distance(Point::new(x, y)) <= AT_END && found.is_down.is_none_or(|down| down == is_down_after(program, *i))
    };
    // The line before the window may be the last that was drawn.
    let mut lines = window.start.saturating_sub(1)..window.end;
    if let Some(line) = lines.find(ends_here) {
        let path = program.path_of(line);
        let Some(lines) = program.paths.get(path) else { return Some(Place { path, along: 0.0 }) };
        return Some(match line {
            line if line < lines.draw => Place { path, along: 0.0 },
            line if line < lines.lift => Place { path, along: program.along(path, line) },
            _ => Place { path: path + 1, along: 0.0 },
        });
    }
    // With the pen up, or nobody knows how, a stroke that passes here may be a later one.
    let first = program.path_of(window.start);
    match found.is_down {
        Some(true) => (first..program.paths.len().min(program.path_of(window.end) + 1))
            .find_map(|path| Some(Place { path, along: program.first_near(path, pen, window, ON_STROKE)?.0 })),
        Some(false) => on_the_way(program, window, pen),
        None => None,
    }
}

/// The path to which a pen that is up was on its way.
fn on_the_way(program: &Program, window: &Range<usize>, pen: Point) -> Option<Place> {
    let travels = |i: &usize| {
        let (Some(before), line) = (i.checked_sub(1), &program.lines[*i]) else { return false };
        let [from, to] = [before, *i].map(|i| Point::new(program.lines[i].at[0], program.lines[i].at[1]));
        let way = to - from;
        let fraction = if way.hypot2() > 0.0 { ((pen - from).dot(way) / way.hypot2()).clamp(0.0, 1.0) } else { 1.0 };
        line.act.moves() && !is_down_after(program, *i) && pen.distance(from + fraction * way) <= ON_STROKE
    };
    window.clone().find(travels).map(|line| Place { path: program.path_of(line), along: 0.0 })
}

/// True if the pen is down after a line.
fn is_down_after(program: &Program, line: usize) -> bool {
    let last = program.lines[..=line].iter().rev().find(|line| matches!(line.act, Act::Lift | Act::Lower));
    last.is_some_and(|line| line.act == Act::Lower)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interrupt::Interrupt;
    use crate::plot::Profile;
    use std::fmt::Write as _;

    /// Ten paths of three strokes, 5 mm apart.
    fn program() -> Program {
        let mut text = "(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nM3 S300\nG4 P.15\n(pen 1: lines 0.3)\n".to_owned();
        for y in (0..50).step_by(5) {
            let (x, z) = ("X10", y + 2);
            let _ = write!(text, "G0 X0 Y{y}\nM3 S700\nG4 P.2\nG1 {x} Y{y} F3000\nG1 {x} Y{z}\nG1 X20 Y{z}\nM3 S300\nG4 P.15\n");
        }
        Program::read(&Profile::built_in("grbl-servo").unwrap(), &text, &Interrupt::never()).unwrap()
    }

    fn record(program: &Program, drawn: usize) -> Record {
        Record { drawn: program.lines[drawn].number, sent: program.lines[drawn].number, path: 1, ..Record::default() }
    }

    fn found(x: f64, y: f64, is_down: bool) -> Found {
        Found { at: [x, y, 0.0], is_down: Some(is_down) }
    }

    #[test]
    fn the_pen_tells_more_than_the_journal() {
        let program = program();
        let begin = record(&program, program.paths[2].begin);
        let go_on = |found, overlap| place_to_continue(&program, &begin, Some(found), overlap);
        assert_eq!(
            place_to_continue(&program, &begin, None, Some(1.0)),
            Some((Place { path: 2, along: 0.0 }, Evidence::Journal))
        );
        assert_eq!(go_on(found(10.0, 17.0, true), Some(1.0)), Some((Place { path: 3, along: 11.0 }, Evidence::Pen)));
        let Some((Place { path: 3, along }, Evidence::Pen)) = go_on(found(14.0, 17.01, true), Some(1.0)) else {
            panic!("on path 4")
        };
        assert!((along - 15.0).abs() < 1e-9, "{along}");
        assert_eq!(go_on(found(14.0, 17.0, true), None), Some((Place { path: 3, along: 0.0 }, Evidence::Pen)));
        assert_eq!(go_on(found(20.0, 17.0, false), Some(1.0)), Some((Place { path: 4, along: 0.0 }, Evidence::Pen)));
        // A stroke that comes back on itself: the overlap covers both passes, and no more.
        let text =
            "(pen up is M3 S300)\n(pen down is M3 S700)\nM3 S300\nG0 X0 Y0\nM3 S700\nG1 X10 Y0 F3000\nG1 X0 Y0.02\nM3 S300\n";
        let back = Program::read(&Profile::built_in("grbl-servo").unwrap(), text, &Interrupt::never()).unwrap();
        let begin = Record { drawn: 1, sent: 7, path: 1, ..Record::default() };
        let again = |overlap| place_to_continue(&back, &begin, Some(found(9.8, 0.01, true)), Some(overlap)).unwrap().0.along;
        assert!((again(1.0) - 9.2).abs() < 0.01 && (again(0.1) - 9.7).abs() < 0.01, "{} {}", again(1.0), again(0.1));
        // On its way from the third path to the fourth.
        let half = go_on(found(10.0, 13.5, false), Some(1.0));
        assert_eq!(half, Some((Place { path: 3, along: 0.0 }, Evidence::Pen)));
        assert_eq!(go_on(found(150.0, 3.0, true), Some(1.0)).unwrap().1, Evidence::Journal);
        let started = Found { at: [0.0; 3], is_down: None };
        assert_eq!(go_on(started, Some(1.0)).unwrap().1, Evidence::Journal);
    }

    #[test]
    fn what_is_drawn_is_not_drawn_again() {
        let program = program();
        let all = record(&program, program.lines.len() - 1);
        let end = Record { is_done: true, ..all };
        assert_eq!(place_to_continue(&program, &end, None, None), None);
        assert_eq!(place_to_continue(&program, &all, Some(found(20.0, 47.0, false)), None), None);
    }
}
