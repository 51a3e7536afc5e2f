//! Depth guessed from regions and shading (Galarza 2017, sections 4.4 and 5.2).

use super::poisson::poisson;
use crate::raster::Raster;

/// V-cycles of the solver.
const CYCLES: usize = 8;

/// Bulges each region (labels above 0) into a cushion that is round at its border and 0 on it: the root of Poisson's solution
/// for an even load, so a disc becomes a hemisphere. In pixels.
pub fn inflate(labels: &Raster<i32>) -> Raster<f32> {
    let given = Raster::from_fn(labels.width(), labels.height(), |x, y| {
        let label = labels.get(x, y);
        let is_border = |dx: isize, dy: isize| {
            let (x, y) = (x as isize + dx, y as isize + dy);
            labels.contains(x, y) && labels.clamped(x, y) != label
        };
        (label <= 0 || is_border(1, 0) || is_border(0, 1)).then_some(0.0_f32)
    });
    poisson(&labels.map(|_| -4.0), &given, CYCLES).map(|z| z.max(0.0).sqrt())
}

/// Bends a relief (`base`, in pixels) until its slopes towards the light agree with the shading: shape from shading with the
/// linear reflectance of Pentland 1990, `lightness = mean - slope / gain` along `light` (a vector of the page towards the lamp),
/// integrated by Poisson's equation. `shading` is the lightness less its local mean; what is outside the labels stays at 0.
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
            let within = |cx: f32, r: f32| (x as f32 - cx).hypot(y as f32 - 29.5) < r;
            if within(35.0, 25.0) { 1 } else { i32::from(within(95.0, 15.0)) * 2 }
        });
        let domes = inflate(&labels);
        assert!((domes.get(35, 29) - 25.0).abs() < 1.5, "{}", domes.get(35, 29));
        assert!((domes.get(95, 29) - 15.0).abs() < 1.5, "{}", domes.get(95, 29));
        assert!((domes.get(35 + 15, 29) - 20.0).abs() < 1.5);
        assert_eq!(domes.get(65, 29), 0.0);
    }

    #[test]
    fn a_lit_bump_is_found_again() {
        let bump = |x: f32, y: f32| 6.0 * (-((x - 40.0).powi(2) + (y - 40.0).powi(2)) / 150.0).exp();
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
