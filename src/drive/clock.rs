//! The time that is drawn, between what a machine certainly drew and what it took.
//!
//! A machine takes lines some seconds ahead of its pen, and in gulps. The clock runs on by itself, never out of these bounds, and is set
//! right by every place that the machine tells.

use super::program::Program;
use super::stand::Stand;
use crate::geometry::Point;
use std::ops::Range;
use std::time::Instant;

/// Places as near as this to the nearest one, in machine units, are told apart by the time alone.
const AS_NEAR: f64 = 0.01;

/// The seconds of a program that are drawn.
pub(super) struct Clock {
    done: f64,
    read: Instant,
}

impl Clock {
    /// A clock at the program's beginning.
    pub fn new() -> Self {
        Self { done: 0.0, read: Instant::now() }
    }

    /// Seconds drawn.
    pub fn done(&self) -> f64 {
        self.done
    }

    /// Runs on at a percent of the file's speed, 0 where the machine waits, within the time of the lines that may be under the pen.
    pub fn run(&mut self, program: &Program, lines: &Range<usize>, percent: u32) {
        let now = Instant::now();
        self.done += (now - self.read).as_secs_f64() * f64::from(percent) / 100.0;
        self.read = now;
        let [least, most] = [before(program, lines.start), before(program, lines.end)];
        self.done = self.done.min(most).max(least);
    }

    /// Sets it to when the pen is where the machine stands. Where the program passes there more than once, the time nearest to the
    /// clock's counts.
    pub fn set(&mut self, program: &Program, lines: Range<usize>, stand: &Stand) {
        let place = Point::new(stand.at[0], stand.at[1]);
        let passes = || lines.clone().map(|i| pass(program, i, place, self.done));
        let nearest = passes().map(|(_, distance)| distance).fold(f64::INFINITY, f64::min);
        let times = passes().filter(|(_, distance)| *distance <= nearest + AS_NEAR).map(|(time, _)| time);
        if let Some(time) = times.min_by(|a, b| (a - self.done).abs().total_cmp(&(b - self.done).abs())) {
            self.done = time;
        }
    }
}

/// When the lines before one are done.
fn before(program: &Program, line: usize) -> f64 {
    if line == 0 { 0.0 } else { program.lines[line - 1].until }
}

/// When a line is nearest to a place, and how near. A line that does not move is there as long as it takes: then the time nearest to
/// `about`.
fn pass(program: &Program, line: usize, place: Point, about: f64) -> (f64, f64) {
    let (begin, end) = (before(program, line), program.lines[line].until);
    let (fraction, distance) = program.nearest_on(line, place);
    let moves = program.before(line) != program.after(line);
    (if moves { begin + fraction * (end - begin) } else { about.clamp(begin, end.max(begin)) }, distance)
}

#[cfg(test)]
mod tests {
    use super::super::program::tests::program;
    use super::*;

    #[test]
    fn a_place_tells_the_time() {
        let (_, program) = program();
        let all = 0..program.lines.len();
        let stand = |x: f64, y: f64| Stand { at: [x, y, 0.0], servo: None };
        let mut clock = Clock::new();
        // The first stroke runs from 1, 1 to 5, 1.
        clock.set(&program, all.clone(), &stand(3.0, 1.02));
        let [begin, end] = [before(&program, 10), before(&program, 11)];
        assert!((clock.done() - f64::midpoint(begin, end)).abs() < 1e-9, "{}", clock.done());
        // At its beginning the pen also waits; the clock says which.
        clock.done = begin - 0.1;
        clock.set(&program, all.clone(), &stand(1.0, 1.0));
        assert!((clock.done() - begin + 0.1).abs() < 1e-9);
        // Zero is passed before the first path and after both.
        clock.done = program.seconds() - 0.01;
        clock.set(&program, all, &stand(0.0, 0.0));
        assert!(clock.done() > program.seconds() - 0.5);
    }

    #[test]
    fn the_clock_stays_between_what_is_drawn_and_what_is_taken() {
        let (_, program) = program();
        let mut clock = Clock::new();
        clock.run(&program, &(0..0), 100);
        assert!(clock.done() <= 0.0);
        clock.run(&program, &(11..12), 0);
        assert!((clock.done() - before(&program, 11)).abs() < 1e-12);
        clock.done = 1e9;
        clock.run(&program, &(11..12), 100);
        assert!((clock.done() - before(&program, 12)).abs() < 1e-12);
    }
}
