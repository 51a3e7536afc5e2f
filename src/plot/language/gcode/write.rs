//! G-code: absolute machine units, pen commands or heights from the profile, arcs if the machine supports them.

use super::{Comment, GcodeDialect, Lift, Orders, Travel};
use crate::geometry::{Point, Step, fit_arcs};
use crate::plot::{Mounting, PenPaths, Profile, Toolpath};
use crate::write::{decimal, thousandths};
use std::fmt::Write as _;
use std::io;

/// Writes a plot of which all lies within reach, and for whose changes of pen the machine can wait.
pub(super) fn write(dialect: &GcodeDialect, orders: &Orders<'_>, out: &mut dyn io::Write) -> io::Result<()> {
    let Orders { plot, profile, mounting, .. } = *orders;
    let mut writer = Gcode { out, profile, dialect, mounting, line: String::new(), at: None };
    writer.begin()?;
    for (i, pen) in plot.pens.iter().enumerate() {
        let is_other_pen = i > 0 && plot.pens[i - 1].number != pen.number;
        if is_other_pen || pen.handling.pauses {
            writer.park()?;
        }
        writer.comment(&format!("pen {}: {} {}", pen.number, pen.name, pen.nib))?;
        if is_other_pen || pen.handling.pauses {
            writer.pause()?;
        }
        writer.dwell(pen.handling.delay_seconds)?;
        for path in &pen.paths {
            writer.path(pen, path)?;
        }
    }
    writer.park()?;
    dialect.end.iter().chain(&dialect.frame).try_for_each(|line| writer.command(line))
}

/// A point in thousandths of a machine unit.
type Grid = (i64, i64);

struct Gcode<'a> {
    out: &'a mut dyn io::Write,
    profile: &'a Profile,
    dialect: &'a GcodeDialect,
    mounting: &'a Mounting,
    line: String,
    at: Option<Grid>,
}

impl Gcode<'_> {
    /// Modes, then the pen goes up before anything else; then the outline, if it is asked for.
    fn begin(&mut self) -> io::Result<()> {
        let dialect = self.dialect;
        dialect.frame.iter().try_for_each(|line| self.command(line))?;
        self.comment(&format!("drypoint {} for {}", env!("CARGO_PKG_VERSION"), self.profile.name))?;
        dialect.header.iter().try_for_each(|line| self.comment(line))?;
        self.comment_pen()?;
        dialect.start.iter().try_for_each(|line| self.command(line))?;
        self.pen_up()?;
        if let Some(frame) = self.mounting.frame {
            self.comment("outline of the drawing, pen up; then the machine waits")?;
            let corners = [(frame.x0, frame.y0), (frame.x1, frame.y0), (frame.x1, frame.y1), (frame.x0, frame.y1)];
            for (x, y) in corners.into_iter().chain([corners[0]]) {
                self.travel(self.snap(self.mounting.to_machine * Point::new(x, y)))?;
            }
            self.park()?;
            self.pause()?;
        }
        Ok(())
    }

    /// Writes comments with the pen commands, which resuming the file in its middle needs.
    fn comment_pen(&mut self) -> io::Result<()> {
        match (self.dialect.lift, self.dialect.height, &self.dialect.pen_up, &self.dialect.pen_down) {
            (Lift::Height, Some(height), ..) => {
                let mut up = String::new();
                decimal(&mut up, thousandths(height.up), 3);
                self.comment(&format!("pen up is G0 Z{up}"))
            }
            (_, _, Some(up), Some(down)) => {
                self.comment(&format!("pen up is {up}"))?;
                self.comment(&format!("pen down is {down}"))
            }
            _ => Ok(()),
        }
    }

    fn command(&mut self, line: &str) -> io::Result<()> {
        self.out.write_all(line.as_bytes())?;
        self.out.write_all(b"\n")
    }

    /// Writes a comment in plain ASCII, without the characters that senders and firmware remove (`?!~`) or that end the comment.
    /// `LinuxCNC` executes comments that begin with MSG and the like; ours begin with a word and a number or are the profile's.
    fn comment(&mut self, text: &str) -> io::Result<()> {
        let plain: String = text
            .chars()
            .map(|c| if c.is_ascii_graphic() || c == ' ' { c } else { '_' })
            .filter(|c| !matches!(c, '?' | '!' | '~' | '(' | ')' | ';'))
            .take(self.dialect.line_length.saturating_sub(4))
            .collect();
        match self.dialect.comment {
            Comment::Parentheses => self.command(&format!("({plain})")),
            Comment::Semicolon => self.command(&format!("; {plain}")),
        }
    }

    fn pause(&mut self) -> io::Result<()> {
        let Some(pause) = &self.dialect.pause else {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the machine's profile has no pause command"));
        };
        self.command(pause)
    }

    fn dwell(&mut self, seconds: f64) -> io::Result<()> {
        if (seconds * 1000.0).round() as i64 <= 0 {
            return Ok(());
        }
        self.command(&self.dialect.wait(seconds))
    }

    fn pen_up(&mut self) -> io::Result<()> {
        match (self.dialect.lift, self.dialect.height, &self.dialect.pen_up) {
            (Lift::Height, Some(height), _) => {
                self.line.clear();
                self.line.push_str("G0 Z");
                decimal(&mut self.line, thousandths(height.up), 3);
                // If the feed is modal for G0 too, the lift would take the last travel's.
                if self.dialect.travel != Travel::Rapid {
                    let _ = write!(self.line, " F{}", feed(height.plunge_speed));
                }
                self.end_line()
            }
            (_, _, Some(command)) => {
                self.command(command)?;
                self.dwell(self.profile.motion.pen_up_seconds)
            }
            _ => Ok(()),
        }
    }

    /// Lowers the pen to the first vertex's height, and dwells there for a touch. A z axis goes down at its plunge feed, never at
    /// G0's rate.
    fn pen_down(&mut self, path: &Toolpath) -> io::Result<()> {
        match (self.dialect.lift, self.dialect.height, &self.dialect.pen_down) {
            (Lift::Height, Some(height), _) => {
                let z = path.heights().and_then(|heights| heights.first().copied()).unwrap_or(height.down);
                self.line.clear();
                self.line.push_str("G1 Z");
                decimal(&mut self.line, thousandths(z), 3);
                let _ = write!(self.line, " F{}", feed(height.plunge_speed));
                self.end_line()?;
                self.dwell(path.dwell_seconds)
            }
            (_, _, Some(command)) => {
                self.command(command)?;
                self.dwell(self.profile.motion.pen_down_seconds + path.dwell_seconds)
            }
            _ => Ok(()),
        }
    }

    fn path(&mut self, pen: &PenPaths, path: &Toolpath) -> io::Result<()> {
        let places: Vec<Grid> = path.points().iter().map(|p| self.snap(self.mounting.place(pen.number, *p))).collect();
        self.travel(places[0])?;
        self.pen_down(path)?;
        let mut feed = Some(feed(pen.handling.speed(self.profile.motion.draw_speed)));
        match path.heights() {
            Some(heights) if self.dialect.lift == Lift::Height => self.swelling(&places, heights, &mut feed)?,
            _ => self.level(places, &mut feed)?,
        }
        self.pen_up()
    }

    fn level(&mut self, mut places: Vec<Grid>, feed: &mut Option<i64>) -> io::Result<()> {
        places.dedup();
        let point = |(x, y): Grid| Point::new(x as f64 / 1000.0, y as f64 / 1000.0);
        if !self.dialect.arcs || !self.has_room_for_arcs(&places) {
            return places[1..].iter().try_for_each(|to| self.draw("G1", *to, feed, |_| ()));
        }
        let points: Vec<Point> = places.iter().map(|p| point(*p)).collect();
        let mut from = points[0];
        for step in fit_arcs(&points, self.mounting.tolerance * self.profile.units_per_mm) {
            let to = (thousandths(step.to().x), thousandths(step.to().y));
            match step {
                Step::Line { .. } => self.draw("G1", to, feed, |_| ())?,
                Step::Arc { centre, sweep, .. } => {
                    let word = if sweep > 0.0 { "G3" } else { "G2" };
                    self.draw(word, to, feed, |line| {
                        line.push_str(" I");
                        decimal(line, thousandths(centre.x - from.x), 3);
                        line.push_str(" J");
                        decimal(line, thousandths(centre.y - from.y), 3);
                    })?;
                }
            }
            from = step.to();
        }
        Ok(())
    }

    /// False near the machine's limits: an arc lies a little outside its chords and could exceed them.
    fn has_room_for_arcs(&self, places: &[Grid]) -> bool {
        let room = 1.5 * self.mounting.tolerance * self.profile.units_per_mm;
        let inner = self.mounting.limits.inset(-room);
        places.iter().all(|&(x, y)| inner.contains(Point::new(x as f64 / 1000.0, y as f64 / 1000.0)))
    }

    fn swelling(&mut self, places: &[Grid], heights: &[f64], feed: &mut Option<i64>) -> io::Result<()> {
        let mut z = thousandths(heights[0]);
        for (to, height) in places.iter().zip(heights).skip(1) {
            let next = thousandths(*height);
            if Some(*to) != self.at || next != z {
                z = next;
                self.draw("G1", *to, feed, |line| {
                    line.push_str(" Z");
                    decimal(line, next, 3);
                })?;
            }
        }
        Ok(())
    }

    fn draw(&mut self, word: &str, to: Grid, feed: &mut Option<i64>, more: impl FnOnce(&mut String)) -> io::Result<()> {
        self.start_move(word, to);
        more(&mut self.line);
        if let Some(feed) = feed.take() {
            let _ = write!(self.line, " F{feed}");
        }
        self.end_line()
    }

    fn travel(&mut self, to: Grid) -> io::Result<()> {
        if Some(to) == self.at {
            return Ok(());
        }
        let travel = self.dialect.travel;
        self.start_move(if travel == Travel::Feed { "G1" } else { "G0" }, to);
        if travel != Travel::Rapid {
            let _ = write!(self.line, " F{}", feed(self.profile.motion.travel_speed));
        }
        self.end_line()
    }

    /// Moves to the park position. The pen is already up.
    fn park(&mut self) -> io::Result<()> {
        self.travel((thousandths(self.mounting.park.x), thousandths(self.mounting.park.y)))
    }

    /// Snaps to thousandths of a machine unit, inside the limits (the check allows 0.02 mm beyond them).
    fn snap(&self, p: Point) -> Grid {
        let limits = self.mounting.limits;
        (thousandths(p.x.clamp(limits.x0, limits.x1)), thousandths(p.y.clamp(limits.y0, limits.y1)))
    }

    fn start_move(&mut self, word: &str, to: Grid) {
        self.line.clear();
        self.line.push_str(word);
        self.line.push_str(" X");
        decimal(&mut self.line, to.0, 3);
        self.line.push_str(" Y");
        decimal(&mut self.line, to.1, 3);
        self.at = Some(to);
    }

    fn end_line(&mut self) -> io::Result<()> {
        self.line.push('\n');
        self.out.write_all(self.line.as_bytes())
    }
}

/// Converts mm/s to whole mm/min, at least 1.
fn feed(speed: f64) -> i64 {
    ((speed * 60.0).round() as i64).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Colour, Page};
    use crate::plot::Plot;
    use crate::plot::language::written;

    #[test]
    fn a_layer_s_own_pause_speed_and_delay() {
        let profile = Profile::built_in("grbl-servo").unwrap();
        let page = Page::new(100.0, 50.0);
        let handling = crate::drawing::Handling { pauses: true, speed_percent: Some(50.0), delay_seconds: 0.5 };
        let paths = vec![Toolpath::through(Point::new(0.0, 0.0), [Point::new(10.0, 0.0)])];
        let pen = PenPaths { number: 1, name: "slow".into(), colour: Colour::BLACK, nib: 0.3, handling, paths };
        let text = written(&Plot { page, pens: vec![pen] }, &profile);
        assert!(text.contains("(pen 1: slow 0.3)\nM0\nG4 P.5\n") && text.contains("F1500"), "{text}");
    }

    #[test]
    fn two_pens_pause_between_them_and_nothing_lets_the_servo_fall() {
        let profile = Profile::built_in("grbl-servo").unwrap();
        let page = Page::new(100.0, 50.0);
        let path = |points: &[(f64, f64)]| Toolpath::new(points.iter().map(|&(x, y)| Point::new(x, y)).collect()).unwrap();
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
        let text = written(&plot, &profile);
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
