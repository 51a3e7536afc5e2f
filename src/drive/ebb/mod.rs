//! The `EBB`, the board of the `AxiDraw` and its kin: firmware 2.8 and later (command reference, evil-mad/EggBot, `docs/ebb.html` for 3.0
//! and `docs/ebb2.html`). Firmware 3 is spoken to in its legacy syntax, which is that of 2.8 but for the answer to `ES`.
//!
//! Its queue holds one command, or with firmware 3 up to 32. A command that finds it full blocks everything after it, the stop too. So
//! the queue is never filled: the sender knows how long each command takes.

mod faults;
mod greeting;
mod plan;
mod plot;
mod rates;
mod servo;
mod streaming;

pub use plot::Rest;

use super::controller::Heard;
use super::stand::Stand;

use super::error::DriveError;
use super::lines::Lines;
use super::port::Port;
use crate::geometry::Point;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// How long an answer may take.
const PATIENCE: Duration = Duration::from_secs(3);
const LISTENING: Duration = Duration::from_millis(5);
/// The longest line that firmware 2 reads; firmware 3 reads 256 bytes.
const LONGEST_LINE: usize = 63;
/// Travels before a drawing: their acceleration in mm/s^2, and the deviation at corners in mm.
const TRAVELLING: (f64, f64) = (400.0, 0.05);
/// A command is held for done so long after its time: it began later by its way to the board. A stuck command waits no longer.
const GUARD: Duration = Duration::from_millis(4);
/// The deepest queue that is asked for.
const DEEPEST: usize = 32;
/// Motor steps per millimetre along each diagonal: 2032 an inch at sixteenths of a step.
pub(super) const STEPS_PER_MM: f64 = 80.0;
/// The answer to `QC` tells the voltage for the motors in steps of 0.03 V, or of 0.036 V on boards before 2.3; below 5.5 or 6.5 V they do
/// not hold.
const LEAST_POWER: u32 = 180;
/// A dip of a moment is no loss: so many answers in a row tell one.
const LOW_ANSWERS: u32 = 3;

/// How the pen is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PenHeights {
    /// Percent of the servo's range with the pen up.
    pub up: f64,
    /// Percent with the pen down.
    pub down: f64,
}

impl Default for PenHeights {
    fn default() -> Self {
        Self { up: 60.0, down: 30.0 }
    }
}

/// A conversation with a board.
pub struct Ebb {
    port: Box<dyn Port>,
    lines: Lines,
    /// Lines that were received and not looked at.
    unread: VecDeque<String>,
    version: String,
    /// Commands that the queue may hold besides the one that runs.
    depth: usize,
    /// Lines that are not accepted.
    window: VecDeque<usize>,
    /// When each accepted or sent command will be done.
    running: VecDeque<Instant>,
    stand: Option<Stand>,
    /// How much faster than in life the board runs: 1, but for models.
    pace: f64,
    /// Questions on their way.
    questions: VecDeque<Question>,
    is_position_known: bool,
    /// The depth of its queue before this session, if it can be set.
    former_depth: Option<usize>,
    /// Answers in a row that told too little power.
    low: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Question {
    Motors,
    Steps,
    Pen,
    Button,
    Power,
}

impl Ebb {
    /// Its firmware, as it says.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// False if the motors were off, so that zero is where the pen stands now.
    pub fn is_position_known(&self) -> bool {
        self.is_position_known
    }

    /// The board runs faster than in life; only a model does.
    #[doc(hidden)]
    pub fn set_pace(&mut self, pace: f64) {
        self.pace = pace;
    }

    /// Receives what has arrived.
    fn receive(&mut self, wait: Duration) -> Result<(), DriveError> {
        self.unread.extend(self.lines.receive(&mut *self.port, wait)?);
        Ok(())
    }

    fn next_line(&mut self, is_it: impl Fn(&str) -> bool) -> Result<String, DriveError> {
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            while let Some(line) = self.unread.pop_front() {
                if line.starts_with('!') {
                    return Err(DriveError::Failed(faults::told(&line)));
                }
                if is_it(&line) {
                    return Ok(line);
                }
            }
            self.receive(LISTENING)?;
        }
        Err(DriveError::Silent { seconds: PATIENCE.as_secs(), expected: "an AxiDraw or another machine with an EBB" })
    }

    fn acknowledged(&mut self) -> Result<(), DriveError> {
        self.next_line(|line| line == "OK").map(drop)
    }

    /// Says a command and waits until it is taken.
    fn say(&mut self, text: &str) -> Result<(), DriveError> {
        self.port.send(format!("{text}\r").as_bytes())?;
        self.acknowledged()
    }

    /// Asks where it stands.
    fn read_stand(&mut self) -> Result<(), DriveError> {
        self.port.send(b"QS\r")?;
        let steps = self.next_line(|line| line.contains(','))?;
        self.acknowledged()?;
        self.port.send(b"QP\r")?;
        let pen = self.next_line(|line| line.ends_with('0') || line.ends_with('1'))?;
        self.acknowledged()?;
        self.stand = stand_of(&steps).map(|stand| Stand { servo: Some(if pen.ends_with('0') { 1.0 } else { 0.0 }), ..stand });
        Ok(())
    }

    /// Commands in the queue, the one that runs among them.
    fn in_flight(&mut self) -> usize {
        let now = Instant::now();
        while self.running.front().is_some_and(|end| *end + GUARD <= now) {
            self.running.pop_front();
        }
        self.running.len()
    }

    fn understand(&mut self, line: &str) -> Heard {
        if line == "OK" {
            return match self.questions.pop_front() {
                // The end of an answer.
                Some(_) => Heard::Said(String::new()),
                None => self.window.pop_front().map_or(Heard::Said(String::new()), Heard::Taken),
            };
        }
        if line.starts_with('!') {
            return Heard::Failed(faults::told(line));
        }
        match self.questions.front() {
            Some(Question::Motors) => {
                // This one has no `OK`.
                self.questions.pop_front();
                let busy = line.split(',').skip(1).any(|field| field.trim() != "0");
                Heard::State { is_still: !busy && self.window.is_empty() }
            }
            Some(Question::Steps) => {
                let servo = self.stand.and_then(|stand| stand.servo);
                self.stand = stand_of(line).map(|stand| Stand { servo, ..stand }).or(self.stand);
                Heard::Said(String::new())
            }
            Some(Question::Pen) => {
                if let Some(stand) = &mut self.stand {
                    stand.servo = Some(if line.ends_with('0') { 1.0 } else { 0.0 });
                }
                Heard::Said(String::new())
            }
            Some(Question::Button) if line.ends_with('1') => Heard::Button,
            Some(Question::Power) if !has_power(line) => {
                self.low += 1;
                if self.low >= LOW_ANSWERS { Heard::Unpowered } else { Heard::Said(String::new()) }
            }
            Some(Question::Power) => {
                self.low = 0;
                Heard::Said(String::new())
            }
            Some(Question::Button) => Heard::Said(String::new()),
            None => Heard::Said(line.to_owned()),
        }
    }
}

/// Steps of both motors at a place: they pull along the diagonals.
fn steps_of(place: Point) -> [i64; 2] {
    [place.x + place.y, place.x - place.y].map(|mm| (mm * STEPS_PER_MM).round() as i64)
}

impl Drop for Ebb {
    /// Leaves the queue as it was found, if nothing is in it.
    fn drop(&mut self) {
        if let Some(depth) = self.former_depth.filter(|_| self.window.is_empty() && self.in_flight() == 0) {
            let _ = self.port.send(format!("CU,4,{depth}\r").as_bytes());
        }
    }
}

/// True if the motors have power, by the answer to `QC`; of an answer that cannot be read nothing is concluded.
fn has_power(answer: &str) -> bool {
    let told = answer.trim_start_matches("QC,").split(',').nth(1).and_then(|value| value.trim().parse::<u32>().ok());
    told.is_none_or(|value| value >= LEAST_POWER)
}

/// The place of the steps of both motors, in millimetres.
fn stand_of(line: &str) -> Option<Stand> {
    let numbers: Vec<f64> = line.trim_start_matches("QS,").split(',').filter_map(|number| number.trim().parse().ok()).collect();
    match numbers[..] {
        [a, b] => Some(Stand { at: [0.5 * (a + b) / STEPS_PER_MM, 0.5 * (a - b) / STEPS_PER_MM, 0.0], servo: None }),
        _ => None,
    }
}

/// How long a command takes, in seconds.
fn seconds_of(text: &str) -> f64 {
    let mut fields = text.split(',');
    let name = fields.next().unwrap_or("");
    let numbers: Vec<f64> = fields.filter_map(|field| field.parse().ok()).collect();
    match (name, &numbers[..]) {
        ("SP", [_, milliseconds, ..]) => milliseconds / 1000.0,
        ("LM", [rate, steps, acceleration, other, more, change, ..]) => {
            lasting(*rate, steps.abs(), *acceleration).max(lasting(*other, more.abs(), *change)) / rates::TICKS
        }
        _ => 0.0,
    }
}

/// Ticks in which steps are made from a rate at an acceleration.
fn lasting(rate: f64, steps: f64, acceleration: f64) -> f64 {
    let full = steps * 2_f64.powi(31);
    if steps == 0.0 {
        0.0
    } else if acceleration == 0.0 {
        full / rate.max(1.0)
    } else {
        // The first time at which rate * t + acceleration * t^2 / 2 is enough.
        let root = (rate * rate + 2.0 * acceleration * full).max(0.0).sqrt();
        2.0 * full / (rate + root).max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_places_are_those_of_the_board() {
        assert!((seconds_of("LM,85899346,10,0,17180814,2,0") - 0.01).abs() < 1e-5);
        assert!((seconds_of("LM,42950000,50,13400,0,0,0") - 0.077).abs() < 1e-3);
        assert!((seconds_of("SP,1,130") - 0.13).abs() < 1e-12);
        assert_eq!(stand_of("800,-160").unwrap().at, [4.0, 6.0, 0.0]);
        assert_eq!(stand_of("QS,80,80").unwrap().at, [1.0, 0.0, 0.0]);
        assert!(has_power("0394,0300") && !has_power("0394,0012") && has_power("nonsense"));
    }
}
