//! What the lines of a machine's file make it do, in any language.

use crate::geometry::Point;
use std::borrow::Cow;

/// What a line makes the machine do.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Act {
    /// Nothing that moves: a comment, a mode, an empty line.
    Mode,
    /// The comment that names the pen in the holder.
    Pen(u32),
    /// Lifts the pen.
    Lift,
    /// Lowers the pen.
    Lower,
    /// Waits for a number of seconds.
    Wait(f64),
    /// Waits for the user.
    Pause,
    /// Moves straight, as fast as the machine travels.
    Rapid,
    /// Moves straight, at machine units per minute.
    Line(f64),
    /// Moves on an arc, at machine units per minute.
    Arc {
        /// Its centre, in machine units.
        centre: Point,
        /// The signed angle, in radians; positive is anticlockwise.
        sweep: f64,
        /// Machine units per minute.
        rate: f64,
    },
}

impl Act {
    /// True if a line moves along the page.
    pub const fn moves(self) -> bool {
        matches!(self, Self::Rapid | Self::Line(_) | Self::Arc { .. })
    }
}

/// A line with what it does.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed<'a> {
    /// The line without its end, or the instruction with it; empty if the line before or after says it.
    pub text: Cow<'a, str>,
    /// What it does.
    pub act: Act,
    /// The position after it: x, y, z, in machine units.
    pub at: [f64; 3],
}
