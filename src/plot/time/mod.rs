//! Estimates how long a plot takes: replays the machine's file as it is written and times each move as the controller plans it.
//!
//! ```text
//!   travel   lower    draw ...   lift        what is written for one path
//!   G0 X Y   M3, G4   G1 X Y     M3, G4      every M3 and G4 lets the motion come to rest first
//! ```
//!
//! Values are rounded as the machine rounds them: positions to the file's decimals and to steps, rates to the file's digits,
//! waits to whole ticks.

mod file;
mod look_ahead;

pub use file::{line_times, replayed};

use super::language::{PenAction, PenMove, Rate};
use super::profile::{Limits, Profile};
use super::{Mounting, PenPaths, Plot, Toolpath};
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Step, Vec2, fit_arcs};
use crate::interrupt::{Interrupt, Interrupted};
use look_ahead::{LookAhead, Place, whole};
use std::f64::consts::PI;

/// Times in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PenTime {
    /// Moving with the pen down.
    pub drawing: f64,
    /// Moving with the pen up.
    pub travelling: f64,
    /// A z axis moving up or down.
    pub lifting: f64,
    /// No axis moves: a servo or a solenoid lifts, lowers or fetches the pen, or a layer or a touch waits.
    pub waiting: f64,
}

impl PenTime {
    /// Total time.
    pub fn total(&self) -> f64 {
        self.motion() + self.waiting
    }

    /// Time in which an axis moves.
    pub fn motion(&self) -> f64 {
        self.drawing + self.travelling + self.lifting
    }
}

/// The time of each pen of a plot, from machine zero with the pen up to the parking position. The user's own time at a pause is
/// unknown and not counted.
pub fn clock(plot: &Plot, profile: &Profile, mounting: &Mounting, interrupt: &Interrupt) -> Result<Vec<PenTime>, Interrupted> {
    let mut run = Run::new(profile, mounting, plot.pens.len());
    if plot.pens.is_empty() {
        return Ok(Vec::new());
    }
    if profile.speech().parks_for_pens() {
        run.act(PenMove::Up, if run.waits_for_pen() { profile.motion.pen_up_seconds } else { 0.0 });
    }
    for (i, pen) in plot.pens.iter().enumerate() {
        let is_other_pen = i > 0 && plot.pens[i - 1].number != pen.number;
        run.change_pen(i, is_other_pen, pen);
        let rate = run.draw_rate(pen);
        for path in &pen.paths {
            interrupt.check()?;
            run.path(pen.number, path, rate);
        }
    }
    run.park();
    Ok(run.finish())
}

/// What a pen's time is spent on.
#[derive(Clone, Copy)]
enum Share {
    Drawing,
    Travelling,
    Lifting,
    Waiting,
}

/// A straight move on the way along a path.
#[derive(Clone, Copy)]
enum Leg {
    /// To a position given in the file.
    Line([f64; 2]),
    /// To a position on an arc, computed by the controller.
    Chord([f64; 2]),
}

/// Number of shares.
const SHARES: usize = 4;

/// A machine replaying its file.
struct Run<'a> {
    profile: &'a Profile,
    mounting: &'a Mounting,
    planner: LookAhead,
    up: Vec<PenAction>,
    down: Vec<PenAction>,
    /// The pen's position in the file, in millimetres.
    at: Place,
    /// Index of the plot's current pen.
    pen: usize,
}

impl<'a> Run<'a> {
    fn new(profile: &'a Profile, mounting: &'a Mounting, pens: usize) -> Self {
        Self {
            profile,
            mounting,
            planner: LookAhead::new(&profile.motion, SHARES * pens),
            up: profile.speech().pen_actions(PenMove::Up),
            down: profile.speech().pen_actions(PenMove::Down),
            at: [0.0; 3],
            pen: 0,
        }
    }

    fn slot(&self, share: Share) -> usize {
        SHARES * self.pen + share as usize
    }

    fn change_pen(&mut self, next: usize, is_other_pen: bool, pen: &PenPaths) {
        let machine = self.profile.pens;
        if !self.profile.speech().parks_for_pens() {
            self.pen = next;
            if is_other_pen || next == 0 {
                self.wait(machine.change_seconds);
            }
            return;
        }
        if is_other_pen {
            self.park();
        }
        self.pen = next;
        if is_other_pen || pen.handling.pauses {
            self.planner.rest();
        }
        self.wait(pen.handling.delay_seconds);
    }

    /// The drawing rate in the file, mm/s.
    fn draw_rate(&self, pen: &PenPaths) -> f64 {
        self.profile.nearest_speed(pen.handling.speed(self.profile.motion.draw_speed))
    }

    fn travel_rate(&self) -> f64 {
        match self.profile.motion.planner.limits {
            Limits::Axis => f64::INFINITY,
            Limits::Path => self.profile.motion.travel_speed,
        }
    }

    fn path(&mut self, pen: u32, path: &Toolpath, rate: f64) {
        let mut places: Vec<[f64; 2]> = path.points().iter().map(|p| self.on_machine(pen, *p)).collect();
        self.travel(places[0]);
        self.lower(path.heights().map(|heights| heights[0]));
        self.wait(self.profile.motion.pen_down_seconds * f64::from(u8::from(self.waits_for_pen())) + path.dwell_seconds);
        let slot = self.slot(Share::Drawing);
        match path.heights() {
            Some(heights) if self.lifts_by_height() => {
                for (place, z) in places.iter().zip(heights).skip(1) {
                    self.at = [place[0], place[1], self.height(*z)];
                    self.planner.line(self.at, rate, slot);
                }
            }
            _ => {
                places.dedup();
                for leg in self.legs(&places) {
                    let (Leg::Line([x, y]) | Leg::Chord([x, y])) = leg;
                    self.at = [x, y, self.at[2]];
                    match leg {
                        Leg::Line(_) => self.planner.line(self.at, rate, slot),
                        Leg::Chord(_) => self.planner.chord(self.at, rate, slot),
                    }
                }
            }
        }
        self.act(PenMove::Up, if self.waits_for_pen() { self.profile.motion.pen_up_seconds } else { 0.0 });
    }

    /// The controller's moves after the first position: straight lines, or the chords into which it cuts written arcs.
    fn legs(&self, places: &[[f64; 2]]) -> Vec<Leg> {
        let sent = self.profile.motion.planner.arc_tolerance.filter(|_| self.profile.speech().sends_arcs());
        let Some(tolerance) = sent else {
            return places[1..].iter().map(|place| Leg::Line(*place)).collect();
        };
        let points: Vec<Point> = places.iter().map(|&[x, y]| Point::new(x, y)).collect();
        let mut legs = Vec::with_capacity(places.len());
        let mut from = points[0];
        for step in fit_arcs(&points, self.mounting.tolerance) {
            if let Step::Arc { centre, sweep, to } = step {
                // The file gives a rounded centre, and the controller computes the angle from it.
                let per_mm = self.profile.speech().places_per_unit() * self.profile.units_per_mm;
                let centre = from + ((centre - from) * per_mm).round() / per_mm;
                let (a, b) = (from - centre, to - centre);
                let sweep = sweep + (a.cross(b).angle_over(a.dot(b)) - sweep + PI).rem_euclid(2.0 * PI) - PI;
                let radius = from.distance(centre);
                let rise = (tolerance * (2.0 * radius - tolerance)).max(1e-12).sqrt();
                let count = (0.5 * sweep.abs() * radius / rise).floor();
                legs.extend(turned(from - centre, sweep / count, count as usize).map(|arm| {
                    let place = centre + arm;
                    Leg::Chord([place.x, place.y])
                }));
            }
            from = step.to();
            legs.push(Leg::Line([from.x, from.y]));
        }
        legs
    }

    fn lifts_by_height(&self) -> bool {
        self.profile.height().is_some()
    }

    /// True if the file waits for the pen. With a z axis the pen is in place when the move ends.
    fn waits_for_pen(&self) -> bool {
        !self.lifts_by_height()
    }

    /// Lowers the pen, directly to the path's own height if it has one.
    fn lower(&mut self, height: Option<f64>) {
        match (height, self.profile.height()) {
            (Some(z), Some(usual)) => {
                self.at[2] = self.height(z);
                self.planner.travel(self.at, usual.plunge_speed, self.slot(Share::Lifting));
            }
            _ => self.act(PenMove::Down, 0.0),
        }
    }

    /// A height of the page as the file gives it, in the machine's millimetres.
    fn height(&self, z: f64) -> f64 {
        let grid = self.profile.speech().places_per_unit();
        whole(z * grid) as f64 / (grid * self.profile.units_per_mm)
    }

    fn travel(&mut self, [x, y]: [f64; 2]) {
        self.at = [x, y, self.at[2]];
        self.planner.travel(self.at, self.travel_rate(), self.slot(Share::Travelling));
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

    /// Waits, after the motion comes to rest. A wait of no time is not written.
    fn wait(&mut self, seconds: f64) {
        if seconds <= 0.0 {
            return;
        }
        let tick = self.profile.motion.planner.dwell_step_seconds;
        let lasting = if tick > 0.0 { (seconds / tick - 1e-6).ceil() * tick } else { seconds };
        let slot = self.slot(Share::Waiting);
        self.planner.rest();
        self.planner.wait(lasting, slot);
    }

    /// Moves to the parking position.
    fn park(&mut self) {
        let scale = self.profile.units_per_mm;
        let place = [self.mounting.park.x / scale, self.mounting.park.y / scale];
        self.travel(place);
    }

    /// A point of the page as the file gives it, in the machine's millimetres.
    fn on_machine(&self, pen: u32, p: Point) -> [f64; 2] {
        let m = self.mounting.place(pen, p);
        let limits = self.mounting.limits;
        let grid = self.profile.speech().places_per_unit();
        let per_mm = grid * self.profile.units_per_mm;
        let snap = |v: f64, low: f64, high: f64| whole(v.clamp(low, high) * grid) as f64 / per_mm;
        [snap(m.x, limits.x0, limits.x1), snap(m.y, limits.y0, limits.y1)]
    }

    fn finish(mut self) -> Vec<PenTime> {
        self.planner.rest();
        let seconds = self.planner.seconds();
        let clock = |s: &[f64]| PenTime { drawing: s[0], travelling: s[1], lifting: s[2], waiting: s[3] };
        seconds.chunks(SHARES).map(clock).collect()
    }
}

/// Chords after which GRBL computes the next one from the arc's start.
const CHORDS_BY_TURNING: usize = 12;

/// The vectors from an arc's centre to the ends of its chords except the last, as GRBL computes them (`motion_control.c`): each
/// is the one before, rotated with third-order sine and cosine, and every thirteenth is exact. On a dot of 0.15 mm, whose chords
/// turn by a third of a radian, they end up a motor step off.
fn turned(start: Vec2, angle: f64, count: usize) -> impl Iterator<Item = Vec2> {
    let small = (angle * (1.0 - angle * angle / 6.0), 1.0 - 0.5 * angle * angle);
    let mut arm = start;
    (1..count).map(move |i| {
        let is_exact = i % (CHORDS_BY_TURNING + 1) == 0;
        let ((sin, cos), from) = if is_exact { ((angle * i as f64).sine_and_cosine(), start) } else { (small, arm) };
        arm = Vec2::new(from.x * cos - from.y * sin, from.x * sin + from.y * cos);
        arm
    })
}
