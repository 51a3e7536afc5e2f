//! A machine's file made ready for sending: its lines with their times, grouped into pen-down paths.
//!
//! ```text
//!   G21, G90, pen up, wait     the head, sent before any part
//!   (pen 1: dots 0.3)          between paths: names, pauses, delays
//!   G0 X Y                     a path: its approach,
//!   M3 S700, G4                the lowering,
//!   G1 X Y F ..., G3 ...       the strokes,
//!   M3 S300, G4                and the lifting
//!   G0 X0 Y0                   the tail
//! ```

use super::error::DriveError;
use super::stand::Stand;
use crate::elementary::{Elementary as _, angle_of};
use crate::geometry::{Point, Vec2};
use crate::interrupt::Interrupt;
use crate::plot::{Act, Language, Profile, line_times, replayed, word};
use std::ops::Range;

/// A line of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramLine {
    /// What is sent: without comment and end of line; empty if there is nothing to send.
    pub text: String,
    /// Its number in the file, from 1; 0 for a line that the file does not hold.
    pub number: usize,
    /// What it does.
    pub act: Act,
    /// The position after it, in machine units.
    pub at: [f64; 3],
    /// When it is done, in seconds from the start.
    pub until: f64,
    /// The comment that names a pen, such as `pen 2: red 0.5`.
    pub name: Option<String>,
}

/// The lines of a pen-down path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathLines {
    /// The pen's number.
    pub pen: u32,
    /// Its number in the file, from 1.
    pub number: usize,
    /// Its first line, the approach.
    pub begin: usize,
    /// The line that lowers the pen.
    pub lower: usize,
    /// Its first stroke.
    pub draw: usize,
    /// The line that lifts the pen.
    pub lift: usize,
    /// The line after its last.
    pub end: usize,
}

/// A file in the order in which it is sent.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// Every line.
    pub lines: Vec<ProgramLine>,
    /// The paths in order.
    pub paths: Vec<PathLines>,
    /// The lines before the first name, pause or path.
    pub head: Range<usize>,
}

/// Where on a program a drawing begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The path, from 0.
    pub path: usize,
    /// Length along it, in machine units.
    pub along: f64,
}

impl Program {
    /// Reads a machine's file.
    ///
    /// ```
    /// use drypoint::{drive::Program, interrupt::Interrupt, plot::Profile};
    ///
    /// let machine = Profile::built_in("grbl-servo")?;
    /// let file = "G21\nG90\nM3 S300\nG4 P0.2\nG0 X10 Y10\nM3 S700\nG4 P0.2\nG1 X40 Y10 F3000\nM3 S300\nG4 P0.2\nG0 X0 Y0\n";
    /// let program = Program::read(&machine, file, &Interrupt::never())?;
    /// assert_eq!(program.paths.len(), 1);
    /// assert!(program.seconds() > 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn read(profile: &Profile, text: &str, interrupt: &Interrupt) -> Result<Self, DriveError> {
        let replayed = replayed(profile, text)
            .ok_or_else(|| DriveError::Unfit(format!("{} is driven by a program of its own", profile.name)))?;
        let is_gcode = profile.language() == Language::Gcode;
        let lines = replayed.into_iter().enumerate().map(|(i, line)| {
            let code = if is_gcode { line.text.split(['(', ';', '%']).next().unwrap_or("").trim() } else { &*line.text };
            let name = match line.act {
                Act::Pen(_) if is_gcode => {
                    Some(line.text.trim_matches(|c: char| "();".contains(c) || c.is_whitespace()).to_owned())
                }
                Act::Pen(number) if number > 0 => Some(format!("pen {number}: slot {number}")),
                _ => None,
            };
            ProgramLine { text: code.to_owned(), number: i + 1, act: line.act, at: line.at, until: 0.0, name }
        });
        let program = Self::of(profile, lines.collect(), interrupt)?;
        if program.paths.is_empty() {
            return Err(DriveError::Unfit(
                "the file draws nothing: its pen commands are not those of this machine, or it holds no path".to_owned(),
            ));
        }
        Ok(program)
    }

    /// Times lines and groups them.
    pub(super) fn of(profile: &Profile, mut lines: Vec<ProgramLine>, interrupt: &Interrupt) -> Result<Self, DriveError> {
        let until = line_times(profile, lines.iter().map(|line| (&*line.text, line.act, line.at)), interrupt)?;
        lines.iter_mut().zip(until).for_each(|(line, until)| line.until = until);
        let paths = paths(&lines);
        let head = 0..head_end(&lines, &paths);
        Ok(Self { lines, paths, head })
    }

    /// Groups lines whose times are known; `path_of` is the number in the file of the path that begins at a line's number.
    pub(super) fn of_timed(lines: Vec<ProgramLine>, path_of: impl Fn(usize) -> usize) -> Result<Self, DriveError> {
        let mut paths = paths(&lines);
        for path in &mut paths {
            path.number = path_of(lines[path.lower].number);
        }
        if paths.is_empty() {
            return Err(DriveError::Unfit("there is nothing to draw".to_owned()));
        }
        let head = 0..head_end(&lines, &paths);
        Ok(Self { lines, paths, head })
    }

    /// Seconds that all of it takes.
    pub fn seconds(&self) -> f64 {
        self.lines.last().map_or(0.0, |line| line.until)
    }

    /// Seconds that the longest line takes.
    pub(super) fn longest_line(&self) -> f64 {
        self.lines.windows(2).map(|pair| pair[1].until - pair[0].until).fold(0.0, f64::max)
    }

    /// The same paths with lines of which some are not in the file.
    pub(super) fn with_lines(
        &self,
        profile: &Profile,
        lines: Vec<ProgramLine>,
        interrupt: &Interrupt,
    ) -> Result<Self, DriveError> {
        let mut program = Self::of(profile, lines, interrupt)?;
        for (path, own) in program.paths.iter_mut().zip(&self.paths) {
            path.number = own.number;
        }
        Ok(program)
    }

    /// Length of a path in machine units.
    pub fn length(&self, path: usize) -> f64 {
        self.pieces(path).map(|(_, length)| length).sum()
    }

    /// The strokes of a path with their lengths.
    pub(super) fn pieces(&self, path: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let path = &self.paths[path];
        (path.draw..path.lift).filter(|i| self.lines[*i].act.moves()).map(|i| {
            let length = match self.lines[i].act {
                Act::Arc { centre, sweep, .. } => sweep.abs() * self.before(i).distance(centre),
                _ => self.before(i).distance(self.after(i)),
            };
            (i, length)
        })
    }

    pub(super) fn before(&self, line: usize) -> Point {
        if line == 0 { Point::ORIGIN } else { self.after(line - 1) }
    }

    pub(super) fn after(&self, line: usize) -> Point {
        let [x, y, _] = self.lines[line].at;
        Point::new(x, y)
    }

    /// The path that a line belongs to, or the first one after it.
    pub fn path_of(&self, line: usize) -> usize {
        self.paths.partition_point(|path| path.end <= line)
    }

    /// The length along its path at which a stroke ends.
    pub fn along(&self, path: usize, line: usize) -> f64 {
        self.pieces(path).take_while(|(i, _)| *i <= line).map(|(_, length)| length).sum()
    }

    /// The first point of a path within `most` of a place, as the length along it, and its distance. Only strokes of the lines given
    /// count. Where a path crosses itself, the first pass counts.
    pub fn first_near(&self, path: usize, place: Point, lines: &Range<usize>, most: f64) -> Option<(f64, f64)> {
        let mut along = 0.0;
        for (i, length) in self.pieces(path) {
            let (fraction, distance) = self.nearest_on(i, place);
            if lines.contains(&i) && distance <= most {
                return Some((along + fraction * length, distance));
            }
            along += length;
        }
        None
    }

    /// The last such point up to a length along the path. Where a path passes itself closely, a machine's place does not tell which pass
    /// it is on.
    pub(super) fn last_near(&self, path: usize, place: Point, most: f64, until: f64) -> Option<f64> {
        let (mut along, mut last) = (0.0, None);
        for (i, length) in self.pieces(path) {
            let (fraction, distance) = self.nearest_on(i, place);
            let here = along + fraction * length;
            last = Some(here).filter(|_| distance <= most && here <= until).or(last);
            along += length;
        }
        last
    }

    /// The fraction of a stroke nearest to a place, and its distance.
    pub(super) fn nearest_on(&self, line: usize, place: Point) -> (f64, f64) {
        let (from, to) = (self.before(line), self.after(line));
        if let Act::Arc { centre, sweep, .. } = self.lines[line].act {
            let (a, b) = (from - centre, place - centre);
            let turn = a.cross(b).angle_over(a.dot(b));
            let turn = if turn * sweep < 0.0 { turn + std::f64::consts::TAU.copysign(sweep) } else { turn };
            if turn.abs() <= sweep.abs() {
                return (turn / sweep, (b.hypot() - a.hypot()).abs());
            }
            let ends = [(0.0, place.distance(from)), (1.0, place.distance(to))];
            return if ends[0].1 <= ends[1].1 { ends[0] } else { ends[1] };
        }
        let way = to - from;
        let fraction = if way.hypot2() > 0.0 { ((place - from).dot(way) / way.hypot2()).clamp(0.0, 1.0) } else { 1.0 };
        (fraction, place.distance(from + fraction * way))
    }

    /// Places of a path whose box is the path's: the ends of its strokes, and where an arc reaches farthest along an axis.
    pub fn places<'a>(&'a self, path: &PathLines) -> impl Iterator<Item = Point> + 'a {
        (path.lower..path.lift).flat_map(|i| self.farthest(i).into_iter().flatten().chain([self.after(i)]))
    }

    /// Where an arc reaches farthest along each direction of the axes, if it does so between its ends.
    fn farthest(&self, line: usize) -> [Option<Point>; 4] {
        let Act::Arc { centre, sweep, .. } = self.lines[line].act else { return [None; 4] };
        let arm = self.before(line) - centre;
        [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, -1.0)].map(|axis| {
            let turn = (angle_of(axis) - angle_of(arm)) * sweep.signum();
            (turn.rem_euclid(std::f64::consts::TAU) < sweep.abs()).then(|| centre + arm.hypot() * axis)
        })
    }

    /// The box of what the pen draws, in machine units: least x and y, greatest x and y.
    pub fn bounds(&self) -> [f64; 4] {
        let places = self.paths.iter().flat_map(|path| self.places(path));
        places.fold([f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY], |b, p| {
            [b[0].min(p.x), b[1].min(p.y), b[2].max(p.x), b[3].max(p.y)]
        })
    }

    /// Whether the pen is down where a machine stands, if that can be told.
    pub fn is_down(&self, stand: &Stand) -> Option<bool> {
        let line = |act: Act| self.lines.iter().find(|line| line.act == act);
        let (up, down) = (line(Act::Lift)?, line(Act::Lower)?);
        let nearer = |value: f64, up: f64, down: f64| (value - down).abs() < (value - up).abs();
        match (word(&up.text, 'S'), word(&down.text, 'S'), stand.servo) {
            // A value of neither, such as that after a start, tells nothing.
            (Some(up), Some(down), Some(servo)) => {
                let is_known = (servo - up).abs().min((servo - down).abs()) < 0.25 * (up - down).abs();
                is_known.then(|| nearer(servo, up, down))
            }
            _ if up.text.starts_with("PU") || up.text.starts_with("SP,") => stand.servo.map(|pen| pen > 0.5),
            _ if up.text.contains('Z') => Some(nearer(stand.at[2], up.at[2], down.at[2])),
            _ => None,
        }
    }

    /// The pens used, with their names, in order.
    pub fn pens(&self) -> Vec<(u32, String)> {
        let mut pens: Vec<(u32, String)> = Vec::new();
        for line in &self.lines {
            if let (Act::Pen(number), Some(name)) = (line.act, &line.name)
                && pens.last().is_none_or(|last| last.0 != number)
            {
                pens.push((number, name.split_once(": ").map_or(name.as_str(), |(_, rest)| rest).to_owned()));
            }
        }
        pens
    }
}

/// The end of the lines before the first name, pause, move or path.
fn head_end(lines: &[ProgramLine], paths: &[PathLines]) -> usize {
    let first = paths.first().map_or(lines.len(), |path| path.begin);
    let is_body = |line: &ProgramLine| matches!(line.act, Act::Pen(_) | Act::Pause) || line.act.moves();
    lines[..first].iter().position(is_body).unwrap_or(first)
}

/// Groups lines into paths: from the last move with the pen up to the wait after lifting.
fn paths(lines: &[ProgramLine]) -> Vec<PathLines> {
    let mut paths = Vec::new();
    let (mut pen, mut approach, mut lower) = (1, None, None);
    let mut i = 0;
    while i < lines.len() {
        match (lines[i].act, lower) {
            (Act::Pen(number), _) => (pen, approach) = (number, None),
            (Act::Pause, None) => approach = None,
            (Act::Rapid | Act::Line(_), None) => approach = Some(i),
            (Act::Lower, None) => lower = Some(i),
            (Act::Lift, Some(low)) => {
                let waits = |from: usize| lines[from..].iter().take_while(|line| matches!(line.act, Act::Wait(_))).count();
                let (draw, end) = (low + 1 + waits(low + 1), i + 1 + waits(i + 1));
                let begin = approach.unwrap_or(low);
                // A dip is no path: none of its lines is in the file.
                if lines[low..=i].iter().all(|line| line.number == 0) {
                    if let Some(last) = paths.last_mut() {
                        let last: &mut PathLines = last;
                        last.end = end;
                    }
                    (approach, lower) = (None, None);
                    i = end;
                    continue;
                }
                paths.push(PathLines { pen, number: paths.len() + 1, begin, lower: low, draw: draw.min(i), lift: i, end });
                (approach, lower) = (None, None);
                i = end - 1;
            }
            _ => {}
        }
        i += 1;
    }
    paths
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    const FILE: &str = "(drypoint)\n(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nM3 S300\nG4 P.15\n(pen 1: dots 0.3)\nG0 X1 Y1\nM3 S700\nG4 P.2\n\
                        G1 X5 Y1 F3000\nG3 X5 Y9 I0 J4\nG1 X10 Y9\nM3 S300\nG4 P.15\nG0 X0 Y0\n(pen 2: red 0.5)\nM0\nG0 X2 Y2\nM3 S700\nG4 P.2\nM3 S300\nG4 P.15\nG0 X0 Y0\n";

    /// Two paths of two pens, the first with an arc.
    pub fn program() -> (Profile, Program) {
        let profile = Profile::built_in("grbl-servo").unwrap();
        let program = Program::read(&profile, FILE, &Interrupt::never()).unwrap();
        (profile, program)
    }

    #[test]
    fn lines_are_grouped_into_paths() {
        let (_, program) = program();
        let first = PathLines { pen: 1, number: 1, begin: 7, lower: 8, draw: 10, lift: 13, end: 15 };
        let second = PathLines { pen: 2, number: 2, begin: 18, lower: 19, draw: 21, lift: 21, end: 23 };
        assert_eq!(program.paths, [first, second]);
        assert_eq!(program.head, 0..6);
        assert_eq!(program.pens(), [(1, "dots 0.3".to_owned()), (2, "red 0.5".to_owned())]);
        assert!((program.length(0) - (4.0 + 4.0 * std::f64::consts::PI + 5.0)).abs() < 1e-9);
        assert_eq!((program.path_of(8), program.path_of(15), program.path_of(22), program.path_of(23)), (0, 1, 1, 2));
    }

    #[test]
    fn arcs_reach_beyond_their_ends() {
        let (_, program) = program();
        let [x0, y0, x1, y1] = program.bounds();
        assert!((x0 - 1.0).abs() < 1e-9 && (y0 - 1.0).abs() < 1e-9 && (x1 - 10.0).abs() < 1e-9 && (y1 - 9.0).abs() < 1e-9);
        let text = "(pen up is M3 S300)\n(pen down is M3 S700)\nM3 S300\nG0 X3 Y5\nM3 S700\nG2 X5 Y3 I2 J0 F600\nM3 S300\n";
        let program = Program::read(&Profile::built_in("grbl-servo").unwrap(), text, &Interrupt::never()).unwrap();
        // Three quarters of a circle of radius 2 around 5, 5 from its left end over the top to its lowest point.
        let bounds = program.bounds();
        for (found, expected) in bounds.into_iter().zip([3.0, 3.0, 7.0, 7.0]) {
            assert!((found - expected).abs() < 1e-9, "{bounds:?}");
        }
    }

    #[test]
    fn travels_before_the_first_path_are_no_head() {
        let text = FILE.replace("(pen 1: dots 0.3)\n", "G0 X0 Y0\nG0 X90 Y0\nG0 X90 Y90\n(pen 1: dots 0.3)\n");
        let program = Program::read(&Profile::built_in("grbl-servo").unwrap(), &text, &Interrupt::never()).unwrap();
        assert_eq!(program.head, 0..6);
    }

    #[test]
    fn the_place_under_the_pen_is_found() {
        let (_, program) = program();
        let all = 0..program.lines.len();
        let (along, distance) = program.first_near(0, Point::new(3.0, 1.05), &all, 0.1).unwrap();
        assert!((along - 2.0).abs() < 1e-9 && (distance - 0.05).abs() < 1e-9);
        let (along, distance) = program.first_near(0, Point::new(9.0, 5.0), &all, 0.1).unwrap();
        assert!((along - 4.0 - 2.0 * std::f64::consts::PI).abs() < 1e-6 && distance < 1e-6, "{along} {distance}");
    }
}
