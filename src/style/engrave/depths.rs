//! Depth without a depth map (Galarza 2017, sections 4.4 and 5.2), and the lighting of a relief.

use super::Drawer;
use super::parameters::DepthFrom;
use super::relief::Relief;
use crate::elementary::{Elementary as _, unit_at};
use crate::field::{bend_by_shading, inflate};
use crate::raster::{Raster, bilateral, enlarge, gaussian_blur, reduce};

impl Drawer<'_> {
    /// Nearness, 0 to 1.
    pub(super) fn guessed_depth(&self) -> Raster<f32> {
        /// Smoothing of a photograph before its light is used as depth, in pitches: finer detail is texture, not form.
        const PHOTO_SMOOTHING: f64 = 1.5;
        /// Difference of lightness that this smoothing keeps as an edge.
        const PHOTO_EDGE: f32 = 0.15;
        let lightness = self.portrait.on_white(&self.portrait.lightness);
        let sigma = (PHOTO_SMOOTHING * self.pitch()) as f32;
        let smoothed = gaussian_blur(&bilateral(&lightness, sigma, PHOTO_EDGE), 0.5 * sigma);
        match self.parameters.depth_from {
            DepthFrom::Luminance => smoothed.map(|v| v.max(1e-4)),
            DepthFrom::Inflate => self.at_form_scale(&smoothed, |regions, _| unit(&inflate(&framed(regions)))),
            DepthFrom::Shape => self.at_form_scale(&smoothed, |regions, lightness| self.shaped(regions, lightness)),
        }
    }

    /// Computes a form on a smaller raster of the main regions and the lightness, since forms are smooth.
    fn at_form_scale(&self, lightness: &Raster<f32>, form: impl Fn(&Raster<i32>, &Raster<f32>) -> Raster<f32>) -> Raster<f32> {
        /// Minimum shorter side of the raster on which forms are computed, in pixels.
        const FORM_SIDE: usize = 200;
        let (width, height) = (lightness.width(), lightness.height());
        let factor = (width.min(height) / FORM_SIDE).max(1);
        let small = reduce(lightness, factor);
        let regions = self.great_regions();
        let middle = |i: usize, end: usize| (i * factor + factor / 2).min(end - 1);
        let regions = Raster::from_fn(small.width(), small.height(), |x, y| regions.get(middle(x, width), middle(y, height)));
        enlarge(&form(&regions, &small), factor, width, height)
    }

    fn shaped(&self, regions: &Raster<i32>, lightness: &Raster<f32>) -> Raster<f32> {
        /// Scale, as a share of the picture's shorter side, above which changes of brightness are colour, not shading.
        const LOCAL: f64 = 0.12;
        /// Slope for a full step of lightness.
        const SHADING_GAIN: f32 = 2.0;
        /// Share of the height taken from the lightness itself: in faces and still lifes near parts catch the light.
        const NEAR_IS_LIGHT: f32 = 0.35;
        let side = lightness.width().min(lightness.height()) as f64;
        let local = gaussian_blur(lightness, (LOCAL * side) as f32);
        let shading = lightness.zip_map(&local, |v, mean| v - mean);
        let light = unit_at(-self.parameters.light_azimuth.to_radians());
        let bent = bend_by_shading(&inflate(regions), &shading, regions, [light.x as f32, light.y as f32], SHADING_GAIN);
        unit(&bent).zip_map(lightness, |form, light| ((1.0 - NEAR_IS_LIGHT) * form + NEAR_IS_LIGHT * light).max(1e-4))
    }

    /// Tone of the relief under a distant lamp (Lambert): the cosine between the surface's normal and the light.
    pub(super) fn lit(&self, relief: &Relief) -> Raster<f32> {
        let height = self.pixels(self.parameters.relief) as f32;
        let (sin, cos) = self.parameters.light_height.to_radians().sine_and_cosine();
        let lamp = unit_at(-self.parameters.light_azimuth.to_radians()) * cos;
        let (lx, ly, lz) = (lamp.x as f32, lamp.y as f32, sin as f32);
        let near = &relief.nearness;
        Raster::from_fn(near.width(), near.height(), |x, y| {
            let (x, y) = (x as isize, y as isize);
            let slope_x = 0.5 * height * (near.clamped(x + 1, y) - near.clamped(x - 1, y));
            let slope_y = 0.5 * height * (near.clamped(x, y + 1) - near.clamped(x, y - 1));
            ((lz - slope_x * lx - slope_y * ly) / (1.0 + slope_x * slope_x + slope_y * slope_y).sqrt()).clamp(0.0, 1.0)
        })
    }
}

/// If a single region fills the picture, makes the picture's rim its border; other labels are unchanged.
fn framed(regions: &Raster<i32>) -> Raster<i32> {
    let first = regions.get(0, 0);
    if regions.pixels().iter().any(|&label| label != first) {
        return regions.clone();
    }
    let (right, bottom) = (regions.width() - 1, regions.height() - 1);
    let is_rim = |x: usize, y: usize| x == 0 || y == 0 || x == right || y == bottom;
    Raster::from_fn(regions.width(), regions.height(), |x, y| if is_rim(x, y) { 0 } else { first })
}

/// Scaled to 0 to 1; above 0 everywhere, since 0 is unknown.
fn unit(raster: &Raster<f32>) -> Raster<f32> {
    let (low, high) = raster.pixels().iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
    let scale = 1.0 / (high - low).max(1e-6);
    raster.map(|v| ((v - low) * scale).max(1e-4))
}
