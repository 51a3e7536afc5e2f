//! G-code line by line: what each line makes the machine do, and where it is then.

use super::GcodeDialect;
use super::resume::{PenWords, names_pen};
use super::words::words;
use crate::elementary::Elementary as _;
use crate::geometry::Point;
use crate::plot::language::{Act, Replayed};
use std::borrow::Cow;
use std::f64::consts::TAU;

/// The state that lines change.
struct Modes {
    at: [f64; 3],
    /// The last of G0 to G3.
    motion: u32,
    feed: f64,
}

/// Every line of a file. `rate` is the drawing speed before the first `F`, in machine units per minute.
pub(super) fn replay<'a>(dialect: &GcodeDialect, text: &'a str, rate: f64) -> Vec<Replayed<'a>> {
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    let usual = match (&dialect.pen_up, &dialect.pen_down, super::Speech::height(dialect)) {
        (Some(up), Some(down), None) => Some(PenWords { up, down: Some(down) }),
        _ => None,
    };
    let pen = PenWords::of(&lines).or(usual);
    let mut modes = Modes { at: [0.0; 3], motion: 0, feed: rate };
    let height = super::Speech::height(dialect);
    let replayed = lines.into_iter().map(|text| {
        let act = modes.take(text, pen.as_ref(), height.map(|height| (height.up, height.down)), dialect);
        Replayed { text: Cow::Borrowed(text), act, at: modes.at }
    });
    replayed.collect()
}

impl Modes {
    fn take(&mut self, text: &str, pen: Option<&PenWords<'_>>, heights: Option<(f64, f64)>, dialect: &GcodeDialect) -> Act {
        if names_pen(text) {
            let number: String = text.chars().skip_while(|c| !c.is_ascii_digit()).take_while(char::is_ascii_digit).collect();
            return Act::Pen(number.parse().unwrap_or(1));
        }
        let code = text.split(['(', ';', '%']).next().unwrap_or("").trim();
        let values = words(code);
        let stops = |word: &(char, f64)| word.0 == 'M' && [0.0, 1.0].contains(&word.1);
        if code == "PAUSE" || dialect.pause.as_deref() == Some(code) || values.iter().any(stops) {
            return Act::Pause;
        }
        let value = |letter: char| values.iter().find(|word| word.0 == letter).map(|word| word.1);
        if let Some(z) = value('Z') {
            self.at[2] = z;
        }
        if let Some(pen) = pen.filter(|pen| pen.down.is_some()) {
            if pen.lifts(code) {
                return Act::Lift;
            }
            if pen.lowers(code) {
                return Act::Lower;
            }
        }
        self.feed = value('F').unwrap_or(self.feed);
        let codes: Vec<f64> = values.iter().filter(|word| word.0 == 'G').map(|word| word.1).collect();
        if codes.contains(&4.0) {
            let unit = if dialect.dwell.contains("{milliseconds}") { 0.001 } else { 1.0 };
            return Act::Wait(value('P').unwrap_or(0.0) * unit);
        }
        if let Some(motion) = codes.iter().find(|code| (0.0..=3.0).contains(*code) && code.fract() == 0.0) {
            self.motion = *motion as u32;
        }
        let (x, y) = (value('X'), value('Y'));
        if x.is_none() && y.is_none() {
            return self.by_height(value('Z'), heights);
        }
        let from = Point::new(self.at[0], self.at[1]);
        (self.at[0], self.at[1]) = (x.unwrap_or(from.x), y.unwrap_or(from.y));
        self.motion_from(from, value('I').unwrap_or(0.0), value('J').unwrap_or(0.0))
    }

    /// A move of the z axis alone lifts or lowers the pen.
    fn by_height(&self, z: Option<f64>, heights: Option<(f64, f64)>) -> Act {
        match (z, heights) {
            (Some(z), Some((up, down))) if (z - up).abs() <= (z - down).abs() && (z - up) * (down - up) <= 0.0 => Act::Lift,
            (Some(z), Some((up, down))) if (z - up).abs() < 0.5 * (z - down).abs() => Act::Lift,
            (Some(_), Some(_)) => Act::Lower,
            (Some(_), None) => Act::Line(self.feed),
            (None, _) => Act::Mode,
        }
    }

    fn motion_from(&self, from: Point, i: f64, j: f64) -> Act {
        let (to, rate) = (Point::new(self.at[0], self.at[1]), self.feed);
        let centre = Point::new(from.x + i, from.y + j);
        let (a, b) = (from - centre, to - centre);
        let turn = a.cross(b).angle_over(a.dot(b));
        match self.motion {
            0 => Act::Rapid,
            1 => Act::Line(rate),
            2 => Act::Arc { centre, sweep: if turn >= -5e-7 { turn - TAU } else { turn }, rate },
            _ => Act::Arc { centre, sweep: if turn <= 5e-7 { turn + TAU } else { turn }, rate },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Dialect, Profile};

    fn acts(machine: &str, text: &str) -> Vec<Act> {
        let profile = Profile::built_in(machine).unwrap();
        let Dialect::Gcode(dialect) = &profile.dialect else { panic!("{machine} speaks G-code") };
        replay(dialect, text, 3000.0).iter().map(|line| line.act).collect()
    }

    #[test]
    fn each_line_is_one_act() {
        let text = "(drypoint)\n(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nM3 S300\nG4 P.15\n(pen 2: dots 0.3)\nM0\nG0 X1 Y2\nM3 S700\nG1 X3 F1200\nX4\nG2 X6 Y2 I1 J0\n";
        let arc = Act::Arc { centre: Point::new(5.0, 2.0), sweep: -std::f64::consts::PI, rate: 1200.0 };
        let expected = [
            Act::Mode,
            Act::Mode,
            Act::Mode,
            Act::Mode,
            Act::Lift,
            Act::Wait(0.15),
            Act::Pen(2),
            Act::Pause,
            Act::Rapid,
            Act::Lower,
            Act::Line(1200.0),
            Act::Line(1200.0),
            arc,
        ];
        assert_eq!(acts("grbl-servo", text), expected);
    }

    #[test]
    fn every_way_to_say_a_pause_is_one() {
        let acts = acts("grbl-servo", "M0\nm0\nN10 M00\nM1\nM0 P1\nM10\nM03 S5\n");
        assert_eq!(acts.iter().filter(|act| **act == Act::Pause).count(), 5, "{acts:?}");
    }

    #[test]
    fn a_z_axis_lifts_and_lowers() {
        let acts = acts("grbl-z", "G0 Z5\nG0 X1 Y1\nG1 Z0 F300\nG1 X2 Y2 Z-.1 F600\nG0 Z5\n");
        assert!(matches!(acts[..], [Act::Lift, Act::Rapid, Act::Lower, Act::Line(_), Act::Lift]), "{acts:?}");
    }
}
