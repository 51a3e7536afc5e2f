//! How long a plot takes: the machine's file is gone through as it is written, and each move timed as the controller plans it.
//!
//! ```text
//!   travel   lower    draw ...   lift        what is written for one path
//!   G0 X Y   M3, G4   G1 X Y     M3, G4      every M3 and G4 lets the motion come to rest first
//! ```
//!
//! What reaches a motor is rounded as the machine rounds it: places to the file's decimals and to steps, rates to the file's
//! digits, waits to whole ticks.

mod look_ahead;
mod pen_action;

use super::profile::{Language, Limits, Profile};
use super::{Mounting, PenPaths, Plot};
use crate::geometry::Point;
use look_ahead::{LookAhead, Place, whole};
use pen_action::{PenAction, Rate, pen_actions};

/// Decimals of a place in a G-code file.
const GCODE_GRID: f64 = 1000.0;

/// Times in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clock {
    /// Pen down, moving.
    pub drawing: f64,
    /// Pen up, moving.
    pub travelling: f64,
    /// Lifting, lowering and changing the pen, and waits that a layer asks for.
    pub lifting: f64,
}

impl Clock {
    /// All of it.
    pub fn total(&self) -> f64 {
        self.drawing + self.travelling + self.lifting
    }
}

/// The time of each pen of a plot, from machine zero with the pen up to where the machine parks; the user's own time at a pause
/// is not known and not counted.
pub fn clock(plot: &Plot, profile: &Profile, mounting: &Mounting) -> Vec<Clock> {
    let mut run = Run::new(profile, mounting, plot.pens.len());
    if plot.pens.is_empty() {
        return Vec::new();
    }
    if profile.language == Language::Gcode {
        run.lift();
    }
    for (i, pen) in plot.pens.iter().enumerate() {
        let is_other_pen = i > 0 && plot.pens[i - 1].number != pen.number;
        run.change_pen(i, is_other_pen, pen);
        let rate = run.draw_rate(pen);
        for path in &pen.paths {
            run.path(&path.points, rate);
        }
    }
    run.park();
    run.finish()
}

/// What a stretch of time is spent on, for each pen.
#[derive(Clone, Copy)]
enum Share {
    Drawing,
    Travelling,
    Lifting,
}

/// A machine that goes through its file.
struct Run<'a> {
    profile: &'a Profile,
    mounting: &'a Mounting,
    planner: LookAhead,
    up: Vec<PenAction>,
    down: Vec<PenAction>,
    /// Where the file has sent the pen, in millimetres.
    at: Place,
    /// Which of the plot's pens draws.
    pen: usize,
}

impl<'a> Run<'a> {
    fn new(profile: &'a Profile, mounting: &'a Mounting, pens: usize) -> Self {
        let actions = |command: fn(&super::GcodeDialect) -> &String| {
            profile.gcode.as_ref().map_or(vec![PenAction::Rest], |gcode| pen_actions(command(gcode), &gcode.dwell))
        };
        Self {
            profile,
            mounting,
            planner: LookAhead::new(&profile.motion, 3 * pens),
            up: actions(|gcode| &gcode.pen_up),
            down: actions(|gcode| &gcode.pen_down),
            at: [0.0; 3],
            pen: 0,
        }
    }

    fn slot(&self, share: Share) -> usize {
        3 * self.pen + share as usize
    }

    fn change_pen(&mut self, next: usize, is_other_pen: bool, pen: &PenPaths) {
        let machine = self.profile.pens;
        match self.profile.language {
            Language::Gcode => {
                if is_other_pen {
                    self.park();
                }
                self.pen = next;
                if is_other_pen || pen.handling.pauses {
                    self.planner.rest();
                }
                self.wait(pen.handling.delay_seconds);
            }
            Language::Hpgl => {
                self.pen = next;
                if is_other_pen || next == 0 {
                    self.wait(machine.change_seconds);
                }
            }
        }
    }

    /// The rate that the file asks for, mm/s.
    fn draw_rate(&self, pen: &PenPaths) -> f64 {
        let motion = &self.profile.motion;
        let speed = pen.handling.speed(motion.draw_speed);
        match self.profile.language {
            Language::Gcode => (speed * 60.0).round().max(1.0) / 60.0,
            Language::Hpgl => (speed.min(motion.draw_speed_limit.unwrap_or(motion.draw_speed)) / 10.0).floor().max(1.0) * 10.0,
        }
    }

    fn travel_rate(&self) -> f64 {
        match self.profile.motion.planner.limits {
            Limits::Axis => f64::INFINITY,
            Limits::Path => self.profile.motion.travel_speed,
        }
    }

    fn path(&mut self, points: &[Point], rate: f64) {
        self.travel(self.on_machine(points[0]));
        self.act(PenMove::Down, self.profile.motion.pen_down_seconds);
        let slot = self.slot(Share::Drawing);
        for p in &points[1..] {
            let [x, y] = self.on_machine(*p);
            self.at = [x, y, self.at[2]];
            self.planner.line(self.at, rate, slot);
        }
        self.lift();
    }

    fn travel(&mut self, [x, y]: [f64; 2]) {
        self.at = [x, y, self.at[2]];
        self.planner.travel(self.at, self.travel_rate(), self.slot(Share::Travelling));
    }

    fn lift(&mut self) {
        self.act(PenMove::Up, self.profile.motion.pen_up_seconds);
    }

    fn act(&mut self, pen: PenMove, seconds: f64) {
        let slot = self.slot(Share::Lifting);
        let count = self.actions(pen).len();
        for i in 0..count {
            match self.actions(pen)[i] {
                PenAction::Rest => self.planner.rest(),
                PenAction::Wait(seconds) => self.wait(seconds),
                PenAction::Move { target, rate } => {
                    for (axis, value) in target.into_iter().enumerate() {
                        self.at[axis] = value.map_or(self.at[axis], |value| value / self.profile.units_per_mm);
                    }
                    let rate = match rate {
                        Rate::Greatest => self.travel_rate(),
                        Rate::Given(rate) => rate / self.profile.units_per_mm,
                        Rate::Last => self.profile.motion.draw_speed,
                    };
                    self.planner.travel(self.at, rate, slot);
                }
            }
        }
        self.wait(seconds);
    }

    fn actions(&self, pen: PenMove) -> &[PenAction] {
        match pen {
            PenMove::Up => &self.up,
            PenMove::Down => &self.down,
        }
    }

    /// A wait, for which the motion comes to rest; none is written for no time.
    fn wait(&mut self, seconds: f64) {
        if seconds <= 0.0 {
            return;
        }
        let tick = self.profile.motion.planner.dwell_step_seconds;
        let lasting = if tick > 0.0 { (seconds / tick - 1e-6).ceil() * tick } else { seconds };
        let slot = self.slot(Share::Lifting);
        self.planner.rest();
        self.planner.wait(lasting, slot);
    }

    /// To where the file leaves the carriage.
    fn park(&mut self) {
        let scale = self.profile.units_per_mm;
        let place = match &self.profile.gcode {
            Some(gcode) => [gcode.park[0] / scale, gcode.park[1] / scale],
            None => [self.mounting.limits.x1.round() / scale, self.mounting.limits.y1.round() / scale],
        };
        self.travel(place);
    }

    /// A point of the page as the file gives it, in the machine's millimetres.
    fn on_machine(&self, p: Point) -> [f64; 2] {
        let m = self.mounting.to_machine * p;
        let limits = self.mounting.limits;
        let grid = if self.profile.language == Language::Gcode { GCODE_GRID } else { 1.0 };
        let per_mm = grid * self.profile.units_per_mm;
        let snap = |v: f64, low: f64, high: f64| whole(v.clamp(low, high) * grid) as f64 / per_mm;
        [snap(m.x, limits.x0, limits.x1), snap(m.y, limits.y0, limits.y1)]
    }

    fn finish(mut self) -> Vec<Clock> {
        self.planner.rest();
        let seconds = self.planner.seconds();
        seconds.chunks(3).map(|s| Clock { drawing: s[0], travelling: s[1], lifting: s[2] }).collect()
    }
}

/// Which way the pen goes.
#[derive(Clone, Copy)]
enum PenMove {
    Up,
    Down,
}
