//! Anisotropic diffusion (Perona and Malik 1990) of a grey or colour picture.

use super::{Raster, gradient};

/// A step of the explicit scheme; stable up to 1/4.
const TIME_STEP: f32 = 0.2;

/// Smooths within regions, for the time in which plain diffusion would be a Gaussian blur of `sigma` pixels.
///
/// Conductance is `1 / (1 + (|gradient| / contrast)^2)`. The squared gradient is summed over the planes and taken by central
/// differences (about one pixel's blur), so that corners keep their place (Papari 2009, figure 7.14). `contrast` is in values per
/// pixel, above 0. Time grows with `sigma^2`.
pub fn anisotropic_diffusion(planes: &[Raster<f32>], sigma: f32, contrast: f32) -> Vec<Raster<f32>> {
    let rounds = (0.5 * sigma * sigma / TIME_STEP).ceil() as usize;
    let mut planes = planes.to_vec();
    for _ in 0..rounds {
        let slopes: Vec<Raster<[f32; 2]>> = planes.iter().map(gradient).collect();
        let Some(conductance) = conductance(&slopes, contrast) else { return planes };
        planes = planes.iter().map(|plane| step(plane, &conductance)).collect();
    }
    planes
}

fn conductance(slopes: &[Raster<[f32; 2]>], contrast: f32) -> Option<Raster<f32>> {
    let squares = slopes.iter().map(|slope| slope.map(|[x, y]| x * x + y * y));
    let sum = squares.reduce(|a, b| a.zip_map(&b, |a, b| a + b))?;
    Some(sum.map(|square| 1.0 / (1.0 + square / (contrast * contrast))))
}

fn step(plane: &Raster<f32>, conductance: &Raster<f32>) -> Raster<f32> {
    Raster::from_fn(plane.width(), plane.height(), |x, y| {
        let (here, through) = (plane.get(x, y), conductance.get(x, y));
        let (x, y) = (x as isize, y as isize);
        let flow = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)]
            .map(|(nx, ny)| 0.5 * (through + conductance.clamped(nx, ny)) * (plane.clamped(nx, ny) - here));
        here + TIME_STEP * (flow[0] + flow[1] + flow[2] + flow[3])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_stays_and_ripples_go() {
        let plane = Raster::from_fn(60, 60, |x, y| {
            let base = if x > 30 && y > 30 { 0.8 } else { 0.2 };
            base + 0.02 * ((x + 2 * y) % 4) as f32 / 3.0
        });
        let smooth = &anisotropic_diffusion(&[plane], 4.0, 0.06)[0];
        assert!(smooth.get(32, 32) > 0.6 && smooth.get(29, 29) < 0.4, "{} {}", smooth.get(32, 32), smooth.get(29, 29));
        assert!((smooth.get(10, 10) - smooth.get(12, 13)).abs() < 0.002);
    }
}
