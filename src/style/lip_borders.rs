//! The outer borders of lips as thin lines, as firm as lips part from the skin there: marks a pitch apart blur them.

use super::columns::{COLUMNS, SMOOTH, averaged, between, smoothed};
use crate::field::CoherentLine;
use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, best_way};

/// Rows across a border.
const ROWS: usize = 25;
/// How far from the landmarks' border it is looked for, as a share of the lip.
const WITHIN: f64 = 0.35;
/// Distances on both sides in which lightness is compared, in widths of the mouth: the wide one tells lips from skin, the narrow one where they
/// part; and the price of a bend by one row.
const BESIDE: [f64; 2] = [0.03, 0.01];
const BEND: f32 = 0.004;
/// How much darker a lip is than the skin beside it where its line begins, and where it is in full; and that width in widths of the mouth.
const LEAST: f64 = 0.05;
const FULL: f64 = 0.2;
const WIDEST: f64 = 0.01;
/// Length of the shortest part that is drawn, in widths of the mouth: shorter ones are ticks beside a shadow.
const SHORTEST: f64 = 0.25;

/// The parts of a lip's border that are seen, between its inner and its outer line as the landmarks have them, each of [`COLUMNS`] points from
/// corner to corner of a mouth of a width.
pub(super) fn lip_border(light: &Raster<f32>, [inner, outer]: [&[Point]; 2], width: f64) -> Vec<CoherentLine> {
    let [from, to] = [1.0 - WITHIN, 1.0 + WITHIN].map(|share| between(inner, outer, share));
    let place = |column: usize, row: usize| from[column].lerp(to[column], row as f64 / (ROWS - 1) as f64);
    let step = |row: usize, column: usize| {
        let (p, out) = (place(column, row), outwards(&from, &to, column) * width);
        let at = |away: f64| light.sample(p.x + away * out.x, p.y + away * out.y);
        BESIDE.iter().map(|away| 0.5 * (at(*away) - at(-away))).sum::<f32>()
    };
    let steps = Raster::from_fn(ROWS, COLUMNS, step);
    let rows = best_way(&steps, 2, BEND);
    let points: Vec<Point> = rows.iter().enumerate().map(|(column, row)| place(column, *row)).collect();
    let found: Vec<f64> = rows.iter().enumerate().map(|(column, row)| f64::from(steps.get(*row, column))).collect();
    let share = |step: &f64| ((step - LEAST) / (FULL - LEAST)).clamp(0.0, 1.0);
    let widths: Vec<f64> = averaged(&found, SMOOTH).iter().map(|step| WIDEST * width * share(step)).collect();
    let line = smoothed(&points, &widths);
    let is_seen: Vec<bool> = line.widths.iter().map(|width| *width > 0.0).collect();
    line.runs(&is_seen).into_iter().filter(|run| run.curve.length() > SHORTEST * width).collect()
}

/// From a lip to the skin, of length 1.
fn outwards(from: &[Point], to: &[Point], column: usize) -> Vec2 {
    let across = to[column] - from[column];
    across / across.hypot().max(1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The border of a lower lip of 200 pixels between 20 and 40 that is so much darker than the skin below, left of `end`.
    fn border(darker: f32, end: usize) -> Vec<CoherentLine> {
        let light = Raster::from_fn(220, 80, |x, y| if y < 40 && x < end { 0.6 - darker } else { 0.6 });
        let line = |y: f64| -> Vec<Point> {
            (0..COLUMNS).map(|i| Point::new(10.0 + 200.0 * i as f64 / (COLUMNS - 1) as f64, y)).collect()
        };
        lip_border(&light, [&line(20.0), &line(42.0)], 200.0)
    }

    #[test]
    fn a_border_runs_where_the_lip_is_darker_and_is_as_firm_as_it() {
        let [faint, firm] = [0.1, 0.3].map(|darker| border(darker, 220));
        for line in [&faint, &firm] {
            assert_eq!(line.len(), 1);
            assert!(line[0].curve.points.iter().all(|p| (p.y - 40.0).abs() < 3.0), "{:?}", line[0].curve.points);
        }
        assert!(firm[0].widths[20] > 1.5 * faint[0].widths[20]);
    }

    #[test]
    fn a_lip_as_light_as_the_skin_and_a_tick_have_none() {
        assert!(border(0.0, 220).is_empty() && border(0.3, 40).is_empty());
    }
}
