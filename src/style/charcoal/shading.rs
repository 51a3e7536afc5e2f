//! Hand shading of features, clothing and background (sections 6.2, 6.3.4 and 6.3.5).

use super::Drawer;
use super::features::Features;
use super::patch::{Patch, Pressing};
use super::regions::Regions;
use crate::drawing::Mark;
use crate::field::histogram_modes;
use crate::raster::{Raster, gaussian_blur, paper_texture};

/// Pressure of the background's strokes, and their width at it as a share of the full width: lighter than anything in the portrait.
const BACKGROUND_PRESSURE: f64 = 0.3;
const BACKGROUND_WIDTH: f64 = 0.44;
/// Width of a background stroke as a share of the stick's.
const BACKGROUND_STROKE: f64 = 0.7;
/// Pressure of the background far from the subject, as a share of that beside it, and the distance over which it falls, in sheet widths.
const FAR_PRESSURE: f64 = 0.35;
const FALL: f64 = 0.22;
/// Clothing lighter than this tone is left to the smudge.
const LIGHT_CLOTH: f64 = 0.5;

impl Drawer<'_> {
    /// Dark clothing and everything that is neither face nor hair: tones found by scale-space filtering, darker ones shaded over lighter
    /// ones, each slightly turned.
    pub(super) fn shading(&self, regions: &Regions, features: &Features) -> Vec<Mark> {
        if !self.parameters.has_shading {
            return Vec::new();
        }
        self.observer.begin("shading");
        let cloth = regions.clothing.zip_map(&features.drawn, |c, drawn| c.min(1.0 - drawn));
        let tone = gaussian_blur(&self.portrait.tone, self.pixels(self.parameters.pitch) as f32);
        let levels = dark_levels(&tone, &cloth);
        let mut marks = Vec::new();
        for (i, (limit, mean)) in levels.iter().enumerate() {
            let region = tone.zip_map(&cloth, |t, c| if f64::from(t) < *limit { c } else { 0.0 });
            let darkness = 1.0 - mean;
            let patch = Patch {
                region: gaussian_blur(&region, 1.0),
                width: self.parameters.stroke_width,
                spacing: self.parameters.pitch * (1.1 + 2.2 * (1.0 - darkness)),
                length: 0.55 * self.parameters.arc_length,
                orientation: self.parameters.arc_orient.0 + 0.35 * i as f64,
                pressure: 0.25 + 0.6 * darkness,
                inset: 0.5 * self.parameters.stroke_width,
                pressing: Pressing::Hatching,
            };
            marks.extend(self.shade_patch(&patch, "shading", i as u64, |_| 1.0));
        }
        marks
    }

    /// Section 6.3.5: firmer where the photograph is darker, with a ragged end before the sheet's border.
    pub(super) fn background(&self, regions: &Regions) -> Vec<Mark> {
        if !self.parameters.has_background || !regions.has_background || self.parameters.background_ink <= 0.0 {
            return Vec::new();
        }
        self.observer.begin("background");
        let region = self.ragged(&regions.subject);
        self.show("background", &region);
        let width = BACKGROUND_STROKE * self.parameters.stroke_width;
        let patch = Patch {
            region,
            width,
            // Spreads a stroke's ink, at the pressure below, over its spacing.
            spacing: BACKGROUND_WIDTH * width / self.parameters.background_ink,
            length: self.parameters.arc_length,
            orientation: self.parameters.arc_orient.0,
            pressure: BACKGROUND_PRESSURE,
            inset: 0.5 * width,
            pressing: Pressing::Hatching,
        };
        let nearness = self.nearness(&regions.subject);
        self.shade_patch(&patch, "background", 0, |p| f64::from(nearness.sample(p.x, p.y)))
    }

    /// Pressure of the background at a place: sets off the subject and leaves the sheet's border airy.
    fn nearness(&self, subject: &Raster<f32>) -> Raster<f32> {
        let (width, height) = self.size();
        let reach = (FALL * width.min(height) as f64) as f32;
        let wide = gaussian_blur(subject, reach);
        let cloud = paper_texture(width / 8 + 2, height / 8 + 2, 14.0, self.seed ^ 0xc10d);
        let far = FAR_PRESSURE as f32;
        Raster::from_fn(width, height, |x, y| {
            let near = (far + 2.2 * (1.0 - far) * wide.get(x, y)).min(1.0);
            near * (0.55 + 0.9 * cloud.sample(x as f64 / 8.0 + 0.5, y as f64 / 8.0 + 0.5))
        })
    }

    /// The background without an irregular margin.
    fn ragged(&self, subject: &Raster<f32>) -> Raster<f32> {
        let (width, height) = self.size();
        let margin = 0.05 * width.min(height) as f64;
        let waver = paper_texture(width / 8 + 2, height / 8 + 2, 10.0, self.seed ^ 0xba5e);
        Raster::from_fn(width, height, |x, y| {
            let edge = x.min(y).min(width - 1 - x).min(height - 1 - y) as f64;
            let wanted = margin * (0.5 + 1.6 * f64::from(waver.sample(x as f64 / 8.0 + 0.5, y as f64 / 8.0 + 0.5)));
            let inner = ((edge - wanted) as f32 + 0.5).clamp(0.0, 1.0);
            inner.min(1.0 - subject.get(x, y))
        })
    }
}

/// The dark tones of a region, lightest first: the tone below which each is shaded, and the tone itself.
fn dark_levels(tone: &Raster<f32>, region: &Raster<f32>) -> Vec<(f64, f64)> {
    let mut histogram = vec![0_u32; 256];
    for (t, _) in tone.pixels().iter().zip(region.pixels()).filter(|(_, r)| **r >= 0.5) {
        histogram[((t * 255.0) as usize).min(255)] += 1;
    }
    let total: u32 = histogram.iter().sum();
    let modes = histogram_modes(&histogram, total / 16);
    let mut levels: Vec<(f64, f64)> = modes
        .iter()
        .enumerate()
        .map(|(i, mode)| (modes.get(i + 1).map_or(1.0, |next| 0.5 * (mode.at + next.at) / 255.0), mode.at / 255.0))
        .filter(|(_, mean)| *mean < LIGHT_CLOTH)
        .collect();
    for level in &mut levels {
        level.0 = level.0.min(LIGHT_CLOTH + 0.08);
    }
    levels.reverse();
    levels
}
