//! The ink that marks lay down, on the working grid.

use crate::drawing::{Dot, Mark};
use crate::geometry::{BezPath, Point, flatten};
use crate::parallel::{mapped, shares};
use crate::raster::{Raster, each_pixel_inside, reduce};
use crate::source::Placement;
use std::ops::Range;

/// Working pixels are halved, so that a dot of one pixel has an area.
const FINER: usize = 2;
/// Flattening tolerance of areas, in fine pixels.
const TOLERANCE: f64 = 0.2;

/// The share of each working pixel under the ink of marks.
pub(crate) fn covered<'a>(marks: impl IntoIterator<Item = &'a Mark>, placement: &Placement) -> Raster<f32> {
    darkened(marks.into_iter().map(|mark| (mark, 1.0)), placement)
}

/// How dark each working pixel is under marks that hide what they cover, by a grid twice as fine. Each comes with its darkness, 0 to 1.
pub(super) fn darkened<'a>(marks: impl IntoIterator<Item = (&'a Mark, f32)>, placement: &Placement) -> Raster<f32> {
    /// Fine rows that one thread covers at a time, in the order of the marks.
    const BAND: usize = 64;
    /// Marks whose shapes are held at a time.
    const HELD: usize = 20_000;
    let marks: Vec<(&Mark, f32)> = marks.into_iter().collect();
    let (columns, rows) = (FINER * placement.columns, FINER * placement.rows);
    let mut fine = Raster::filled(columns, rows, 0.0_f32);
    for marks in marks.chunks(HELD) {
        let shapes = mapped(marks, &|(mark, _)| Shape::of(mark, placement));
        shares(fine.pixels_mut(), BAND * columns, &|band, pixels| {
            let mut band = Band { first: BAND * band, columns, pixels };
            shapes.iter().zip(marks).for_each(|(shape, (_, ink))| band.cover(shape, *ink));
        });
    }
    reduce(&fine, FINER)
}

/// What a mark covers of the fine grid.
enum Shape {
    /// Discs along a stroke, or one.
    Discs(Vec<Discs>),
    /// Runs of pixels: row and columns.
    Runs(Vec<(usize, Range<usize>)>),
}

/// Some neighbouring discs: x, y and radius in fine pixels; and the rows that they reach.
struct Discs {
    discs: Vec<[f32; 3]>,
    rows: Range<f64>,
}

impl Shape {
    fn of(mark: &Mark, placement: &Placement) -> Self {
        let scale = FINER as f64 / placement.mm_per_pixel();
        match mark {
            Mark::Stroke(stroke) => {
                let (points, widths) = stroke.sampled(1.0 / scale);
                let discs = points.iter().zip(widths).map(|(p, width)| (on_fine(placement, *p), 0.5 * width * scale));
                Self::discs(&discs.collect::<Vec<_>>())
            }
            Mark::Dot(Dot { centre, radius, outline: None, .. }) => Self::discs(&[(on_fine(placement, *centre), radius * scale)]),
            Mark::Dot(dot) => Self::runs(&dot.path(), placement),
            Mark::Area(area) => Self::runs(&area.outline, placement),
        }
    }

    fn discs(discs: &[(Point, f64)]) -> Self {
        /// Discs that share their rows: a long line reaches into many bands.
        const TOGETHER: usize = 32;
        let some = |discs: &[(Point, f64)]| {
            let ends = |(from, to): (f64, f64), (p, radius): &(Point, f64)| (from.min(p.y - radius), to.max(p.y + radius));
            let (from, to) = discs.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends);
            Discs { discs: discs.iter().map(|(p, radius)| [p.x as f32, p.y as f32, *radius as f32]).collect(), rows: from..to }
        };
        Self::Discs(discs.chunks(TOGETHER).map(some).collect())
    }

    fn runs(outline: &BezPath, placement: &Placement) -> Self {
        let tolerance = TOLERANCE * placement.mm_per_pixel() / FINER as f64;
        let corners = |(points, _): (Vec<Point>, bool)| {
            points.into_iter().map(|p| on_fine(placement, p)).map(|p| [p.x, p.y]).collect::<Vec<_>>()
        };
        let polygons: Vec<Vec<[f64; 2]>> = flatten(outline, tolerance).into_iter().map(corners).collect();
        let mut runs: Vec<(usize, Range<usize>)> = Vec::new();
        each_pixel_inside(FINER * placement.columns, FINER * placement.rows, &polygons, |x, y| match runs.last_mut() {
            Some((row, columns)) if *row == y && columns.end == x => columns.end += 1,
            _ => runs.push((y, x..x + 1)),
        });
        Self::Runs(runs)
    }
}

/// Some rows of the fine grid.
struct Band<'a> {
    first: usize,
    columns: usize,
    pixels: &'a mut [f32],
}

impl Band<'_> {
    fn end(&self) -> usize {
        self.first + self.pixels.len() / self.columns.max(1)
    }

    fn cover(&mut self, shape: &Shape, ink: f32) {
        match shape {
            Shape::Discs(all) => {
                let (first, end) = (self.first as f64 - 1.0, self.end() as f64 + 1.0);
                let near = all.iter().filter(|discs| discs.rows.end >= first && discs.rows.start <= end);
                near.flat_map(|discs| &discs.discs).for_each(|disc| self.cover_disc(disc.map(f64::from), ink));
            }
            Shape::Runs(runs) => {
                let first = runs.partition_point(|(row, _)| *row < self.first);
                let end = self.end();
                runs[first..]
                    .iter()
                    .take_while(|(row, _)| *row < end)
                    .for_each(|(row, columns)| self.fill(*row, columns.clone(), ink));
            }
        }
    }

    fn cover_disc(&mut self, [x, y, radius]: [f64; 3], ink: f32) {
        let (x, y) = (x - 0.5, y - 0.5);
        let from = (y - radius).ceil().max(self.first as f64) as usize;
        let end = ((y + radius).floor() + 1.0).clamp(0.0, self.end() as f64) as usize;
        for row in from..end {
            let half = (radius * radius - (row as f64 - y).powi(2)).max(0.0).sqrt();
            let from = (x - half).ceil().max(0.0) as usize;
            let end = ((x + half).floor() + 1.0).clamp(0.0, self.columns as f64) as usize;
            self.fill(row, from.min(end)..end, ink);
        }
    }

    fn fill(&mut self, row: usize, columns: Range<usize>, ink: f32) {
        let start = (row - self.first) * self.columns;
        self.pixels[start + columns.start..start + columns.end].fill(ink);
    }
}

/// The grid's point in fine pixels.
fn on_fine(placement: &Placement, p: Point) -> Point {
    let p = placement.to_grid(p);
    Point::new(FINER as f64 * p.x, FINER as f64 * p.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Area;
    use crate::geometry::Rect;
    use kurbo::Shape;

    #[test]
    fn every_kind_of_mark_covers_its_area() {
        let placement = Placement::new(Rect::new(0.0, 0.0, 20.0, 10.0), 8.0);
        let ring = kurbo::Circle::new((10.0, 5.0), 2.0).to_path(1e-3);
        let area = |outline: &BezPath| Mark::Area(Area { outline: outline.clone(), colour: None });
        let mm2 = |mark: Mark| {
            let sum: f32 = covered([&mark], &placement).pixels().iter().sum();
            f64::from(sum) * placement.mm_per_pixel().powi(2)
        };
        let disc = 4.0 * std::f64::consts::PI;
        assert!((mm2(Mark::Dot(Dot::circle(Point::new(10.0, 5.0), 2.0))) - disc).abs() < 0.1);
        assert!((mm2(area(&ring)) - disc).abs() < 0.1);
        let mut holed = ring;
        holed.extend(kurbo::Circle::new((10.0, 5.0), 1.0).to_path(1e-3).reverse_subpaths());
        assert!((mm2(area(&holed)) - 0.75 * disc).abs() < 0.1);
    }
}
