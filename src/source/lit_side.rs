//! The side of a face that the light comes from.

use super::Landmarks;
use crate::geometry::Point;
use crate::raster::Raster;

/// Points of the mesh on the skin of the person's right side, from forehead to jaw, and the same on the left.
const SIDES: [[usize; 10]; 2] =
    [[104, 69, 117, 118, 50, 101, 36, 205, 187, 147], [333, 299, 346, 347, 280, 330, 266, 425, 411, 376]];
/// Places around each point that are averaged, and their distance in widths of the face.
const AROUND: [(f64, f64); 5] = [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
const APART: f64 = 0.02;
/// Difference of lightness at which one side counts as lit in full: soft light has 0.05, a window at the side 0.2.
const CLEAR: f64 = 0.15;

impl Landmarks {
    /// Where the light comes from, across the picture: -1 from its left, 1 from its right, 0 from the front. The face's points are in
    /// pixels of `lightness`.
    pub(crate) fn lit_side(&self, lightness: &Raster<f32>) -> f64 {
        let step = APART * self.width();
        let mean = |side: [usize; 10]| {
            let places =
                side.into_iter().flat_map(|index| AROUND.map(|(x, y)| self.point(index) + step * Point::new(x, y).to_vec2()));
            let (lights, across): (Vec<f64>, Vec<f64>) = places.map(|p| (f64::from(lightness.sample(p.x, p.y)), p.x)).unzip();
            let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
            (mean(&lights), mean(&across))
        };
        let [(right, right_x), (left, left_x)] = SIDES.map(mean);
        let towards_left = ((left - right) / CLEAR).clamp(-1.0, 1.0);
        if left_x > right_x { towards_left } else { -towards_left }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{Iris, POINTS};

    #[test]
    fn the_lit_cheek_tells_the_side() {
        let mut points = vec![[50.0, 50.0, 0.0]; POINTS];
        for (side, x) in SIDES.into_iter().zip([30.0, 70.0]) {
            side.into_iter().for_each(|index| points[index] = [x, 50.0, 0.0]);
        }
        let iris = |x: f64| Iris { centre: Point::new(x, 40.0), radius: 3.0 };
        let face = Landmarks { points, irises: [iris(35.0), iris(65.0)], spectacles: None, pearls: Vec::new() };
        let light = |left: f32, right: f32| Raster::from_fn(100, 100, move |x, _| if x < 50 { left } else { right });
        assert!((face.lit_side(&light(0.8, 0.5)) + 1.0).abs() < 1e-6);
        assert!((face.lit_side(&light(0.5, 0.575)) - 0.5).abs() < 1e-3);
        assert!(face.lit_side(&light(0.6, 0.6)).abs() < 1e-6);
    }
}
