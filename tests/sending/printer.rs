//! Marlin, modelled: numbered lines with checksums, a serial buffer of 128 bytes, a planner of 16 blocks, noise on the line.

use crate::machine::{Chance, Device, Job, Machine, at_once, many, said};
use std::collections::VecDeque;
use std::fmt::Write as _;
use std::time::Duration;

/// The firmware.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Marlin,
    /// It takes whatever it is sent for two seconds ahead, waits too, and knows no `M410`.
    Klipper,
}

/// How much faster than in life the machine runs in the tests that stop it.
const PACE: f64 = 20.0;
/// Seconds that Klipper looks ahead.
const AHEAD: f64 = 2.0;

struct Printer {
    kind: Kind,
    /// Where zero was set.
    zero: [f64; 2],
    serial: VecDeque<u8>,
    last: u64,
    output: Vec<u8>,
    now: f64,
    /// When each planned move ends, its end, and whether the pen is down on it.
    planned: VecDeque<(f64, [f64; 3])>,
    at: [f64; 3],
    planned_at: [f64; 3],
    /// A line that waits for the planner or for the motion to end.
    waiting: Option<String>,
    /// Moves are thrown away until then.
    cleans_until: f64,
    /// It takes `M410` out of the bytes that arrive, before they are lines.
    has_emergency_parser: bool,
    dwells_until: f64,
    busy_told: f64,
    touches: Vec<[f64; 2]>,
    drawn: f64,
    noise: Chance,
    every: u64,
    /// A byte of this line was hit. One at most is: the checksum, a sum by exclusive or, cannot see two equal bytes hit alike.
    is_hit: bool,
    lost: usize,
    pub resent: usize,
}

impl Printer {
    fn new(seed: u64, every: u64) -> Self {
        Self {
            kind: Kind::Marlin,
            zero: [0.0; 2],
            serial: VecDeque::new(),
            last: 0,
            output: Vec::new(),
            now: 0.0,
            planned: VecDeque::new(),
            at: [0.0, 0.0, 2.0],
            planned_at: [0.0, 0.0, 2.0],
            waiting: None,
            cleans_until: 0.0,
            has_emergency_parser: seed % 4 < 2,
            dwells_until: 0.0,
            busy_told: 0.0,
            touches: Vec::new(),
            drawn: 0.0,
            noise: Chance(seed),
            every,
            is_hit: false,
            lost: 0,
            resent: 0,
        }
    }

    fn say(&mut self, text: &str) {
        self.output.extend_from_slice(text.as_bytes());
        self.output.push(b'\n');
    }

    fn refuse(&mut self, why: &str) {
        self.resent += 1;
        let (last, next) = (self.last, self.last + 1);
        // What is in the serial buffer is forgotten.
        self.serial.clear();
        self.say(&format!("Error:{why}, Last Line: {last}"));
        self.say(&format!("Resend: {next}"));
        self.say("ok");
    }

    /// Forgets what is planned, and throws every move away for a second.
    fn stop(&mut self) {
        self.planned.clear();
        self.cleans_until = self.now + 1.0 * PACE;
    }

    fn line(&mut self, line: &str) {
        if line.trim() == "M410" {
            if self.kind == Kind::Klipper {
                self.say("// Unknown command:\"M410\"");
            } else {
                self.stop();
                self.planned_at = self.at;
            }
            return self.say("ok");
        }
        let Some((body, checksum)) = line.trim().rsplit_once('*') else {
            if !line.trim().is_empty() {
                self.refuse("No Checksum with line number");
            }
            return;
        };
        if body.bytes().fold(0, |sum, byte| sum ^ byte).to_string() != checksum {
            return self.refuse("checksum mismatch");
        }
        let (number, command) = body.split_once(' ').unwrap();
        let number: u64 = number[1..].parse().unwrap_or(0);
        if command == "M110 N0" {
            self.last = 0;
            return self.say("ok");
        }
        if number != self.last + 1 {
            return self.refuse("Line Number is not Last Line Number+1");
        }
        self.last = number;
        self.waiting = Some(command.to_owned());
    }

    fn has_room(&self) -> bool {
        match self.kind {
            Kind::Marlin => self.planned.len() < 16,
            Kind::Klipper => self.planned.back().is_none_or(|last| last.0 < self.now + AHEAD),
        }
    }

    /// True if the waiting line was done.
    fn work(&mut self) -> bool {
        let Some(command) = self.waiting.clone() else { return false };
        let words: Vec<&str> = command.split_whitespace().collect();
        let value = |letter: char| words.iter().find_map(|word| word.strip_prefix(letter)?.parse::<f64>().ok());
        match words[0] {
            "G0" | "G1" => {
                if !self.has_room() {
                    return false;
                }
                let (from, zero) = (self.planned_at, self.zero);
                let [x, y] = [('X', 0), ('Y', 1)].map(|(letter, axis)| value(letter).map_or(from[axis], |v| v + zero[axis]));
                let to = [x, y, value('Z').unwrap_or(from[2])];
                if self.now < self.cleans_until {
                    // It believes to be there.
                    self.planned_at = to;
                    self.waiting = None;
                    self.say("ok");
                    return true;
                }
                let length = (0..3).map(|axis| (to[axis] - from[axis]).powi(2)).sum::<f64>().sqrt();
                let begin = self.planned.back().map_or(self.now, |last| last.0);
                self.planned.push_back((begin + length / 50.0, to));
                self.planned_at = to;
            }
            "G4" if self.kind == Kind::Klipper => {
                if !self.has_room() {
                    return false;
                }
                let begin = self.planned.back().map_or(self.now, |last| last.0);
                self.planned.push_back((begin + value('P').unwrap_or(0.0) / 1000.0, self.planned_at));
            }
            "M114" if self.kind == Kind::Klipper => {
                // What is planned is told, wherever the pen is.
                let [x, y, z] = self.planned_at;
                self.say(&format!("X:{:.3} Y:{:.3} Z:{z:.3} E:0.000", x - self.zero[0], y - self.zero[1]));
            }
            "G4" | "M400" | "M114" if !self.planned.is_empty() => return false,
            "G92" => self.zero = [self.planned_at[0] - value('X').unwrap(), self.planned_at[1] - value('Y').unwrap()],
            "G4" => {
                if self.dwells_until == 0.0 {
                    self.dwells_until = self.now + value('P').unwrap_or(0.0) / 1000.0;
                }
                if self.now < self.dwells_until {
                    return false;
                }
                self.dwells_until = 0.0;
            }
            "M114" => {
                let [x, y, z] = [self.at[0] - self.zero[0], self.at[1] - self.zero[1], self.at[2]];
                self.say(&format!("X:{x:.2} Y:{y:.2} Z:{z:.2} E:0.00 Count X:0 Y:0 Z:0"));
            }
            "M115" if self.kind == Kind::Klipper => {
                // One line with its `ok`.
                self.waiting = None;
                self.say("ok FIRMWARE_NAME:Klipper FIRMWARE_VERSION:v0.12.0-85");
                return true;
            }
            "M115" => self.say("FIRMWARE_NAME:Marlin 2.1.2 (Jan  1 2026) SOURCE_CODE_URL:github.com/MarlinFirmware"),
            "G21" | "G90" | "M400" | "M220" | "M0" => {}
            _ => self.say(&format!("echo:Unknown command: \"{command}\"")),
        }
        self.waiting = None;
        self.say("ok");
        true
    }
}

impl Device for Printer {
    fn receive(&mut self, bytes: &[u8]) {
        if self.has_emergency_parser && self.kind == Kind::Marlin && bytes.windows(5).any(|part| part == b"M410\n") {
            self.stop();
        }
        for &byte in bytes {
            let is_hit = byte != b'\n' && !self.is_hit && self.noise.below(self.every) == 0;
            self.is_hit = byte != b'\n' && (self.is_hit || is_hit);
            let byte = if is_hit { b'x' } else { byte };
            if self.serial.len() < 128 { self.serial.push_back(byte) } else { self.lost += 1 }
        }
    }

    fn run_until(&mut self, seconds: f64) {
        while self.now < seconds {
            self.now = (self.now + 0.002).min(seconds);
            while let Some((end, to)) = self.planned.front().copied()
                && end <= self.now
            {
                self.planned.pop_front();
                if to[2] <= 0.0 && self.at[2] > 0.0 {
                    self.touches.push([to[0], to[1]]);
                }
                if self.at[2] <= 0.0 && to[2] <= 0.0 {
                    self.drawn += (to[0] - self.at[0]).hypot(to[1] - self.at[1]);
                }
                self.at = to;
            }
            while self.work() || self.waiting.is_none() {
                let Some(end) = self.serial.iter().position(|byte| *byte == b'\n') else { break };
                let line: Vec<u8> = self.serial.drain(..=end).collect();
                self.line(&String::from_utf8_lossy(&line));
            }
            if self.waiting.is_some() && self.now - self.busy_told > 2.0 {
                self.busy_told = self.now;
                self.say("echo:busy: processing");
            }
        }
    }

    fn output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.output)
    }

    fn is_done(&self) -> bool {
        self.planned.is_empty() && self.waiting.is_none()
    }
}

/// Strokes of 4 mm and dots on a z axis.
fn plot(paths: usize) -> String {
    let mut text = "; drypoint 0.1.0 for marlin-z\n; pen up is G0 Z2\nG21\nG90\nG0 Z2 F300\n; pen 1: lines 0.3\n".to_owned();
    for i in 0..paths {
        let (x, y) = (8 * (i % 20), 8 * (i / 20) + 3);
        let _ = write!(text, "G0 X{x} Y{y} F6000\nG1 Z0 F300\n");
        if i % 3 > 0 {
            let _ = writeln!(text, "G1 X{} Y{y} F3000\nG1 X{} Y{}", x + 2, x + 2, y + 2);
        }
        text += "G0 Z2 F300\n";
    }
    text + "G0 X0 Y0 F6000\nM400\n"
}

const PATHS: usize = 40;

fn length() -> f64 {
    4.0 * (0..PATHS).filter(|i| i % 3 > 0).count() as f64
}

#[test]
fn noise_on_the_line_loses_nothing() {
    at_once(many(40) as u64, |seed| {
        let (machine, job) = (Machine::of_pace(Printer::new(seed + 1, 300), 60.0), Job::new(&plot(PATHS)));
        let output = job.run(&machine, &[]);
        assert!(output.status.success() && said(&output).contains("Marlin 2.1.2 answers"), "{}", said(&output));
        let printer = machine.firmware();
        assert!(printer.resent > 0 && printer.lost == 0, "{} sent again, {} lost", printer.resent, printer.lost);
        assert!(
            printer.touches.len() == PATHS && (printer.drawn - length()).abs() < 1e-6,
            "{} {}",
            printer.touches.len(),
            printer.drawn
        );
    });
}

/// One in two is killed, the other stopped; then the drawing goes on.
fn disturbed(kind: Kind, runs: u64, most_again: usize) {
    at_once(runs, |seed| {
        let printer = Printer { kind, ..Printer::new(seed + 1, u64::MAX) };
        let (machine, job) = (Machine::of_pace(printer, PACE), Job::new(&plot(PATHS)));
        let mut child = job.start(&machine, &[]);
        std::thread::sleep(Duration::from_millis(900 + Chance(seed + 1).below(1500)));
        let signal = if seed % 2 == 0 { "-KILL" } else { "-TERM" };
        assert!(std::process::Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        let _ = child.wait();
        if signal == "-TERM" {
            machine.rest();
            assert!(machine.firmware().at[2] > 0.0, "seed {seed}: the pen is down after a stop");
        }
        if !job.file.with_extension("gcode.journal").exists() {
            return;
        }
        let output = job.run(&machine, &["--continue"]);
        assert!(output.status.success(), "seed {seed}: {}", said(&output));
        let printer = machine.firmware();
        let mut places = printer.touches.iter().map(|place| place.map(|v| v.round() as i64)).collect::<Vec<_>>();
        let again = places.len() - PATHS.min(places.len());
        places.sort_unstable();
        places.dedup();
        assert!(places.len() == PATHS && again <= most_again, "seed {seed}: {} paths, {again} again", places.len());
        assert!(printer.drawn > length() - 0.1, "seed {seed}: {} of {} mm", printer.drawn, length());
    });
}

#[test]
fn it_is_stopped_and_goes_on() {
    disturbed(Kind::Marlin, many(40) as u64, 1);
}

/// A line that Klipper has taken may be two seconds from being drawn.
#[test]
fn klipper_is_stopped_and_goes_on() {
    disturbed(Kind::Klipper, many(40) as u64, 1);
}

#[test]
fn zero_is_set_where_the_pen_stands() {
    let machine =
        Machine::of_pace(Printer { at: [50.0, 60.0, 2.0], planned_at: [50.0, 60.0, 2.0], ..Printer::new(1, u64::MAX) }, 60.0);
    let output = Job::new(&plot(4)).run(&machine, &["--at-origin"]);
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(machine.firmware().touches[0], [50.0, 63.0]);
}
