//! Directions drawn by hand: near the lines of a mask, marks run along them.

use super::drawer::{Drawer, Pitched};
use crate::elementary::Elementary as _;
use crate::field::{Curve, nearest_seed};
use crate::geometry::{Millimetres, Point, resample};
use crate::raster::{Raster, gaussian_blur};
use crate::source::MaskRole;
use std::f64::consts::PI;

/// How far a line reaches to either side, in pitches: a lock or a fold that one line describes.
const REACH: f64 = 14.0;
/// Blur of the directions of several lines, as a share of the reach: between two lines marks turn from one to the other.
const BLUR: f64 = 0.4;
/// Share of the reach from which a line's direction fades into what was found.
const FIRM: f32 = 0.5;

/// The drawn lines and the directions around them, on the working grid.
pub(super) struct DrawnDirections {
    pub lines: Vec<Curve>,
    /// Doubled-angle unit vectors; y runs down.
    doubled: Raster<[f32; 2]>,
    /// How much they count, 0 to 1.
    weight: Raster<f32>,
}

impl<P: Pitched> Drawer<'_, P> {
    /// The directions drawn by hand; none without a mask of them.
    pub(super) fn drawn_directions(&self) -> Option<DrawnDirections> {
        /// Smoothing of the lines in pitches, and the spacing of the places on them in pixels.
        const SMOOTHING: f64 = 1.0;
        const SPACING: f64 = 0.7;
        let mask = self.portrait.masks.get(&MaskRole::Directions)?;
        let lines = self.hand_made(mask, Millimetres(SMOOTHING * self.parameters.pitch().0));
        let (width, height) = self.size();
        let mut along = Raster::filled(width, height, [0.0_f32; 2]);
        let mut marked = Raster::filled(width, height, 0_u8);
        for line in &lines {
            for pair in resample(&line.points, SPACING).windows(2) {
                let (middle, way) = (pair[0].midpoint(pair[1]), pair[1] - pair[0]);
                let (x, y) = (middle.x.floor() as isize, middle.y.floor() as isize);
                if !along.contains(x, y) {
                    continue;
                }
                let angle = 2.0 * way.y.angle_over(way.x);
                along.set(x as usize, y as usize, [angle.cosine() as f32, angle.sine() as f32]);
                marked.set(x as usize, y as usize, 1);
            }
        }
        let nearest = nearest_seed(&marked)?;
        let reach = (REACH * self.pitch()) as f32;
        let around = [0, 1].map(|i| gaussian_blur(&along.map(|v| v[i]), (BLUR * REACH * self.pitch()) as f32));
        let weight = Raster::from_fn(width, height, |x, y| {
            let seed = nearest.get(x, y) as usize;
            let (dx, dy) = (x as f32 - (seed % width) as f32, y as f32 - (seed / width) as f32);
            let left = ((1.0 - dx.hypotenuse(dy) / reach) / FIRM).clamp(0.0, 1.0);
            left * left * (3.0 - 2.0 * left)
        });
        let doubled = around[0].zip_map(&around[1], |x, y| {
            let length = x.hypotenuse(y).max(1e-20);
            [x / length, y / length]
        });
        Some(DrawnDirections { lines, doubled, weight })
    }
}

impl DrawnDirections {
    /// Angles in radians (y down), turned towards the drawn lines by at most a quarter turn, so that a signed angle keeps its sense.
    pub(super) fn over_angles(&self, angles: &Raster<f32>) -> Raster<f32> {
        Raster::from_fn(angles.width(), angles.height(), |x, y| {
            let (angle, weight) = (f64::from(angles.get(x, y)), self.weight.get(x, y));
            let turn = self.angle(x, y) - angle;
            (angle + f64::from(weight) * (turn - PI * (turn / PI).round())) as f32
        })
    }

    /// A field of doubled angles with the drawn lines over it.
    pub(super) fn over_doubled(&self, doubled: &Raster<[f32; 2]>) -> Raster<[f32; 2]> {
        Raster::from_fn(doubled.width(), doubled.height(), |x, y| {
            let ([x0, y0], [x1, y1], weight) = (doubled.get(x, y), self.doubled.get(x, y), self.weight.get(x, y));
            let length = x0.hypotenuse(y0).max(weight);
            [x0 + weight * (length * x1 - x0), y0 + weight * (length * y1 - y0)]
        })
    }

    /// The mean direction in radians in each of `count` regions, labelled from 1, if the drawn lines reach a fair share of it.
    pub(super) fn means_in(&self, labels: &Raster<i32>, count: usize) -> Vec<Option<f64>> {
        /// Share of a region that lines must reach.
        const FAIR: f64 = 0.15;
        let mut sums = vec![[0.0_f64; 4]; count + 1];
        for ((&label, &weight), doubled) in labels.pixels().iter().zip(self.weight.pixels()).zip(self.doubled.pixels()) {
            let (weight, [cos, sin]) = (f64::from(weight), doubled.map(f64::from));
            let of_pixel = [weight * cos, weight * sin, weight, 1.0];
            let sum = &mut sums[label.max(0) as usize];
            *sum = std::array::from_fn(|i| sum[i] + of_pixel[i]);
        }
        let mean =
            |[cos, sin, weight, all]: &[f64; 4]| (*weight > 0.0 && *weight > FAIR * all).then(|| 0.5 * sin.angle_over(*cos));
        sums[1..].iter().map(mean).collect()
    }

    /// The drawn direction in radians and its weight, 0 to 1.
    pub(super) fn at(&self, p: Point) -> (f64, f64) {
        let clamped = |v: f64, count: usize| (v.max(0.0) as usize).min(count - 1);
        let (x, y) = (clamped(p.x, self.weight.width()), clamped(p.y, self.weight.height()));
        (self.angle(x, y), f64::from(self.weight.get(x, y)))
    }

    fn angle(&self, x: usize, y: usize) -> f64 {
        let [cos, sin] = self.doubled.get(x, y);
        0.5 * f64::from(sin).angle_over(f64::from(cos))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::Silent;
    use crate::style::form::mean_portrait;

    struct Pitch;

    impl Pitched for Pitch {
        fn pitch(&self) -> Millimetres {
            Millimetres(0.5)
        }
    }

    /// A line from the upper left to the lower right.
    fn drawn() -> DrawnDirections {
        let mut portrait = mean_portrait(4.0, 0.0, |_| 128);
        let mask = portrait.lightness.map(|_| 0.0);
        let mask =
            Raster::from_fn(mask.width(), mask.height(), |x, y| f32::from(u8::from(x.abs_diff(y) < 2 && (20..120).contains(&x))));
        portrait.masks.insert(MaskRole::Directions, mask);
        Drawer { portrait: &portrait, parameters: Pitch, seed: 0, observer: &Silent }.drawn_directions().unwrap()
    }

    #[test]
    fn marks_run_along_a_drawn_line_and_far_from_it_as_before() {
        let drawn = drawn();
        let across = drawn.weight.map(|_| 0.3_f32);
        let turned = drawn.over_angles(&across);
        assert!((turned.get(70, 70) - 0.785).abs() < 0.05, "{}", turned.get(70, 70));
        assert_eq!(turned.get(2, turned.height() - 2), 0.3);
        let doubled = drawn.over_doubled(&across.map(|_| [1.0, 0.0]));
        assert!(doubled.get(70, 70)[1] > 0.97 && doubled.get(2, turned.height() - 2) == [1.0, 0.0]);
        let (angle, weight) = drawn.at(Point::new(70.5, 72.0));
        assert!((angle - 0.785).abs() < 0.05 && weight > 0.99);
    }

    #[test]
    fn a_region_has_the_direction_of_the_lines_in_it() {
        let drawn = drawn();
        let near = |x: usize, y: usize| i32::from(x.abs_diff(y) < 8 && x < 120);
        let labels = drawn.weight.map(|_| 0);
        let labels = Raster::from_fn(labels.width(), labels.height(), |x, y| if x < 10 && y > 100 { 2 } else { near(x, y) });
        let means = drawn.means_in(&labels, 2);
        assert!((means[0].unwrap() - 0.785).abs() < 0.05 && means[1].is_none());
    }
}
