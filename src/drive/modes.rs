//! Lines that set modes: said again after a reset, and where lines are left out.

use super::program::{PathLines, Program, ProgramLine};
use crate::plot::{Act, is_instruction, word, words};

/// Codes of G that move, set places or last for one line only.
const NO_MODES: [f64; 11] = [4.0, 10.0, 28.0, 28.1, 29.0, 30.0, 30.1, 38.2, 53.0, 92.0, 92.1];
/// Codes of M that stop, end, or change tools.
const ENDS: [f64; 11] = [0.0, 1.0, 2.0, 6.0, 18.0, 30.0, 60.0, 84.0, 112.0, 400.0, 410.0];
/// Instructions of HP-GL that hold until they are given again.
const HELD: [&str; 11] = ["AS", "FS", "IP", "IW", "LT", "PA", "PT", "RO", "SC", "VN", "VS"];

/// True for a line that does nothing but set a mode.
fn sets_a_mode(line: &ProgramLine) -> bool {
    let text = &line.text;
    if line.act != Act::Mode || text.is_empty() {
        return false;
    }
    if is_instruction(text) {
        return HELD.iter().any(|name| text.starts_with(name));
    }
    let words = words(text);
    let is_mode = |&(letter, value): &(char, f64)| match letter {
        'G' => !NO_MODES.contains(&value),
        'M' => !ENDS.contains(&value),
        'X' | 'Y' | 'Z' | 'A' | 'B' | 'C' | 'E' | 'T' => false,
        _ => true,
    };
    !words.is_empty() && words.iter().all(is_mode)
}

/// What a mode is about: a later line of the same kind takes its place.
fn kind(text: &str) -> &str {
    let is_code = text.starts_with(['G', 'M']);
    let length = if is_instruction(text) {
        2
    } else if is_code {
        text.len()
    } else {
        1
    };
    text.get(..length).unwrap_or(text)
}

/// The modes that lines have set which are left out.
#[derive(Default)]
pub(super) struct Modes {
    lines: Vec<ProgramLine>,
    /// The last feed.
    feed: Option<f64>,
}

impl Modes {
    /// A line is left out.
    pub fn take(&mut self, line: &ProgramLine) {
        if !is_instruction(&line.text) {
            let feed = words(&line.text).into_iter().rev().find(|word| word.0 == 'F').map(|word| word.1);
            self.feed = feed.filter(|_| line.act.moves()).or(self.feed);
        }
        if sets_a_mode(line) {
            self.lines.retain(|held| kind(&held.text) != kind(&line.text));
            self.lines.push(ProgramLine { number: 0, ..line.clone() });
        }
    }

    /// The lines that set them, and the last feed; nothing is left.
    pub fn spell_out(&mut self) -> (Vec<ProgramLine>, Option<f64>) {
        (std::mem::take(&mut self.lines), self.feed.take())
    }
}

impl Program {
    /// The lines that bring a machine after a reset into the state of lifting, and lift the pen: the modes that are set before the first
    /// path, the first lifting, and the waits after it.
    pub fn to_lift(&self) -> Vec<&ProgramLine> {
        let first = self.paths.first().map_or(0, |path| path.lower);
        let modes = self.lines[..first].iter().filter(|line| sets_a_mode(line) && !is_instruction(&line.text));
        let lift = self.lines.iter().position(|line| line.act == Act::Lift).unwrap_or(self.lines.len());
        let waits = self.lines[lift..].iter().skip(1).take_while(|line| matches!(line.act, Act::Wait(_)));
        modes.chain(self.lines.get(lift)).chain(waits).filter(|line| !line.text.is_empty()).collect()
    }

    /// The lines of a path that does not follow the one before it in the file: it is approached along both axes, even if the pen stood
    /// there already; its first stroke says its motion; lowering and stroke say a feed that an earlier line has set.
    pub(super) fn anew(&self, path: usize, mut feed: Option<f64>) -> Vec<ProgramLine> {
        let PathLines { begin, lower, draw, lift, end, .. } = self.paths[path];
        let before = lower.checked_sub(1).map_or([0.0; 3], |before| self.lines[before].at);
        let has_approach = begin < lower && {
            let own = words(&self.lines[begin].text);
            is_instruction(&self.lines[begin].text)
                || ['G', 'X', 'Y'].iter().all(|letter| own.iter().any(|word| word.0 == *letter))
        };
        let mut lines: Vec<ProgramLine> = (!has_approach).then(|| self.approach(before)).into_iter().collect();
        let first = (draw..lift).find(|i| self.lines[*i].act.moves());
        for i in if has_approach || begin == lower { begin } else { begin + 1 }..end {
            let own = &self.lines[i];
            feed = feed.filter(|_| word(&own.text, 'F').is_none());
            let text = match own.act {
                Act::Lower if word(&own.text, 'Z').is_some() => with_feed(own.text.clone(), feed),
                _ if Some(i) == first => self.spelled_out(i, feed),
                _ => own.text.clone(),
            };
            lines.push(ProgramLine { text, ..own.clone() });
        }
        lines
    }

    /// A line that says its motion and its feed itself, wherever it stands. `feed` is for strokes that depend on an earlier line.
    pub(super) fn spelled_out(&self, line: usize, feed: Option<f64>) -> String {
        let ProgramLine { text, act, .. } = &self.lines[line];
        if text.is_empty() || is_instruction(text) {
            return text.clone();
        }
        let own = words(text);
        let motion = match act {
            Act::Rapid => "G0 ",
            Act::Line(_) => "G1 ",
            Act::Arc { sweep, .. } if *sweep < 0.0 => "G2 ",
            Act::Arc { .. } => "G3 ",
            _ => "",
        };
        let motion = if own.iter().any(|word| word.0 == 'G' && word.1 < 4.0) { "" } else { motion };
        with_feed(format!("{motion}{text}"), feed.filter(|_| *act != Act::Rapid && act.moves()))
    }

    /// A line that goes with the pen up to a place, in the words of the file.
    pub(super) fn approach(&self, [x, y, z]: [f64; 3]) -> ProgramLine {
        let own = self.paths.iter().find(|path| path.begin < path.lower).map(|path| &self.lines[path.begin]);
        let is_hpgl = self.lines.iter().any(|line| is_instruction(&line.text));
        let text = if is_hpgl {
            format!("PU{x:.0},{y:.0};")
        } else {
            let words = own.map(|line| words(&line.text)).unwrap_or_default();
            let feed = words.iter().find(|word| word.0 == 'F').map(|word| format!(" F{}", word.1)).unwrap_or_default();
            let motion = if own.is_some_and(|line| matches!(line.act, Act::Line(_))) { "G1" } else { "G0" };
            format!("{motion} X{x:.3} Y{y:.3}{feed}")
        };
        ProgramLine { text, number: 0, act: own.map_or(Act::Rapid, |line| line.act), at: [x, y, z], until: 0.0, name: None }
    }
}

/// A line with a feed, if it has none.
pub(super) fn with_feed(text: String, feed: Option<f64>) -> String {
    match feed {
        Some(feed) if word(&text, 'F').is_none() => format!("{text} F{feed}"),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interrupt::Interrupt;
    use crate::plot::Profile;

    #[test]
    fn a_foreign_file_is_lifted_without_its_moves() {
        let text = "(pen up is M5)\n(pen down is M3)\nG20\nG28\n$H\nG0 X1 Y1\nG90\nG92 X0 Y0\nM5\nG4 P0.1\nG0 X3 Y3\nM3\nG1 X5 Y5 F100\nM5\n";
        let program = Program::read(&Profile::built_in("grbl-servo").unwrap(), text, &Interrupt::never()).unwrap();
        let said: Vec<&str> = program.to_lift().iter().map(|line| line.text.as_str()).collect();
        assert_eq!(said, ["G20", "G90", "M5", "G4 P0.1"]);
    }

    #[test]
    fn motion_and_feed_are_spelled_out() {
        let text = "(pen up is M5)\n(pen down is M3)\nM5\nG0 X1 Y1\nG1 F100\nM3\nX5 Y5\nX6\nM5\n";
        let program = Program::read(&Profile::built_in("grbl-servo").unwrap(), text, &Interrupt::never()).unwrap();
        assert_eq!(program.spelled_out(6, Some(100.0)), "G1 X5 Y5 F100");
        assert_eq!(program.spelled_out(6, None), "G1 X5 Y5");
        assert_eq!(program.approach([2.0, 3.5, 0.0]).text, "G0 X2.000 Y3.500");
        let lines = |path: usize| program.anew(path, Some(900.0)).into_iter().map(|line| line.text).collect::<Vec<_>>();
        assert_eq!(lines(0), ["G0 X1 Y1", "G1 F100", "M3", "G1 X5 Y5", "X6", "M5"]);
    }

    #[test]
    fn a_path_that_is_approached_along_one_axis_is_begun_in_its_place() {
        let text = "(pen up is M5)\n(pen down is M3)\nM5\nG0 X10 Y0\nM3\nG1 X0 F100\nM5\nG0 Y5\nM3\nG1 X10\nM5\n";
        let program = Program::read(&Profile::built_in("grbl-servo").unwrap(), text, &Interrupt::never()).unwrap();
        let lines: Vec<String> = program.anew(1, Some(100.0)).into_iter().map(|line| line.text).collect();
        assert_eq!(lines, ["G0 X0.000 Y5.000", "M3", "G1 X10 F100", "M5"]);
    }
}
