//! The firmware behind its serial line: a line buffer of 128 bytes, real-time commands, status reports, feed hold and soft reset,
//! and what the pen drew. Time is given from outside.
//!
//! Rules: gnea/grbl 1.1, `serial.c`, `protocol.c`, `system.c`, `report.c`, reimplemented.

mod hands;
mod lines;

use super::planner::Planner;
use super::program::{Command, Program};
use super::stepper::Stepper;
use super::{DWELL_STEP, Settings};
use std::collections::VecDeque;
use std::fmt::Write as _;

/// `RX_BUFFER_SIZE`, of which one place stays free.
const LINE_BUFFER: usize = 128;

/// A straight piece that the pen drew, from and to, in mm.
pub type Piece = [[f64; 2]; 2];

/// What lowers the pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pen {
    /// Values of S above this.
    Servo(f32),
    /// Heights below this.
    Height(f64),
}

/// What it says of its planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// `[OPT:V,15,128]`.
    Told,
    /// Nothing, as `FluidNC`.
    Untold,
}

/// Reports between two that tell the offset of the work, at rest and in motion (`REPORT_WCO_REFRESH_IDLE_COUNT` and `_BUSY_COUNT`).
const OFFSET_REPORTS: [u32; 2] = [10, 30];
/// Seconds of homing.
const HOMING: f32 = 4.0;

// Flags of the firmware's own.
#[allow(clippy::struct_excessive_bools)]
pub struct Firmware {
    settings: Settings,
    /// `$` settings as reported.
    reported: Vec<(u32, String)>,
    program: Program<'static>,
    planner: Planner,
    stepper: Stepper,
    /// Seconds since its start.
    pub now: f64,
    /// Seconds that the running segment has run.
    ran: f64,
    buffer: VecDeque<u8>,
    line: Vec<u8>,
    /// A line is being executed: its `ok` is owed.
    is_busy: bool,
    command: Option<Command>,
    dwells_until: Option<f64>,
    /// Blocks are executed.
    is_cycling: bool,
    is_held: bool,
    is_alarmed: bool,
    is_checking: bool,
    /// Offset of the work by `G92`, which a reset takes away.
    pub offset: [f64; 3],
    /// Offset of the work by `G54`, which lasts.
    pub work: [f64; 3],
    /// Reports until the offset is told again.
    offset_told: u32,
    output: Vec<u8>,
    pub pen: Pen,
    pub build: Build,
    is_homing: bool,
    was_down: bool,
    /// What the pen drew.
    pub drawn: Vec<Piece>,
    /// Where the pen touched the paper: each lowering.
    pub touches: Vec<[f64; 2]>,
    last_spindle: f32,
    /// Bytes lost because the line buffer was full.
    pub lost: usize,
    /// Seconds without anything to do between the first line and the last.
    pub starved: f64,
    is_starving: f64,
    /// Lines received.
    pub lines: usize,
    /// Greatest number of bytes in the line buffer.
    pub fullest: usize,
    /// When motion last came to rest, and when the pen was last lifted.
    pub rested: f64,
    pub lifted: f64,
}

impl Firmware {
    pub fn new(settings: &Settings) -> Self {
        let mut firmware = Self {
            settings: *settings,
            reported: reported(settings),
            program: Program::new("", settings),
            planner: Planner::new(settings),
            stepper: Stepper::default(),
            now: 0.0,
            ran: 0.0,
            buffer: VecDeque::new(),
            line: Vec::new(),
            is_busy: false,
            command: None,
            dwells_until: None,
            is_cycling: false,
            is_held: false,
            is_alarmed: false,
            is_checking: false,
            offset: [0.0; 3],
            work: [0.0; 3],
            offset_told: 0,
            output: Vec::new(),
            pen: Pen::Servo(500.0),
            build: Build::Told,
            is_homing: false,
            was_down: false,
            drawn: Vec::new(),
            touches: Vec::new(),
            last_spindle: 0.0,
            lost: 0,
            starved: 0.0,
            is_starving: 0.0,
            lines: 0,
            fullest: 0,
            rested: 0.0,
            lifted: 0.0,
        };
        firmware.greet();
        firmware
    }

    fn greet(&mut self) {
        self.say("\r\nGrbl 1.1h ['$' for help]");
    }

    fn say(&mut self, text: &str) {
        self.output.extend_from_slice(text.as_bytes());
        self.output.extend_from_slice(b"\r\n");
    }

    /// What it says.
    pub fn output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.output)
    }

    /// Bytes arrive.
    pub fn receive(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            match byte {
                b'?' => self.report(),
                b'!' => {
                    if self.is_moving() {
                        self.stepper.hold();
                    }
                    self.is_held = true;
                }
                b'~' => {
                    self.is_held = false;
                    self.stepper.resume(&mut self.planner);
                }
                0x18 => self.reset(),
                0x80.. => {}
                byte if self.buffer.len() < LINE_BUFFER - 1 => {
                    self.buffer.push_back(byte);
                    self.fullest = self.fullest.max(self.buffer.len());
                }
                _ => self.lost += 1,
            }
        }
    }

    fn is_moving(&self) -> bool {
        self.stepper.running().is_some() || self.is_cycling && !self.planner.is_empty()
    }

    fn is_idle(&self) -> bool {
        !self.is_moving() && self.planner.is_empty() && self.command.is_none() && self.dwells_until.is_none()
    }

    fn report(&mut self) {
        let state = if self.is_alarmed {
            "Alarm"
        } else if self.is_held && (self.stepper.is_held() || !self.is_moving()) {
            "Hold:0"
        } else if self.is_held {
            "Hold:1"
        } else if self.is_checking {
            "Check"
        } else if self.is_idle() {
            "Idle"
        } else {
            "Run"
        };
        let joined = |place: [f64; 3]| place.map(|v| format!("{v:.3}")).join(",");
        let mut text = format!("<{state}|MPos:{}", joined(self.stepper.at));
        let free = LINE_BUFFER - 1 - self.buffer.len();
        let _ = write!(text, "|Bf:{},{free}|FS:0,{:.0}", self.planner.free(), self.last_spindle);
        if self.offset_told == 0 {
            let _ = write!(text, "|WCO:{}", joined(self.zero()));
            self.offset_told = OFFSET_REPORTS[usize::from(self.is_moving())];
        }
        self.offset_told -= 1;
        self.say(&format!("{text}>"));
    }

    /// Where zero of the work lies on the machine.
    fn zero(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.offset[axis] + self.work[axis])
    }

    /// The pen's place in the work.
    fn place(&self) -> [f64; 3] {
        let zero = self.zero();
        std::array::from_fn(|axis| self.stepper.at[axis] - zero[axis])
    }

    /// Soft reset: in motion it loses its position.
    fn reset(&mut self) {
        let was_moving = self.is_moving() && !self.stepper.is_held();
        let was_homing = std::mem::take(&mut self.is_homing);
        self.stepper.reset();
        let at = self.stepper.at;
        self.planner.reset(at);
        self.offset = [0.0; 3];
        self.offset_told = 0;
        self.program.reset(self.place().map(|v| v as f32));
        (self.command, self.dwells_until, self.is_busy, self.is_cycling, self.is_held) = (None, None, false, false, false);
        self.buffer.clear();
        self.line.clear();
        self.ran = 0.0;
        self.last_spindle = 0.0;
        self.is_checking = false;
        if was_moving || was_homing {
            self.is_alarmed = true;
            self.say(if was_homing { "ALARM:6" } else { "ALARM:3" });
        }
        self.greet();
    }

    /// Time passes.
    pub fn run_until(&mut self, time: f64) {
        // In steps of a millisecond, so that lines are taken as time passes.
        while self.now < time {
            let step = (time - self.now).min(0.001);
            self.now += step;
            self.take_lines();
            self.move_for(step);
        }
    }

    fn move_for(&mut self, seconds: f64) {
        // On hold nothing begins.
        if self.is_held && self.stepper.running().is_none() {
            return;
        }
        self.is_cycling |=
            self.planner.free() == 0 || (self.buffer.is_empty() || self.command.is_some()) && !self.planner.is_empty();
        if self.is_cycling {
            self.stepper.fill(&mut self.planner);
        }
        let was_moving = self.stepper.running().is_some();
        self.ran += seconds;
        while let Some(lasts) = self.stepper.running() {
            if self.ran < lasts {
                break;
            }
            self.ran -= lasts;
            let from = self.stepper.at;
            self.stepper.finish_segment();
            let to = self.stepper.at;
            if self.is_pen_down() && from[..2] != to[..2] {
                self.drawn.push([[from[0], from[1]], [to[0], to[1]]]);
            }
            self.watch_pen();
            self.stepper.fill(&mut self.planner);
        }
        if self.stepper.running().is_none() {
            self.ran = 0.0;
            if was_moving {
                self.rested = self.now;
            }
            if self.planner.is_empty() {
                self.is_cycling = false;
            }
            let has_nothing = self.planner.is_empty() && self.command.is_none() && self.dwells_until.is_none();
            if has_nothing && !self.buffer.contains(&b'\n') {
                self.is_starving += seconds;
            }
        }
    }

    /// The servo follows S; the program has waited for the motion before.
    fn follow_spindle(&mut self) {
        self.last_spindle = self.program.spindle_speed();
        self.watch_pen();
        if self.last_spindle != 0.0 && !self.is_pen_down() {
            self.lifted = self.now;
        }
    }

    /// Notes where the pen comes down.
    fn watch_pen(&mut self) {
        let is_down = self.is_pen_down();
        if is_down && !self.was_down {
            self.touches.push([self.stepper.at[0], self.stepper.at[1]]);
        }
        self.was_down = is_down;
    }
}

fn reported(settings: &Settings) -> Vec<(u32, String)> {
    let mut list = vec![(11, settings.junction_deviation), (12, settings.arc_tolerance), (20, 0.0), (32, 0.0)];
    for axis in 0..3 {
        list.push((100 + axis as u32, settings.steps_per_mm[axis]));
        list.push((110 + axis as u32, settings.greatest_rate[axis]));
        list.push((120 + axis as u32, settings.acceleration[axis]));
        list.push((130 + axis as u32, 300.0));
    }
    list.into_iter().map(|(number, value)| (number, format!("{value:.3}"))).collect()
}
