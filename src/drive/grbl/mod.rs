//! GRBL 1.1 and `FluidNC`: character counting, real-time commands, status reports (gnea/grbl, `interface.md`).
//!
//! The machine holds 128 bytes of lines that it has not parsed yet. The sender counts what it sent, and each `ok` or `error` frees the
//! oldest line. Real-time commands (`? ! ~` and bytes above 0x7f) are taken out before that buffer and are not counted.

mod faults;
mod reply;
mod settings;
mod streaming;

pub use reply::{MachineState, Status};
pub use settings::{Difference, Settings, adopted, differences, enforced_reach};

use super::error::DriveError;
use super::lines::Lines;
use super::port::Port;
use crate::interrupt::Interrupt;
use reply::Reply;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Bytes that may be on their way or in the machine's line buffer of 128: one place of the ring stays free.
const MOST_OUTSTANDING: usize = 127;
/// Moves of which only segments are left, and that the planner has forgotten (`SEGMENT_BUFFER_SIZE`).
const SEGMENTED: usize = 6;
/// How long a travel across the table may take.
const TRAVELLING: Duration = Duration::from_mins(5);
/// Longest time to come to rest.
const BRAKING: Duration = Duration::from_secs(20);

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

/// Blocks of the planner where the machine does not tell their number: some builds of `grblHAL` and `FluidNC` have so many.
const MOST_BLOCKS: usize = 128;
/// How long an answer to a command may take.
const PATIENCE: Duration = Duration::from_secs(5);
/// How long a machine may take from its start to its greeting: the boot loader alone waits a second or two.
const STARTING: Duration = Duration::from_secs(6);
/// Between two questions for the state.
const ASKING: Duration = Duration::from_millis(20);
/// Soft reset.
const RESET: u8 = 0x18;

/// A conversation with a machine.
pub struct Grbl {
    port: Box<dyn Port>,
    lines: Lines,
    /// Lines that are not acknowledged, with their bytes.
    window: VecDeque<(usize, usize)>,
    status: Status,
    /// Offset of the work on the machine, which is reported now and then.
    offset: Option<[f64; 3]>,
    /// Blocks of the planner.
    blocks: usize,
    /// Percent of the file's speed.
    percent: u32,
    /// True while it holds without having been asked to.
    holds: bool,
    firmware: String,
}

impl Grbl {
    /// Meets the machine at a port.
    pub fn greet(port: Box<dyn Port>) -> Result<(Self, Greeting), DriveError> {
        let mut grbl = Self {
            port,
            lines: Lines::default(),
            window: VecDeque::new(),
            status: Status::default(),
            offset: None,
            blocks: MOST_BLOCKS,
            percent: 100,
            holds: false,
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
        let lines = self.lines.receive(&mut *self.port, wait)?;
        let replies: Vec<Reply> = lines.iter().filter_map(|line| Reply::of(line)).collect();
        for reply in &replies {
            if let Reply::Status(status) = reply {
                self.status = status.clone();
                self.offset = status.offset.or(self.offset);
            }
        }
        Ok(replies)
    }

    /// The last status report.
    pub fn status(&self) -> &Status {
        &self.status
    }

    /// The position of the pen in the work's coordinates, in millimetres, as last reported; `None` before it could be told.
    pub fn position(&self) -> Option<[f64; 3]> {
        let from_machine =
            |machine: [f64; 3]| Some(self.offset?).map(|offset| std::array::from_fn(|axis| machine[axis] - offset[axis]));
        self.status.work.or_else(|| from_machine(self.status.machine?))
    }

    /// Asks until the pen's position is known.
    pub fn locate(&mut self) -> Result<(), DriveError> {
        /// Reports after which an offset of the work was certainly told: every thirtieth does while it moves
        /// (`REPORT_WCO_REFRESH_BUSY_COUNT`).
        const REPORTS: usize = 40;
        for _ in 0..REPORTS {
            self.ask_status()?;
            if self.position().is_some() {
                break;
            }
        }
        Ok(())
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

    /// Waits until the machine stands still with nothing left to do, as far as it knows. An interrupt ends the waiting only.
    pub fn wait_until_idle(&mut self, most: Duration, interrupt: &Interrupt) -> Result<MachineState, DriveError> {
        let begun = Instant::now();
        let mut idle = 0;
        loop {
            interrupt.check()?;
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
        Ok(self.ask(text, PATIENCE, &Interrupt::never())?.0)
    }

    /// An interrupt resets the machine, which stops it at once.
    fn ask(&mut self, text: &str, most: Duration, interrupt: &Interrupt) -> Result<(Vec<String>, Settings), DriveError> {
        self.port.send(format!("{text}\n").as_bytes())?;
        let (mut said, mut settings, begun) = (Vec::new(), Settings::new(), Instant::now());
        while begun.elapsed() < most {
            if interrupt.is_raised() {
                self.port.send(&[RESET])?;
                return Err(DriveError::Interrupted);
            }
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
        Ok(self.ask("$$", PATIENCE, &Interrupt::never())?.1)
    }

    /// Asks how many blocks its planner has (`$I`, `[OPT:V,15,128]`); a machine that does not say keeps what is assumed.
    pub fn read_build(&mut self) -> Result<(), DriveError> {
        let said = self.command("$I")?;
        let blocks = said.iter().find_map(|line| line.strip_prefix("[OPT:")?.split(',').nth(1)?.parse().ok());
        self.blocks = blocks.filter(|blocks| *blocks > 0).unwrap_or(MOST_BLOCKS);
        Ok(())
    }

    /// Homes it (`$H`); it answers when it is done.
    pub fn home(&mut self, interrupt: &Interrupt) -> Result<(), DriveError> {
        /// How long homing may take.
        const HOMING: Duration = Duration::from_mins(2);
        self.ask("$H", HOMING, interrupt).map(drop)
    }

    /// Resets it softly: whatever it had not parsed or drawn is forgotten. A machine at rest keeps its position; an offset set by
    /// `G92`, which the reset takes away, is set again.
    pub fn clear(&mut self) -> Result<(), DriveError> {
        if self.position().is_none() {
            self.locate()?;
        }
        let before = self.position();
        self.port.send(&[RESET])?;
        self.window.clear();
        self.lines.clear();
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
        // What was told of the offset before is no longer true.
        (self.offset, self.status, self.percent) = (None, Status::default(), 100);
        self.locate()?;
        match (before, self.position()) {
            (Some(before), Some(after)) if self.status.state != MachineState::Alarm => self.move_zero(before, after),
            _ => Ok(()),
        }
    }

    /// Gives the place where the pen stands its coordinates again.
    fn move_zero(&mut self, wanted: [f64; 3], told: [f64; 3]) -> Result<(), DriveError> {
        /// Positions closer than this, in millimetres, are the same: reports have three decimals.
        const SAME: f64 = 0.002;
        let differing = (0..3).filter(|axis| (wanted[*axis] - told[*axis]).abs() > SAME);
        let words: Vec<String> = differing.map(|axis| format!("{}{:.3}", ["X", "Y", "Z"][axis], wanted[axis])).collect();
        if words.is_empty() { Ok(()) } else { self.set_place(&words.join(" ")) }
    }

    /// Says where the pen stands (`G92`), and asks for the new offset.
    fn set_place(&mut self, words: &str) -> Result<(), DriveError> {
        self.command(&format!("G92 {words}"))?;
        self.offset = None;
        self.locate()
    }
}
