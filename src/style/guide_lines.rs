//! Lines that steer marks and are not found in the photograph: those drawn by hand and the subject's border. And the thresholds by which
//! the others are found.

use super::Picture;
use super::drawer::{Drawer, Pitched};
use crate::field::{Curve, contours, lines_of};
use crate::geometry::{Millimetres, smooth_polyline};
use crate::raster::{Raster, Thresholds, thin};

/// Minimum brightness of a hand-made line; low, since thin lines grow faint when the mask is scaled down.
const LINE_BRIGHTNESS: f32 = 0.25;

impl<P: Pitched> Drawer<'_, P> {
    /// Centre lines of white lines on black.
    pub(super) fn hand_made(&self, mask: &Raster<f32>, smoothing: Millimetres) -> Vec<Curve> {
        let marked = mask.map(|v| u8::from(v >= LINE_BRIGHTNESS));
        self.observer.picture("hand-made", &|| Picture::Mask(marked.clone()));
        lines_of(&thin(&marked), self.pixels(smoothing).min(3.0) as f32, 0.5 * self.pitch() as f32)
    }

    /// The subject's border as smooth lines, without those shorter than `least`.
    pub(super) fn silhouette(&self, smoothing: Millimetres, least: Millimetres) -> Vec<Curve> {
        let (smoothing, least) = (self.pixels(smoothing).max(1.0), self.pixels(least));
        contours(&self.portrait.subject, 0.5)
            .into_iter()
            .filter(|line| line.length() >= least)
            .map(|line| Curve { points: smooth_polyline(&line.points, line.closed.into(), smoothing, 1.5), closed: line.closed })
            .filter(|line| line.points.len() > 1)
            .collect()
    }

    /// Thresholds given as changes of lightness per pitch; the lower is at most the upper.
    pub(super) fn thresholds(&self, low: f64, high: f64) -> Thresholds {
        let per_pixel = 1.0 / self.pitch();
        Thresholds { low: (low.min(high) * per_pixel) as f32, high: (high * per_pixel) as f32 }
    }
}
