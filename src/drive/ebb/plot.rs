//! A plot as the board's commands: each path planned as a whole, from rest to rest.

use super::plan::{Limits, Piece, plan};
use super::rates::{TICKS, move_command, ticks_of};
use super::servo::Servo;
use super::steps_of;
use crate::drive::error::DriveError;
use crate::drive::program::{Program, ProgramLine};
use crate::geometry::{Point, polyline_length};
use crate::interrupt::Interrupt;
use crate::plot::{Act, Mounting, Plot, Profile};

/// What of a plot is drawn, and from where.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// Its paths, by their numbers from 1, ascending; `None` for all.
    pub paths: Option<Vec<usize>>,
    /// Length of the first of them that is left out, in millimetres.
    pub along: f64,
    /// Where the pen stands, in machine units.
    pub from: [f64; 2],
}

impl Default for Rest {
    fn default() -> Self {
        Self { paths: None, along: 0.0, from: [0.0; 2] }
    }
}

struct Writer<'a> {
    profile: &'a Profile,
    lines: Vec<ProgramLine>,
    /// Motor steps from zero.
    steps: [i64; 2],
    at: Point,
    until: f64,
    /// The number of the path, and of the next line in it.
    number: usize,
}

impl Program {
    /// The commands of a plot for an `AxiDraw`. Lines are numbered by path: a thousandth of the number is the path.
    pub fn of_plot(
        profile: &Profile,
        plot: &Plot,
        mounting: &Mounting,
        rest: &Rest,
        interrupt: &Interrupt,
    ) -> Result<Self, DriveError> {
        let from = Point::new(rest.from[0], rest.from[1]);
        let mut writer = Writer { profile, lines: Vec::new(), steps: steps_of(from), at: from, until: 0.0, number: 1 };
        writer.pen(Act::Lift);
        let mut count = 0;
        let (mut is_first, mut last_pen) = (true, None);
        for pen in &plot.pens {
            let is_wanted = |number: usize| rest.paths.as_ref().is_none_or(|paths| paths.binary_search(&number).is_ok());
            let begins = count;
            count += pen.paths.len();
            let Some(first) = (begins + 1..=count).find(|number| is_wanted(*number)) else { continue };
            writer.number = LINES_PER_PATH * first;
            writer.change_pen(pen.number, &format!("pen {}: {} {}", pen.number, pen.name, pen.nib), last_pen);
            last_pen = Some(pen.number);
            for (i, path) in pen.paths.iter().enumerate() {
                interrupt.check()?;
                let number = begins + i + 1;
                if !is_wanted(number) {
                    continue;
                }
                let points: Vec<Point> = path.points().iter().map(|p| mounting.place(pen.number, *p)).collect();
                let along = if std::mem::take(&mut is_first) { rest.along } else { 0.0 };
                writer.path(number, &points, along, pen.handling.speed(profile.motion.draw_speed));
            }
        }
        writer.number = LINES_PER_PATH * (count + 1);
        let park = mounting.park;
        writer.travel(park);
        Program::of_timed(writer.lines, |line| line / LINES_PER_PATH)
    }
}

/// Numbers of lines that a path may have, of which the first half is for the way to it.
const LINES_PER_PATH: usize = 1_000_000;

/// The rest of a line from a length along it.
fn cut(points: &[Point], along: f64) -> Vec<Point> {
    let mut left = along.min((polyline_length(points) - 1e-3).max(0.0));
    for (i, pair) in points.windows(2).enumerate() {
        let length = pair[0].distance(pair[1]);
        if left < length {
            let mut rest = vec![pair[0].lerp(pair[1], left / length)];
            rest.extend_from_slice(&points[i + 1..]);
            return rest;
        }
        left -= length;
    }
    points.to_vec()
}

impl Writer<'_> {
    fn push(&mut self, text: String, act: Act, seconds: f64, name: Option<String>) {
        self.until += seconds;
        let at = [self.at.x, self.at.y, 0.0];
        self.lines.push(ProgramLine { text, number: self.number, act, at, until: self.until, name });
        self.number += 1;
    }

    /// Lifts or lowers the pen, and waits for it.
    fn pen(&mut self, act: Act) {
        let motion = &self.profile.motion;
        let (value, seconds) = if act == Act::Lift { (1, motion.pen_up_seconds) } else { (0, motion.pen_down_seconds) };
        let pin = Servo::of_machine(self.profile).pin;
        self.push(format!("SP,{value},{:.0},{pin}", (1000.0 * seconds).max(1.0)), act, seconds, None);
    }

    fn change_pen(&mut self, pen: u32, name: &str, last: Option<u32>) {
        let is_other = last.is_some_and(|last| last != pen);
        if is_other {
            self.travel(Point::ORIGIN);
        }
        self.push(String::new(), Act::Pen(pen), 0.0, Some(name.to_owned()));
        if is_other {
            self.push(String::new(), Act::Pause, 0.0, None);
        }
    }

    /// A path, or its rest from a length along it. A piece has the same number in the whole and in the rest: there it is that of the
    /// whole's piece in which it begins.
    fn path(&mut self, number: usize, points: &[Point], along: f64, speed: f64) {
        let motion = &self.profile.motion;
        let limits = Limits { speed, acceleration: motion.acceleration, deviation: motion.corner_deviation() };
        let rest = if along > 0.0 { cut(points, along) } else { points.to_vec() };
        self.number = LINES_PER_PATH * number + 1000;
        self.travel(rest[0]);
        self.number = LINES_PER_PATH * number + LINES_PER_PATH / 2;
        self.pen(Act::Lower);
        let (first, act) = (self.number, Act::Line(60.0 * speed));
        let whole = plan(points, limits);
        if along > 0.0 {
            let ends = distances(points[0], &whole);
            let pieces = plan(&rest, limits);
            let done = polyline_length(points) - polyline_length(&rest);
            let begins = std::iter::once(0.0).chain(distances(rest[0], &pieces));
            let numbers = begins.map(|begin| first + ends.partition_point(|end| *end <= done + begin + 1e-6));
            self.moves(&pieces, numbers, act);
        } else {
            self.moves(&whole, first.., act);
        }
        self.number = first + whole.len();
        self.pen(Act::Lift);
    }

    fn travel(&mut self, to: Point) {
        let motion = &self.profile.motion;
        let acceleration = motion.travel_acceleration.unwrap_or(motion.acceleration);
        let limits = Limits { speed: motion.travel_speed, acceleration, deviation: motion.corner_deviation() };
        self.moves(&plan(&[self.at, to], limits), self.number.., Act::Rapid);
        self.number += 1;
    }

    /// Pieces of motion with the numbers of their lines.
    fn moves(&mut self, pieces: &[Piece], numbers: impl Iterator<Item = usize>, act: Act) {
        // Pieces too short for a step go with the next one.
        let mut owed = 0.0;
        for (piece, number) in pieces.iter().zip(numbers) {
            let steps = steps_of(piece.to);
            let moved = [steps[0] - self.steps[0], steps[1] - self.steps[1]];
            let seconds = piece.seconds + owed;
            let ticks = ticks_of(moved, seconds);
            self.number = number;
            match move_command(moved, ticks, piece.speeds) {
                Some(command) => {
                    (self.steps, self.at, owed) = (steps, piece.to, 0.0);
                    self.push(command, act, ticks as f64 / TICKS, None);
                }
                None => owed = seconds,
            }
        }
        self.at = pieces.last().map_or(self.at, |last| last.to);
    }
}

/// Lengths from a point to the ends of pieces that follow it.
fn distances(from: Point, pieces: &[Piece]) -> Vec<f64> {
    let mut at = from;
    let mut length = 0.0;
    let ends = pieces.iter().map(|piece| {
        length += at.distance(piece.to);
        at = piece.to;
        length
    });
    ends.collect()
}
