//! GRBL 1.1 and `FluidNC`: character counting, real-time commands, status reports (gnea/grbl, `interface.md`).
//!
//! The machine holds 128 bytes of lines that it has not parsed yet. The sender counts what it sent, and each `ok` or `error` frees the
//! oldest line. Real-time commands (`? ! ~` and bytes above 0x7f) are taken out before that buffer and are not counted.

mod faults;
mod reply;
mod settings;

pub use reply::{MachineState, Status};
pub use settings::{Difference, Settings, adopted, differences, enforced_reach};

use super::controller::{Controller, Heard, SpeedChange, Stand};
use super::error::DriveError;
use super::port::Port;
use crate::plot::Act;
use reply::Reply;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Bytes that may be on their way or in the machine's line buffer of 128: one place of the ring stays free.
const MOST_OUTSTANDING: usize = 127;
/// Moves that may be acknowledged and not yet drawn: the planner's 15 blocks and the one that the stepper has begun.
const HIDDEN_MOVES: usize = 16;
/// How long an answer to a command may take.
const PATIENCE: Duration = Duration::from_secs(5);
/// How long a machine may take from its start to its greeting: the boot loader alone waits a second or two.
const STARTING: Duration = Duration::from_secs(6);
/// Between two questions for the state.
const ASKING: Duration = Duration::from_millis(20);
/// Longest time to come to rest.
const BRAKING: Duration = Duration::from_secs(20);
/// Positions closer than this, in millimetres, are the same: reports have three decimals.
const SAME: f64 = 0.002;

/// Soft reset.
const RESET: u8 = 0x18;

/// What a machine says when it is met.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Greeting {
    /// Its firmware, such as `Grbl 1.1h`; empty if it did not say.
    pub firmware: String,
    /// Its state.
    pub status: Status,
    /// True if it restarted when the port was opened, so that it does not know where the pen is.
    pub is_restarted: bool,
}

/// A conversation with a machine.
pub struct Grbl {
    port: Box<dyn Port>,
    /// Received bytes of an unfinished line.
    unfinished: Vec<u8>,
    /// Lines that are not acknowledged, with their bytes.
    window: VecDeque<(usize, usize)>,
    status: Status,
    /// Offset of the work on the machine: reported now and then.
    offset: [f64; 3],
    firmware: String,
}

impl Grbl {
    /// Meets the machine at a port.
    pub fn greet(port: Box<dyn Port>) -> Result<(Self, Greeting), DriveError> {
        let mut grbl = Self {
            port,
            unfinished: Vec::new(),
            window: VecDeque::new(),
            status: Status::default(),
            offset: [0.0; 3],
            firmware: String::new(),
        };
        let begun = Instant::now();
        let mut greeting = Greeting::default();
        loop {
            if begun.elapsed() > STARTING {
                return Err(DriveError::Silent { seconds: STARTING.as_secs(), expected: "GRBL or FluidNC" });
            }
            grbl.port.send(b"?")?;
            let asked = Instant::now();
            let mut is_answered = false;
            while asked.elapsed() < Duration::from_millis(250) {
                for reply in grbl.hear(Duration::from_millis(50))? {
                    match reply {
                        Reply::Banner(name) => (greeting.firmware, greeting.is_restarted) = (name, true),
                        Reply::Status(_) => is_answered = true,
                        _ => {}
                    }
                }
            }
            if is_answered {
                greeting.status = grbl.status.clone();
                grbl.firmware.clone_from(&greeting.firmware);
                return Ok((grbl, greeting));
            }
        }
    }

    /// Everything that was said within `wait`. Status reports are remembered.
    fn hear(&mut self, wait: Duration) -> Result<Vec<Reply>, DriveError> {
        let mut buffer = [0; 1024];
        let count = self.port.receive(&mut buffer, wait)?;
        let mut replies = Vec::new();
        for &byte in &buffer[..count] {
            if byte != b'\n' {
                // A line of any firmware is shorter; endless noise must not fill the memory.
                if self.unfinished.len() < 4096 {
                    self.unfinished.push(byte);
                }
                continue;
            }
            let line = String::from_utf8_lossy(&self.unfinished).into_owned();
            self.unfinished.clear();
            replies.extend(Reply::of(&line));
        }
        for reply in &replies {
            if let Reply::Status(status) = reply {
                self.status = status.clone();
                self.offset = status.offset.unwrap_or(self.offset);
            }
        }
        Ok(replies)
    }

    /// The last status report.
    pub fn status(&self) -> &Status {
        &self.status
    }

    /// The position of the pen in the work's coordinates, in millimetres, as last reported.
    pub fn position(&self) -> Option<[f64; 3]> {
        let from_machine = |machine: [f64; 3]| std::array::from_fn(|axis| machine[axis] - self.offset[axis]);
        self.status.work.or_else(|| self.status.machine.map(from_machine))
    }

    /// Asks for the state until the answer comes.
    pub fn ask_status(&mut self) -> Result<MachineState, DriveError> {
        self.port.send(b"?")?;
        let asked = Instant::now();
        while asked.elapsed() < PATIENCE {
            if self.hear(ASKING)?.iter().any(|reply| matches!(reply, Reply::Status(_))) {
                return Ok(self.status.state);
            }
        }
        Err(DriveError::Silent { seconds: PATIENCE.as_secs(), expected: "GRBL or FluidNC" })
    }

    /// Waits until the machine stands still with nothing left to do, as far as it knows.
    pub fn wait_until_idle(&mut self, most: Duration) -> Result<MachineState, DriveError> {
        let begun = Instant::now();
        let mut idle = 0;
        loop {
            match self.ask_status()? {
                // Between taking a line and starting the motors it is idle for a moment.
                MachineState::Idle | MachineState::Check if idle >= 1 => return Ok(self.status.state),
                MachineState::Idle | MachineState::Check => idle += 1,
                MachineState::Alarm | MachineState::Held | MachineState::Away => return Ok(self.status.state),
                _ => idle = 0,
            }
            if begun.elapsed() > most {
                return Err(DriveError::Busy(format!("{:?}", self.status.state)));
            }
            self.hear(ASKING)?;
        }
    }

    /// Sends a line and waits for its answer; returns what the machine said besides.
    pub fn command(&mut self, text: &str) -> Result<Vec<String>, DriveError> {
        Ok(self.ask(text, PATIENCE)?.0)
    }

    fn ask(&mut self, text: &str, most: Duration) -> Result<(Vec<String>, Settings), DriveError> {
        self.port.send(format!("{text}\n").as_bytes())?;
        let (mut said, mut settings, begun) = (Vec::new(), Settings::new(), Instant::now());
        while begun.elapsed() < most {
            for reply in self.hear(ASKING)? {
                match reply {
                    Reply::Ok => return Ok((said, settings)),
                    Reply::Error(code) => {
                        return Err(DriveError::Refused { number: 0, text: text.to_owned(), code, meaning: faults::error(code) });
                    }
                    Reply::Alarm(code) => return Err(DriveError::Alarm { code, meaning: faults::alarm(code) }),
                    Reply::Setting(number, value) => drop(settings.insert(number, value)),
                    Reply::Other(text) => said.push(text),
                    Reply::Banner(_) | Reply::Status(_) => {}
                }
            }
        }
        Err(DriveError::Silent { seconds: most.as_secs(), expected: "GRBL or FluidNC" })
    }

    /// Its settings (`$$`).
    pub fn settings(&mut self) -> Result<Settings, DriveError> {
        Ok(self.ask("$$", PATIENCE)?.1)
    }

    /// Homes it (`$H`); it answers when it is done.
    pub fn home(&mut self) -> Result<(), DriveError> {
        self.ask("$H", Duration::from_mins(2)).map(drop)
    }

    /// Resets it softly: whatever it had not parsed or drawn is forgotten. A machine at rest keeps its position; an offset set by
    /// `G92` is set again.
    pub fn clear(&mut self) -> Result<(), DriveError> {
        let before = self.position();
        self.port.send(&[RESET])?;
        self.window.clear();
        self.unfinished.clear();
        let begun = Instant::now();
        loop {
            let replies = self.hear(ASKING)?;
            if let Some(Reply::Banner(name)) = replies.iter().find(|reply| matches!(reply, Reply::Banner(_))) {
                self.firmware.clone_from(name);
                break;
            }
            if begun.elapsed() > STARTING {
                return Err(DriveError::Silent { seconds: STARTING.as_secs(), expected: "GRBL or FluidNC" });
            }
        }
        self.ask_status()?;
        // Reports tell the offset only now and then; the first after a reset does.
        self.ask_status()?;
        if let (Some(before), Some(after)) = (before, self.position())
            && self.status.state != MachineState::Alarm
            && (0..2).any(|axis| (before[axis] - after[axis]).abs() > SAME)
        {
            self.command(&format!("G92 X{:.3} Y{:.3}", before[0], before[1]))?;
            self.ask_status()?;
        }
        Ok(())
    }
}

impl Controller for Grbl {
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
                Reply::Status(status) => heard.push(Heard::State { is_still: status.state == MachineState::Idle }),
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

    fn proves(&self, act: Act) -> bool {
        // The firmware waits for all motion before it switches the spindle, and before it dwells.
        matches!(act, Act::Lift | Act::Lower | Act::Wait(_))
    }

    fn hidden_moves(&self) -> usize {
        HIDDEN_MOVES
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
        let stand = self.stand();
        self.clear()?;
        Ok(stand)
    }

    fn change_speed(&mut self, change: SpeedChange) -> Result<(), DriveError> {
        let byte = match change {
            SpeedChange::Usual => 0x90,
            SpeedChange::Faster => 0x91,
            SpeedChange::Slower => 0x92,
        };
        Ok(self.port.send(&[byte])?)
    }

    fn ask(&mut self, text: &str) -> Result<(), DriveError> {
        // Longer than any wait of a pen.
        self.ask(text, Duration::from_secs(65)).map(drop)
    }

    fn wait_until_still(&mut self, most: Duration) -> Result<(), DriveError> {
        self.wait_until_idle(most).map(drop)
    }

    fn travel(&mut self, [x, y]: [f64; 2], rate: f64) -> Result<(), DriveError> {
        self.command(&format!("G1 X{x:.3} Y{y:.3} F{rate:.0}")).map(drop)
    }

    fn name(&self) -> &str {
        if self.firmware.is_empty() { "GRBL" } else { &self.firmware }
    }
}
