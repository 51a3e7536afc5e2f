//! Isophotes: lines of equal lightness around the lightest regions (Bruehl 2023, section 2.2).

use super::contour::contours;
use super::curve::Curve;
use crate::geometry::smooth_polyline;
use crate::raster::{Raster, bilateral};

/// Every step of the detection, for `stages`.
#[derive(Clone, Debug)]
pub struct IsophoteSteps {
    /// Lightness after the bilateral filter.
    pub smoothed: Raster<f32>,
    /// Lightness in `levels` equal steps, 0 to 1.
    pub posterised: Raster<f32>,
    /// The outlines of the lightest regions.
    pub lines: Vec<Curve>,
}

/// Smooths, posterises to `levels` steps and outlines the `lightest` lightest of them, one line per step border.
///
/// A step's border is taken as the contour of the smoothed lightness at that value, at sub-pixel accuracy. `smoothing` (pixels) applies
/// to the bilateral filter and the lines; lines shorter than `least` are dropped.
pub fn detect_isophotes(lightness: &Raster<f32>, levels: u32, lightest: u32, smoothing: f32, least: f32) -> IsophoteSteps {
    let smoothed = bilateral(&bilateral(lightness, smoothing, 0.08), smoothing, 0.08);
    let steps = levels as f32;
    let posterised = smoothed.map(|v| (v * steps).floor().min(steps - 1.0) / (steps - 1.0).max(1.0));
    let lines = (1..=lightest.min(levels - 1))
        .flat_map(|k| contours(&smoothed, 1.0 - k as f32 / steps))
        .filter(|line| line.length() >= f64::from(least))
        .map(|line| Curve {
            points: smooth_polyline(&line.points, line.closed.into(), f64::from(smoothing), 1.5),
            closed: line.closed,
        })
        .filter(|line| line.points.len() > 1)
        .collect();
    IsophoteSteps { smoothed, posterised, lines }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    #[test]
    fn a_lit_ball_has_rings() {
        let ball = Raster::from_fn(100, 100, |x, y| (1.0 - (x as f32 - 50.0).hypotenuse(y as f32 - 50.0) / 60.0).max(0.0));
        let steps = detect_isophotes(&ball, 5, 2, 2.0, 10.0);
        assert_eq!(steps.lines.len(), 2);
        for (line, radius) in steps.lines.iter().zip([12.0, 24.0]) {
            assert!(line.closed);
            let mean = line.points.iter().map(|p| p.distance(crate::geometry::Point::new(50.5, 50.5))).sum::<f64>()
                / line.points.len() as f64;
            assert!((mean - radius).abs() < 0.7, "{mean} for {radius}");
        }
    }
}
