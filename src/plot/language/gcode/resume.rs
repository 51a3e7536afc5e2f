//! Resumes G-code: one command per line; the header names the commands that lift and lower the pen.

use super::numbers::check_gcode;
use super::words::word;
use crate::plot::language::stop::back_along;
use crate::plot::language::{ResumeError, StopPlace};
use std::fmt::Write as _;

/// The rest of a G-code file from the line that was not finished; `again` is how many machine units are drawn again.
pub(in crate::plot::language) fn resume(text: &str, stop: StopPlace, again: f64) -> Result<String, ResumeError> {
    check_gcode(text)?;
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    let pen = PenWords::of(&lines).ok_or(ResumeError::NoPen)?;
    let line = line_of(text, &lines, &pen, stop)?;
    let mut state = State::default();
    for (i, text) in lines[..line].iter().enumerate() {
        state.take(i, text, &pen);
    }
    let mut rest = String::new();
    let first_up = lines.iter().position(|text| pen.lifts(text)).unwrap_or(0);
    if line <= first_up {
        lines.iter().for_each(|text| push(&mut rest, text));
        return Ok(rest);
    }
    lines[..=first_up].iter().for_each(|text| push(&mut rest, text));
    wait_after(&mut rest, &lines, first_up);
    if state.is_down || state.draws_before_next_pen(&lines, &pen) {
        state.restore_pen(&mut rest, &lines, &pen);
    }
    let from = if state.is_down { state.restore_path(&mut rest, &lines, again) } else { state.last_up + 1 };
    lines[from..].iter().for_each(|text| push(&mut rest, text));
    Ok(rest)
}

fn push(rest: &mut String, line: &str) {
    rest.push_str(line);
    rest.push('\n');
}

/// Appends the dwell that follows a pen command, if any.
fn wait_after(rest: &mut String, lines: &[&str], i: usize) {
    if let Some(wait) = lines.get(i + 1).filter(|line| line.starts_with("G4")) {
        push(rest, wait);
    }
}

/// The line at which the machine stopped, from 0.
fn line_of(text: &str, lines: &[&str], pen: &PenWords, stop: StopPlace) -> Result<usize, ResumeError> {
    let beyond = |stop: String, count: String| Err(ResumeError::Beyond { stop, count });
    match stop {
        StopPlace::Line(line) if line > lines.len() => beyond(format!("line {line}"), format!("{} lines", lines.len())),
        StopPlace::Line(line) => Ok(line.max(1) - 1),
        StopPlace::Byte(byte) if byte >= text.len() => beyond(format!("byte {byte}"), format!("{} bytes", text.len())),
        StopPlace::Byte(byte) => Ok(text.as_bytes()[..byte].iter().filter(|b| **b == b'\n').count()),
        StopPlace::Path(path) => {
            let falls: Vec<usize> = (0..lines.len()).filter(|&i| pen.lowers(lines[i])).collect();
            match falls.get(path.max(1) - 1) {
                Some(&line) => Ok(line),
                None => beyond(format!("path {path}"), format!("{} paths", falls.len())),
            }
        }
    }
}

/// The commands that move the pen.
pub(super) struct PenWords<'a> {
    pub up: &'a str,
    /// `None` for a z axis, whose height differs from path to path.
    pub down: Option<&'a str>,
}

impl<'a> PenWords<'a> {
    /// From the comments in a file's header.
    pub fn of(lines: &[&'a str]) -> Option<Self> {
        let said = |what: &str| {
            let line = lines.iter().find_map(|line| line.trim_start_matches(['(', ';', ' ']).strip_prefix(what))?;
            Some(line.trim_end_matches(')').trim())
        };
        Some(Self { up: said("pen up is ")?, down: said("pen down is ") })
    }

    pub fn lifts(&self, line: &str) -> bool {
        line == self.up || self.down.is_none() && line.starts_with(self.up) && line[self.up.len()..].starts_with(" F")
    }

    /// True if a line after a pen's name pauses for the user: `M0`, `PAUSE` or another command of the machine, but not a move,
    /// dwell, comment or pen command.
    fn pauses(&self, line: &str) -> bool {
        let is_code = line.starts_with('G') && line[1..].starts_with(|c: char| c.is_ascii_digit());
        !line.is_empty() && !is_code && !line.starts_with(['(', ';', '%']) && !self.lifts(line) && !self.lowers(line)
    }

    pub fn lowers(&self, line: &str) -> bool {
        match self.down {
            Some(down) => line == down,
            None => word(line, 'Z').is_some() && word(line, 'X').is_none() && word(line, 'Y').is_none() && !self.lifts(line),
        }
    }
}

/// True if a line is the comment that names the pen in the holder, such as `(pen 2: red 0.5)`.
pub(super) fn names_pen(line: &str) -> bool {
    let comment = line.strip_prefix(['(', ';']).map(str::trim_start);
    let number = comment.and_then(|text| text.strip_prefix("pen ")?.split_once(':')).map(|(number, _)| number);
    number.is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
}

/// A vertex of the path being drawn: the line that moves there, the position, and the height if it varies along the path.
#[derive(Clone, Copy)]
struct Vertex {
    line: usize,
    at: (f64, f64),
    z: Option<f64>,
}

#[derive(Default)]
struct State {
    at: (f64, f64),
    z: Option<f64>,
    feed: Option<f64>,
    is_down: bool,
    last_up: usize,
    last_down: usize,
    /// The last line that named the pen in use.
    pen: Option<usize>,
    /// The line of the last travel move.
    travel: Option<usize>,
    path: Vec<Vertex>,
}

impl State {
    fn take(&mut self, i: usize, line: &str, pen: &PenWords) {
        if names_pen(line) {
            self.pen = Some(i);
        }
        self.z = word(line, 'Z').or(self.z);
        if pen.lifts(line) {
            self.is_down = false;
            self.last_up = i;
            return;
        }
        if pen.lowers(line) {
            self.is_down = true;
            self.last_down = i;
            self.path = vec![Vertex { line: i, at: self.at, z: word(line, 'Z') }];
            return;
        }
        let (x, y) = (word(line, 'X'), word(line, 'Y'));
        if line.starts_with('G') && (x.is_some() || y.is_some()) {
            self.at = (x.unwrap_or(self.at.0), y.unwrap_or(self.at.1));
            if self.is_down {
                self.path.push(Vertex { line: i, at: self.at, z: self.path[0].z.and(self.z) });
            } else {
                self.travel = Some(i);
            }
        }
        self.feed = if self.is_down { word(line, 'F').or(self.feed) } else { self.feed };
    }

    /// True if the pen in the holder has a path left to draw before the next pen is named.
    fn draws_before_next_pen(&self, lines: &[&str], pen: &PenWords) -> bool {
        let left = lines[self.last_up + 1..].iter().take_while(|line| !names_pen(line));
        left.into_iter().any(|line| pen.lowers(line))
    }

    /// Appends the comment that names the pen, and the pause that follows it, if any.
    fn restore_pen(&self, rest: &mut String, lines: &[&str], pen: &PenWords) {
        let Some(i) = self.pen else { return };
        push(rest, lines[i]);
        if let Some(pause) = lines.get(i + 1).filter(|line| pen.pauses(line)) {
            push(rest, pause);
        }
    }

    /// Goes back at least `again` units along the path and lowers the pen there; returns the line to continue from.
    fn restore_path(&self, rest: &mut String, lines: &[&str], again: f64) -> usize {
        let start = self.path[back_along(self.path.len(), |i| self.path[i].at, again)];
        let travel = self.travel.map_or("G0", |i| lines[i]);
        let word_of_travel = travel.split_whitespace().next().unwrap_or("G0");
        let feed_of_travel = word(travel, 'F').map(|feed| format!(" F{feed}")).unwrap_or_default();
        let _ = writeln!(rest, "{word_of_travel} X{} Y{}{feed_of_travel}", number(start.at.0), number(start.at.1));
        let down = lines[self.last_down];
        match (start.z, word(down, 'Z')) {
            (Some(z), Some(_)) => {
                let feed = word(down, 'F').map(|feed| format!(" F{feed}")).unwrap_or_default();
                let _ = writeln!(rest, "G1 Z{}{feed}", number(z));
            }
            _ => push(rest, down),
        }
        wait_after(rest, lines, self.last_down);
        let mut next = start.line + 1;
        if lines.get(next).is_some_and(|line| line.starts_with("G4")) {
            next += 1;
        }
        // The feed is in the path's first line, which may not be part of the rest.
        if let (Some(line), Some(feed)) = (lines.get(next).filter(|line| word(line, 'X').is_some()), self.feed)
            && word(line, 'F').is_none()
        {
            let _ = writeln!(rest, "{line} F{feed}");
            next += 1;
        }
        next
    }
}

fn number(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "(drypoint)\n(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nM3 S300\nG4 P0.15\n(pen 1: dots 0.3)\nG0 X1 Y1\nM3 S700\nG4 P0.2\n\
                        G1 X5 Y1 F3000\nG1 X10 Y1\nG1 X10 Y9\nM3 S300\nG4 P0.15\nG0 X0 Y0\n(pen 2: red 0.5)\nM0\nG0 X2 Y2\nM3 S700\nG4 P0.2\nM3 S300\nG4 P0.15\nG0 X0 Y0\n";

    #[test]
    fn in_a_path_it_goes_back_a_little_with_the_feed() {
        let rest = resume(FILE, StopPlace::Line(13), 3.0).unwrap();
        let expected = "(drypoint)\n(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nM3 S300\nG4 P0.15\n(pen 1: dots 0.3)\n\
                        G0 X5 Y1\nM3 S700\nG4 P0.2\nG1 X10 Y1 F3000\nG1 X10 Y9\nM3 S300\n";
        assert!(rest.starts_with(expected), "{rest}");
        assert!(rest.ends_with("G0 X0 Y0\n"));
    }

    #[test]
    fn between_paths_it_says_the_pen_and_waits() {
        let rest = resume(FILE, StopPlace::Line(19), 3.0).unwrap();
        assert_eq!(rest.matches("(pen 2: red 0.5)\nM0\n").count(), 1, "{rest}");
        assert_eq!(rest.matches("\nM3 S700").count(), 1);
        assert_eq!(resume(FILE, StopPlace::Line(2), 3.0).unwrap(), FILE);
        assert_eq!(resume(FILE, StopPlace::Path(2), 3.0).unwrap().matches("\nM3 S700").count(), 1);
    }

    #[test]
    fn faults_are_named() {
        let infinite = FILE.replace("X5 Y1", "X5 Ynan");
        assert!(
            matches!(resume(&infinite, StopPlace::Line(13), 3.0), Err(ResumeError::NotFinite { place, .. }) if place == "line 11")
        );
        assert!(matches!(resume(FILE, StopPlace::Line(900), 3.0), Err(ResumeError::Beyond { .. })));
        assert!(matches!(resume(FILE, StopPlace::Path(3), 3.0), Err(ResumeError::Beyond { .. })));
        assert_eq!(resume("G21\nG0 X1\n", StopPlace::Line(1), 3.0), Err(ResumeError::NoPen));
    }
}
