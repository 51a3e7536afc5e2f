//! Keeps wet lines from being crossed: paths are put off, and the machine waits when nothing else is left to draw.

use super::profile::Motion;
use super::{PenPaths, Plot, Toolpath};
use crate::geometry::Point;
use crate::interrupt::{Interrupt, Interrupted};
use std::collections::{HashMap, VecDeque};

/// Cells per nib in which wet ink is tracked: lines whose centres are less than about half a nib apart share or touch one.
const CELLS_A_NIB: f64 = 2.0;

/// Puts off every path that would touch another path's ink drawn less than `seconds` ago, otherwise keeping the plot's order, and
/// makes the machine wait with the pen up where only such paths are left. Speeds are taken as constant: a machine that must
/// accelerate leaves the ink more time. Returns the seconds waited.
///
/// Paths of a group are put off one by one. O(length of ink / nib) for each round; there are about as many rounds as paths
/// overlap one another.
pub fn delay_for_drying(
    plot: &mut Plot,
    seconds: f64,
    home: Point,
    motion: &Motion,
    interrupt: &Interrupt,
) -> Result<f64, Interrupted> {
    let mut paper = Paper { wet: HashMap::new(), seconds, now: 0.0, at: home, waited: 0.0 };
    let mut drawn = Vec::new();
    for pen in &plot.pens {
        drawn.extend(paper.draw(pen, motion, interrupt)?);
    }
    plot.pens = drawn;
    Ok(paper.waited)
}

/// A cell of the page.
type Cell = (i32, i32);

/// The sheet as it is being drawn on.
struct Paper {
    /// Time at which each cell was last inked.
    wet: HashMap<Cell, f64>,
    seconds: f64,
    now: f64,
    at: Point,
    waited: f64,
}

impl Paper {
    /// One pen's paths in drawing order, split where the machine waits.
    fn draw(&mut self, pen: &PenPaths, motion: &Motion, interrupt: &Interrupt) -> Result<Vec<PenPaths>, Interrupted> {
        let cell = pen.nib.max(0.05) / CELLS_A_NIB;
        let speed = pen.handling.speed(motion.draw_speed);
        let with_cells = |path: &Toolpath| interrupt.check().map(|()| (path.clone(), cells(path.points(), cell)));
        let mut left: VecDeque<(Toolpath, Vec<Cell>)> = pen.paths.iter().map(with_cells).collect::<Result<_, _>>()?;
        let empty = |delay_seconds: f64| {
            let handling = crate::drawing::Handling { delay_seconds, ..pen.handling };
            PenPaths { handling, paths: Vec::new(), ..pen.clone() }
        };
        let mut parts = vec![empty(pen.handling.delay_seconds)];
        while !left.is_empty() {
            let mut put_off = VecDeque::new();
            let mut soonest = f64::INFINITY;
            let before = left.len();
            for (path, cells) in left {
                interrupt.check()?;
                let dry_at = self.dry_at(&cells);
                if dry_at > self.now {
                    soonest = soonest.min(dry_at);
                    put_off.push_back((path, cells));
                    continue;
                }
                let ends = path.ends();
                self.now += self.at.distance(ends.start) / motion.travel_speed + motion.pen_down_seconds;
                self.now += path.length() / speed + path.dwell_seconds + motion.pen_up_seconds;
                self.at = ends.end;
                self.wet.extend(cells.iter().map(|cell| (*cell, self.now)));
                parts.last_mut().into_iter().for_each(|part| part.paths.push(path.clone()));
            }
            left = put_off;
            if left.len() == before {
                let wait = soonest - self.now;
                self.now = soonest;
                self.waited += wait;
                // A part that draws nothing yet waits longer; otherwise a new part begins.
                match parts.last_mut() {
                    Some(part) if part.paths.is_empty() => part.handling.delay_seconds += wait,
                    _ => parts.push(empty(wait)),
                }
            }
        }
        parts.retain(|part| !part.paths.is_empty());
        Ok(parts)
    }

    /// Time at which all ink in or beside these cells is dry.
    fn dry_at(&self, cells: &[Cell]) -> f64 {
        let around = |&(x, y): &Cell| [(x, y), (x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)];
        let inked = cells.iter().flat_map(around).filter_map(|cell| self.wet.get(&cell));
        inked.map(|at| at + self.seconds).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// The cells that a path's centre line crosses, each once.
fn cells(points: &[Point], size: f64) -> Vec<Cell> {
    let cell = |p: Point| ((p.x / size).floor() as i32, (p.y / size).floor() as i32);
    let mut found: Vec<Cell> = points.iter().take(1).map(|p| cell(*p)).collect();
    for pair in points.windows(2) {
        let steps = (2.0 * pair[0].distance(pair[1]) / size).ceil().max(1.0) as usize;
        found.extend((1..=steps).map(|i| cell(pair[0].lerp(pair[1], i as f64 / steps as f64))));
    }
    found.sort_unstable();
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Colour, Handling, Page};
    use crate::plot::Profile;

    fn plot(lines: &[[f64; 4]]) -> Plot {
        let path = |&[x0, y0, x1, y1]: &[f64; 4]| Toolpath::through(Point::new(x0, y0), [Point::new(x1, y1)]);
        let paths = lines.iter().map(path).collect();
        let pen =
            PenPaths { number: 1, name: "x".to_owned(), colour: Colour::BLACK, nib: 0.5, handling: Handling::default(), paths };
        Plot { page: Page::new(100.0, 100.0), pens: vec![pen] }
    }

    fn motion() -> Motion {
        Profile::built_in("grbl-servo").unwrap().motion
    }

    #[test]
    fn a_crossing_line_waits_its_turn() {
        let mut crossing = plot(&[[0.0, 5.0, 50.0, 5.0], [25.0, 0.0, 25.0, 50.0], [0.0, 90.0, 90.0, 90.0]]);
        let waited = delay_for_drying(&mut crossing, 2.0, Point::ORIGIN, &motion(), &Interrupt::never()).unwrap();
        let first: Vec<f64> = crossing.pens.iter().flat_map(|pen| &pen.paths).map(|path| path.first().y).collect();
        assert_eq!((first, waited, crossing.pens.len()), (vec![5.0, 90.0, 0.0], 0.0, 1));
    }

    #[test]
    fn where_nothing_else_is_left_the_machine_waits() {
        let mut crossing = plot(&[[0.0, 5.0, 50.0, 5.0], [25.0, 0.0, 25.0, 50.0]]);
        let waited = delay_for_drying(&mut crossing, 60.0, Point::ORIGIN, &motion(), &Interrupt::never()).unwrap();
        assert_eq!(crossing.pens.len(), 2);
        assert!((waited - 60.0).abs() < 1e-6 && (crossing.pens[1].handling.delay_seconds - 60.0).abs() < 1e-6, "{waited}");
    }

    #[test]
    fn every_path_is_drawn_once_and_none_touches_wet_ink() {
        let spread = |i: u32, step: f64| 90.0 * (f64::from(i) * step).fract();
        let lines: Vec<[f64; 4]> =
            (1..200).map(|i| [spread(i, 0.754_877), spread(i, 0.569_840), spread(i, 0.618_034), spread(i, 0.414_214)]).collect();
        let mut drawn = plot(&lines);
        let before = drawn.clone();
        delay_for_drying(&mut drawn, 30.0, Point::ORIGIN, &motion(), &Interrupt::never()).unwrap();
        let paths = |plot: &Plot| -> Vec<String> {
            let mut all: Vec<String> = plot.pens.iter().flat_map(|pen| &pen.paths).map(|path| format!("{path:?}")).collect();
            all.sort();
            all
        };
        assert_eq!(paths(&before), paths(&drawn));
        // Replayed against the clock, no path meets ink younger than 30 s.
        let mut paper = Paper { wet: HashMap::new(), seconds: 30.0 - 1e-6, now: 0.0, at: Point::ORIGIN, waited: 0.0 };
        let motion = motion();
        for pen in &drawn.pens {
            paper.now += pen.handling.delay_seconds;
            for path in &pen.paths {
                let cells = cells(path.points(), 0.25);
                assert!(paper.dry_at(&cells) <= paper.now, "{path:?}");
                paper.now += paper.at.distance(path.first()) / motion.travel_speed + motion.pen_down_seconds;
                paper.now += path.length() / motion.draw_speed + motion.pen_up_seconds;
                paper.at = path.last();
                let now = paper.now;
                paper.wet.extend(cells.into_iter().map(|cell| (cell, now)));
            }
        }
    }
}
