//! The gaps between teeth as a draughtsman sets them: short thin lines from the upper lip, which end in points before the lower one.
//!
//! ```text
//!   profile   how light columns from lip to lip are, along the mouth
//!   gaps      columns that are darker than what lies on both sides, as the space of a tooth apart
//!   lines     the darkest straight way down each
//! ```

use super::columns::smoothed;
use crate::field::CoherentLine;
use crate::geometry::Point;
use crate::raster::Raster;

/// Columns along a mouth, and rows down a gap.
const COLUMNS: usize = 240;
const ROWS: usize = 25;
/// The part of the height between the lips in which gaps are looked for: above it is the lip's shade, below it lower teeth.
const SEEN: [f64; 2] = [0.15, 0.7];
/// Half of the widest gap, and the reach in which its sides lie, in widths of the mouth: an upper incisor has 0.13.
const HALF: f64 = 0.012;
const BESIDE: f64 = 0.045;
/// The least distance of two gaps, in widths of the mouth.
const APART: f64 = 0.045;
/// Contrast from which a gap is seen, and at which its line is widest.
const LEAST: f32 = 0.02;
const FULL: f32 = 0.12;
/// How far down from the upper lip a line ends: longer ones are bars.
const END: f64 = 0.58;
/// Width of a line at full contrast, in widths of the mouth, the least share of it, and what is left of it at its lower end.
const WIDEST: f64 = 0.0075;
const THINNEST: f64 = 0.5;
const POINT: f64 = 0.3;
/// How far the ends of a line may lie from its column, in widths of the mouth, and the places tried.
const LEAN: f64 = 0.02;
const LEAN_STEPS: usize = 9;

/// An open mouth in the photograph.
pub(super) struct Teeth<'a> {
    /// The photograph's lightness, and that of the lips: what is no lighter is no tooth.
    pub light: &'a Raster<f32>,
    pub lips: f32,
    /// Lines along the lips from corner to corner.
    pub upper: &'a [Point],
    pub lower: &'a [Point],
    /// Of the mouth.
    pub width: f64,
}

impl Teeth<'_> {
    /// The lines between the teeth.
    pub(super) fn gaps(&self) -> Vec<CoherentLine> {
        let profile: Vec<f32> = (0..COLUMNS).map(|column| self.lightness(column)).collect();
        let contrasts: Vec<f32> = (0..COLUMNS).map(|column| self.contrast(&profile, column)).collect();
        let apart = columns(APART);
        let is_gap = |column: &usize| {
            let first = column.saturating_sub(apart);
            let near = first..(column + apart + 1).min(COLUMNS);
            let darkest = near.fold(first, |best, other| if contrasts[other] > contrasts[best] { other } else { best });
            contrasts[*column] > LEAST && darkest == *column
        };
        (0..COLUMNS).filter(is_gap).map(|column| self.line(column, contrasts[column])).collect()
    }

    /// A place so far along the mouth and down from the upper lip, both 0 to 1.
    fn place(&self, along: f64, down: f64) -> Point {
        let at = |line: &[Point]| {
            let on = along.clamp(0.0, 1.0) * (line.len() - 1) as f64;
            let i = (on as usize).min(line.len() - 2);
            line[i].lerp(line[i + 1], on - i as f64)
        };
        at(self.upper).lerp(at(self.lower), down)
    }

    fn seen(&self, along: f64, down: f64) -> f32 {
        let p = self.place(along, down);
        self.light.sample(p.x, p.y)
    }

    /// The mean lightness of a column.
    fn lightness(&self, column: usize) -> f32 {
        let along = column as f64 / (COLUMNS - 1) as f64;
        (0..ROWS).map(|row| self.seen(along, down(row))).sum::<f32>() / ROWS as f32
    }

    /// How much lighter the darker of both sides is, if that is a tooth.
    fn contrast(&self, profile: &[f32], column: usize) -> f32 {
        let (near, far) = (columns(HALF), columns(BESIDE));
        if column < far || column + far >= COLUMNS {
            return 0.0;
        }
        let lightest = |side: &[f32]| side.iter().copied().fold(0.0_f32, f32::max);
        let side = lightest(&profile[column - far..=column - near]).min(lightest(&profile[column + near..=column + far]));
        if side > self.lips { side - profile[column] } else { 0.0 }
    }

    /// The darkest straight line down a gap, of a width by its contrast.
    fn line(&self, column: usize, contrast: f32) -> CoherentLine {
        let middle = column as f64 / (COLUMNS - 1) as f64;
        let at = |step: usize| middle + LEAN * (2.0 * step as f64 / (LEAN_STEPS - 1) as f64 - 1.0);
        let ends = (0..LEAN_STEPS).flat_map(|top| (0..LEAN_STEPS).map(move |foot| [at(top), at(foot)]));
        let lightness = |ends: &[f64; 2]| (0..ROWS).map(|row| self.seen_on(*ends, down(row))).sum::<f32>();
        let darkest = ends
            .map(|ends| (lightness(&ends), ends))
            .fold((f32::INFINITY, [middle; 2]), |best, each| if each.0 < best.0 { each } else { best });
        let full = WIDEST * self.width * f64::from(contrast / FULL).clamp(THINNEST, 1.0);
        let shares = (0..ROWS).map(|i| i as f64 / (ROWS - 1) as f64);
        let points: Vec<Point> = shares.clone().map(|share| self.on(darkest.1, share * END)).collect();
        let widths: Vec<f64> = shares.map(|share| full * (1.0 - (1.0 - POINT) * share)).collect();
        smoothed(&points, &widths)
    }

    /// A place so far down a line that stands at two places along the mouth at the upper and the lower end of what is seen.
    fn on(&self, [top, foot]: [f64; 2], down: f64) -> Point {
        self.place(top + (foot - top) * (down - SEEN[0]) / (SEEN[1] - SEEN[0]), down)
    }

    fn seen_on(&self, ends: [f64; 2], down: f64) -> f32 {
        let p = self.on(ends, down);
        self.light.sample(p.x, p.y)
    }
}

/// Columns in a distance in widths of the mouth.
fn columns(distance: f64) -> usize {
    (distance * COLUMNS as f64).round() as usize
}

/// How far down a row lies between the lips, 0 to 1.
fn down(row: usize) -> f64 {
    SEEN[0] + (SEEN[1] - SEEN[0]) * row as f64 / (ROWS - 1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines between teeth in a mouth of 200 pixels, 40 high, whose gaps are so much darker than the teeth.
    fn gaps(teeth: f32, gap: f32) -> Vec<CoherentLine> {
        let is_gap = |x: usize| [60, 90, 120, 150].iter().any(|at| x.abs_diff(*at) < 2);
        let light = Raster::from_fn(220, 80, |x, _| if is_gap(x) { teeth - gap } else { teeth });
        let line = |y: f64| -> Vec<Point> { (0..=20).map(|i| Point::new(10.0 + 10.0 * f64::from(i), y)).collect() };
        Teeth { light: &light, lips: 0.4, upper: &line(20.0), lower: &line(60.0), width: 200.0 }.gaps()
    }

    #[test]
    fn each_gap_has_one_line_that_ends_in_a_point_before_the_lower_lip() {
        let found = gaps(0.8, 0.2);
        let places: Vec<f64> = found.iter().map(|line| line.curve.points[0].x).collect();
        assert_eq!(found.len(), 4, "{places:?}");
        for (line, at) in found.iter().zip([60.0, 90.0, 120.0, 150.0]) {
            assert!(line.curve.points.iter().all(|p| (p.x - at).abs() < 4.0 && p.y < 50.0), "{at}: {places:?}");
            assert!(line.widths[0] > 2.0 * line.widths[line.widths.len() - 1]);
        }
    }

    #[test]
    fn even_teeth_and_what_is_as_dark_as_lips_have_none() {
        assert!(gaps(0.8, 0.01).is_empty() && gaps(0.35, 0.2).is_empty());
    }
}
