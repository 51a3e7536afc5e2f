//! Dipping the pen: after a length of line or a time of drawing it goes to the ink, comes down, waits, and goes on with the next path.

use super::error::DriveError;
use super::modes::with_feed;
use super::program::{Program, ProgramLine};
use crate::interrupt::Interrupt;
use crate::plot::{Act, Language, Profile, replayed, word};

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

/// How a pen gets its ink.
#[derive(Clone, Debug, PartialEq)]
pub enum Refill {
    /// It goes to an inkwell, comes down, waits, and rises.
    Well(Inkwell),
    /// By lines of the profile's own, in which the place is filled in.
    Lines(Vec<String>),
    /// The machine waits, and the user sees to it.
    User,
}

impl Program {
    /// The program with refills between its paths. The first is before the first path, but for a user, who begins with a full pen.
    pub fn with_dips(&self, profile: &Profile, dip: Dip, refill: &Refill, interrupt: &Interrupt) -> Result<Self, DriveError> {
        let is_by_user = *refill == Refill::User;
        if profile.language() != Language::Gcode && !is_by_user {
            return Err(DriveError::Unfit("the machine goes to the ink in G-code only; it may wait for you instead".to_owned()));
        }
        let mut lines = self.lines[..self.paths.first().map_or(0, |path| path.begin)].to_vec();
        let (mut used, mut feed) = (0.0, None);
        for (i, path) in self.paths.iter().enumerate() {
            let most = match dip {
                Dip::Millimetres(most) | Dip::Seconds(most) => most,
            };
            let is_fresh = self.has_fresh_pen(i);
            let is_dipped = used >= most || is_fresh && !is_by_user;
            let from = i.checked_sub(1).map_or(0, |before| self.paths[before].begin);
            feed = self.lines[from..path.begin].iter().rev().find_map(|line| word(&line.text, 'F')).or(feed);
            if is_dipped {
                lines.extend(match refill {
                    Refill::Well(ink) => self.dip(i, profile, *ink, feed),
                    Refill::Lines(own) => self.refill(i, profile, own),
                    Refill::User => vec![self.wait_for_ink(i)],
                });
            }
            if is_dipped || is_fresh {
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

    /// The profile's own lines before a path.
    fn refill(&self, path: usize, profile: &Profile, own: &[String]) -> Vec<ProgramLine> {
        let z = self.lines[self.paths[path].lift].at[2];
        let text = own.join("\n");
        let lines = replayed(profile, &text).unwrap_or_default().into_iter();
        lines
            .map(|line| ProgramLine {
                text: line.text.into_owned(),
                number: 0,
                act: line.act,
                at: [line.at[0], line.at[1], z],
                until: 0.0,
                name: None,
            })
            .collect()
    }

    /// A line at which the machine waits for the user.
    fn wait_for_ink(&self, path: usize) -> ProgramLine {
        let at = self.paths[path].begin.checked_sub(1).map_or([0.0; 3], |before| self.lines[before].at);
        ProgramLine { text: String::new(), number: 0, act: Act::Pause, at, until: 0.0, name: Some("ink".to_owned()) }
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

    /// Paths of 10 mm for `grbl-servo`.
    fn plot(paths: usize) -> String {
        let mut text = "(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nM3 S300\nG4 P.15\n(pen 1: lines 0.3)\n".to_owned();
        for y in 0..paths {
            text += &["G0 X0 Y", "\nM3 S700\nG4 P.2\nG1 X10 Y", " F3000\nM3 S300\nG4 P.15\n"].join(&y.to_string());
        }
        text
    }

    #[test]
    fn the_pen_is_dipped_between_paths_and_dips_are_no_paths() {
        let text = plot(6);
        let profile = Profile::built_in("grbl-servo").unwrap();
        let program = Program::read(&profile, &text, &Interrupt::never()).unwrap();
        let ink = Refill::Well(Inkwell { at: [200.0, 5.0], seconds: 0.5 });
        let dipped = program.with_dips(&profile, Dip::Millimetres(20.0), &ink, &Interrupt::never()).unwrap();
        assert_eq!(dipped.paths.len(), 6);
        let dips: Vec<usize> = (0..dipped.lines.len()).filter(|i| dipped.lines[*i].text == "G0 X200.000 Y5.000 F6000").collect();
        assert_eq!(dips.len(), 3, "before the first, the third and the fifth path");
        let texts: Vec<&str> = dipped.lines[dips[1]..].iter().take(7).map(|line| line.text.as_str()).collect();
        assert_eq!(texts, ["G0 X200.000 Y5.000 F6000", "M3 S700", "G4 P.2", "G4 P.5", "M3 S300", "G4 P.15", "G0 X0 Y2"]);
        // A pause never leaves the pen in the ink: a dip belongs to the path before it.
        assert!(dips[1..].iter().all(|dip| dipped.paths.iter().any(|path| (path.begin..path.end).contains(dip))));
        let timed = program.with_dips(&profile, Dip::Seconds(1e9), &ink, &Interrupt::never()).unwrap();
        assert_eq!(timed.lines.len(), program.lines.len() + 6, "once, at the beginning");
        let changed = text.replace("G0 X0 Y3\n", "G0 X0 Y0\n(pen 2: red 0.5)\nM0\nG0 X0 Y3\n");
        let program = Program::read(&profile, &changed, &Interrupt::never()).unwrap();
        let fresh = program.with_dips(&profile, Dip::Seconds(1e9), &ink, &Interrupt::never()).unwrap();
        assert_eq!(fresh.lines.len(), program.lines.len() + 12, "each pen once");
    }

    #[test]
    fn a_user_or_the_profile_s_own_lines_may_see_to_the_ink() {
        let text = plot(4);
        let profile = Profile::built_in("grbl-servo").unwrap();
        let program = Program::read(&profile, &text, &Interrupt::never()).unwrap();
        let by_user = program.with_dips(&profile, Dip::Millimetres(15.0), &Refill::User, &Interrupt::never()).unwrap();
        let waits: Vec<usize> = (0..by_user.lines.len()).filter(|i| by_user.lines[*i].act == Act::Pause).collect();
        assert_eq!(waits.len(), 1, "after the second path");
        assert_eq!((by_user.path_of(waits[0]), by_user.lines[waits[0]].at), (2, [10.0, 1.0, 0.0]));
        let own = ["G0 X200 Y5", "M3 S900", "G4 P1", "M3 S300"].map(str::to_owned).to_vec();
        let refilled = program.with_dips(&profile, Dip::Millimetres(15.0), &Refill::Lines(own), &Interrupt::never()).unwrap();
        assert_eq!(refilled.paths.len(), 4);
        assert_eq!(
            refilled.lines.iter().filter(|line| line.text == "M3 S900").count(),
            2,
            "at the beginning, and after two paths"
        );
    }
}
