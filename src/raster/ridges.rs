//! Line detection: thin dark and light lines of a raster, as one-pixel ridges of its second derivative.
//!
//! Wong 1999, section 3.1.2 uses "a standard line-detection algorithm"; textbook masks see four directions. Here the second
//! derivatives give the strength and the direction across the line, and only the ridge itself is kept, so that the Hough
//! transform that follows counts thin lines.

use super::Raster;
use crate::elementary::Elementary as _;

/// Marks (1) the pixels on a dark or light line: the magnitude of the second derivative across the line is the largest among its
/// neighbours and at least `least` (raster units per square pixel). Blur the raster first: the blur sets the width of the lines
/// found.
pub fn ridges(raster: &Raster<f32>, least: f32) -> Raster<u8> {
    let curvature = Raster::from_fn(raster.width(), raster.height(), |x, y| across(raster, x as isize, y as isize));
    let strength = curvature.map(|[s, ..]| s.abs());
    Raster::from_fn(raster.width(), raster.height(), |x, y| {
        let [here, ux, uy] = curvature.get(x, y);
        if here.abs() < least || here == 0.0 {
            return 0;
        }
        let at = |step: f32| strength.sample(x as f64 + 0.5 + f64::from(step * ux), y as f64 + 0.5 + f64::from(step * uy));
        // Two pixels each way, since a blurred line has a weaker line of the opposite sign on both sides.
        u8::from(here.abs() > at(1.0).max(at(2.0)) && here.abs() >= at(-1.0).max(at(-2.0)))
    })
}

/// The second derivative of largest magnitude (positive on a dark line) and its unit direction.
fn across(raster: &Raster<f32>, x: isize, y: isize) -> [f32; 3] {
    let at = |dx: isize, dy: isize| raster.clamped(x + dx, y + dy);
    let xx = at(1, 0) - 2.0 * at(0, 0) + at(-1, 0);
    let yy = at(0, 1) - 2.0 * at(0, 0) + at(0, -1);
    let xy = 0.25 * (at(1, 1) - at(-1, 1) - at(1, -1) + at(-1, -1));
    let (mean, spread) = (0.5 * (xx + yy), (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt());
    let value = if mean >= 0.0 { mean + spread } else { mean - spread };
    // The eigenvector, from the row of the matrix with the larger entry.
    let (a, b) = if (value - yy).abs() > (value - xx).abs() { (value - yy, xy) } else { (xy, value - xx) };
    let length = a.hypotenuse(b);
    if length > 0.0 { [value, a / length, b / length] } else { [value, 1.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::gaussian_blur;

    #[test]
    fn a_dark_and_a_light_line_are_found_where_they_are() {
        let picture = Raster::from_fn(60, 40, |x, y| match (x, y) {
            (10, _) => 0.0,
            (_, 30) if x > 20 => 1.0,
            _ => 0.5,
        });
        let lines = ridges(&gaussian_blur(&picture, 1.2), 0.03);
        assert_eq!(lines.get(10, 15), 1);
        assert_eq!(lines.get(40, 30), 1);
        let marked = lines.pixels().iter().filter(|v| **v != 0).count();
        assert!((70..130).contains(&marked), "{marked} pixels for 40 + 39");
    }

    #[test]
    fn flat_rasters_have_no_lines() {
        assert!(ridges(&Raster::filled(9, 9, 0.3), 0.0).pixels().iter().all(|v| *v == 0));
    }
}
