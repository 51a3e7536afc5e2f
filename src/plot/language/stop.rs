//! Where a machine stopped, and why the rest of its file cannot be had.

use crate::elementary::Elementary as _;
use thiserror::Error;

/// Where a machine stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopPlace {
    /// The line that was not finished, from 1, as a sender shows it.
    Line(usize),
    /// The first byte that was not received, from 0.
    Byte(usize),
    /// The pen-down path that was not finished, from 1, in file order.
    Path(usize),
}

/// The vertex of a path that lies at least `again` units before its last one, or the first.
pub(super) fn back_along(count: usize, at: impl Fn(usize) -> (f64, f64), again: f64) -> usize {
    let mut length = 0.0;
    let mut first = count - 1;
    while first > 0 && length < again {
        let (a, b) = (at(first - 1), at(first));
        length += (a.0 - b.0).hypotenuse(a.1 - b.1);
        first -= 1;
    }
    first
}

/// Why a file cannot be resumed.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum ResumeError {
    /// The stop is past the end of the file.
    #[error("{stop} is past the end of the file, which has {count}")]
    Beyond {
        /// The given stop, such as `line 12`.
        stop: String,
        /// Number of lines, bytes or paths in the file, such as `10 lines`.
        count: String,
    },
    /// A number that is NaN, infinite or malformed, which must not reach a machine.
    #[error("{place}: '{number}' is not a finite number; write a number up to 1e30")]
    NotFinite {
        /// The line or byte, such as `line 12`.
        place: String,
        /// The text found there.
        number: String,
    },
    /// The file's header does not name its pen commands.
    #[error(
        "the file does not name its pen commands: its header needs the comments 'pen up is ...' and 'pen down is ...', as in files that drypoint writes"
    )]
    NoPen,
    /// The machine is driven by a program of its own, which alone knows where it stopped.
    #[error("the machine is driven by its own program, which alone knows where it stopped")]
    OwnProgram,
}
