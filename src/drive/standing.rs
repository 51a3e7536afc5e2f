//! Where a drawing stands: what is sent, taken and certainly drawn.

use super::clock::Clock;
use super::journal::Record;
use super::program::{Program, ProgramLine};
use super::stand::Stand;
use crate::plot::{Act, word, words};
use std::borrow::Cow;
use std::ops::Range;

/// How far a drawing is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Fraction of the planned time that is drawn.
    pub fraction: f64,
    /// Planned seconds left.
    pub seconds_left: f64,
    /// Paths drawn.
    pub paths: usize,
    /// Paths in all.
    pub paths_in_all: usize,
    /// The pen in use.
    pub pen: u32,
    /// Where it was last, in machine units.
    pub at: Option<[f64; 3]>,
}

/// Where a drawing stands.
pub(super) struct Standing<'a> {
    pub program: &'a Program,
    /// The next line to send.
    pub next: usize,
    /// Lines before this one are taken.
    pub taken: usize,
    /// Lines before this one are certainly drawn.
    pub drawn: usize,
    pub stand: Option<Stand>,
    /// Percent of the file's speed at which the machine draws.
    pub percent: u32,
    pub clock: Clock,
    pub is_done: bool,
    pub is_stopped: bool,
}

impl<'a> Standing<'a> {
    /// A drawing that begins.
    pub fn new(program: &'a Program) -> Self {
        let clock = Clock::new();
        Self { program, next: 0, taken: 0, drawn: 0, stand: None, percent: 100, clock, is_done: false, is_stopped: false }
    }

    /// The lines that may be under the pen: a machine takes some only when it has done them.
    fn under_the_pen(&self) -> Range<usize> {
        self.drawn..(self.taken + 1).min(self.next).max(self.drawn)
    }

    /// The machine told where it stands.
    pub fn stands(&mut self, stand: Option<Stand>) {
        // A machine that says nothing new stands still, or was not asked where it stands.
        if let Some(stand) = stand.as_ref().filter(|_| stand != self.stand) {
            self.clock.set(self.program, self.under_the_pen(), stand);
        }
        self.stand = stand;
    }

    /// Time passed, in which the machine drew or waited for the user.
    pub fn pass_time(&mut self, percent: u32) {
        self.clock.run(self.program, &self.under_the_pen(), percent);
    }

    /// A line was taken, which proves that all before it is drawn.
    pub fn prove(&mut self, line: usize) {
        self.drawn = self.drawn.max(line + 1);
    }

    /// A line was taken; as many moves as are `hidden` may be waiting in the machine.
    pub fn take(&mut self, line: usize, hidden: usize) {
        // The moves before the last `hidden` ones cannot all be waiting.
        let mut moves = 0;
        for i in (self.drawn..=line).rev() {
            moves +=
                usize::from(self.program.lines[i].act.moves() || matches!(self.program.lines[i].act, Act::Lift | Act::Lower));
            if moves > hidden {
                self.drawn = i + 1;
                return;
            }
        }
    }

    /// The end of the path of which the last line sent is a part; else the next line.
    pub fn end_of_path(&self) -> usize {
        let path = self.program.paths.get(self.program.path_of(self.next.saturating_sub(1)));
        path.filter(|path| path.begin < self.next).map_or(self.next, |path| path.end)
    }

    pub fn progress(&self) -> Progress {
        let program = self.program;
        let done = self.clock.done();
        let path = program.path_of(self.drawn);
        Progress {
            fraction: if program.seconds() > 0.0 { done / program.seconds() } else { 1.0 },
            seconds_left: (program.seconds() - done) * 100.0 / f64::from(self.percent),
            paths: path,
            paths_in_all: program.paths.len(),
            pen: program.paths.get(path).or(program.paths.last()).map_or(1, |path| path.pen),
            at: self.stand.map(|stand| stand.at),
        }
    }

    /// The record for the journal.
    pub fn record(&self) -> Record {
        let lines = &self.program.lines;
        let number = |i: usize| lines.get(i..).unwrap_or(&[]).iter().map(|line| line.number).find(|number| *number > 0);
        let end = lines.iter().rev().map(|line| line.number).find(|number| *number > 0).map_or(1, |last| last + 1);
        // The head says nothing of the drawing: in a part of a file, which has it too, much more is drawn before it.
        let drawn = self.drawn.max(self.program.head.end);
        let path = self.program.paths.get(self.program.path_of(drawn));
        Record {
            drawn: number(drawn).unwrap_or(end),
            taken: number(self.taken.max(drawn)).unwrap_or(end),
            sent: number(self.next.max(drawn)).unwrap_or(end),
            path: path.map_or(0, |path| path.number),
            at: self.stand.map(|stand| stand.at),
            is_down: self.stand.and_then(|stand| self.program.is_down(&stand)),
            is_done: self.is_done,
            is_stopped: self.is_stopped,
        }
    }
}

/// The text of a line; a lowering presses harder or more lightly if that was wished.
pub(super) fn pressed<'a>(program: &Program, line: &'a ProgramLine, steps: i32) -> Cow<'a, str> {
    if steps == 0 || line.act != Act::Lower {
        return Cow::Borrowed(&line.text);
    }
    let lift = program.lines.iter().find(|line| line.act == Act::Lift).map_or("", |line| &line.text);
    let pressed = words(&line.text).into_iter().map(|(letter, down)| {
        let step = match letter {
            'S' => 5.0,
            'Z' => 0.05,
            _ => return format!("{letter}{down}"),
        };
        let Some(up) = word(lift, letter) else { return format!("{letter}{down}") };
        let value = down + step * f64::from(steps).copysign(f64::from(steps) * (down - up));
        format!("{letter}{}", (value * 100.0).round() / 100.0)
    });
    let pressed = pressed.collect::<Vec<_>>().join(" ");
    // A command of another kind has no pressure.
    if pressed.is_empty() { Cow::Borrowed(&line.text) } else { Cow::Owned(pressed) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interrupt::Interrupt;
    use crate::plot::Profile;

    #[test]
    fn the_pen_presses_harder_in_its_own_direction() {
        let texts = [
            ("grbl-servo", "M3 S300\nG0 X1 Y1\nM3 S700\nG1 X2 Y2 F600\nM3 S300\n", "M3 S710", "M3 S695"),
            ("grbl-z", "G0 Z5\nG0 X1 Y1\nG1 Z-1 F300\nG1 X2 Y2 F600\nG0 Z5\n", "G1 Z-1.1 F300", "G1 Z-0.95 F300"),
        ];
        for (machine, text, harder, lighter) in texts {
            let program = Program::read(&Profile::built_in(machine).unwrap(), text, &Interrupt::never()).unwrap();
            let line = &program.lines[program.paths[0].lower];
            assert_eq!(pressed(&program, line, 2), harder);
            assert_eq!(pressed(&program, line, -1), lighter);
            assert_eq!(pressed(&program, line, 0), line.text);
        }
    }
}
