//! Step 1: the depth that bends the lines, known everywhere and smooth, and what of the page is drawn.

use super::Drawer;
use crate::field::nearest_seed;
use crate::raster::{Raster, bilateral, gaussian_blur};
use crate::style::Picture;

/// Difference of depth beyond which smoothing sees an edge, as a fraction of the whole range.
const DEPTH_EDGE: f32 = 0.06;
/// Blur of the known area's border, which is a staircase, in pixels.
const BORDER_BLUR: f32 = 0.8;

/// What bends the lines.
pub(super) struct Relief {
    /// Nearness, 0 to 1, continued beyond what is known.
    pub nearness: Raster<f32>,
    /// How far each pixel is drawn, 0 to 1.
    pub cover: Raster<f32>,
}

impl Drawer<'_> {
    pub(super) fn relief(&self) -> Relief {
        self.observer.begin("depth");
        let subject = &self.portrait.subject;
        let (depth, cover) = match &self.portrait.depth {
            Some(depth) => {
                let known = gaussian_blur(&depth.map(|d| if d > 0.0 { 1.0 } else { 0.0 }), BORDER_BLUR);
                (depth.clone(), subject.zip_map(&known, f32::min))
            }
            None => (self.guessed_depth(), subject.clone()),
        };
        self.observer.picture("depth", &|| Picture::Grey(depth.clone()));
        let nearness = self.smoothed(&continued(&depth, &cover));
        self.observer.picture("depth-smoothed", &|| Picture::Grey(nearness.clone()));
        Relief { nearness, cover }
    }

    /// Smoothed within its edges, then a little across them, so that no line has a corner.
    fn smoothed(&self, depth: &Raster<f32>) -> Raster<f32> {
        let sigma = self.pixels(self.parameters.smoothing) as f32;
        if sigma <= 0.0 {
            return depth.clone();
        }
        gaussian_blur(&bilateral(depth, sigma.clamp(0.5, 40.0), DEPTH_EDGE), 0.5 * sigma)
    }
}

/// Depth where there is none: that of the nearest place inside that has one.
fn continued(depth: &Raster<f32>, cover: &Raster<f32>) -> Raster<f32> {
    let is_known = depth.zip_map(cover, |d, c| u8::from(d > 0.0 && c >= 0.5));
    match nearest_seed(&is_known) {
        Some(nearest) => nearest.map(|i| depth.pixels()[i as usize]),
        None => depth.clone(),
    }
}
