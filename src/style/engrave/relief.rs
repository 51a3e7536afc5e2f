//! Step 1: the depth that bends the lines, known everywhere and smooth, and what of the page is drawn.

use super::Drawer;
use crate::field::nearest_seed;
use crate::raster::{Raster, bilateral, fast_gaussian, gaussian_blur};
use crate::style::Picture;

/// Difference of depth beyond which smoothing sees an edge, as a fraction of the whole range.
const DEPTH_EDGE: f32 = 0.06;
/// Blur of the known area's border, which is a staircase, in pixels.
const BORDER_BLUR: f32 = 0.8;

/// Smoothing of the depth that is continued beyond what is known, reached at the same distance, in pitches: with half of it a curl's
/// teeth still show, with twice it lines turn away before a silhouette.
const CONTINUED: f64 = 2.0;

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
        let nearness = self.smoothed(&continued(&depth, &cover, self.pixels(CONTINUED * self.parameters.pitch) as f32));
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

/// Depth where there is none: that of the nearest place inside that has one, smoother the farther away. Lines are bent by what is
/// read where they come from, which at a silhouette is outside: its teeth would show in them.
fn continued(depth: &Raster<f32>, cover: &Raster<f32>, smoothing: f32) -> Raster<f32> {
    let is_known = depth.zip_map(cover, |d, c| u8::from(d > 0.0 && c >= 0.5));
    let Some(nearest) = nearest_seed(&is_known) else { return depth.clone() };
    let plain = nearest.map(|i| depth.pixels()[i as usize]);
    let smooth = fast_gaussian(&plain, smoothing);
    let width = depth.width();
    Raster::from_fn(width, depth.height(), |x, y| {
        let seed = nearest.get(x, y) as usize;
        let away = (x as f32 - (seed % width) as f32).hypot(y as f32 - (seed / width) as f32);
        let share = (away / smoothing).min(1.0);
        plain.get(x, y) * (1.0 - share) + smooth.get(x, y) * share
    })
}
