//! How soft edges are, by the corner marks' outer edge.

use super::picture::Probe;
use super::spotting::Grey;
use super::view::View;
use crate::colour::sheet::grid::{CORNERS, RING};
use crate::elementary::Elementary as _;
use crate::geometry::Vec2;

/// Rays from each mark's centre, steps along them, and where they begin and end, in cells.
const RAYS: usize = 24;
const STEPS: usize = 48;
const FROM: f64 = 0.35;
const TO: f64 = 0.49;

/// Slopes below this share of the steepest are noise.
const NOISE: f64 = 0.04;

/// Standard deviation of the edge's blur, in cells: the median of the four marks.
pub(super) fn blur(view: &View, probe: &Probe<'_>, grey: Grey) -> f64 {
    let mut blurs = CORNERS.map(|corner| {
        let profile: Vec<f64> = (0..=STEPS)
            .map(|i| {
                let r = FROM + (TO - FROM) * i as f64 / STEPS as f64;
                let turns = (0..RAYS).map(|k| std::f64::consts::TAU * k as f64 / RAYS as f64);
                turns.map(|t| grey.of(probe.at(view.at(corner + r * Vec2::new(t.cosine(), t.sine()))))).sum::<f64>()
            })
            .collect();
        width(&profile) * (TO - FROM) / STEPS as f64
    });
    blurs.sort_unstable_by(f64::total_cmp);
    // A square pixel adds its own width; what is meant is the picture's whole blur, so it stays in.
    0.5 * (blurs[1] + blurs[2])
}

/// Standard deviation of the rise of a profile, in steps; an edge that is not there has the deviation of none.
fn width(profile: &[f64]) -> f64 {
    let slopes: Vec<f64> = profile.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let noise = NOISE * slopes.iter().copied().fold(0.0, f64::max);
    let slopes: Vec<f64> = slopes.into_iter().map(|v| if v > noise { v } else { 0.0 }).collect();
    let sum: f64 = slopes.iter().sum::<f64>().max(1e-9);
    let moment =
        |power: i32, about: f64| slopes.iter().enumerate().map(|(i, v)| v * (i as f64 - about).powi(power)).sum::<f64>() / sum;
    moment(2, moment(1, 0.0)).max(0.0).sqrt()
}

/// Expected place of the edge lies within the rays.
const _: () = assert!(FROM < RING[0] && RING[0] < TO && FROM > RING[1]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_width_of_an_edge_is_its_blur() {
        // The rise of a Gaussian of deviation 3, summed up.
        let mut sum = 0.0;
        let mut edge = |i: usize| {
            sum += (-0.5 * ((i as f64 - 24.0) / 3.0).powi(2)).exponential();
            sum
        };
        let width = width(&(0..49).map(&mut edge).collect::<Vec<_>>());
        assert!((width - 3.0).abs() < 0.2, "{width}");
    }
}
