//! Step 1: the depth that bends the lines, smooth and continued everywhere, and the drawn part of the page.

use super::Drawer;
use crate::elementary::Elementary as _;
use crate::field::{Curve, contours, nearest_seed};
use crate::raster::{Raster, bilateral, fast_gaussian, gaussian_blur};
use crate::style::Picture;
use std::sync::Arc;

/// Difference of depth that smoothing keeps as an edge, as a fraction of the whole range.
const DEPTH_EDGE: f32 = 0.06;
/// Blur of the known area's stair-stepped border, in pixels.
const BORDER_BLUR: f32 = 0.8;

/// Smoothing of the depth continued beyond the known area, reached at the same distance, in pitches: with half of it the jags of a curl
/// still show, with twice it lines turn away before a silhouette.
const CONTINUED: f64 = 2.0;

/// Form without tone, the same for all pens that draw a portrait.
pub(super) struct Relief {
    /// Nearness, 0 to 1, continued beyond the known area.
    pub nearness: Raster<f32>,
    /// Share of each pixel that is drawn, 0 to 1, and the border of that.
    pub cover: Raster<f32>,
    pub silhouette: Vec<Curve>,
}

impl Drawer<'_> {
    /// The relief that bends the lines: the one at hand, or a new one.
    pub(super) fn relief(&self) -> Arc<Relief> {
        self.portrait.prepared.get().unwrap_or_else(|| Arc::new(self.new_relief()))
    }

    pub(super) fn new_relief(&self) -> Relief {
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
        Relief { nearness, silhouette: contours(&cover, 0.5), cover }
    }

    /// Smooths within edges, then slightly across them, so that no line has a corner.
    fn smoothed(&self, depth: &Raster<f32>) -> Raster<f32> {
        let sigma = self.pixels(self.parameters.smoothing) as f32;
        if sigma <= 0.0 {
            return depth.clone();
        }
        gaussian_blur(&bilateral(depth, sigma.clamp(0.5, 40.0), DEPTH_EDGE), 0.5 * sigma)
    }
}

/// Continues depth to unknown places: takes that of the nearest known place inside, smoother with distance. Lines are bent by the depth
/// at their undisplaced place, which at a silhouette lies outside, so its jags would show in them.
fn continued(depth: &Raster<f32>, cover: &Raster<f32>, smoothing: f32) -> Raster<f32> {
    let is_known = depth.zip_map(cover, |d, c| u8::from(d > 0.0 && c >= 0.5));
    let Some(nearest) = nearest_seed(&is_known) else { return depth.clone() };
    let plain = nearest.map(|i| depth.pixels()[i as usize]);
    let smooth = fast_gaussian(&plain, smoothing);
    let width = depth.width();
    Raster::from_fn(width, depth.height(), |x, y| {
        let seed = nearest.get(x, y) as usize;
        let away = (x as f32 - (seed % width) as f32).hypotenuse(y as f32 - (seed / width) as f32);
        let share = (away / smoothing).min(1.0);
        plain.get(x, y) * (1.0 - share) + smooth.get(x, y) * share
    })
}
