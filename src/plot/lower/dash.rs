//! Draws a line thinner than the nib as dashes, or as touches where it is very thin, with the same ink.
//!
//! ```text
//!   wanted  --------------------------  width w
//!   drawn   ====    ====    ====    ==  width of the nib; P w = L nib + pi/4 nib^2 for period P and dash L
//! ```

use super::super::Toolpath;
use crate::geometry::Point;
use std::f64::consts::FRAC_PI_4;

/// Distance between the end points of two dashes, in nibs: at 1 they would touch; at 2 the eye sees dots instead of a line.
const GAP: f64 = 1.5;
/// Width in nibs from which a line is drawn solid; its dash period would be over 20 nibs.
pub(super) const NEARLY_WHOLE: f64 = 0.97;

/// A point of a line and its width there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub at: Point,
    pub width: f64,
}

/// Dashes along a line. `phase`, from 0 to 1, is the elapsed share of the first period; different phases keep the ends of
/// neighbouring lines apart. Samples should lie at most a quarter of a nib apart.
pub(super) fn dashes(samples: &[Sample], nib: f64, phase: f64) -> Vec<Toolpath> {
    let mut paths: Vec<Toolpath> = Vec::new();
    let mut phase = phase.rem_euclid(1.0);
    let mut dash: Vec<Point> = Vec::new();
    let mut finish = |dash: &mut Vec<Point>| paths.extend(Toolpath::new(std::mem::take(dash)));
    for pair in samples.windows(2) {
        let length = pair[0].at.distance(pair[1].at);
        let (period, down) = rhythm(0.5 * (pair[0].width + pair[1].width), nib);
        let mut travelled = 0.0;
        while travelled < length {
            // Advance to the next change of state, or to the end of this step.
            let is_down = phase < down;
            let until = (if is_down { down } else { 1.0 } - phase) * period;
            let changes = until <= length - travelled;
            let step = until.min(length - travelled);
            let place = |along: f64| pair[0].at.lerp(pair[1].at, along / length);
            if is_down {
                if dash.is_empty() {
                    dash.push(place(travelled));
                }
                dash.push(place(travelled + step));
            } else {
                finish(&mut dash);
            }
            travelled += step;
            phase = match (changes, is_down) {
                (false, _) => phase + step / period,
                (true, true) => down,
                (true, false) => {
                    dash.push(place(travelled));
                    0.0
                }
            };
        }
    }
    finish(&mut dash);
    paths
}

/// The period in millimetres and the pen-down share of it that give the ink of a line of this width.
fn rhythm(width: f64, nib: f64) -> (f64, f64) {
    let width = width.clamp(1e-3 * nib, NEARLY_WHOLE * nib);
    let gap = GAP * nib;
    let period = nib * (gap - FRAC_PI_4 * nib) / (nib - width);
    if period > gap { (period, (period - gap) / period) } else { (FRAC_PI_4 * nib * nib / width, 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(width: impl Fn(f64) -> f64) -> Vec<Sample> {
        (0..=4000).map(|i| f64::from(i) * 0.05).map(|x| Sample { at: Point::new(x, 0.0), width: width(x) }).collect()
    }

    fn ink(paths: &[Toolpath], nib: f64) -> f64 {
        paths.iter().map(|path| path.length() * nib + FRAC_PI_4 * nib * nib).sum()
    }

    #[test]
    fn dashes_lay_down_the_line_s_ink() {
        for width in [0.01, 0.05, 0.1, 0.15, 0.16, 0.2, 0.25, 0.28, 0.29] {
            let asked = 200.0 * width;
            for phase in [0.0, 0.3, 0.8] {
                let laid = ink(&dashes(&line(|_| width), 0.3, phase), 0.3);
                assert!((laid / asked - 1.0).abs() < 0.05, "width {width}, phase {phase}: {laid} for {asked}");
            }
        }
        let swelling = line(|x| 0.28 * x / 200.0);
        let laid = ink(&dashes(&swelling, 0.3, 0.5), 0.3);
        assert!((laid / 28.0 - 1.0).abs() < 0.02, "{laid}");
    }

    #[test]
    fn gaps_are_seen_and_dashes_do_not_touch() {
        let paths = dashes(&line(|_| 0.27), 0.3, 0.0);
        assert!(paths.len() > 10);
        for pair in paths.windows(2) {
            let gap = pair[1].first().x - pair[0].last().x;
            assert!((gap - 0.45).abs() < 1e-6, "{gap}");
        }
    }

    #[test]
    fn a_line_of_no_length_or_no_width_draws_nothing_or_next_to_nothing() {
        let nothing = [Sample { at: Point::ORIGIN, width: 0.1 }; 3];
        assert!(dashes(&nothing, 0.3, 0.0).is_empty());
        assert!(dashes(&line(|_| 0.0), 0.3, 0.0).len() <= 1);
    }
}
