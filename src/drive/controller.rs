//! What a session needs of a machine's protocol.

use super::error::DriveError;
use super::program::ProgramLine;
use super::stand::Stand;
use crate::interrupt::Interrupt;
use std::time::Duration;

/// What a machine said.
#[derive(Clone, Debug, PartialEq)]
pub enum Heard {
    /// It took a line: parsed and planned, which is not drawn.
    Taken(usize),
    /// It refused a line.
    Refused {
        /// The line, if it is known.
        line: Option<usize>,
        /// Its code.
        code: u32,
        /// In words.
        meaning: &'static str,
    },
    /// It stopped itself.
    Alarm {
        /// Its code.
        code: u32,
        /// In words.
        meaning: &'static str,
    },
    /// It failed, in its own words.
    Failed(String),
    /// It restarted.
    Restarted,
    /// Its motors have no power.
    Unpowered,
    /// Whether it stands still.
    State {
        /// True if it does, with nothing left to draw.
        is_still: bool,
    },
    /// Its button was pressed.
    Button,
    /// Anything else.
    Said(String),
}

/// A change of the speed at which a machine draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpeedChange {
    /// As the file says.
    Usual,
    /// A tenth faster.
    Faster,
    /// A tenth slower.
    Slower,
}

impl SpeedChange {
    /// The percent of the file's speed after the change.
    pub(super) fn of(self, percent: u32) -> u32 {
        match self {
            Self::Usual => 100,
            Self::Faster => (percent + 10).min(200),
            Self::Slower => percent.saturating_sub(10).max(10),
        }
    }
}

/// A machine's protocol.
pub trait Controller {
    /// The longest line that it can take, in bytes.
    fn longest_line(&self) -> usize;

    /// True if a line may be sent now.
    fn has_room(&self, text: &str) -> bool;

    /// Sends a line, for which there must be room.
    fn send(&mut self, line: usize, text: &str) -> Result<(), DriveError>;

    /// What was heard; waits up to `wait` for the first of it.
    fn listen(&mut self, wait: Duration) -> Result<Vec<Heard>, DriveError>;

    /// The oldest line that was sent and not taken.
    fn outstanding(&self) -> Option<usize>;

    /// Asks for the state, which [`listen`](Self::listen) hears.
    fn ask_state(&mut self) -> Result<(), DriveError>;

    /// True if it answers such a question only after what was sent before, so that asking holds up what follows.
    fn answers_in_turn(&self) -> bool {
        false
    }

    /// Where the pen was when it was last told.
    fn stand(&self) -> Option<Stand>;

    /// True if taking a line proves that everything before it is drawn.
    fn proves(&self, line: &ProgramLine) -> bool;

    /// A line that proves it, for a machine to which no line of a file does.
    fn checkpoint(&self) -> Option<&'static str> {
        None
    }

    /// The number of moves that may be taken and not drawn.
    fn hidden_moves(&self) -> usize;

    /// How long it may say nothing after it was asked, besides the time of the line that it draws.
    fn patience(&self) -> Duration {
        Duration::from_secs(5)
    }

    /// Stops at once and forgets what was sent; the machine keeps its position, which is returned.
    fn halt(&mut self) -> Result<Option<Stand>, DriveError>;

    /// Draws faster or slower from now on; returns the percent of the file's speed, or `None` if the machine cannot.
    fn change_speed(&mut self, change: SpeedChange) -> Result<Option<u32>, DriveError>;

    /// Sends a line of its own and waits until it is taken. Nothing may be outstanding.
    fn ask(&mut self, text: &str) -> Result<(), DriveError>;

    /// Waits until the machine stands still with nothing left to do; at most so long. An interrupt ends the waiting only.
    fn await_rest(&mut self, most: Duration, interrupt: &Interrupt) -> Result<(), DriveError>;

    /// The same, but an interrupt halts the machine.
    fn wait_until_still(&mut self, most: Duration, interrupt: &Interrupt) -> Result<(), DriveError> {
        let waited = self.await_rest(most, interrupt);
        if matches!(waited, Err(DriveError::Interrupted)) {
            self.halt()?;
        }
        waited
    }

    /// Moves with the pen up to a place in machine units, at machine units per minute, and waits until it is there. An interrupt halts
    /// it.
    fn travel(&mut self, to: [f64; 2], rate: f64, interrupt: &Interrupt) -> Result<(), DriveError>;

    /// Sets zero where the pen stands.
    fn set_zero(&mut self) -> Result<(), DriveError>;

    /// What it calls itself.
    fn name(&self) -> &str;
}
