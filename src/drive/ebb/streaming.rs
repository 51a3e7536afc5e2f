//! Sending to the board: its queue is never filled, since the time of each command is known.

use super::plan::{Limits, plan};
use super::{Ebb, GUARD, LISTENING, LONGEST_LINE, PATIENCE, Question, TRAVELLING, rates, seconds_of, steps_of};
use crate::drive::controller::{Controller, Heard, SpeedChange};
use crate::drive::error::DriveError;
use crate::drive::program::ProgramLine;
use crate::drive::stand::Stand;
use crate::geometry::Point;
use crate::interrupt::Interrupt;
use std::time::{Duration, Instant};

impl Ebb {
    /// Hears the answers to commands and questions sent before `ES`, which the board owes in order, and its own, which has five values in
    /// firmware 2 and one in firmware 3.
    fn hear_stop(&mut self) -> Result<(), DriveError> {
        let mut owed = self.window.len() + self.questions.iter().filter(|question| **question != Question::Motors).count();
        let begun = Instant::now();
        loop {
            while let Some(line) = self.unread.pop_front() {
                match owed {
                    0 if line == "OK" => return Ok(()),
                    _ if line == "OK" || line.starts_with('!') => owed = owed.saturating_sub(1),
                    _ => {}
                }
            }
            if begun.elapsed() > PATIENCE {
                return Err(DriveError::Silent {
                    seconds: PATIENCE.as_secs(),
                    expected: "an AxiDraw or another machine with an EBB",
                });
            }
            self.receive(LISTENING)?;
        }
    }

    /// The motors lost their power: the count of steps is no longer true. Motors that are disabled say so to whoever comes next.
    fn give_up(&mut self) -> Result<(), DriveError> {
        self.port.send(b"ES\r")?;
        self.hear_stop()?;
        self.forget();
        self.say("EM,0,0")
    }

    fn forget(&mut self) {
        self.window.clear();
        self.running.clear();
        self.questions.clear();
    }
}

impl Controller for Ebb {
    fn longest_line(&self) -> usize {
        if self.former_depth.is_some() { 255 } else { LONGEST_LINE }
    }

    fn has_room(&self, text: &str) -> bool {
        let now = Instant::now();
        let in_flight = self.running.iter().filter(|end| **end + GUARD > now).count();
        // In firmware 2 a stop forgets moves only: a lowering that waits would still be done.
        if self.former_depth.is_none() && text.starts_with("SP,0") && (in_flight > 0 || !self.window.is_empty()) {
            return false;
        }
        // One runs, the others wait; two places stay free, so that none blocks the stop. A queue of one holds one besides.
        in_flight < (self.depth - 1).max(2) && self.window.len() < 2
    }

    fn send(&mut self, line: usize, text: &str) -> Result<(), DriveError> {
        self.in_flight();
        self.port.send(format!("{text}\r").as_bytes())?;
        self.window.push_back(line);
        let begins = self.running.back().copied().unwrap_or_else(Instant::now).max(Instant::now());
        self.running.push_back(begins + Duration::from_secs_f64(seconds_of(text) / self.pace));
        Ok(())
    }

    fn listen(&mut self, wait: Duration) -> Result<Vec<Heard>, DriveError> {
        // Short: room comes by time, not by an answer.
        self.receive(wait.min(Duration::from_millis(2)))?;
        let lines = std::mem::take(&mut self.unread);
        let heard: Vec<Heard> =
            lines.iter().map(|line| self.understand(line)).filter(|heard| *heard != Heard::Said(String::new())).collect();
        if heard.contains(&Heard::Unpowered) {
            self.give_up()?;
        }
        Ok(heard)
    }

    fn outstanding(&self) -> Option<usize> {
        self.window.front().copied()
    }

    fn ask_state(&mut self) -> Result<(), DriveError> {
        // Answers have no names: nothing else may be on its way.
        if self.questions.is_empty() && self.window.is_empty() {
            self.port.send(b"QM\rQS\rQP\rQB\rQC\r")?;
            self.questions.extend([Question::Motors, Question::Steps, Question::Pen, Question::Button, Question::Power]);
        }
        Ok(())
    }

    fn stand(&self) -> Option<Stand> {
        self.stand
    }

    fn proves(&self, _: &ProgramLine) -> bool {
        false
    }

    fn hidden_moves(&self) -> usize {
        self.depth + 2
    }

    fn halt(&mut self) -> Result<Option<Stand>, DriveError> {
        self.port.send(b"ES\r")?;
        self.hear_stop()?;
        self.forget();
        self.read_stand()?;
        Ok(self.stand)
    }

    fn change_speed(&mut self, _: SpeedChange) -> Result<Option<u32>, DriveError> {
        Ok(None)
    }

    fn ask(&mut self, text: &str) -> Result<(), DriveError> {
        self.say(text)
    }

    fn await_rest(&mut self, most: Duration, interrupt: &Interrupt) -> Result<(), DriveError> {
        let begun = Instant::now();
        loop {
            interrupt.check()?;
            self.port.send(b"QM\r")?;
            let state = self.next_line(|line| line.starts_with("QM"))?;
            if state.split(',').skip(1).all(|field| field.trim() == "0") {
                return self.read_stand();
            }
            if begun.elapsed() > most {
                return Err(DriveError::Busy("that it still draws".to_owned()));
            }
            std::thread::sleep(LISTENING);
        }
    }

    fn travel(&mut self, [x, y]: [f64; 2], rate: f64, interrupt: &Interrupt) -> Result<(), DriveError> {
        self.wait_until_still(PATIENCE, interrupt)?;
        let from = self.stand.map_or(Point::ORIGIN, |stand| Point::new(stand.at[0], stand.at[1]));
        let mut steps = steps_of(from);
        let limits = Limits { speed: rate / 60.0, acceleration: TRAVELLING.0, deviation: TRAVELLING.1 };
        for piece in plan(&[from, Point::new(x, y)], limits) {
            if interrupt.is_raised() {
                self.halt()?;
                return Err(DriveError::Interrupted);
            }
            let to = steps_of(piece.to);
            let moved = [to[0] - steps[0], to[1] - steps[1]];
            if let Some(command) = rates::move_command(moved, rates::ticks_of(moved, piece.seconds), piece.speeds) {
                self.say(&command)?;
                steps = to;
            }
        }
        self.wait_until_still(PATIENCE, interrupt)
    }

    fn set_zero(&mut self) -> Result<(), DriveError> {
        self.say("CS")?;
        self.is_position_known = true;
        self.read_stand()
    }

    fn name(&self) -> &str {
        &self.version
    }
}
