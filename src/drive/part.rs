//! A part of a program: some of its paths, the first perhaps from its middle.

use super::error::DriveError;
use super::program::{PathLines, Program, ProgramLine};
use crate::geometry::Point;
use crate::interrupt::Interrupt;
use crate::plot::{Act, Language, Profile};
use std::ops::Range;

impl Program {
    /// The program that draws only some paths, and begins the first of them in its middle if that is asked for.
    pub fn part(&self, profile: &Profile, chosen: &[usize], along: f64, interrupt: &Interrupt) -> Result<Self, DriveError> {
        let mut part = Part { program: self, lines: Vec::new(), pen: None };
        part.copy(self.head.clone());
        let mut from = self.head.end;
        for (i, path) in self.paths.iter().enumerate() {
            if chosen.binary_search(&i).is_ok() {
                part.between(from..path.begin, path.pen);
                match chosen.first() {
                    Some(first) if *first == i && along > 0.0 && profile.language() == Language::Gcode => part.rest_of(i, along),
                    _ => part.copy(path.begin..path.end),
                }
            }
            from = path.end;
        }
        part.copy(from..self.lines.len());
        let lines = part.lines;
        let mut program = Self::of(profile, lines, interrupt)?;
        // Paths keep the numbers that they have in the file.
        for (path, chosen) in program.paths.iter_mut().zip(chosen) {
            path.number = self.paths[*chosen].number;
        }
        Ok(program)
    }
}

/// A program that is put together from parts of another.
struct Part<'a> {
    program: &'a Program,
    lines: Vec<ProgramLine>,
    /// The pen named last.
    pen: Option<u32>,
}

impl Part<'_> {
    fn copy(&mut self, lines: Range<usize>) {
        self.lines.extend_from_slice(&self.program.lines[lines]);
    }

    /// A line that the file does not hold.
    fn add(&mut self, text: String, act: Act, at: [f64; 3]) {
        self.lines.push(ProgramLine { text, number: 0, act, at, until: 0.0, name: None });
    }

    /// What stands between two paths. If the lines before name no pen, the pen's name is repeated, so that it can be asked for.
    fn between(&mut self, lines: Range<usize>, pen: u32) {
        let names = lines.clone().any(|i| self.program.lines[i].act == Act::Pen(pen));
        if !names && self.pen != Some(pen) {
            let of_pen = |line: &&ProgramLine| line.act == Act::Pen(pen);
            if let Some(line) = self.program.lines[..lines.start].iter().rev().find(of_pen) {
                self.lines.push(ProgramLine { number: 0, ..line.clone() });
                // A pen that the machine fetches itself is named by what is sent.
                if self.pen.is_some() && line.text.is_empty() {
                    self.add(String::new(), Act::Pause, line.at);
                }
            }
        }
        self.pen = Some(pen);
        self.copy(lines);
    }

    /// The rest of a path from a length along it.
    fn rest_of(&mut self, path: usize, along: f64) {
        let program = self.program;
        let lines = &program.paths[path];
        let mut left = along.min(program.length(path));
        let pieces: Vec<(usize, f64)> = program.pieces(path).collect();
        let mut first = 0;
        while first + 1 < pieces.len() && left >= pieces[first].1 {
            left -= pieces[first].1;
            first += 1;
        }
        let Some(&(line, length)) = pieces.get(first) else { return self.copy(lines.begin..lines.end) };
        let fraction = if length > 0.0 { (left / length).min(1.0) } else { 0.0 };
        let (start, z) = (program.on(line, fraction), program.height_on(line, fraction));
        let approach = &program.lines[lines.begin];
        let word = approach.text.split_whitespace().next().filter(|_| lines.begin < lines.lower).unwrap_or("G0");
        let feed = feed_word(&approach.text).map(|feed| format!(" {feed}")).unwrap_or_default();
        self.add(format!("{word} X{:.3} Y{:.3}{feed}", start.x, start.y), approach.act, [start.x, start.y, approach.at[2]]);
        self.lower(lines, [start.x, start.y, z]);
        let feed = (lines.draw..=line).rev().find_map(|i| feed_word(&program.lines[i].text));
        let stroke = &program.lines[line];
        let act = match stroke.act {
            Act::Arc { centre, sweep, rate } => Act::Arc { centre, sweep: (1.0 - fraction) * sweep, rate },
            act => act,
        };
        self.lines.push(ProgramLine { text: program.stroke_from(line, start, feed), act, ..stroke.clone() });
        self.copy(line + 1..lines.end);
    }

    /// The lines that lower the pen, at another height if the z axis draws with it.
    fn lower(&mut self, lines: &PathLines, at: [f64; 3]) {
        let program = self.program;
        let text = &program.lines[lines.lower].text;
        let lowered = if text.contains('Z') {
            let feed = feed_word(text).map(|feed| format!(" {feed}")).unwrap_or_default();
            format!("G1 Z{:.3}{feed}", at[2])
        } else {
            text.clone()
        };
        self.add(lowered, Act::Lower, at);
        self.copy(lines.lower + 1..lines.draw);
    }
}

impl Program {
    /// A point on a stroke.
    fn on(&self, line: usize, fraction: f64) -> Point {
        match self.lines[line].act {
            Act::Arc { centre, sweep, .. } => {
                let (sin, cos) = (fraction * sweep).sin_cos();
                let arm = self.before(line) - centre;
                Point::new(centre.x + arm.x * cos - arm.y * sin, centre.y + arm.x * sin + arm.y * cos)
            }
            _ => self.before(line).lerp(self.after(line), fraction),
        }
    }

    /// The pen's height on a stroke along which it changes.
    fn height_on(&self, line: usize, fraction: f64) -> f64 {
        let (from, to) = (self.lines[line.saturating_sub(1)].at[2], self.lines[line].at[2]);
        from + fraction * (to - from)
    }

    /// A stroke's line when it begins at a point on it.
    fn stroke_from(&self, line: usize, start: Point, feed: Option<&str>) -> String {
        let text = &self.lines[line].text;
        let mut words: Vec<String> =
            text.split_whitespace().filter(|word| !word.starts_with(['I', 'J', 'F'])).map(str::to_owned).collect();
        if let Act::Arc { centre, .. } = self.lines[line].act {
            words.push(format!("I{:.3}", centre.x - start.x));
            words.push(format!("J{:.3}", centre.y - start.y));
        }
        words.extend(feed.map(str::to_owned));
        words.join(" ")
    }
}

/// The feed of a line, such as `F3000`.
fn feed_word(text: &str) -> Option<&str> {
    text.split_whitespace().find(|word| word.starts_with('F'))
}

#[cfg(test)]
mod tests {
    use super::super::program::tests::program;
    use super::*;

    #[test]
    fn a_part_begins_in_a_stroke() {
        let (profile, program) = program();
        let part = program.part(&profile, &[0, 1], 2.0, &Interrupt::never()).unwrap();
        let text: Vec<&str> = part.lines.iter().map(|line| line.text.as_str()).filter(|text| !text.is_empty()).collect();
        let start = ["G21", "M3 S300", "G4 P.15", "G0 X3.000 Y1.000", "M3 S700", "G4 P.2", "G1 X5 Y1 F3000", "G3 X5 Y9 I0 J4"];
        assert_eq!(text[..8], start);
        let bend = program.part(&profile, &[0], 4.0 + 2.0 * std::f64::consts::PI, &Interrupt::never()).unwrap();
        let text: Vec<&str> = bend.lines.iter().map(|line| line.text.as_str()).filter(|text| !text.is_empty()).collect();
        assert_eq!(text[3..7], ["G0 X9.000 Y5.000", "M3 S700", "G4 P.2", "G3 X5 Y9 I-4.000 J0.000 F3000"]);
        assert_eq!(text.last(), Some(&"G0 X0 Y0"));
        assert!(!text.contains(&"M0"), "the second pen draws nothing: {text:?}");
    }
}
