//! The time of each line of a machine's file, as the machine plans it.

use super::look_ahead::LookAhead;
use super::turned;
use crate::geometry::Point;
use crate::interrupt::{Interrupt, Interrupted};
use crate::plot::language::{Act, Replayed};
use crate::plot::profile::{Limits, Profile};

/// Every line of a machine's file with what it does; `None` if the file is a drawing.
pub fn replayed<'a>(profile: &Profile, text: &'a str) -> Option<Vec<Replayed<'a>>> {
    let rate = 60.0 * profile.units_per_mm * profile.motion.draw_speed;
    profile.speech().replay(text, rate, profile.units_per_mm)
}

/// The time from the start to the end of each line of a file, in seconds: its text, what it does, and the position after it.
pub fn line_times<'a>(
    profile: &Profile,
    lines: impl ExactSizeIterator<Item = (&'a str, Act, [f64; 3])>,
    interrupt: &Interrupt,
) -> Result<Vec<f64>, Interrupted> {
    let planner = LookAhead::new(&profile.motion, lines.len());
    let mut run = FileRun { profile, planner, from: [0.0; 3], is_up: true };
    for (slot, line) in lines.enumerate() {
        if slot % 4096 == 0 {
            interrupt.check()?;
        }
        run.take(line, slot);
    }
    run.planner.rest();
    let mut sum = 0.0;
    let until = run.planner.seconds().iter().map(|seconds| {
        sum += seconds;
        sum
    });
    Ok(until.collect())
}

/// A machine replaying a file.
struct FileRun<'a> {
    profile: &'a Profile,
    planner: LookAhead,
    /// The position before the line, in machine units.
    from: [f64; 3],
    is_up: bool,
}

impl FileRun<'_> {
    fn take(&mut self, (text, act, at): (&str, Act, [f64; 3]), slot: usize) {
        let scale = self.profile.units_per_mm;
        let place = at.map(|v| v / scale);
        let rapid = match self.profile.motion.planner.limits {
            Limits::Axis => f64::INFINITY,
            Limits::Path => self.profile.motion.travel_speed,
        };
        match act {
            Act::Mode | Act::Pen(_) => {}
            Act::Lift | Act::Lower => {
                self.is_up = act == Act::Lift;
                self.move_pen(text, act, place, slot);
            }
            Act::Pause => self.planner.rest(),
            Act::Wait(seconds) => {
                let tick = self.profile.motion.planner.dwell_step_seconds;
                let lasting = if tick > 0.0 { (seconds / tick - 1e-6).ceil() * tick } else { seconds };
                self.planner.rest();
                self.planner.wait(lasting, slot);
            }
            Act::Rapid => self.planner.travel(place, rapid, slot),
            Act::Line(rate) if self.is_up => self.planner.travel(place, rate / (60.0 * scale), slot),
            Act::Line(rate) => self.planner.line(place, rate / (60.0 * scale), slot),
            Act::Arc { centre, sweep, rate } => self.arc(centre, sweep, rate / (60.0 * scale), place, slot),
        }
        self.from = at;
    }

    /// A servo lets the motion come to rest; a z axis moves.
    fn move_pen(&mut self, text: &str, act: Act, place: [f64; 3], slot: usize) {
        match self.profile.height() {
            Some(_) if text.starts_with("G0") && self.profile.motion.planner.limits == Limits::Axis => {
                self.planner.travel(place, f64::INFINITY, slot);
            }
            Some(height) => self.planner.travel(place, height.plunge_speed, slot),
            None => {
                self.planner.rest();
                if self.profile.speech().pen_takes_time() {
                    let motion = &self.profile.motion;
                    let lasting = if act == Act::Lift { motion.pen_up_seconds } else { motion.pen_down_seconds };
                    self.planner.wait(lasting, slot);
                }
            }
        }
    }

    fn arc(&mut self, centre: Point, sweep: f64, rate: f64, to: [f64; 3], slot: usize) {
        let scale = self.profile.units_per_mm;
        if let Some(tolerance) = self.profile.motion.planner.arc_tolerance {
            let arm = (Point::new(self.from[0], self.from[1]) - centre) / scale;
            let radius = arm.hypot();
            let rise = (tolerance * (2.0 * radius - tolerance)).max(1e-12).sqrt();
            let count = (0.5 * sweep.abs() * radius / rise).floor().min(1e6);
            let middle = Point::new(centre.x / scale, centre.y / scale);
            for arm in turned(arm, sweep / count.max(1.0), count as usize) {
                let place = middle + arm;
                self.planner.chord([place.x, place.y, to[2]], rate, slot);
            }
        }
        self.planner.line(to, rate, slot);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Colour, Handling, Page};
    use crate::elementary::Elementary as _;
    use crate::plot::language::written;
    use crate::plot::{PenPaths, PenTime, Plot, Toolpath, clock, mount};

    /// Lines, an arc, dots and a second pen.
    fn plot() -> Plot {
        let path = |points: &[(f64, f64)]| Toolpath::new(points.iter().map(|&(x, y)| Point::new(x, y)).collect()).unwrap();
        let round = (0..=60).map(|i| 0.05 * f64::from(i)).map(|t| Point::new(60.0 + 9.0 * t.cosine(), 20.0 + 9.0 * t.sine()));
        let paths =
            vec![path(&[(1.0, 2.0), (30.0, 2.0), (30.0, 31.0)]), Toolpath::new(round.collect()).unwrap(), path(&[(80.0, 8.0)])];
        let handling = Handling::default();
        let pen = PenPaths { number: 1, name: "lines".into(), colour: Colour::BLACK, nib: 0.3, handling, paths };
        let other = PenPaths { number: 2, name: "more".into(), ..pen.clone() };
        Plot { page: Page::new(100.0, 50.0), pens: vec![pen, other] }
    }

    #[test]
    fn a_file_takes_the_time_of_its_plot() {
        for machine in ["grbl-servo", "grbl-z", "fluidnc", "marlin-z", "klipper", "hp7475a"] {
            let profile = Profile::built_in(machine).unwrap();
            let text = written(&plot(), &profile);
            let lines = replayed(&profile, &text).unwrap();
            let until = line_times(&profile, lines.iter().map(|line| (&*line.text, line.act, line.at)), &Interrupt::never());
            let mounting = mount(&profile, &plot().page).unwrap();
            let told: f64 = clock(&plot(), &profile, &mounting, &Interrupt::never()).unwrap().iter().map(PenTime::total).sum();
            let until = until.unwrap();
            let end = until.last().copied().unwrap();
            // Changing pens in a carousel is not told by the file.
            let told = if machine == "hp7475a" { told - 2.0 * profile.pens.change_seconds } else { told };
            assert!((end / told - 1.0).abs() < 0.004, "{machine}: {end} s, the plot {told} s");
            assert!(until.is_sorted());
        }
    }

    #[test]
    fn a_drawing_has_no_lines() {
        assert_eq!(replayed(&Profile::built_in("axidraw-v3").unwrap(), "<svg/>"), None);
    }
}
