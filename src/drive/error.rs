//! Why a drawing cannot be sent.

use std::io;
use thiserror::Error;

/// Why a machine does not draw.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DriveError {
    /// The ports cannot be listed.
    #[error("the ports of this computer cannot be listed: {0}")]
    Listing(String),
    /// The port cannot be opened.
    #[error("{port} cannot be opened: {error}")]
    Opening {
        /// The port.
        port: String,
        /// The system's error.
        #[source]
        error: io::Error,
    },
    /// The connection broke.
    #[error("the connection to the machine is lost: {0}")]
    Lost(#[from] io::Error),
    /// Nothing answers.
    #[error("nothing answers within {seconds} s; is it switched on, is the speed of the line right, is it {expected}?")]
    Silent {
        /// Seconds waited.
        seconds: u64,
        /// The firmware expected, such as `GRBL`.
        expected: &'static str,
    },
    /// The machine refuses a line.
    #[error("line {number}, '{text}': the machine says error {code}, {meaning}")]
    Refused {
        /// The line in the file, from 1; 0 for a line that the file does not hold.
        number: usize,
        /// The line.
        text: String,
        /// The machine's code.
        code: u32,
        /// In words, with what to do.
        meaning: &'static str,
    },
    /// The machine stopped itself.
    #[error("the machine stopped itself: alarm {code}, {meaning}")]
    Alarm {
        /// The machine's code.
        code: u32,
        /// In words, with what to do.
        meaning: &'static str,
    },
    /// The machine failed, in its own words.
    #[error("the machine says: {0}")]
    Failed(String),
    /// The machine is locked until it is homed or unlocked.
    #[error("the machine is locked after an alarm or at its start; home it, or unlock it if the pen stands where it should")]
    Locked,
    /// The machine restarted while it drew.
    #[error("the machine restarted: its power failed, or its reset button was pressed; it no longer knows where the pen is")]
    Restarted,
    /// The motors have no power.
    #[error(
        "the motors have no power, so that nobody knows where the pen is; plug it in, and put the carriage into its home corner"
    )]
    Unpowered,
    /// The machine is at something else.
    #[error("the machine is not ready: it says {0}")]
    Busy(String),
    /// The file is not for this machine.
    #[error("{0}")]
    Unfit(String),
    /// The journal cannot be kept.
    #[error("the journal cannot be written: {0}")]
    Journal(#[source] io::Error),
    /// The user stopped it.
    #[error("interrupted")]
    Interrupted,
}

impl From<crate::interrupt::Interrupted> for DriveError {
    fn from(_: crate::interrupt::Interrupted) -> Self {
        Self::Interrupted
    }
}
