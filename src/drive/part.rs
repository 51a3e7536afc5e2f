//! A part of a program: some of its paths, the first perhaps from its middle.

use super::error::DriveError;
use super::modes::Modes;
use super::program::{PathLines, Program, ProgramLine};
use crate::elementary::Elementary as _;
use crate::geometry::Point;
use crate::interrupt::Interrupt;
use crate::plot::{Act, Language, Profile, is_instruction, word};
use std::fmt::Write as _;
use std::ops::Range;

impl Program {
    /// The program that draws only some paths, and begins the first of them in its middle if that is asked for.
    pub fn part(&self, profile: &Profile, chosen: &[usize], along: f64, interrupt: &Interrupt) -> Result<Self, DriveError> {
        if self.lines.iter().any(|line| is_instruction(&line.text) && line.text.starts_with("PR")) {
            let problem = "its moves are relative (PR), so that it can only be drawn as a whole";
            return Err(DriveError::Unfit(problem.to_owned()));
        }
        let mut part = Part { program: self, lines: Vec::new(), pen: None, left_out: Modes::default(), last: None };
        part.copy(self.head.clone());
        let mut from = self.head.end;
        for (i, path) in self.paths.iter().enumerate() {
            if chosen.binary_search(&i).is_ok() {
                part.between(from..path.begin, path.pen);
                match chosen.first() {
                    Some(first) if *first == i && along > 0.0 && profile.language() == Language::Gcode => part.rest_of(i, along),
                    _ => part.path(i),
                }
                part.last = Some(i);
            } else {
                self.lines[from..path.end].iter().for_each(|line| part.left_out.take(line));
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
    /// Modes set by lines that are left out.
    left_out: Modes,
    /// The path copied last.
    last: Option<usize>,
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

    /// A whole path, after the modes that lines left out have set.
    fn path(&mut self, path: usize) {
        let PathLines { begin, end, .. } = self.program.paths[path];
        let (modes, feed) = self.left_out.spell_out();
        self.lines.extend(modes);
        if path > 0 && self.last == Some(path - 1) {
            self.copy(begin..end);
        } else {
            self.lines.extend(self.program.anew(path, feed));
        }
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
        let Some(&(line, length)) = pieces.get(first) else { return self.path(path) };
        let fraction = if length > 0.0 { (left / length).min(1.0) } else { 0.0 };
        let (start, z) = (program.on(line, fraction), program.height_on(line, fraction));
        let (modes, feed) = self.left_out.spell_out();
        self.lines.extend(modes);
        self.lines.push(program.approach([start.x, start.y, program.lines[lines.begin].at[2]]));
        self.lower(lines, [start.x, start.y, z]);
        let own = (lines.draw..=line).rev().find_map(|i| word(&program.lines[i].text, 'F'));
        let stroke = &program.lines[line];
        let act = match stroke.act {
            Act::Arc { rate, .. } if (1.0 - fraction) * length < SHORTEST_ARC => Act::Line(rate),
            Act::Arc { centre, sweep, rate } => Act::Arc { centre, sweep: (1.0 - fraction) * sweep, rate },
            act => act,
        };
        let text = program.stroke_from(line, act, start, own.or(feed));
        self.lines.push(ProgramLine { text, act, ..stroke.clone() });
        // The next stroke may rely on a motion that an arc's end, drawn straight, did not set.
        match pieces.get(first + 1) {
            Some(&(next, _)) => {
                self.copy(line + 1..next);
                self.lines.push(ProgramLine { text: program.spelled_out(next, None), ..program.lines[next].clone() });
                self.copy(next + 1..lines.end);
            }
            None => self.copy(line + 1..lines.end),
        }
    }

    /// The lines that lower the pen, at another height if the z axis draws with it.
    fn lower(&mut self, lines: &PathLines, at: [f64; 3]) {
        let program = self.program;
        let text = &program.lines[lines.lower].text;
        let lowered = if word(text, 'Z').is_some() {
            let feed = word(text, 'F').map(|feed| format!(" F{feed}")).unwrap_or_default();
            format!("G1 Z{:.3}{feed}", at[2])
        } else {
            text.clone()
        };
        self.add(lowered, Act::Lower, at);
        let waits = program.lines[lines.lower + 1..lines.draw].iter();
        self.lines.extend(waits.map(|line| ProgramLine { at, ..line.clone() }));
    }
}

impl Program {
    /// A point on a stroke.
    fn on(&self, line: usize, fraction: f64) -> Point {
        match self.lines[line].act {
            Act::Arc { centre, sweep, .. } => {
                let (sin, cos) = (fraction * sweep).sine_and_cosine();
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

    /// A stroke's line when it begins at a point on it, as the motion that is left.
    fn stroke_from(&self, line: usize, act: Act, start: Point, feed: Option<f64>) -> String {
        let ProgramLine { text, at, .. } = &self.lines[line];
        let has = |letter: char| word(text, letter).is_some();
        let mut left = match act {
            Act::Rapid => "G0".to_owned(),
            Act::Arc { sweep, .. } => if sweep < 0.0 { "G2" } else { "G3" }.to_owned(),
            _ => "G1".to_owned(),
        };
        for (axis, letter) in ['X', 'Y', 'Z'].into_iter().enumerate().filter(|(_, letter)| has(*letter)) {
            let _ = write!(left, " {letter}{}", (at[axis] * 1e4).round() / 1e4);
        }
        if let Act::Arc { centre, .. } = act {
            let _ = write!(left, " I{:.3} J{:.3}", centre.x - start.x, centre.y - start.y);
        }
        if let Some(feed) = feed {
            let _ = write!(left, " F{feed}");
        }
        left
    }
}

/// An arc whose rest is shorter, in machine units, is ended straight: its ends would be the same, which is a full circle.
const SHORTEST_ARC: f64 = 0.02;

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

    fn texts(program: &Program) -> Vec<&str> {
        program.lines.iter().map(|line| line.text.as_str()).filter(|text| !text.is_empty()).collect()
    }

    fn read(machine: &str, text: &str) -> (Profile, Program) {
        let profile = Profile::built_in(machine).unwrap();
        let program = Program::read(&profile, text, &Interrupt::never()).unwrap();
        (profile, program)
    }

    #[test]
    fn an_arc_that_is_all_but_drawn_is_no_full_circle() {
        let (profile, program) = program();
        let end = 4.0 + 4.0 * std::f64::consts::PI;
        let part = program.part(&profile, &[0], end - 0.004, &Interrupt::never()).unwrap();
        let expected = ["G0 X5.004 Y9.000", "M3 S700", "G4 P.2", "G1 X5 Y9 F3000", "G1 X10 Y9"];
        assert_eq!(texts(&part)[3..8], expected);
        assert!((part.length(0) - 5.004).abs() < 1e-6);
    }

    #[test]
    fn a_path_that_begins_where_another_ended_is_approached() {
        let text = "(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nM3 S300\nG0 X1 Y1\nM3 S700\nG1 X5 Y1 F3000\nM3 S300\n\
                    M3 S700\nX9\nM3 S300\nM3 S700\nX9 Y9\nM3 S300\n";
        let (profile, program) = read("grbl-servo", text);
        let part = program.part(&profile, &[1, 2], 0.0, &Interrupt::never()).unwrap();
        let expected = ["G21", "M3 S300", "G0 X5.000 Y1.000", "M3 S700", "G1 X9 F3000", "M3 S300", "M3 S700", "X9 Y9", "M3 S300"];
        assert_eq!(texts(&part), expected);
    }

    #[test]
    fn modes_of_lines_left_out_are_set() {
        let text = "IN;PS4;SP1;VS30;PU10,10;PD20,10;PU;VS10;AS2;PU40,40;PD50,40;PU60,60;PD70,60;PU;SP0;";
        let (profile, program) = read("hp7475a", text);
        let part = program.part(&profile, &[2], 0.0, &Interrupt::never()).unwrap();
        let expected = ["IN;", "PS4;", "SP1;", "VS10;", "AS2;", "PU60,60;", "PD70,60;", "PU;", "SP0;"];
        assert_eq!(texts(&part), expected);
        let (profile, relative) = read("hp7475a", "IN;SP1;PU10,10;PR;PD20,10;PU10,10;PD1,1;PU;");
        assert!(relative.part(&profile, &[1], 0.0, &Interrupt::never()).is_err());
    }
}
