//! Resumes HP-GL: instructions that end with a semicolon, absolute after each pen-up move.

use super::read::instructions as instructions_of;
use crate::elementary::Elementary as _;
use crate::geometry::parse_finite;
use crate::plot::language::stop::back_along;
use crate::plot::language::{ResumeError, StopPlace};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::Range;

/// Plotter units per millimetre, near enough for how much is drawn again.
const UNITS_PER_MM: f64 = 40.0;

/// The rest of an HP-GL file from the place that was not taken; `again` is how many millimetres are drawn again. A path packed with
/// `PE` is drawn again from its start.
pub(in crate::plot::language) fn resume(text: &str, stop: StopPlace, again: f64) -> Result<String, ResumeError> {
    let again = again * UNITS_PER_MM;
    let instructions = instructions(text);
    check(&instructions)?;
    let byte = byte_of(text, &instructions, stop)?;
    let Some(first_pen) = instructions.iter().find(|i| i.name == "SP").filter(|first| byte > first.start) else {
        return Ok(text.to_owned());
    };
    let mut state = State::default();
    for instruction in instructions.iter().take_while(|i| i.end <= byte) {
        state.take(instruction, instruction.numbers.len());
    }
    let open = instructions.iter().find(|i| i.start < byte && byte < i.end);
    // Inside a list of points, those before the byte are done.
    if let Some(open) = open.filter(|open| matches!(open.name.as_str(), "PD" | "PA" | "PU")) {
        let done = open.numbers.iter().take_while(|(_, end)| *end <= byte).count() & !1;
        if done > 0 {
            state.take(open, done);
        }
    }
    let mut rest = text[..first_pen.start].to_owned();
    state.restore_pen(&mut rest);
    let next = instructions.iter().find(|i| i.end > byte).map_or(text.len(), |i| i.start);
    if state.is_down && !state.path.is_empty() {
        state.restore_path(&mut rest, text, again);
    } else {
        if let Some((x, y)) = state.at {
            let _ = write!(rest, "PU{},{};", x.round(), y.round());
        }
        rest.push_str(&text[next..]);
    }
    Ok(rest)
}

fn byte_of(text: &str, instructions: &[Instruction], stop: StopPlace) -> Result<usize, ResumeError> {
    let beyond = |stop: String, count: String| Err(ResumeError::Beyond { stop, count });
    match stop {
        StopPlace::Byte(byte) if byte >= text.len() => beyond(format!("byte {byte}"), format!("{} bytes", text.len())),
        StopPlace::Byte(byte) => Ok(byte),
        StopPlace::Line(line) => {
            let starts: Vec<usize> = std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect();
            match starts.get(line.max(1) - 1).filter(|start| **start < text.len()) {
                Some(start) => Ok(*start),
                None => beyond(format!("line {line}"), format!("{} lines", text.lines().count())),
            }
        }
        StopPlace::Path(path) => {
            let mut is_down = false;
            let falls = instructions.iter().filter(|i| {
                let falls = !is_down && matches!(i.name.as_str(), "PD" | "PE");
                is_down = if matches!(i.name.as_str(), "PU" | "PE" | "SP" | "IN") { false } else { is_down || i.name == "PD" };
                falls
            });
            let starts: Vec<usize> = falls.map(|i| i.start).collect();
            match starts.get(path.max(1) - 1) {
                Some(start) => Ok(*start),
                None => beyond(format!("path {path}"), format!("{} paths", starts.len())),
            }
        }
    }
}

/// One instruction with its byte range, and each number with the byte offset after it.
struct Instruction<'a> {
    /// In upper case.
    name: String,
    /// Without its terminator.
    text: &'a str,
    start: usize,
    end: usize,
    numbers: Vec<(f64, usize)>,
}

/// Splits a text into instructions.
fn instructions(text: &str) -> Vec<Instruction<'_>> {
    let instruction = |(bytes, body): (Range<usize>, _)| {
        let (name, numbers) = str::split_at_checked(body, 2)?;
        let name = name.to_ascii_uppercase();
        let numbers = if name == "PE" { Vec::new() } else { self::numbers(numbers, bytes.start + 2, bytes.end) };
        Some(Instruction { name, text: body, start: bytes.start, end: bytes.end, numbers })
    };
    instructions_of(text).filter_map(instruction).collect()
}

/// Refuses parameters that are not finite numbers, in instructions that take numbers.
fn check(instructions: &[Instruction]) -> Result<(), ResumeError> {
    let takes_numbers = |name: &str| matches!(name, "PU" | "PD" | "PA" | "PR" | "AA" | "AR" | "SP" | "VS" | "FS" | "AS");
    for instruction in instructions.iter().filter(|i| takes_numbers(&i.name)) {
        let mut parts = pieces(&instruction.text[2..]).map(|(part, _)| part);
        if let Some(number) = parts.find(|part| parse_finite(part).is_none()) {
            let place = format!("byte {}", instruction.start);
            return Err(ResumeError::NotFinite { place, number: number.chars().take(20).collect() });
        }
    }
    Ok(())
}

/// The pieces between commas and blanks, each with the byte offset after it and its separator.
fn pieces(text: &str) -> impl Iterator<Item = (&str, usize)> {
    let mut end = 0;
    let pieces = text.split_inclusive([',', ' ']).map(move |piece| {
        end += piece.len();
        (piece.trim_end_matches([',', ' ']), end)
    });
    pieces.filter(|(piece, _)| !piece.is_empty())
}

/// The numbers of an instruction, each with the byte offset after it. The last one's offset includes the terminator.
fn numbers(text: &str, offset: usize, end: usize) -> Vec<(f64, usize)> {
    let number = |(piece, behind): (&str, _)| Some((piece.parse().ok()?, offset + behind));
    let mut found: Vec<_> = pieces(text).filter_map(number).collect();
    if let Some((_, last)) = found.last_mut() {
        *last = end;
    }
    found
}

/// A vertex of the path being drawn, and the byte offset at which the file continues from there.
#[derive(Clone, Copy)]
struct Vertex {
    at: (f64, f64),
    next: usize,
    /// True if more points of the same instruction follow.
    is_inside: bool,
}

#[derive(Default)]
struct State<'a> {
    at: Option<(f64, f64)>,
    is_down: bool,
    pen: Option<&'a str>,
    /// The last settings of speed, force and acceleration.
    set: BTreeMap<String, &'a str>,
    path: Vec<Vertex>,
}

impl<'a> State<'a> {
    /// Executes an instruction; of a list of points, only its first `numbers` numbers.
    fn take(&mut self, instruction: &Instruction<'a>, numbers: usize) {
        match instruction.name.as_str() {
            "SP" => (self.pen, self.is_down) = (Some(instruction.text), false),
            "VS" | "FS" | "AS" => {
                self.set.insert(instruction.name.clone(), instruction.text);
            }
            "PU" => self.is_down = false,
            "PD" if !self.is_down => {
                self.is_down = true;
                let at = self.at.unwrap_or_default();
                // The first vertex: the file continues with this instruction.
                self.path = vec![Vertex { at, next: instruction.start, is_inside: false }];
            }
            "PE" => self.path.clear(),
            "AA" => self.turn(instruction),
            _ => {}
        }
        if !matches!(instruction.name.as_str(), "PU" | "PD" | "PA") {
            return;
        }
        for pair in instruction.numbers[..numbers].chunks_exact(2) {
            let at = (pair[0].0, pair[1].0);
            self.at = Some(at);
            if self.is_down {
                self.path.push(Vertex { at, next: pair[1].1, is_inside: pair[1].1 < instruction.end });
            }
        }
    }

    /// Moves to an arc's end, approximately; the next absolute point is exact.
    fn turn(&mut self, arc: &Instruction) {
        let (Some(at), [(x, _), (y, _), (degrees, _), ..]) = (self.at, &arc.numbers[..]) else { return };
        let ((sin, cos), (dx, dy)) = (degrees.to_radians().sine_and_cosine(), (at.0 - x, at.1 - y));
        let end = (x + dx * cos - dy * sin, y + dx * sin + dy * cos);
        self.at = Some(end);
        if self.is_down {
            self.path.push(Vertex { at: end, next: arc.end, is_inside: false });
        }
    }

    fn restore_pen(&self, rest: &mut String) {
        rest.push_str("PU;");
        for text in self.pen.into_iter().chain(self.set.values().copied()) {
            let _ = write!(rest, "{text};");
        }
    }

    /// Goes back at least `again` units along the path and continues from there with the pen down.
    fn restore_path(&self, rest: &mut String, text: &str, again: f64) {
        let start = self.path[back_along(self.path.len(), |i| self.path[i].at, again)];
        let _ = write!(rest, "PU{},{};", start.at.0.round(), start.at.1.round());
        match (start.is_inside, text[start.next..].starts_with("PD")) {
            (true, _) => rest.push_str("PD"),
            (false, false) => rest.push_str("PD;"),
            (false, true) => {}
        }
        rest.push_str(&text[start.next..]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "IN;PU;PS4;SP1;VS30;FS2;PU100,100;PD200,100,300,100;PD300,200,300,300;PU500,500;PD;PU;SP2;VS10;FS2;PU600,600;PD700,700;PU;PU0,7721;SP0;\n";

    fn at(text: &str) -> usize {
        FILE.find(text).unwrap()
    }

    #[test]
    fn in_a_path_it_goes_back_a_little() {
        let rest = resume(FILE, StopPlace::Byte(at("300,300;PU500")), 3.0).unwrap();
        assert!(rest.starts_with("IN;PU;PS4;PU;SP1;FS2;VS30;PU200,100;PD300,100;PD300,200,300,300;PU500,500;"), "{rest}");
        let start = resume(FILE, StopPlace::Byte(at("200,100")), 3.0).unwrap();
        assert!(start.contains("VS30;PU100,100;PD200,100,300,100;"), "{start}");
    }

    #[test]
    fn the_pen_in_use_is_fetched() {
        let rest = resume(FILE, StopPlace::Path(3), 3.0).unwrap();
        assert!(rest.starts_with("IN;PU;PS4;PU;SP2;FS2;VS10;PU600,600;PD700,700;"), "{rest}");
        assert_eq!(resume(FILE, StopPlace::Byte(3), 3.0).unwrap(), FILE);
        assert!(resume(FILE, StopPlace::Path(2), 3.0).unwrap().contains("VS30;PU500,500;PD;PU;SP2;"));
    }

    #[test]
    fn what_is_no_finite_number_is_a_fault() {
        for number in ["nan", "1e999", "inf5", "2x"] {
            let refused = resume(&FILE.replace("PD200", &format!("PD{number}")), StopPlace::Path(2), 3.0);
            let place = format!("byte {}", at("PD200,100"));
            assert_eq!(refused, Err(ResumeError::NotFinite { place, number: number.into() }));
        }
    }

    /// Semicolons, line ends and escape sequences all end an instruction, and letters may be lower case.
    #[test]
    fn instructions_are_told_apart_as_they_are_read() {
        let stop = |text: &str, byte| resume(text, StopPlace::Byte(byte), 3.0).unwrap();
        let expected = stop(FILE, at("300,300;PU500"));
        let lines = FILE.replace(';', "\n");
        assert_eq!(stop(&lines, at("300,300;PU500")).replace('\n', ";"), expected.replace('\n', ";"));
        assert_eq!(stop(&FILE.to_lowercase(), at("300,300;PU500")).to_uppercase(), expected);
        let escape = "\u{1b}.N;19:";
        let escaped = FILE.replace(";PD200", &format!("{escape}PD200")).replace("SP1;", "SP1\u{1b}.E");
        let rest = stop(&escaped, escaped.find("PD300,200").unwrap());
        assert_eq!(rest, stop(FILE, at("PD300,200")));
    }

    #[test]
    fn beyond_the_end_is_refused() {
        for stop in [StopPlace::Byte(4000), StopPlace::Line(9), StopPlace::Path(4)] {
            assert!(matches!(resume(FILE, stop, 3.0), Err(ResumeError::Beyond { .. })), "{stop:?}");
        }
    }
}
