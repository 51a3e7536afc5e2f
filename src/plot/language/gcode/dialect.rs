//! The G-code dialect of a machine.

use crate::plot::language::Refusal;
use crate::plot::profile::{above_zero, are_near};
use crate::write::decimal;
use serde::Deserialize;

/// The G-code dialect of one machine.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GcodeDialect {
    /// The `G` and `M` words and named commands that the controller knows. Nothing else is written.
    pub words: Vec<String>,
    /// The line that opens and closes a file, such as `%`.
    pub frame: Option<String>,
    /// Syntax of comments.
    #[serde(default)]
    pub comment: Comment,
    /// Comment lines at the top of the file.
    #[serde(default)]
    pub header: Vec<String>,
    /// Lines before the first move.
    pub start: Vec<String>,
    /// Lines after the pen is parked.
    #[serde(default)]
    pub end: Vec<String>,
    /// What lifts the pen.
    pub lift: Lift,
    /// Command that lifts the pen, if a command does.
    pub pen_up: Option<String>,
    /// Command that lowers the pen, if a command does.
    pub pen_down: Option<String>,
    /// The pen's heights, if the z axis lifts it.
    pub height: Option<Height>,
    /// Syntax of moves with the pen up.
    #[serde(default)]
    pub travel: Travel,
    /// Write arcs as `G2` and `G3`.
    #[serde(default)]
    pub arcs: bool,
    /// Where the pen waits at the end, in machine units.
    pub park: [f64; 2],
    /// Command that waits for the user. Without it, jobs that need a pause are refused.
    pub pause: Option<String>,
    /// Command that waits for a time; `{seconds}` or `{milliseconds}` is replaced.
    pub dwell: String,
    /// Maximum length of a line in characters.
    pub line_length: usize,
    /// How the controller talks while lines are sent to it.
    #[serde(default)]
    pub protocol: Protocol,
    /// Lines that refill the pen, with the pen up before and after; `{x}` and `{y}` are the ink's place in machine units. Without
    /// them the pen goes to the ink, comes down, waits, and rises.
    #[serde(default)]
    pub refill: Vec<String>,
}

/// How a controller talks while lines are sent to it.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Protocol {
    /// Counted characters, real-time commands, status reports: GRBL and `FluidNC`.
    #[default]
    Grbl,
    /// Numbered lines with checksums: Marlin, and Klipper.
    Marlin,
    /// The controller reads the file itself.
    File,
}

/// Syntax of comments.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Comment {
    /// `(so)`.
    #[default]
    Parentheses,
    /// `; so`.
    Semicolon,
}

/// What lifts the pen.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Lift {
    /// The commands `pen_up` and `pen_down`.
    Command,
    /// The z axis.
    Height,
}

/// The pen's heights on the z axis, in machine units. Either may be the greater.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Height {
    /// Off the paper.
    pub up: f64,
    /// On the paper.
    pub down: f64,
    /// Lowering speed, mm/s.
    pub plunge_speed: f64,
}

/// Syntax of moves with the pen up.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Travel {
    /// `G0`, at the machine's maximum rate.
    #[default]
    Rapid,
    /// `G0` with a feed.
    Fed,
    /// `G1` with a feed.
    Feed,
}

impl GcodeDialect {
    /// The line that waits for a time, to the millisecond.
    pub(in crate::plot) fn wait(&self, seconds: f64) -> String {
        let (mut whole, mut milli) = (String::new(), String::new());
        let milliseconds = (seconds * 1000.0).round() as i64;
        decimal(&mut whole, milliseconds, 3);
        decimal(&mut milli, milliseconds, 0);
        self.dwell.replace("{seconds}", &whole).replace("{milliseconds}", &milli)
    }

    /// Checks that the commands or heights that lift and lower the pen are given and differ.
    fn check_lift(&self) -> Result<(), Refusal> {
        let given = |command: &Option<String>| command.as_ref().is_some_and(|text| !text.trim().is_empty());
        match (self.lift, self.height) {
            (Lift::Command, _) if !given(&self.pen_up) => Err(Refusal::new("gcode.pen_up", "must be a command")),
            (Lift::Command, _) if !given(&self.pen_down) => Err(Refusal::new("gcode.pen_down", "must be a command")),
            (Lift::Command, _) if self.pen_up == self.pen_down => {
                Err(Refusal::new("gcode.pen_up", "must differ from gcode.pen_down"))
            }
            (Lift::Height, None) => Err(Refusal::new("gcode.height", "is missing, and gcode.lift is \"height\"")),
            (Lift::Height, Some(z)) if !are_near(&[z.up, z.down]) => {
                Err(Refusal::new("gcode.height.up", "and gcode.height.down must be numbers up to 10000000"))
            }
            (Lift::Height, Some(z)) if (z.up - z.down).abs() < 0.05 => {
                Err(Refusal::new("gcode.height.up", "must differ from gcode.height.down by 0.05 mm or more"))
            }
            (Lift::Height, Some(z)) => above_zero("gcode.height.plunge_speed", z.plunge_speed),
            (Lift::Command, _) => Ok(()),
        }
    }

    /// Checks that nothing is written that the controller does not know, that draws during travel, or that exceeds the line
    /// length.
    pub(super) fn check(&self) -> Result<(), Refusal> {
        self.check_lift()?;
        if !self.dwell.contains("{seconds}") && !self.dwell.contains("{milliseconds}") {
            return Err(Refusal::new("gcode.dwell", "must contain {seconds} or {milliseconds}"));
        }
        if !(60..=256).contains(&self.line_length) {
            return Err(Refusal::new("gcode.line_length", "must be from 60 to 256"));
        }
        let own = [("gcode.pause", &self.pause), ("gcode.pen_up", &self.pen_up), ("gcode.pen_down", &self.pen_down)];
        // A profile that lifts by height may have inherited commands that it does not use.
        let used = if self.lift == Lift::Command { 3 } else { 1 };
        let mut lines: Vec<(&str, &str)> = own[..used].iter().filter_map(|(key, line)| Some((*key, line.as_deref()?))).collect();
        lines.push(("gcode.dwell", &self.dwell));
        lines.extend(self.start.iter().map(|line| ("gcode.start", line.as_str())));
        lines.extend(self.end.iter().map(|line| ("gcode.end", line.as_str())));
        lines.extend(self.refill.iter().map(|line| ("gcode.refill", line.as_str())));
        for (key, line) in lines {
            self.check_line(key, line)?;
        }
        for (needed, why) in [("G0", "travel"), ("G1", "drawing")].into_iter().chain(self.arcs.then_some(("G2", "arcs"))) {
            if !self.words.iter().any(|word| word == needed) {
                return Err(Refusal::new("gcode.words", &format!("must contain {needed}, which {why} needs")));
            }
        }
        Ok(())
    }

    fn check_line(&self, key: &str, line: &str) -> Result<(), Refusal> {
        if line.len() > self.line_length || line.contains(['\n', '\r', '?', '!', '~', '(', ';']) || !line.is_ascii() {
            let most = self.line_length;
            return Err(Refusal::new(key, &format!("'{line}' must be one ASCII line of at most {most} bytes without ? ! ~ ( ;")));
        }
        let unknown = line.split_whitespace().enumerate().find(|(i, word)| {
            let is_command = word.starts_with(['G', 'M', 'O', '$']) && word[1..].starts_with(|c: char| c.is_ascii_digit());
            (*i == 0 || is_command) && !self.words.iter().any(|known| known == word)
        });
        match unknown {
            Some((_, word)) => Err(Refusal::new(key, &format!("holds {word}, which is not in gcode.words"))),
            None => Ok(()),
        }
    }
}
