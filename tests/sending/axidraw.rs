//! The board of the `AxiDraw`, modelled tick by tick: its queue of one or 32 commands, its accumulators, its stop.

mod drawing;

use crate::machine::{Chance, Device, Job, Machine, at_once, many, said};
use crate::streaming::{connected_at, drawn};
use drypoint::drawing::{Colour, Handling, Page};
use drypoint::drive::{Ebb, Ending, Happening, Onlooker, PenHeights, Program, Rest, Wish};
use drypoint::geometry::Point;
use drypoint::interrupt::Interrupt;
use drypoint::plot::{Act, PenLift, PenPaths, Plot, Profile, Toolpath, mount};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Mutex;
use std::time::{Duration, Instant};

const FULL: i64 = 1 << 31;
const TICK: f64 = 1.0 / 25_000.0;
/// How much faster than in life the board runs here.
const PACE: f64 = 10.0;

enum Motion {
    Move { rate: [i64; 2], left: [i64; 2], change: [i64; 2], sign: [i64; 2] },
    Pen { is_down: bool, ticks: i64 },
}

// Flags of the board's own.
#[allow(clippy::struct_excessive_bools)]
struct Board {
    version: &'static str,
    depth: usize,
    queue: VecDeque<Motion>,
    running: Option<Motion>,
    sums: [i64; 2],
    /// A command that found the queue full: nothing is read until it has room.
    stuck: Option<Motion>,
    input: VecDeque<u8>,
    output: Vec<u8>,
    now: f64,
    steps: [i64; 2],
    is_down: bool,
    is_enabled: bool,
    is_powered: bool,
    /// The power was lost since it was asked for.
    was_dark: bool,
    /// Times that the count of steps was set to zero with the motors.
    zeroed: usize,
    is_new_syntax: bool,
    is_pressed: bool,
    /// Steps at each lifting, and where the pen came down.
    lifts: Vec<[i64; 2]>,
    touches: Vec<[i64; 2]>,
    /// Settings of the pen's servo, and the pins at which it was moved.
    servo: BTreeMap<i64, i64>,
    pins: BTreeSet<i64>,
    unknown: Vec<String>,
    blocked: usize,
    stopped: Option<f64>,
}

impl Board {
    fn new(version: &'static str) -> Self {
        Self {
            version,
            depth: 1,
            queue: VecDeque::new(),
            running: None,
            sums: [0; 2],
            stuck: None,
            input: VecDeque::new(),
            output: Vec::new(),
            now: 0.0,
            steps: [0; 2],
            is_down: false,
            is_enabled: false,
            is_powered: true,
            was_dark: false,
            zeroed: 0,
            is_new_syntax: version == NEW,
            // Somebody pressed it long ago.
            is_pressed: true,
            lifts: Vec::new(),
            touches: Vec::new(),
            servo: BTreeMap::new(),
            pins: BTreeSet::new(),
            unknown: Vec::new(),
            blocked: 0,
            stopped: None,
        }
    }

    fn say(&mut self, text: &str) {
        self.output.extend_from_slice(text.as_bytes());
    }

    fn accept(&mut self, motion: Motion) {
        if self.running.is_none() && self.queue.is_empty() {
            self.running = Some(motion);
        } else if self.queue.len() < self.depth {
            self.queue.push_back(motion);
        } else {
            self.blocked += 1;
            self.stuck = Some(motion);
            return;
        }
        self.say("OK\r\n");
    }

    fn command(&mut self, text: &str) {
        let fields: Vec<&str> = text.split(',').collect();
        let numbers: Vec<i64> = fields[1..].iter().filter_map(|field| field.parse().ok()).collect();
        match (fields[0], &numbers[..]) {
            ("", _) => {}
            ("V", _) if self.is_new_syntax => self.say(&format!("V,{}\n", self.version)),
            ("V", _) => self.say(&format!("{}\r\n", self.version)),
            ("CU", [1, 1]) if self.is_new_syntax => self.say("CU\n"),
            ("QE", _) => self.say(if self.is_enabled { "16,16\r\nOK\r\n" } else { "0,0\r\nOK\r\n" }),
            ("EM", [first, _]) => {
                (self.is_enabled, self.steps, self.zeroed) = (*first != 0, [0; 2], self.zeroed + 1);
                self.say("OK\r\n");
            }
            ("QC", _) => self.say(if self.is_powered { "0394,0300\r\nOK\r\n" } else { "0394,0008\r\nOK\r\n" }),
            ("CU", [10, 0]) if self.version == NEW => {
                // In the syntax that another program has set.
                let was_new = std::mem::take(&mut self.is_new_syntax);
                self.say(if was_new { "CUOK\r\n" } else { "OK\r\n" });
            }
            ("QG", _) if self.version == NEW => {
                let lost = if std::mem::take(&mut self.was_dark) { 0x40 } else { 0 };
                self.say(&format!("{:02X}\r\n", lost | if self.is_down { 0 } else { 0x10 }));
            }
            ("QU", [2]) if self.version == NEW => self.say("QU,32\r\nOK\r\n"),
            ("QU", [3]) if self.version == NEW => {
                let depth = self.depth;
                self.say(&format!("QU,{depth}\r\nOK\r\n"));
            }
            ("SC", [number, value]) => {
                self.servo.insert(*number, *value);
                self.say("OK\r\n");
            }
            ("CU", [1, 1]) => self.say("OK\r\n"),
            ("CU", [50, 1] | [61, 0] | [60, _]) if self.version == NEW => self.say("OK\r\n"),
            ("CS", _) => {
                self.steps = [0; 2];
                self.say("OK\r\n");
            }
            ("CU", [4, depth]) if self.version == NEW => {
                assert!(self.is_done(), "the queue's depth was changed while it held something");
                self.depth = (*depth as usize).min(32);
                self.say("OK\r\n");
            }
            ("QS", _) => self.say(&format!("{},{}\n\rOK\r\n", self.steps[0], self.steps[1])),
            ("QP", _) => self.say(if self.is_down { "0\n\rOK\r\n" } else { "1\n\rOK\r\n" }),
            ("QB", _) => {
                let pressed = i32::from(std::mem::take(&mut self.is_pressed));
                self.say(&format!("{pressed}\r\nOK\r\n"));
            }
            ("QM", _) => {
                let busy = i32::from(self.running.is_some());
                let moves = i32::from(matches!(self.running, Some(Motion::Move { .. })));
                let waits = i32::from(!self.queue.is_empty());
                self.say(&format!("QM,{busy},{moves},{moves},{waits}\n\r"));
            }
            ("ES", _) => {
                // Firmware 2 forgets moves only: what the pen was told is still done.
                let is_kept = |motion: &Motion| self.version == OLD && matches!(motion, Motion::Pen { .. });
                self.queue.retain(is_kept);
                self.running = self.running.take().filter(is_kept);
                self.stopped = Some(self.now);
                // Firmware 3 has one value here.
                self.say(if self.version == NEW { "1\n\rOK\r\n" } else { "1,0,0,0,0\n\rOK\r\n" });
            }
            ("SP", [value, milliseconds, pin]) => {
                self.pins.insert(*pin);
                self.accept(Motion::Pen { is_down: *value == 0, ticks: milliseconds * 25 });
            }
            ("LM", [rate, steps, change, other, more, turn, 3]) => {
                let (rates, counts, changes) = ([*rate, *other], [*steps, *more], [*change, *turn]);
                assert!(counts != [0; 2] && text.len() < 64, "{text}");
                self.is_enabled = true;
                let motion = Motion::Move {
                    rate: [rates[0] - changes[0] / 2, rates[1] - changes[1] / 2],
                    left: counts.map(i64::abs),
                    change: changes,
                    sign: counts.map(i64::signum),
                };
                self.accept(motion);
            }
            _ => {
                self.unknown.push(text.to_owned());
                self.say("!8 Err: Unknown command\r\n");
            }
        }
    }

    fn tick(&mut self) {
        if self.running.is_none() {
            self.running = self.queue.pop_front();
            self.sums = [0; 2];
        }
        let Some(motion) = &mut self.running else { return };
        let is_done = match motion {
            Motion::Pen { is_down, ticks } => {
                if *is_down != self.is_down {
                    if *is_down {
                        self.touches.push(self.steps);
                    } else {
                        self.lifts.push(self.steps);
                    }
                    self.is_down = *is_down;
                }
                *ticks -= 1;
                *ticks <= 0
            }
            Motion::Move { rate, left, change, sign } => {
                for axis in (0..2).filter(|axis| left[*axis] > 0).collect::<Vec<_>>() {
                    rate[axis] += change[axis];
                    assert!(rate[axis] >= 0, "the rate rolled over");
                    self.sums[axis] += rate[axis];
                    if self.sums[axis] >= FULL {
                        self.sums[axis] -= FULL;
                        left[axis] -= 1;
                        self.steps[axis] += sign[axis];
                    }
                }
                *left == [0, 0]
            }
        };
        if is_done {
            self.running = self.queue.pop_front();
            self.sums = [0; 2];
            if self.queue.len() < self.depth
                && let Some(stuck) = self.stuck.take()
            {
                self.queue.push_back(stuck);
                self.say("OK\r\n");
            }
        }
    }
}

impl Device for Board {
    fn receive(&mut self, bytes: &[u8]) {
        self.input.extend(bytes);
    }

    fn run_until(&mut self, seconds: f64) {
        loop {
            while self.stuck.is_none()
                && let Some(end) = self.input.iter().position(|byte| *byte == b'\r')
            {
                let line: Vec<u8> = self.input.drain(..=end).collect();
                self.command(String::from_utf8_lossy(&line).trim());
            }
            if self.now >= seconds {
                return;
            }
            self.now += TICK;
            self.tick();
        }
    }

    fn output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.output)
    }

    fn is_done(&self) -> bool {
        self.running.is_none() && self.queue.is_empty() && self.stuck.is_none()
    }
}

fn pen(number: u32, paths: Vec<Vec<Point>>) -> PenPaths {
    let paths = paths.into_iter().filter_map(Toolpath::new).collect();
    PenPaths { number, name: "lines".into(), colour: Colour::BLACK, nib: 0.3, handling: Handling::default(), paths }
}

/// Three drawings: rings, long lines with corners, and dots with short zigzags.
fn drawings() -> Vec<Plot> {
    let mut chance = Chance(4711);
    let ring = |i: usize| {
        let (x, y, r) = (15.0 + 12.0 * i as f64, 20.0, 1.0 + i as f64);
        (0..=40)
            .map(|k| f64::from(k) * std::f64::consts::TAU / 40.0)
            .map(|t| Point::new(x + r * t.cos(), y + r * t.sin()))
            .collect()
    };
    let rings: Vec<Vec<Point>> = (0..4).map(ring).collect();
    let corners = vec![
        vec![
            Point::new(5.0, 5.0),
            Point::new(90.0, 5.0),
            Point::new(90.0, 50.0),
            Point::new(20.0, 48.7),
            Point::new(20.02, 48.6),
        ],
        vec![Point::new(33.333, 11.111), Point::new(34.0, 44.0)],
    ];
    let zigzags = (0..12).map(|i| {
        let (x, y) = (6.0 + 7.0 * f64::from(i), 60.0);
        (0..if i % 3 == 0 { 1 } else { 12 })
            .map(|k| Point::new(x + 0.3 * f64::from(k), y + chance.below(200) as f64 / 100.0))
            .collect()
    });
    [rings, corners, zigzags.collect()]
        .into_iter()
        .map(|paths| Plot { page: Page::new(150.0, 100.0), pens: vec![pen(1, paths)] })
        .collect()
}

struct Stopping(Option<Instant>);

impl Onlooker for Stopping {
    fn wish(&mut self) -> Option<Wish> {
        self.0.is_some_and(|at| Instant::now() >= at).then_some(Wish::Stop)
    }

    fn happens(&mut self, _: &Happening<'_>) {}
}

const OLD: &str = "EBBv13_and_above EB Firmware Version 2.8.1";
const NEW: &str = "EBBv13_and_above EB Firmware Version 3.0.2";

fn program(plot: &Plot) -> Program {
    program_for("axidraw-v3", plot)
}

fn program_for(machine: &str, plot: &Plot) -> Program {
    let profile = Profile::built_in(machine).unwrap();
    let mounting = mount(&profile, &plot.page).unwrap();
    Program::of_plot(&profile, plot, &mounting, &Rest::default(), &Interrupt::never()).unwrap()
}

fn conversation(machine: &Machine<Board>) -> Ebb {
    conversation_with(PenLift::Servo, machine)
}

fn conversation_with(lift: PenLift, machine: &Machine<Board>) -> Ebb {
    let mut ebb = Ebb::greet(connected_at(&machine.port()), PenHeights::default(), lift, &Interrupt::never()).unwrap();
    ebb.set_pace(PACE);
    ebb
}
