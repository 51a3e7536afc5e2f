//! Depth estimated from regions and shading (Galarza 2017, sections 4.4 and 5.2).

use super::distance::nearest_seed;
use super::poisson::poisson;
use crate::elementary::Elementary as _;
use crate::raster::{Raster, gaussian_blur};

/// V-cycles of the solver.
const CYCLES: usize = 8;

/// Standard deviation of the smoothing of the load, as a fraction of the maximum distance from a border: with none the ridges of the
/// distance remain, with much more a region's arms lose their own height.
const RIDGE_SMOOTHING: f32 = 0.15;

/// Inflates each region (labels above 0) into a cushion with a round rim, 0 on the region's border; in pixels.
///
/// With the distance `d` to the region's border and its maximum `R`, the squared height is `d (2 R - d)`. This makes a disc a hemisphere
/// but leaves a ridge wherever two sides meet. Its smoothed Laplacian is the load of Poisson's equation with the borders at 0, whose
/// solution has no ridges. A raster without any border stays flat.
pub fn inflate(labels: &Raster<i32>) -> Raster<f32> {
    let is_border = Raster::from_fn(labels.width(), labels.height(), |x, y| {
        let label = labels.get(x, y);
        let differs = |dx: isize, dy: isize| {
            let (x, y) = (x as isize + dx, y as isize + dy);
            labels.contains(x, y) && labels.clamped(x, y) != label
        };
        u8::from(label <= 0 || differs(1, 0) || differs(0, 1))
    });
    let Some(nearest) = nearest_seed(&is_border) else { return labels.map(|_| 0.0) };
    let distance = distances(&nearest);
    let squared = squared_heights(labels, &distance);
    let load = Raster::from_fn(labels.width(), labels.height(), |x, y| {
        let (x, y) = (x as isize, y as isize);
        let beside =
            squared.clamped(x - 1, y) + squared.clamped(x + 1, y) + squared.clamped(x, y - 1) + squared.clamped(x, y + 1);
        if is_border.clamped(x, y) > 0 { 0.0 } else { beside - 4.0 * squared.clamped(x, y) }
    });
    // Only the inside counts, so that nothing leaks from one region into the next.
    let deepest = distance.pixels().iter().copied().fold(0.0, f32::max);
    let blurred = |raster: &Raster<f32>| gaussian_blur(raster, (RIDGE_SMOOTHING * deepest).max(0.5));
    let share = blurred(&is_border.map(|border| 1.0 - f32::from(border)));
    let load = blurred(&load).zip_map(&share, |load, share| load / share.max(1e-3));
    poisson(&load, &is_border.map(|border| (border > 0).then_some(0.0)), CYCLES).map(|z| z.max(0.0).sqrt())
}

/// Distance from each pixel to its nearest one, in pixels.
fn distances(nearest: &Raster<u32>) -> Raster<f32> {
    let width = nearest.width();
    Raster::from_fn(width, nearest.height(), |x, y| {
        let seed = nearest.get(x, y) as usize;
        (x as f32 - (seed % width) as f32).hypotenuse(y as f32 - (seed / width) as f32)
    })
}

/// `d (2 R - d)` with each region's own maximum distance.
fn squared_heights(labels: &Raster<i32>, distance: &Raster<f32>) -> Raster<f32> {
    let count = labels.pixels().iter().copied().max().unwrap_or(0).max(0) as usize;
    let mut greatest = vec![0.0_f32; count + 1];
    for (&label, &d) in labels.pixels().iter().zip(distance.pixels()) {
        let greatest = &mut greatest[label.max(0) as usize];
        *greatest = greatest.max(d);
    }
    labels.zip_map(distance, |label, d| d * (2.0 * greatest[label.max(0) as usize] - d))
}

/// Bends a relief (`base`, in pixels) until its slopes towards the light agree with the shading: shape from shading with the linear
/// reflectance of Pentland 1990, `lightness = mean - slope / gain` along `light` (a vector of the page towards the lamp), integrated by
/// Poisson's equation. `shading` is the lightness less its local mean; pixels outside the labels stay at 0.
pub fn bend_by_shading(
    base: &Raster<f32>,
    shading: &Raster<f32>,
    labels: &Raster<i32>,
    light: [f32; 2],
    gain: f32,
) -> Raster<f32> {
    let slope = |raster: &Raster<f32>, x: isize, y: isize| {
        [raster.clamped(x + 1, y) - raster.clamped(x, y), raster.clamped(x, y + 1) - raster.clamped(x, y)]
    };
    // Bright where the surface falls towards the lamp.
    let wanted = Raster::from_fn(base.width(), base.height(), |x, y| {
        let [sx, sy] = slope(base, x as isize, y as isize);
        let tilt = -gain * shading.get(x, y);
        [sx + tilt * light[0], sy + tilt * light[1]]
    });
    let divergence = Raster::from_fn(base.width(), base.height(), |x, y| {
        let here = wanted.get(x, y);
        here[0] - wanted.clamped(x as isize - 1, y as isize)[0] + here[1] - wanted.clamped(x as isize, y as isize - 1)[1]
    });
    let given = labels.map(|label| (label <= 0).then_some(0.0_f32));
    poisson(&divergence, &given, CYCLES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_discs_become_two_domes() {
        let labels = Raster::from_fn(120, 60, |x, y| {
            let within = |cx: f32, r: f32| (x as f32 - cx).hypotenuse(y as f32 - 29.5) < r;
            if within(35.0, 25.0) { 1 } else { i32::from(within(95.0, 15.0)) * 2 }
        });
        let domes = inflate(&labels);
        assert!((domes.get(35, 29) - 25.0).abs() < 1.5, "{}", domes.get(35, 29));
        assert!((domes.get(95, 29) - 15.0).abs() < 1.5, "{}", domes.get(95, 29));
        assert!((domes.get(35 + 15, 29) - 20.0).abs() < 1.5);
        assert_eq!(domes.get(65, 29), 0.0);
    }

    #[test]
    fn an_l_has_no_ridges() {
        let labels =
            Raster::from_fn(120, 120, |x, y| i32::from((5..115).contains(&x) && (5..115).contains(&y) && (x < 55 || y > 65)));
        let cushion = inflate(&labels);
        let bend = |x: usize, y: usize| cushion.get(x - 2, y) + cushion.get(x + 2, y) - 2.0 * cushion.get(x, y);
        // Across the arm, where the plain distance has a ridge of -4.
        assert!((15..45).all(|x| bend(x, 30) > -1.0), "{:?}", (15..45).map(|x| bend(x, 30)).collect::<Vec<_>>());
        assert!(cushion.get(30, 30) > 15.0 && cushion.get(30, 90) > cushion.get(30, 30));
    }

    #[test]
    fn a_lit_bump_is_found_again() {
        let bump = |x: f32, y: f32| 6.0 * (-((x - 40.0).powi(2) + (y - 40.0).powi(2)) / 150.0).exponential();
        let shading = Raster::from_fn(80, 80, |x, y| {
            let (x, y) = (x as f32, y as f32);
            let slope_x = bump(x + 0.5, y) - bump(x - 0.5, y);
            -slope_x * 0.5
        });
        let flat = Raster::filled(80, 80, 0.0_f32);
        let labels = Raster::from_fn(80, 80, |x, y| i32::from(x > 0 && y > 0 && x < 79 && y < 79));
        let found = bend_by_shading(&flat, &shading, &labels, [1.0, 0.0], 2.0);
        // Along the light the slopes are those of the bump; across it a single picture says nothing.
        assert!(found.get(40, 40) > 1.5, "{}", found.get(40, 40));
        assert!(found.get(40, 40) > found.get(10, 40) + 1.0 && found.get(40, 40) > found.get(70, 40) + 1.0);
    }
}
