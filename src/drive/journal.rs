//! The journal: what was sent, taken and certainly drawn, so that a drawing can be continued after anything.
//!
//! One line of JSON for the beginning, then one for each path and each quarter of a second. A line cut off by a crash is ignored.

use super::error::DriveError;
use serde::{Deserialize, Serialize};
use std::io;
use std::time::{Duration, Instant};

/// Where a journal is kept.
pub trait Ledger {
    /// Appends a line; it must survive the end of this process.
    fn append(&mut self, line: &str) -> io::Result<()>;

    /// Asks that everything appended survives a loss of power. It may happen a little later, so that drawing does not wait.
    fn sync(&mut self) -> io::Result<()>;
}

/// What a journal begins with.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Beginning {
    /// The file's name.
    pub file: String,
    /// SHA-256 of the file, in hexadecimal.
    pub sha256: String,
    /// The profile's name.
    pub profile: String,
    /// The firmware, as the machine said.
    pub machine: String,
    /// The paths that are drawn, by their numbers in the file; none means all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub paths: Option<Vec<usize>>,
}

/// A later line: numbers are lines of the file, from 1.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Record {
    /// Everything before this line is certainly drawn.
    pub drawn: usize,
    /// Everything before this line is taken.
    pub taken: usize,
    /// Everything before this line is sent.
    pub sent: usize,
    /// The number of the path that comes next or is under the pen, from 1.
    pub path: usize,
    /// Where the pen was, in machine units.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
    /// Whether it was down there, if the machine knows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub is_down: Option<bool>,
    /// True at the end.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_done: bool,
    /// True if the drawing was stopped, and the pen lifted.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_stopped: bool,
}

/// Between two records on the same path.
const RECORDING: Duration = Duration::from_millis(250);
/// Between two syncs.
const SYNCING: Duration = Duration::from_secs(1);

/// A journal that is being written.
pub struct Journal<'a> {
    ledger: &'a mut dyn Ledger,
    last: Record,
    recorded: Instant,
    synced: Instant,
}

impl<'a> Journal<'a> {
    /// Begins a journal.
    pub fn begin(ledger: &'a mut dyn Ledger, beginning: &Beginning) -> Result<Self, DriveError> {
        let line = serde_json::to_string(beginning).map_err(|error| DriveError::Journal(error.into()))?;
        ledger.append(&line).and_then(|()| ledger.sync()).map_err(DriveError::Journal)?;
        Ok(Self { ledger, last: Record::default(), recorded: Instant::now(), synced: Instant::now() })
    }

    /// Goes on with a journal that has its beginning.
    pub fn go_on(ledger: &'a mut dyn Ledger) -> Self {
        Self { ledger, last: Record::default(), recorded: Instant::now(), synced: Instant::now() }
    }

    /// Writes where the drawing stands, if it is time.
    pub(super) fn note(&mut self, record: Record) -> Result<(), DriveError> {
        let is_other_path = record.path != self.last.path;
        let is_last = record.is_done || record.is_stopped;
        if record == self.last || !is_other_path && !is_last && self.recorded.elapsed() < RECORDING {
            return Ok(());
        }
        let line = serde_json::to_string(&record).map_err(|error| DriveError::Journal(error.into()))?;
        self.ledger.append(&line).map_err(DriveError::Journal)?;
        (self.last, self.recorded) = (record, Instant::now());
        if is_other_path || is_last || self.synced.elapsed() >= SYNCING {
            self.ledger.sync().map_err(DriveError::Journal)?;
            self.synced = Instant::now();
        }
        Ok(())
    }
}

/// Reads a journal: its beginning and its last whole record.
pub fn read_journal(text: &str) -> Option<(Beginning, Record)> {
    let mut lines = text.lines();
    let beginning = serde_json::from_str(lines.next()?).ok()?;
    let last = lines.rev().find_map(|line| serde_json::from_str(line).ok());
    Some((beginning, last.unwrap_or(Record { drawn: 1, taken: 1, sent: 1, path: 1, ..Record::default() })))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_was_cut_off_is_ignored() {
        let beginning =
            Beginning { file: "a.gcode".into(), sha256: "00".into(), profile: "p".into(), machine: "Grbl".into(), paths: None };
        let record = Record { drawn: 12, taken: 20, sent: 25, path: 3, at: Some([1.0, 2.0, 0.0]), ..Record::default() };
        let text =
            format!("{}\n{}\n{{\"drawn\":4", serde_json::to_string(&beginning).unwrap(), serde_json::to_string(&record).unwrap());
        assert_eq!(read_journal(&text), Some((beginning.clone(), record)));
        let (_, first) = read_journal(&serde_json::to_string(&beginning).unwrap()).unwrap();
        assert_eq!((first.drawn, first.path), (1, 1));
        assert_eq!(read_journal("nonsense"), None);
        assert_eq!(read_journal(""), None);
    }
}
