//! G-code: absolute millimetres, the pen's own commands from the profile, a dwell after each.

use super::number::decimal;
use crate::geometry::Point;
use crate::plot::{GcodeDialect, Mounting, Plot, Profile};
use std::fmt::Write as _;
use std::io;

/// Writes a plot for a machine; the mounting says where the page lies. The caller has checked that all of it is within reach.
///
/// # Panics
/// If the profile's language is not G-code.
pub fn write_gcode(plot: &Plot, profile: &Profile, mounting: &Mounting, out: &mut impl io::Write) -> io::Result<()> {
    let dialect = profile.gcode.as_ref().expect("a G-code profile has a dialect");
    let mut writer = Gcode { out, profile, dialect, mounting, line: String::new(), at: None };
    writer.comment(concat!("drypoint ", env!("CARGO_PKG_VERSION")))?;
    for line in &dialect.header {
        writer.comment(line)?;
    }
    for line in &dialect.start {
        writer.command(line)?;
    }
    writer.pen(&dialect.pen_up, profile.motion.pen_up_seconds)?;
    for (i, pen) in plot.pens.iter().enumerate() {
        let is_other_pen = i > 0 && plot.pens[i - 1].number != pen.number;
        if is_other_pen {
            writer.park()?;
        }
        writer.comment(&format!("pen {}: {} {}", pen.number, pen.name, pen.nib))?;
        if is_other_pen || pen.handling.pauses {
            writer.command(&dialect.pause)?;
        }
        writer.dwell(pen.handling.delay_seconds)?;
        for path in &pen.paths {
            writer.path(&path.points, pen.handling.speed(profile.motion.draw_speed))?;
        }
    }
    writer.park()
}

struct Gcode<'a, W: io::Write> {
    out: &'a mut W,
    profile: &'a Profile,
    dialect: &'a GcodeDialect,
    mounting: &'a Mounting,
    line: String,
    at: Option<(i64, i64)>,
}

impl<W: io::Write> Gcode<'_, W> {
    fn command(&mut self, line: &str) -> io::Result<()> {
        self.out.write_all(line.as_bytes())?;
        self.out.write_all(b"\n")
    }

    /// A comment in plain ASCII without the characters that senders and firmware take out (`?!~`) or that end it.
    fn comment(&mut self, text: &str) -> io::Result<()> {
        let plain: String = text
            .chars()
            .map(|c| if c.is_ascii_graphic() || c == ' ' { c } else { '_' })
            .filter(|c| !matches!(c, '?' | '!' | '~' | '(' | ')' | ';'))
            .take(self.dialect.line_length.saturating_sub(4))
            .collect();
        self.command(&format!("({plain})"))
    }

    fn pen(&mut self, command: &str, seconds: f64) -> io::Result<()> {
        self.command(command)?;
        self.dwell(seconds)
    }

    fn dwell(&mut self, seconds: f64) -> io::Result<()> {
        if seconds <= 0.0 {
            return Ok(());
        }
        let (mut whole, mut milli) = (String::new(), String::new());
        decimal(&mut whole, (seconds * 1000.0).round() as i64, 3);
        decimal(&mut milli, (seconds * 1000.0).round() as i64, 0);
        self.command(&self.dialect.dwell.replace("{seconds}", &whole).replace("{milliseconds}", &milli))
    }

    fn path(&mut self, points: &[Point], speed: f64) -> io::Result<()> {
        let (dialect, motion) = (self.dialect, self.profile.motion);
        self.travel(self.snap(points[0]))?;
        self.pen(&dialect.pen_down, motion.pen_down_seconds)?;
        let mut feed = Some(((speed * 60.0).round() as i64).max(1));
        for p in &points[1..] {
            let to = self.snap(*p);
            if Some(to) == self.at {
                continue;
            }
            self.start_move("G1", to);
            if let Some(feed) = feed.take() {
                let _ = write!(self.line, " F{feed}");
            }
            self.end_move(to)?;
        }
        self.pen(&dialect.pen_up, motion.pen_up_seconds)
    }

    fn travel(&mut self, to: (i64, i64)) -> io::Result<()> {
        if Some(to) == self.at {
            return Ok(());
        }
        self.start_move("G0", to);
        self.end_move(to)
    }

    /// Pen up already; to where it does no harm.
    fn park(&mut self) -> io::Result<()> {
        let [x, y] = self.dialect.park;
        self.travel(((x * 1000.0).round() as i64, (y * 1000.0).round() as i64))
    }

    /// Thousandths of a machine unit, inside the limits (the check has forgiven 0.02 mm).
    fn snap(&self, p: Point) -> (i64, i64) {
        let m = self.mounting.to_machine * p;
        let limits = self.mounting.limits;
        let grid = |v: f64, low: f64, high: f64| (v.clamp(low, high) * 1000.0).round() as i64;
        (grid(m.x, limits.x0, limits.x1), grid(m.y, limits.y0, limits.y1))
    }

    fn start_move(&mut self, word: &str, to: (i64, i64)) {
        self.line.clear();
        self.line.push_str(word);
        self.line.push_str(" X");
        decimal(&mut self.line, to.0, 3);
        self.line.push_str(" Y");
        decimal(&mut self.line, to.1, 3);
    }

    fn end_move(&mut self, to: (i64, i64)) -> io::Result<()> {
        self.at = Some(to);
        self.line.push('\n');
        self.out.write_all(self.line.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Colour, Page};
    use crate::plot::{PenPaths, Toolpath, built_in, mount};

    #[test]
    fn a_layer_s_own_pause_speed_and_delay() {
        let profile = Profile::parse("grbl-servo", built_in("grbl-servo").unwrap()).unwrap();
        let page = Page::new(100.0, 50.0);
        let handling = crate::drawing::Handling { pauses: true, speed_percent: Some(50.0), delay_seconds: 0.5 };
        let paths = vec![Toolpath::new(vec![Point::new(0.0, 0.0), Point::new(10.0, 0.0)])];
        let pen = PenPaths { number: 1, name: "slow".into(), colour: Colour::BLACK, nib: 0.3, handling, paths };
        let mut bytes = Vec::new();
        write_gcode(&Plot { page, pens: vec![pen] }, &profile, &mount(&profile, &page).unwrap(), &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.contains("(pen 1: slow 0.3)\nM0\nG4 P.5\n") && text.contains("F1500"), "{text}");
    }

    #[test]
    fn two_pens_pause_between_them_and_nothing_lets_the_servo_fall() {
        let profile = Profile::parse("grbl-servo", built_in("grbl-servo").unwrap()).unwrap();
        let page = Page::new(100.0, 50.0);
        let path = |points: &[(f64, f64)]| Toolpath::new(points.iter().map(|&(x, y)| Point::new(x, y)).collect());
        let pen = |number, name: &str, paths| PenPaths {
            number,
            name: name.into(),
            colour: Colour::BLACK,
            nib: 0.3,
            handling: crate::drawing::Handling::default(),
            paths,
        };
        let plot = Plot {
            page,
            pens: vec![pen(1, "dots", vec![path(&[(0.0, 0.0), (10.0, 0.0)])]), pen(2, "what?! (ééé)", vec![path(&[(5.0, 5.0)])])],
        };
        let mut bytes = Vec::new();
        write_gcode(&plot, &profile, &mount(&profile, &page).unwrap(), &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.iter().all(|l| l.len() <= 78 && l.is_ascii() && !l.contains(['?', '!', '~'])), "{text}");
        assert!(!text.contains("M5") && !text.contains("M2") && !text.contains("M30"));
        assert_eq!(lines.iter().filter(|l| **l == "M0").count(), 1);
        let expected = [
            "G0 X0 Y50",
            "M3 S700",
            "G4 P.2",
            "G1 X10 Y50 F3000",
            "M3 S300",
            "G4 P.15",
            "G0 X0 Y0",
            "(pen 2: what ___ 0.3)",
            "M0",
            "G0 X5 Y45",
        ];
        let start = lines.iter().position(|l| *l == expected[0]).unwrap();
        assert_eq!(&lines[start..start + expected.len()], expected);
        assert_eq!(lines.last(), Some(&"G0 X0 Y0"));
    }
}
