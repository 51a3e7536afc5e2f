//! Checkpoints, for a machine that acknowledges what it has only planned.

use super::error::DriveError;
use super::program::{Program, ProgramLine};
use crate::interrupt::Interrupt;
use crate::plot::{Act, Profile};

impl Program {
    /// The program with a line after every so many seconds, between two paths.
    pub fn with_checkpoints(
        &self,
        profile: &Profile,
        text: &str,
        seconds: f64,
        interrupt: &Interrupt,
    ) -> Result<Self, DriveError> {
        let mut lines = Vec::with_capacity(self.lines.len());
        let (mut from, mut last) = (0, 0.0);
        for path in &self.paths {
            lines.extend_from_slice(&self.lines[from..path.end]);
            from = path.end;
            let end = &self.lines[path.end - 1];
            if end.until - last >= seconds {
                last = end.until;
                lines.push(ProgramLine { text: text.to_owned(), number: 0, act: Act::Mode, name: None, ..end.clone() });
            }
        }
        lines.extend_from_slice(&self.lines[from..]);
        self.with_lines(profile, lines, interrupt)
    }
}
