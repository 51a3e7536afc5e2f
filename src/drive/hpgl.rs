//! HP-GL plotters: the buffer's free space is asked for (`ESC.B`), or the line itself holds the sender back.
//!
//! Device control instructions are those of the HP 7475A (Interfacing and Programming Manual, chapter on device control): `ESC.B` tells
//! the free bytes of the buffer, `ESC.L` its size once it is empty, `ESC.O` the extended status, `ESC.E` the error, `ESC.K` forgets what
//! is buffered, `ESC.J` an unfinished device control instruction. `OA` tells position and pen, `OI` the model.
//!
//! A Roland DXY-1100, 1200 or 1300 has the same ones in RD-GL I mode (DXY-1300/1200/1100 Command Reference Manual, sections 5.3 and 5.4),
//! with the same codes of status; its buffer holds 1024 bytes too, and its pin 20 falls when that is full.

use super::controller::{Controller, Heard, SpeedChange};
use super::error::DriveError;
use super::lines::Lines;
use super::port::{Handshake, Port};
use super::program::ProgramLine;
use super::stand::Stand;
use crate::interrupt::Interrupt;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// How long an answer may take: it waits behind the instruction that is being drawn.
const PATIENCE: Duration = Duration::from_secs(30);
/// How long the first answer may take.
const MEETING: Duration = Duration::from_secs(4);
/// Bytes of the buffer that are never used: an escape sequence may arrive while it is full.
const SPARE: usize = 16;
/// Between two questions for free space while the buffer is full.
const ASKING: Duration = Duration::from_millis(50);
/// Between two questions for errors.
const ERRORS: Duration = Duration::from_secs(1);
/// Instructions that are taken out of the buffer and not yet drawn: the one under the pen, and one that is being read.
const HIDDEN_MOVES: usize = 2;

/// Extended status: the buffer is empty.
const BUFFER_EMPTY: u32 = 8;
/// Extended status: the machine was told by its front panel to wait, or its paper is loose.
const NOT_READY: u32 = 16 | 32;

/// A conversation with a plotter.
pub struct Hpgl {
    port: Box<dyn Port>,
    handshake: Handshake,
    model: String,
    /// Size of the buffer in bytes.
    capacity: usize,
    /// Bytes that are certainly free.
    free: usize,
    /// Bytes sent since the last question for free space was answered.
    asked: Option<Instant>,
    errors_asked: Instant,
    /// Instructions that are, or may be, in the buffer, with their bytes.
    window: VecDeque<(usize, usize)>,
    lines: Lines,
    /// Answers that were received and not looked at.
    unread: VecDeque<String>,
    /// Questions that are not answered, in order.
    questions: VecDeque<Question>,
    stand: Option<Stand>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Question {
    Free { sent: usize },
    Status,
    Error,
}

impl Hpgl {
    /// Meets the plotter at a port.
    pub fn greet(port: Box<dyn Port>, handshake: Handshake) -> Result<Self, DriveError> {
        let mut plotter = Self {
            port,
            handshake,
            model: String::new(),
            capacity: 0,
            free: 0,
            asked: None,
            errors_asked: Instant::now(),
            window: VecDeque::new(),
            lines: Lines::default(),
            unread: VecDeque::new(),
            questions: VecDeque::new(),
            stand: None,
        };
        // An unfinished device control instruction of an earlier sender is forgotten, and its buffer.
        plotter.port.send(b"\x1b.J\x1b.K")?;
        if handshake == Handshake::Software {
            plotter.port.send(b"\x1b.I81;;17:\x1b.N;19:")?;
        }
        plotter.drain()?;
        plotter.port.send(b"\x1b.E")?;
        plotter.answer(MEETING)?;
        // Where an earlier drawing left the pen.
        plotter.port.send(b";OA;")?;
        plotter.stand = stand(&plotter.answer(PATIENCE)?);
        plotter.port.send(b"\x1b.B")?;
        plotter.capacity = plotter.number(MEETING)?.max(64) as usize;
        plotter.free = plotter.capacity;
        plotter.port.send(b"OI;")?;
        plotter.model = plotter.answer(PATIENCE)?;
        Ok(plotter)
    }

    /// Throws away what was said to somebody else.
    fn drain(&mut self) -> Result<(), DriveError> {
        let mut buffer = [0; 256];
        while self.port.receive(&mut buffer, Duration::from_millis(60))? > 0 {}
        self.lines.clear();
        self.unread.clear();
        self.questions.clear();
        Ok(())
    }

    /// The next answer, when no other question is open.
    fn answer(&mut self, most: Duration) -> Result<String, DriveError> {
        let begun = Instant::now();
        while self.unread.is_empty() {
            self.unread.extend(self.lines.receive(&mut *self.port, Duration::from_millis(20))?);
            if begun.elapsed() > most {
                return Err(DriveError::Silent { seconds: most.as_secs(), expected: "an HP-GL plotter that is on line" });
            }
        }
        Ok(self.unread.pop_front().unwrap_or_default())
    }

    fn number(&mut self, most: Duration) -> Result<u32, DriveError> {
        Ok(self.answer(most)?.trim().parse().unwrap_or(0))
    }

    fn ask_for(&mut self, question: Question) -> Result<(), DriveError> {
        let text: &[u8] = match question {
            Question::Free { .. } => b"\x1b.B",
            Question::Status => b"\x1b.O",
            Question::Error => b"\x1b.E",
        };
        self.port.send(text)?;
        self.questions.push_back(question);
        Ok(())
    }

    fn in_buffer(&self) -> usize {
        self.window.iter().map(|(_, bytes)| bytes).sum()
    }

    /// What an answer means.
    fn understand(&mut self, answer: &str, heard: &mut Vec<Heard>) {
        let number: u32 = answer.trim().parse().unwrap_or(0);
        match self.questions.pop_front() {
            Some(Question::Free { sent }) => {
                // Of what had been sent when it was asked, so much is still in the buffer.
                let held = self.capacity.saturating_sub(number as usize);
                let since = self.in_buffer().saturating_sub(sent);
                self.free = (number as usize).saturating_sub(since);
                while self.window.len() > 1 && self.in_buffer() - self.window[0].1 >= held + since {
                    heard.extend(self.window.pop_front().map(|(line, _)| Heard::Taken(line)));
                }
                if held == 0 && since == 0 {
                    heard.extend(self.window.drain(..).map(|(line, _)| Heard::Taken(line)));
                }
                self.asked = None;
            }
            Some(Question::Status) => {
                let is_still = number & BUFFER_EMPTY != 0 && number & NOT_READY == 0;
                heard.push(Heard::State { is_still: is_still && self.window.is_empty() });
            }
            Some(Question::Error) if number != 0 => {
                heard.push(Heard::Refused {
                    line: self.window.front().map(|(line, _)| *line),
                    code: number,
                    meaning: fault(number),
                });
            }
            Some(Question::Error) => {}
            None => heard.push(Heard::Said(answer.to_owned())),
        }
    }
}

/// Position and pen, from the answer to `OA`.
fn stand(answer: &str) -> Option<Stand> {
    let numbers: Vec<f64> = answer.split(',').filter_map(|number| number.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, pen, ..] => Some(Stand { at: [x, y, 0.0], servo: Some(pen) }),
        _ => None,
    }
}

/// Errors of the interface in words (`ESC.E`).
pub(super) fn fault(code: u32) -> &'static str {
    match code {
        10 => "it was asked something while it still answered; only one program may use the port",
        11 => "an escape sequence was garbled; check the cable and the speed of the line",
        12 => "an escape sequence holds a character that it does not know; check the cable",
        13 => "a number of an escape sequence is out of range; check the profile's preamble",
        14 => "an escape sequence has too many numbers; check the profile's preamble",
        15 => {
            "bytes were lost on the line: parity, framing or overrun; the speed, parity and stop bits must be those of its switches"
        }
        16 => "its buffer ran over, and lines are lost: it does not keep the handshake; choose another one",
        _ => "which its manual explains",
    }
}

impl Controller for Hpgl {
    fn longest_line(&self) -> usize {
        self.capacity.saturating_sub(SPARE)
    }

    fn has_room(&self, text: &str) -> bool {
        match self.handshake {
            Handshake::None => self.free >= text.len() + SPARE,
            // The line holds back what does not fit.
            Handshake::Software | Handshake::Hardware => self.in_buffer() + text.len() <= self.capacity,
        }
    }

    fn send(&mut self, line: usize, text: &str) -> Result<(), DriveError> {
        self.port.send(text.as_bytes())?;
        self.free = self.free.saturating_sub(text.len());
        self.window.push_back((line, text.len()));
        Ok(())
    }

    fn listen(&mut self, wait: Duration) -> Result<Vec<Heard>, DriveError> {
        let is_full = self.free < self.capacity / 2 || self.handshake != Handshake::None;
        if self.asked.is_none_or(|asked| asked.elapsed() > PATIENCE) && !self.window.is_empty() && is_full {
            self.ask_for(Question::Free { sent: self.in_buffer() })?;
            self.asked = Some(Instant::now());
        }
        if self.errors_asked.elapsed() >= ERRORS {
            self.ask_for(Question::Error)?;
            self.errors_asked = Instant::now();
        }
        let mut heard = Vec::new();
        for answer in self.lines.receive(&mut *self.port, wait.min(ASKING))? {
            self.understand(&answer, &mut heard);
        }
        Ok(heard)
    }

    fn outstanding(&self) -> Option<usize> {
        self.window.front().map(|(line, _)| *line)
    }

    fn ask_state(&mut self) -> Result<(), DriveError> {
        if !self.window.is_empty() && self.asked.is_none() {
            self.ask_for(Question::Free { sent: self.in_buffer() })?;
            self.asked = Some(Instant::now());
        }
        if self.questions.contains(&Question::Status) { Ok(()) } else { self.ask_for(Question::Status) }
    }

    fn stand(&self) -> Option<Stand> {
        self.stand
    }

    fn proves(&self, _: &ProgramLine) -> bool {
        false
    }

    fn hidden_moves(&self) -> usize {
        HIDDEN_MOVES
    }

    fn patience(&self) -> Duration {
        PATIENCE
    }

    fn halt(&mut self) -> Result<Option<Stand>, DriveError> {
        self.port.send(b"\x1b.K")?;
        self.window.clear();
        self.drain()?;
        // The instruction under the pen is drawn to its end.
        self.port.send(b";OA;PU;")?;
        self.stand = stand(&self.answer(PATIENCE)?);
        self.free = self.capacity;
        self.asked = None;
        Ok(self.stand)
    }

    fn change_speed(&mut self, _: SpeedChange) -> Result<Option<u32>, DriveError> {
        Ok(None)
    }

    fn ask(&mut self, text: &str) -> Result<(), DriveError> {
        self.port.send(text.as_bytes())?;
        self.wait_until_still(PATIENCE, &Interrupt::never())
    }

    fn await_rest(&mut self, most: Duration, interrupt: &Interrupt) -> Result<(), DriveError> {
        let begun = Instant::now();
        self.drain()?;
        loop {
            interrupt.check()?;
            self.port.send(b"\x1b.O")?;
            let status = self.number(PATIENCE)?;
            if status & NOT_READY != 0 {
                return Err(DriveError::Busy(
                    "that it waits: its view button is pressed, or no paper lies under its wheels".to_owned(),
                ));
            }
            if status & BUFFER_EMPTY != 0 {
                return Ok(());
            }
            if begun.elapsed() > most {
                return Err(DriveError::Busy("that it still draws".to_owned()));
            }
            std::thread::sleep(ASKING);
        }
    }

    fn travel(&mut self, [x, y]: [f64; 2], _: f64, interrupt: &Interrupt) -> Result<(), DriveError> {
        self.port.send(format!("PU{x:.0},{y:.0};").as_bytes())?;
        self.wait_until_still(PATIENCE, interrupt)
    }

    fn set_zero(&mut self) -> Result<(), DriveError> {
        Err(DriveError::Unfit("an HP-GL plotter has its own zero, at a corner of its paper".to_owned()))
    }

    fn name(&self) -> &str {
        &self.model
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_of_the_interface_has_words_that_help() {
        for code in 10..=16 {
            assert!(fault(code) != fault(99) && fault(code).len() > 20, "error {code}");
        }
        assert_eq!(stand("120,-34,1\r"), Some(Stand { at: [120.0, -34.0, 0.0], servo: Some(1.0) }));
        assert_eq!(stand("nonsense"), None);
    }
}
