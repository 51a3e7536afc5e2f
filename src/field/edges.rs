//! Edges: grey, blur, Canny, dilation, median, removal of short ones, median again (Bruehl 2023, section 2.1).

use super::curve::Curve;
use super::trace::trace;
use crate::geometry::smooth_polyline;
use crate::raster::{Raster, Thresholds, canny, components, dilate, gaussian_blur, majority, remove_components, thin};

/// Parameters of edge detection; lengths in working pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeParameters {
    /// Standard deviation of the blur before Canny.
    pub blur: f32,
    /// Canny's thresholds, in lightness (0 to 1) per pixel.
    pub thresholds: Thresholds,
    /// Edges whose skeleton has fewer pixels are removed.
    pub least_length: f32,
    /// Standard deviation along the line of the smoothing of traced edges.
    pub smoothing: f32,
}

/// Every step of the detection, for `stages`.
#[derive(Clone, Debug)]
pub struct EdgeSteps {
    /// The blurred lightness.
    pub blurred: Raster<f32>,
    /// Canny's result.
    pub canny: Raster<u8>,
    /// After dilation and the first median.
    pub thickened: Raster<u8>,
    /// After the removal of short edges and the second median.
    pub kept: Raster<u8>,
    /// One pixel wide.
    pub skeleton: Raster<u8>,
}

/// Finds the edges of a lightness raster.
pub fn detect_edges(lightness: &Raster<f32>, parameters: EdgeParameters) -> EdgeSteps {
    let blurred = gaussian_blur(lightness, parameters.blur);
    let canny = canny(&blurred, parameters.thresholds);
    let thickened = majority(&dilate(&canny, 1), 1);
    let kept = majority(&remove_short(&thickened, parameters.least_length), 1);
    let skeleton = thin(&kept);
    EdgeSteps { blurred, canny, thickened, kept, skeleton }
}

/// Drops the connected components whose skeleton has fewer than `least` pixels (Bruehl 2023, section 2.1.1).
fn remove_short(edges: &Raster<u8>, least: f32) -> Raster<u8> {
    let (labels, count) = components(edges);
    let mut length = vec![0_u32; count + 1];
    for (&label, &marked) in labels.pixels().iter().zip(thin(edges).pixels()) {
        length[label as usize] += u32::from(marked != 0);
    }
    remove_components(edges, &labels, |label| length[label as usize] as f32 >= least)
}

/// The lines of a skeleton as smooth curves, without those shorter than `least`.
pub fn lines_of(skeleton: &Raster<u8>, smoothing: f32, least: f32) -> Vec<Curve> {
    trace(skeleton)
        .into_iter()
        .filter(|line| line.length() >= f64::from(least))
        .map(|line| {
            let points = smooth_polyline(&line.points, line.closed.into(), f64::from(smoothing.max(0.5)), 1.5);
            Curve { points, closed: line.closed }
        })
        .filter(|line| line.points.len() > 1)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::distances_from;

    #[test]
    fn a_disc_s_edge_is_one_closed_line_at_its_radius_and_specks_are_gone() {
        let (disc, speck) = (distances_from(59.5, 120), distances_from(10.0, 120));
        let picture = disc.zip_map(&speck, |disc, speck| if disc < 35.0 || speck < 2.5 { 0.2 } else { 0.9 });
        let parameters =
            EdgeParameters { blur: 1.5, thresholds: Thresholds { low: 0.02, high: 0.05 }, least_length: 40.0, smoothing: 3.0 };
        let steps = detect_edges(&picture, parameters);
        let lines = lines_of(&steps.skeleton, parameters.smoothing, 10.0);
        assert_eq!(lines.len(), 1, "{}", lines.len());
        assert!(lines[0].closed);
        for p in &lines[0].points {
            let r = p.distance(crate::geometry::Point::new(60.0, 60.0));
            assert!((r - 35.0).abs() < 1.0, "radius {r}");
        }
    }
}
