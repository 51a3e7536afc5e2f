//! Dipping the pen: after a length of line or a time of drawing it goes to the ink, comes down, waits, and goes on with the next path.

use super::error::DriveError;
use super::modes::with_feed;
use super::program::{Program, ProgramLine};
use crate::interrupt::Interrupt;
use crate::plot::{Act, Language, Profile, word};

/// When a pen is dipped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dip {
    /// After a length of line.
    Millimetres(f64),
    /// After a time of drawing.
    Seconds(f64),
}

/// Where the ink stands, and how long the pen stays in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inkwell {
    /// Its place, in machine units.
    pub at: [f64; 2],
    /// Seconds in the ink.
    pub seconds: f64,
}

impl Program {
    /// The program with dips between its paths; the first is before the first path.
    pub fn with_dips(&self, profile: &Profile, dip: Dip, ink: Inkwell, interrupt: &Interrupt) -> Result<Self, DriveError> {
        if profile.language() != Language::Gcode {
            return Err(DriveError::Unfit("dips are for G-code".to_owned()));
        }
        let mut lines = self.lines[..self.paths.first().map_or(0, |path| path.begin)].to_vec();
        let (mut used, mut feed) = (f64::INFINITY, None);
        for (i, path) in self.paths.iter().enumerate() {
            let most = match dip {
                Dip::Millimetres(most) | Dip::Seconds(most) => most,
            };
            let is_dipped = used >= most || self.has_fresh_pen(i);
            let from = i.checked_sub(1).map_or(0, |before| self.paths[before].begin);
            feed = self.lines[from..path.begin].iter().rev().find_map(|line| word(&line.text, 'F')).or(feed);
            if is_dipped {
                lines.extend(self.dip(i, profile, ink, feed));
                used = 0.0;
            }
            used += match dip {
                Dip::Millimetres(_) => self.length(i) / profile.units_per_mm,
                Dip::Seconds(_) => self.lines[path.lift].until - self.lines[path.lower].until,
            };
            let next = self.paths.get(i + 1).map_or(self.lines.len(), |next| next.begin);
            lines.extend(if is_dipped { self.anew(i, feed) } else { self.lines[path.begin..path.end].to_vec() });
            lines.extend_from_slice(&self.lines[path.end..next]);
        }
        self.with_lines(profile, lines, interrupt)
    }

    /// True if the pen was changed before a path.
    fn has_fresh_pen(&self, path: usize) -> bool {
        let Some(before) = path.checked_sub(1).map(|before| &self.paths[before]) else { return true };
        let own = &self.paths[path];
        own.pen != before.pen || self.lines[before.end..own.begin].iter().any(|line| line.act == Act::Pause)
    }

    /// The lines of a dip, with the pen commands of a path.
    fn dip(&self, path: usize, profile: &Profile, ink: Inkwell, feed: Option<f64>) -> Vec<ProgramLine> {
        let path = &self.paths[path];
        let [x, y] = ink.at;
        let travel = 60.0 * profile.motion.travel_speed * profile.units_per_mm;
        let line = |text: String, act: Act, z: f64| ProgramLine { text, number: 0, act, at: [x, y, z], until: 0.0, name: None };
        let copied = |range: std::ops::Range<usize>| {
            let with_own = |own: &ProgramLine| {
                let feed = feed.filter(|_| word(&own.text, 'Z').is_some());
                line(with_feed(own.text.clone(), feed), own.act, own.at[2])
            };
            self.lines[range].iter().map(with_own).collect::<Vec<_>>()
        };
        let up = self.lines[path.lift].at[2];
        let mut lines = vec![line(format!("G0 X{x:.3} Y{y:.3} F{travel:.0}"), Act::Rapid, up)];
        lines.extend(copied(path.lower..path.draw));
        if let Some(text) = profile.wait_command(ink.seconds) {
            lines.push(line(text, Act::Wait(ink.seconds), self.lines[path.lower].at[2]));
        }
        lines.extend(copied(path.lift..path.end));
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pen_is_dipped_between_paths_and_dips_are_no_paths() {
        let mut text = "(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nM3 S300\nG4 P.15\n(pen 1: lines 0.3)\n".to_owned();
        for y in 0..6 {
            text += &["G0 X0 Y", "\nM3 S700\nG4 P.2\nG1 X10 Y", " F3000\nM3 S300\nG4 P.15\n"].join(&y.to_string());
        }
        let profile = Profile::built_in("grbl-servo").unwrap();
        let program = Program::read(&profile, &text, &Interrupt::never()).unwrap();
        let ink = Inkwell { at: [200.0, 5.0], seconds: 0.5 };
        let dipped = program.with_dips(&profile, Dip::Millimetres(20.0), ink, &Interrupt::never()).unwrap();
        assert_eq!(dipped.paths.len(), 6);
        let dips: Vec<usize> = (0..dipped.lines.len()).filter(|i| dipped.lines[*i].text == "G0 X200.000 Y5.000 F6000").collect();
        assert_eq!(dips.len(), 3, "before the first, the third and the fifth path");
        let texts: Vec<&str> = dipped.lines[dips[1]..].iter().take(7).map(|line| line.text.as_str()).collect();
        assert_eq!(texts, ["G0 X200.000 Y5.000 F6000", "M3 S700", "G4 P.2", "G4 P.5", "M3 S300", "G4 P.15", "G0 X0 Y2"]);
        // A pause never leaves the pen in the ink: a dip belongs to the path before it.
        assert!(dips[1..].iter().all(|dip| dipped.paths.iter().any(|path| (path.begin..path.end).contains(dip))));
        let timed = program.with_dips(&profile, Dip::Seconds(1e9), ink, &Interrupt::never()).unwrap();
        assert_eq!(timed.lines.len(), program.lines.len() + 6, "once, at the beginning");
        let changed = text.replace("G0 X0 Y3\n", "G0 X0 Y0\n(pen 2: red 0.5)\nM0\nG0 X0 Y3\n");
        let program = Program::read(&profile, &changed, &Interrupt::never()).unwrap();
        let fresh = program.with_dips(&profile, Dip::Seconds(1e9), ink, &Interrupt::never()).unwrap();
        assert_eq!(fresh.lines.len(), program.lines.len() + 12, "each pen once");
    }
}
