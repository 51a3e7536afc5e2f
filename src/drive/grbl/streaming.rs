//! Streaming to GRBL: characters are counted.

use super::reply::{MachineState, Reply};
use super::{BRAKING, Grbl, MOST_OUTSTANDING, SEGMENTED, TRAVELLING, faults};
use crate::drive::controller::{Controller, Heard, SpeedChange};
use crate::drive::error::DriveError;
use crate::drive::program::ProgramLine;
use crate::drive::stand::Stand;
use crate::interrupt::Interrupt;
use crate::plot::Act;
use std::time::{Duration, Instant};

/// What is said when the machine's own button, or its door, holds it.
const ON_HOLD: &str = "on hold, by its own button or door; its start button goes on";

impl Controller for Grbl {
    fn longest_line(&self) -> usize {
        MOST_OUTSTANDING - 1
    }

    fn has_room(&self, text: &str) -> bool {
        self.window.iter().map(|(_, bytes)| bytes).sum::<usize>() + text.len() < MOST_OUTSTANDING
    }

    fn send(&mut self, line: usize, text: &str) -> Result<(), DriveError> {
        self.port.send(format!("{text}\n").as_bytes())?;
        self.window.push_back((line, text.len() + 1));
        Ok(())
    }

    fn listen(&mut self, wait: Duration) -> Result<Vec<Heard>, DriveError> {
        let mut heard = Vec::new();
        for reply in self.hear(wait)? {
            match reply {
                Reply::Ok => heard.extend(self.window.pop_front().map(|(line, _)| Heard::Taken(line))),
                Reply::Error(code) => {
                    let line = self.window.pop_front().map(|(line, _)| line);
                    heard.push(Heard::Refused { line, code, meaning: faults::error(code) });
                }
                Reply::Alarm(code) => heard.push(Heard::Alarm { code, meaning: faults::alarm(code) }),
                Reply::Banner(_) => heard.push(Heard::Restarted),
                Reply::Status(status) => {
                    heard.push(Heard::State { is_still: status.state == MachineState::Idle });
                    // Halting asks for the state by itself, so this hold is nobody's wish here.
                    let holds = matches!(status.state, MachineState::Holding | MachineState::Held);
                    if holds && !std::mem::replace(&mut self.holds, holds) {
                        heard.push(Heard::Said(ON_HOLD.to_owned()));
                    }
                    self.holds = holds;
                }
                Reply::Other(text) => heard.push(Heard::Said(text)),
                Reply::Setting(..) => {}
            }
        }
        Ok(heard)
    }

    fn outstanding(&self) -> Option<usize> {
        self.window.front().map(|(line, _)| *line)
    }

    fn ask_state(&mut self) -> Result<(), DriveError> {
        Ok(self.port.send(b"?")?)
    }

    fn stand(&self) -> Option<Stand> {
        Some(Stand { at: self.position()?, servo: self.status.spindle })
    }

    fn proves(&self, line: &ProgramLine) -> bool {
        // The firmware waits for all motion before it dwells. Lifting a z axis is one more move.
        matches!(line.act, Act::Wait(_))
    }

    fn hidden_moves(&self) -> usize {
        self.blocks + SEGMENTED
    }

    fn halt(&mut self) -> Result<Option<Stand>, DriveError> {
        self.port.send(b"!")?;
        let begun = Instant::now();
        loop {
            match self.ask_status()? {
                MachineState::Held | MachineState::Idle => break,
                MachineState::Alarm => return Err(DriveError::Locked),
                _ if begun.elapsed() > BRAKING => return Err(DriveError::Busy("that it does not stop".to_owned())),
                _ => {}
            }
        }
        if self.position().is_none() {
            self.locate()?;
        }
        let stand = self.stand();
        self.clear()?;
        Ok(stand)
    }

    fn change_speed(&mut self, change: SpeedChange) -> Result<Option<u32>, DriveError> {
        let byte = match change {
            SpeedChange::Usual => 0x90,
            SpeedChange::Faster => 0x91,
            SpeedChange::Slower => 0x92,
        };
        self.port.send(&[byte])?;
        self.percent = change.of(self.percent);
        Ok(Some(self.percent))
    }

    fn ask(&mut self, text: &str) -> Result<(), DriveError> {
        // Longer than any wait of a pen.
        self.ask(text, Duration::from_secs(65), &Interrupt::never()).map(drop)
    }

    fn await_rest(&mut self, most: Duration, interrupt: &Interrupt) -> Result<(), DriveError> {
        self.wait_until_idle(most, interrupt).map(drop)
    }

    fn travel(&mut self, [x, y]: [f64; 2], rate: f64, interrupt: &Interrupt) -> Result<(), DriveError> {
        self.command(&format!("G1 X{x:.3} Y{y:.3} F{rate:.0}"))?;
        self.wait_until_still(TRAVELLING, interrupt)
    }

    fn set_zero(&mut self) -> Result<(), DriveError> {
        self.set_place("X0 Y0")
    }

    fn name(&self) -> &str {
        if self.firmware.is_empty() { "GRBL" } else { &self.firmware }
    }
}
