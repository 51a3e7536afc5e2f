//! A step-by-step simulation of a machine with GRBL 1.1: an independent and slow answer to how long a G-code file takes.
//!
//! The rules are the firmware's published ones (gnea/grbl 1.1: `gcode.c`, `motion_control.c`, `planner.c`, `stepper.c`,
//! `config.h`), reimplemented; nothing is shared with the library's own timing. Parsing and planning take no time, so the block
//! buffer is full whenever there is input; what is counted is the motors' timer ticks and the waits.
#![allow(dead_code)]

pub mod firmware;
mod planner;
mod program;
mod stepper;

use planner::Planner;
use program::{Command, Program};
use stepper::Stepper;

/// The firmware computes in single precision, millimetres and minutes.
type Real = f32;

/// The firmware's `$` settings, for x, y and z.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// `$100` to `$102`, steps/mm.
    pub steps_per_mm: [f64; 3],
    /// `$110` to `$112`, mm/min.
    pub greatest_rate: [f64; 3],
    /// `$120` to `$122`, mm/s^2.
    pub acceleration: [f64; 3],
    /// `$11`, mm.
    pub junction_deviation: f64,
    /// `$12`, mm.
    pub arc_tolerance: f64,
    /// `$32`.
    pub laser: Laser,
    /// Blocks that the planner holds besides the one place that stays free.
    pub blocks: usize,
}

/// A machine with the profile `grbl-servo`.
pub const SERVO: Settings = Settings {
    steps_per_mm: [80.0, 80.0, 400.0],
    greatest_rate: [6000.0, 6000.0, 6000.0],
    acceleration: [250.0, 250.0, 250.0],
    junction_deviation: 0.01,
    arc_tolerance: 0.002,
    laser: Laser::Off,
    blocks: 15,
};

/// A machine with the profile `grbl-z`.
pub const Z: Settings = Settings { greatest_rate: [6000.0, 6000.0, 500.0], ..SERVO };

/// `$32`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Laser {
    Off,
    On,
}

/// Times of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Elapsed {
    /// Seconds in which the motors ran.
    pub motion: f64,
    /// Seconds waited.
    pub dwell: f64,
    /// Seconds of motion lost to a last step that rounding made late.
    pub late: f64,
    /// Steps of the leading axis.
    pub steps: u64,
    /// Greatest speed at the end of a segment, mm/s.
    pub top_speed: f64,
}

impl Elapsed {
    pub fn total(&self) -> f64 {
        self.motion + self.dwell
    }
}

/// Waits are counted in steps of this many seconds, rounded up.
const DWELL_STEP: f32 = 0.05;

/// Runs a whole file.
pub fn run(text: &str, settings: &Settings) -> Elapsed {
    let mut machine = Machine { planner: Planner::new(settings), stepper: Stepper::default(), cycle: false };
    let mut dwell = 0.0;
    for command in Program::new(text, settings) {
        match command {
            Command::Line { target, rate } => {
                machine.make_room();
                machine.planner.add(target, rate, &mut machine.stepper);
            }
            Command::Synchronize => machine.drain(),
            Command::Dwell(seconds) => {
                machine.drain();
                dwell += f64::from((seconds / DWELL_STEP - 1e-4).ceil()) * f64::from(DWELL_STEP);
            }
        }
    }
    machine.drain();
    let stepper = machine.stepper;
    Elapsed {
        motion: stepper.clock,
        dwell,
        late: stepper.late,
        steps: stepper.steps,
        top_speed: f64::from(stepper.top_speed) / 60.0,
    }
}

struct Machine {
    planner: Planner,
    stepper: Stepper,
    /// Whether the motors run; at the start and after a stop, blocks are collected until the buffer is full.
    cycle: bool,
}

impl Machine {
    /// Waits until the buffer has room for a block.
    fn make_room(&mut self) {
        loop {
            if self.cycle {
                self.stepper.fill(&mut self.planner);
            }
            if !self.planner.is_full() {
                return;
            }
            self.cycle = true;
            self.stepper.fill(&mut self.planner);
            self.stepper.finish_segment();
        }
    }

    /// Waits until everything is done.
    fn drain(&mut self) {
        self.stepper.fill(&mut self.planner);
        while self.stepper.finish_segment() {
            self.stepper.fill(&mut self.planner);
        }
        self.cycle = false;
    }
}
