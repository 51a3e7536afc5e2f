//! A plot as the board's commands: each path planned as a whole, from rest to rest.

use super::STEPS_PER_MM;
use super::plan::{Limits, plan};
use super::rates::{TICKS, move_command};
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
            if !(begins + 1..=count).any(is_wanted) {
                continue;
            }
            writer.number = LINES_PER_PATH * (begins + 1);
            writer.change_pen(pen.number, &format!("pen {}: {} {}", pen.number, pen.name, pen.nib), last_pen);
            last_pen = Some(pen.number);
            for (i, path) in pen.paths.iter().enumerate() {
                interrupt.check()?;
                let number = begins + i + 1;
                if !is_wanted(number) {
                    continue;
                }
                let mut points: Vec<Point> = path.points.iter().map(|p| mounting.place(pen.number, *p)).collect();
                if std::mem::take(&mut is_first) && rest.along > 0.0 {
                    points = cut(&points, rest.along);
                }
                writer.path(number, &points, pen.handling.speed(profile.motion.draw_speed));
            }
        }
        writer.number = LINES_PER_PATH * (count + 1);
        let park = mounting.park;
        writer.travel(park);
        Program::of_timed(writer.lines, |line| line / LINES_PER_PATH)
    }
}

/// Numbers of lines that a path may have.
const LINES_PER_PATH: usize = 1_000_000;

/// Steps of both motors at a place: they pull along the diagonals.
fn steps_of(place: Point) -> [i64; 2] {
    [place.x + place.y, place.x - place.y].map(|mm| (mm * STEPS_PER_MM).round() as i64)
}

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
        self.push(format!("SP,{value},{:.0}", 1000.0 * seconds), act, seconds, None);
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

    fn path(&mut self, number: usize, points: &[Point], speed: f64) {
        self.number = LINES_PER_PATH * number + 1000;
        self.travel(points[0]);
        self.pen(Act::Lower);
        let motion = &self.profile.motion;
        let limits = Limits { speed, acceleration: motion.acceleration, deviation: motion.corner_deviation() };
        self.moves(points, limits, Act::Line(60.0 * speed));
        self.pen(Act::Lift);
    }

    fn travel(&mut self, to: Point) {
        let motion = &self.profile.motion;
        let acceleration = motion.travel_acceleration.unwrap_or(motion.acceleration);
        let limits = Limits { speed: motion.travel_speed, acceleration, deviation: motion.corner_deviation() };
        let from = self.at;
        self.moves(&[from, to], limits, Act::Rapid);
    }

    fn moves(&mut self, points: &[Point], limits: Limits, act: Act) {
        // Pieces too short for a step go with the next one.
        let mut owed = 0.0;
        for piece in plan(points, limits) {
            let steps = steps_of(piece.to);
            let moved = [steps[0] - self.steps[0], steps[1] - self.steps[1]];
            let seconds = piece.seconds + owed;
            let ticks = (seconds * TICKS).round().max(1.0) as u64;
            // No motor makes more than a step a tick.
            let ticks = ticks.max(2 * moved[0].unsigned_abs().max(moved[1].unsigned_abs()));
            match move_command(moved, ticks, piece.speeds) {
                Some(command) => {
                    (self.steps, self.at, owed) = (steps, piece.to, 0.0);
                    self.push(command, act, ticks as f64 / TICKS, None);
                }
                None => owed = seconds,
            }
        }
        self.at = *points.last().unwrap_or(&self.at);
    }
}
