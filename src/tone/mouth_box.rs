//! What surrounds a face's mouth, cut out of the picture: its outlines as zones, and how red it is.

use super::zones::{pixels_in, polygon};
use crate::geometry::{Point, Rect};
use crate::raster::Raster;
use crate::source::{Landmarks, outlines};
use std::ops::Range;

/// A box around a face's lips.
pub(super) struct MouthBox {
    pub columns: Range<usize>,
    pub rows: Range<usize>,
    /// 1 inside the outer line of the lips, and inside their inner line.
    pub outer: Raster<u8>,
    pub inner: Raster<u8>,
    /// The difference of red and green over their sum in linear light: the same in light and shade.
    pub redness: Raster<f32>,
    /// The redness less half of the yellowness, the like difference of green and blue: lips are less yellow than the skin around them.
    /// On all of the sixteen portraits they differ from it by more of its deviations than in redness alone.
    pub pinkness: Raster<f32>,
}

impl MouthBox {
    /// The box that extends beyond the lips by a share of their size; none outside the picture.
    pub(super) fn of(face: &Landmarks, light: &Raster<[f32; 3]>, beyond: f64) -> Option<Self> {
        let [outer, inner] = [&outlines::LIPS, &outlines::MOUTH].map(|line| face.line(line));
        let corner = outer.iter().fold(outer[0], |a, p| Point::new(a.x.min(p.x), a.y.min(p.y)));
        let far = outer.iter().fold(outer[0], |a, p| Point::new(a.x.max(p.x), a.y.max(p.y)));
        let more = (far - corner) * beyond;
        let [columns, rows] = pixels_in(Rect::from_points(corner - more, far + more), (light.width(), light.height()))?;
        let away = Point::new(columns.start as f64, rows.start as f64).to_vec2();
        let in_box = |line: &[Point]| polygon(columns.len(), rows.len(), &line.iter().map(|p| *p - away).collect::<Vec<_>>());
        let light = light.part(&columns, &rows);
        let between = |a: f32, b: f32| (a - b) / (a + b).max(0.01);
        let redness = light.map(|[r, g, _]| between(r, g));
        let pinkness = light.map(|[r, g, b]| between(r, g) - 0.5 * between(g, b));
        Some(Self { outer: in_box(&outer), inner: in_box(&inner), redness, pinkness, columns, rows })
    }

    /// Gives each place of the box a tone by its place in the box and its tone so far.
    pub(super) fn retone(&self, tone: &mut Raster<f32>, to: impl Fn(usize, usize, f32) -> f32) {
        for y in 0..self.rows.len() {
            for x in 0..self.columns.len() {
                let (column, row) = (self.columns.start + x, self.rows.start + y);
                tone.set(column, row, to(x, y, tone.get(column, row)));
            }
        }
    }

    /// True on the lips themselves.
    pub(super) fn lips(&self) -> Raster<bool> {
        self.outer.zip_map(&self.inner, |outer, inner| outer == 1 && inner == 0)
    }
}

/// The values of a raster where they are asked for, from the least to the most.
pub(super) fn sorted(values: &Raster<f32>, of: &Raster<bool>) -> Vec<f32> {
    let inside = values.pixels().iter().zip(of.pixels()).filter(|(_, is)| **is);
    let mut values: Vec<f32> = inside.map(|(value, _)| *value).collect();
    values.sort_unstable_by(f32::total_cmp);
    values
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::elementary::unit_at;
    use crate::source::{Iris, POINTS};
    use std::f64::consts::TAU;

    /// A face that is a laughing mouth alone: lips 100 by 50 pixels about a place, and an opening of 80 by 32.
    pub(in crate::tone) fn with_mouth(middle: Point) -> Landmarks {
        let mut points = vec![[0.0; 3]; POINTS];
        for (outline, size) in [(&outlines::LIPS, [50.0, 25.0]), (&outlines::MOUTH, [40.0, 16.0])] {
            for (i, point) in outline.iter().enumerate() {
                let along = unit_at(TAU * i as f64 / outline.len() as f64);
                points[*point] = [middle.x + size[0] * along.x, middle.y + size[1] * along.y, 0.0];
            }
        }
        let iris = Iris { centre: middle, radius: 1.0 };
        Landmarks { points, irises: [iris; 2], spectacles: None, pearls: Vec::new() }
    }

    #[test]
    fn the_box_holds_the_lips_and_their_redness() {
        let face = with_mouth(Point::new(60.0, 30.0));
        let light = Raster::filled(120, 60, [0.3, 0.1, 0.1]);
        let mouth = MouthBox::of(&face, &light, 0.0).expect("a mouth");
        assert_eq!((mouth.columns.clone(), mouth.rows.clone()), (10..110, 5..55));
        let lips = sorted(&mouth.redness, &mouth.lips());
        assert!((lips.len() as f64 / (TAU * 0.5 * (50.0 * 25.0 - 40.0 * 16.0)) - 1.0).abs() < 0.05, "{}", lips.len());
        assert!(lips.iter().all(|red| (red - 0.5).abs() < 1e-6));
        assert!(MouthBox::of(&with_mouth(Point::new(-200.0, 30.0)), &light, 0.0).is_none());
    }
}
