//! Where a machine stopped, and why the rest of its file cannot be had.

use thiserror::Error;

/// Where a machine stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The line that it did not finish, from 1, as a sender shows it.
    Line(usize),
    /// The byte that it did not take, from 0.
    Byte(usize),
    /// The pen-down path that it did not finish, from 1, in the order of the file.
    Path(usize),
}

/// Why a file cannot be resumed.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum ResumeError {
    /// Nothing is left to do there.
    #[error("{stop} lies beyond the last drawn path of the file; it has {count}")]
    Beyond {
        /// What was asked for, in words.
        stop: String,
        /// How many lines, bytes or paths there are, in words.
        count: String,
    },
    /// A number that is none or infinite, which no machine may get.
    #[error("{place}: '{number}' is not a finite number; write a number up to 1e30")]
    NotFinite {
        /// The line or byte, in words.
        place: String,
        /// What stands there.
        number: String,
    },
    /// The commands for pen up and pen down are not known.
    #[error(
        "the file does not say how the pen is lifted: its header needs the comments 'pen up is ...' and 'pen down is ...', as in files that drypoint writes"
    )]
    NoPen,
    /// The machine is driven by a program of its own, which alone knows where it stopped.
    #[error("the machine is driven by its own program, which alone knows where it stopped")]
    OwnProgram,
}
