//! Converts a press's dot gain to the distance by which it moves a mark's border.

use crate::geometry::{Point, radius_for_area};

/// The distance, in the unit of `pitch`, by which the border of each dot of a 50 % tint must move for the tint to print as 50 % +
/// `gain`. The tint has round dots on a square screen, as the tints on which dot gain is measured.
pub(super) fn of_gain(gain: f64, pitch: f64) -> f64 {
    let cell = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
    let radius = |tone: f64| radius_for_area(&cell, Point::new(0.5, 0.5), tone);
    (radius(0.5 + gain) - radius(0.5)).max(0.0) * pitch
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_of_known_presses() {
        // sqrt(0.66 / pi) - sqrt(0.5 / pi) of 1/6 mm.
        assert!((of_gain(0.16, 10.0 / 60.0) - 0.009_902).abs() < 1e-5);
        assert!((of_gain(0.26, 10.0 / 40.0) - 0.023_230).abs() < 1e-5);
        assert_eq!(of_gain(0.0, 0.2), 0.0);
        // Dots that touch still spread.
        assert!(of_gain(0.4, 1.0) > of_gain(0.3, 1.0));
    }
}
