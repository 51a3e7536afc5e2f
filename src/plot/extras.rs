//! Additions to the drawing: registration crosses, rests of touches, pauses.

use super::{PenPaths, Plot, Toolpath};
use crate::drawing::Handling;
use crate::geometry::{Point, Rect};

/// Half the width of a registration cross, in millimetres: large enough to judge a tenth of a millimetre by eye, small enough for
/// a margin.
const CROSS: f64 = 2.5;

/// Adds a cross in each corner of the drawable area, drawn by every pen before its own paths.
pub fn add_registration(plot: &mut Plot, drawable: Rect) {
    let corners = drawable.inset(-CROSS);
    if corners.width() <= 2.0 * CROSS || corners.height() <= 2.0 * CROSS {
        return;
    }
    let mut seen = Vec::new();
    for pen in &mut plot.pens {
        if seen.contains(&pen.number) {
            continue;
        }
        seen.push(pen.number);
        let places = [(corners.x0, corners.y0), (corners.x1, corners.y0), (corners.x1, corners.y1), (corners.x0, corners.y1)];
        let line = |x0: f64, y0: f64, x1: f64, y1: f64| Toolpath::through(Point::new(x0, y0), [Point::new(x1, y1)]);
        let crosses = places.into_iter().flat_map(|(x, y)| [line(x - CROSS, y, x + CROSS, y), line(x, y - CROSS, x, y + CROSS)]);
        pen.paths = crosses.chain(std::mem::take(&mut pen.paths)).collect();
    }
}

/// Makes every touch rest on the paper for `seconds` of its pen's number.
pub fn add_touch_rests(plot: &mut Plot, seconds: impl Fn(u32) -> f64) {
    for pen in &mut plot.pens {
        let more = seconds(pen.number);
        pen.paths.iter_mut().filter(|path| path.is_touch()).for_each(|touch| touch.dwell_seconds += more);
    }
}

/// Splits each pen's paths so that the machine waits after every `length` millimetres drawn, at the end of a path.
pub fn pause_every(plot: &mut Plot, length: f64) {
    let pens = std::mem::take(&mut plot.pens);
    for pen in pens {
        let again = PenPaths { handling: Handling { pauses: true, ..pen.handling }, paths: Vec::new(), ..pen.clone() };
        let mut part = PenPaths { paths: Vec::new(), ..pen.clone() };
        let mut drawn = 0.0;
        for path in pen.paths {
            if drawn >= length {
                plot.pens.push(std::mem::replace(&mut part, again.clone()));
                drawn = 0.0;
            }
            drawn += path.length();
            part.paths.push(path);
        }
        plot.pens.push(part);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Colour, Page};

    fn plot() -> Plot {
        let path = |y: f64| Toolpath::through(Point::new(20.0, y), [Point::new(30.0, y)]);
        let paths = (0..6).map(|i| path(20.0 + f64::from(i))).chain([Toolpath::touch(Point::new(5.0, 5.0))]).collect();
        let handling = Handling::default();
        let pen = PenPaths { number: 2, name: "x".into(), colour: Colour::BLACK, nib: 0.3, handling, paths };
        Plot { page: Page::new(60.0, 60.0), pens: vec![pen] }
    }

    #[test]
    fn work_is_parted_where_the_pen_is_up() {
        let mut parted = plot();
        pause_every(&mut parted, 25.0);
        let counts: Vec<(usize, bool)> = parted.pens.iter().map(|pen| (pen.paths.len(), pen.handling.pauses)).collect();
        assert_eq!(counts, [(3, false), (3, true), (1, true)]);
    }

    #[test]
    fn crosses_lie_within_and_touches_rest() {
        let mut crossed = plot();
        add_registration(&mut crossed, Rect::new(1.0, 2.0, 50.0, 60.0));
        assert_eq!(crossed.pens[0].paths.len(), 7 + 8);
        let inside = |p: &Point| (1.0..=50.0).contains(&p.x) && (2.0..=60.0).contains(&p.y);
        assert!(crossed.pens[0].paths.iter().flat_map(Toolpath::points).all(inside));
        add_touch_rests(&mut crossed, |pen| 0.1 * f64::from(pen));
        assert_eq!(crossed.pens[0].paths.iter().filter(|path| path.dwell_seconds > 0.0).count(), 1);
    }
}
