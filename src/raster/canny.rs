//! Canny's edge detector (Canny 1986; Bruehl 2023, sections 1.4.3 and 2.1) on real-valued rasters.

use super::{Raster, sobel};
use crate::elementary::Elementary as _;

/// Gradient thresholds, in raster units per pixel; `low <= high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// An edge pixel weaker than this is dropped.
    pub low: f32,
    /// An edge needs at least one pixel as strong as this.
    pub high: f32,
}

/// Marks (1) the ridges of the gradient that reach `high` somewhere and never fall below `low`, one pixel wide.
///
/// The raster is not blurred here: blur it first. The outermost ring of pixels is never an edge.
pub fn canny(raster: &Raster<f32>, thresholds: Thresholds) -> Raster<u8> {
    let gradient = sobel(raster);
    let strength = gradient.map(|[gx, gy]| gx.hypotenuse(gy));
    let ridges = suppress_non_maxima(&gradient, &strength, thresholds.low);
    follow_from_strong(&ridges, &strength, thresholds.high)
}

/// Keeps pixels whose gradient is at least that of the two points one pixel ahead and behind along it.
fn suppress_non_maxima(gradient: &Raster<[f32; 2]>, strength: &Raster<f32>, low: f32) -> Raster<u8> {
    let (width, height) = (strength.width(), strength.height());
    Raster::from_fn(width, height, |x, y| {
        let here = strength.get(x, y);
        if here < low || here <= 0.0 || x == 0 || y == 0 || x + 1 == width || y + 1 == height {
            return 0;
        }
        let [gx, gy] = gradient.get(x, y);
        let (ux, uy) = (f64::from(gx / here), f64::from(gy / here));
        let (cx, cy) = (x as f64 + 0.5, y as f64 + 0.5);
        let ahead = strength.sample(cx + ux, cy + uy);
        let behind = strength.sample(cx - ux, cy - uy);
        // Strict on one side only, so that a plateau two pixels wide leaves one line and not none.
        u8::from(here > ahead && here >= behind)
    })
}

/// Hysteresis: flood from the strong pixels through the weak ones, over eight neighbours.
fn follow_from_strong(ridges: &Raster<u8>, strength: &Raster<f32>, high: f32) -> Raster<u8> {
    let (width, height) = (ridges.width(), ridges.height());
    let mut edges = Raster::filled(width, height, 0_u8);
    let mut stack: Vec<(usize, usize)> = Vec::new();
    for y in 0..height {
        for x in 0..width {
            if ridges.get(x, y) == 0 || edges.get(x, y) != 0 || strength.get(x, y) < high {
                continue;
            }
            edges.set(x, y, 1);
            stack.push((x, y));
            while let Some((cx, cy)) = stack.pop() {
                for ny in cy.saturating_sub(1)..=(cy + 1).min(height - 1) {
                    for nx in cx.saturating_sub(1)..=(cx + 1).min(width - 1) {
                        if ridges.get(nx, ny) != 0 && edges.get(nx, ny) == 0 {
                            edges.set(nx, ny, 1);
                            stack.push((nx, ny));
                        }
                    }
                }
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::gaussian_blur;

    fn disc(radius: f32) -> Raster<f32> {
        Raster::from_fn(64, 64, |x, y| f32::from((x as f32 - 31.5).hypotenuse(y as f32 - 31.5) < radius))
    }

    #[test]
    fn the_edge_of_a_disc_is_a_thin_ring_at_its_radius() {
        let edges = canny(&gaussian_blur(&disc(20.0), 1.5), Thresholds { low: 0.02, high: 0.06 });
        let mut count = 0;
        for y in 0..64 {
            for x in 0..64 {
                if edges.get(x, y) == 1 {
                    count += 1;
                    let r = (x as f32 - 31.5).hypotenuse(y as f32 - 31.5);
                    assert!((r - 20.0).abs() < 1.5, "edge pixel at radius {r}");
                }
            }
        }
        assert!((90..180).contains(&count), "{count} pixels for a circumference of 126");
    }

    #[test]
    fn weak_edges_need_a_strong_pixel() {
        let faint = disc(20.0).map(|v| v * 0.1);
        let edges = canny(&gaussian_blur(&faint, 1.5), Thresholds { low: 0.005, high: 0.2 });
        assert!(edges.pixels().iter().all(|&v| v == 0));
    }
}
