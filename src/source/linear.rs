//! From a picture's own encoding to linear sRGB light and alpha, in bands of rows, so that a large photograph is never held in
//! memory as floats.

use super::colour::srgb_to_linear;
use super::error::SourceError;
use crate::parallel::{collected, rows_with};
use image::{DynamicImage, Luma, LumaA, Pixel, Primitive, Rgb, Rgba};
use moxcms::{ColorProfile, DataColorSpace, Layout, TransformExecutor, TransformOptions};
use std::sync::Arc;

/// Converts one picture's samples to light.
pub(super) struct Lineariser {
    /// From the embedded profile to sRGB, both 16 bits; `None` if the picture is sRGB already.
    transform: Option<Arc<dyn TransformExecutor<u16> + Send + Sync>>,
    /// Light for each 16-bit sRGB value.
    table: Vec<f32>,
}

impl std::fmt::Debug for Lineariser {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Lineariser").field("profile", &self.transform.is_some()).finish_non_exhaustive()
    }
}

impl Lineariser {
    pub(super) fn srgb() -> Self {
        let table = collected(1 << 16, &|v| srgb_to_linear(v as f32 / 65535.0));
        Self { transform: None, table }
    }

    /// For the profile embedded in a picture.
    pub(super) fn from_profile(profile: &[u8], pixels: &DynamicImage) -> Result<Self, SourceError> {
        let reject = |error: moxcms::CmsError| SourceError::Profile(error.to_string());
        let source = ColorProfile::new_from_slice(profile).map_err(reject)?;
        let layout = match (source.color_space, pixels.color().has_color()) {
            (DataColorSpace::Rgb, _) => Layout::Rgb,
            (DataColorSpace::Gray, false) => Layout::Gray,
            (space, _) => return Err(SourceError::Profile(format!("a {space:?} profile in a picture of {:?}", pixels.color()))),
        };
        if layout == Layout::Rgb && is_srgb(&source) {
            return Ok(Self::srgb());
        }
        let transform = source
            .create_transform_16bit(layout, &ColorProfile::new_srgb(), Layout::Rgb, TransformOptions::default())
            .map_err(reject)?;
        Ok(Self { transform: Some(transform), ..Self::srgb() })
    }

    /// True if samples go through an embedded profile; false if they are sRGB already.
    pub(super) const fn is_managed(&self) -> bool {
        self.transform.is_some()
    }

    /// Rows `first..first + count` as linear red, green, blue on white paper, and alpha.
    pub(super) fn rows(&self, pixels: &DynamicImage, first: u32, count: u32) -> Vec<[f32; 4]> {
        match pixels {
            DynamicImage::ImageLuma8(i) => self.band(i.as_raw(), i.width(), first, count, |p: &Luma<u8>| from_luma(p.0[0], 255)),
            DynamicImage::ImageLumaA8(i) => {
                self.band(i.as_raw(), i.width(), first, count, |p: &LumaA<u8>| from_luma(p.0[0], p.0[1]))
            }
            DynamicImage::ImageRgb8(i) => self.band(i.as_raw(), i.width(), first, count, |p: &Rgb<u8>| from_rgb(p.0, 255)),
            DynamicImage::ImageRgba8(i) => {
                self.band(i.as_raw(), i.width(), first, count, |p: &Rgba<u8>| from_rgb([p.0[0], p.0[1], p.0[2]], p.0[3]))
            }
            DynamicImage::ImageLuma16(i) => {
                self.band(i.as_raw(), i.width(), first, count, |p: &Luma<u16>| [p.0[0], p.0[0], p.0[0], u16::MAX])
            }
            DynamicImage::ImageLumaA16(i) => {
                self.band(i.as_raw(), i.width(), first, count, |p: &LumaA<u16>| [p.0[0], p.0[0], p.0[0], p.0[1]])
            }
            DynamicImage::ImageRgb16(i) => {
                self.band(i.as_raw(), i.width(), first, count, |p: &Rgb<u16>| [p.0[0], p.0[1], p.0[2], u16::MAX])
            }
            DynamicImage::ImageRgba16(i) => self.band(i.as_raw(), i.width(), first, count, |p: &Rgba<u16>| p.0),
            DynamicImage::ImageRgb32F(i) => light_band(i.as_raw(), i.width(), first, count),
            other => light_band(other.to_rgb32f().as_raw(), other.width(), first, count),
        }
    }

    /// True for a grey picture without alpha whose samples are sRGB.
    pub(super) const fn has_plain_grey(&self, pixels: &DynamicImage) -> bool {
        self.transform.is_none() && matches!(pixels, DynamicImage::ImageLuma8(_) | DynamicImage::ImageLuma16(_))
    }

    /// Rows of a plain grey picture as linear light; others have none.
    pub(super) fn grey_rows(&self, pixels: &DynamicImage, first: u32, count: u32) -> Vec<f32> {
        let width = pixels.width() as usize;
        let range = first as usize * width..(first + count) as usize * width;
        match pixels {
            DynamicImage::ImageLuma8(grey) => grey.as_raw()[range].iter().map(|&v| self.table[usize::from(v) * 257]).collect(),
            DynamicImage::ImageLuma16(grey) => grey.as_raw()[range].iter().map(|&v| self.table[usize::from(v)]).collect(),
            _ => Vec::new(),
        }
    }

    fn band<P: Pixel>(
        &self,
        samples: &[P::Subpixel],
        width: u32,
        first: u32,
        count: u32,
        widen: impl Fn(&P) -> [u16; 4] + Sync,
    ) -> Vec<[f32; 4]>
    where
        P::Subpixel: Primitive + Send + Sync,
    {
        let channels = usize::from(P::CHANNEL_COUNT);
        let row = width as usize * channels;
        let band = &samples[first as usize * row..(first + count) as usize * row];
        let mut out = vec![[0.0; 4]; width as usize * count as usize];
        rows_with(
            &mut out,
            width as usize,
            &|| (vec![0_u16; 4 * width as usize], vec![0_u16; 3 * width as usize], vec![0_u16; 3 * width as usize]),
            &|(wide, encoded, managed), y, out| {
                let row = &band[y * row..(y + 1) * row];
                for (wide, pixel) in wide.chunks_exact_mut(4).zip(row.chunks_exact(channels)) {
                    wide.copy_from_slice(&widen(P::from_slice(pixel)));
                }
                let channels = self.to_srgb(wide, encoded, managed, P::CHANNEL_COUNT < 3);
                for ((out, srgb), wide) in out.iter_mut().zip(channels.chunks_exact(3)).zip(wide.chunks_exact(4)) {
                    let alpha = f32::from(wide[3]) / 65535.0;
                    let light = |v: u16| 1.0 - alpha + alpha * self.table[usize::from(v)];
                    *out = [light(srgb[0]), light(srgb[1]), light(srgb[2]), alpha];
                }
            },
        );
        out
    }

    /// One row of sRGB triples, through the profile if there is one.
    fn to_srgb<'a>(&self, wide: &[u16], encoded: &'a mut [u16], managed: &'a mut [u16], is_grey: bool) -> &'a [u16] {
        let Some(transform) = &self.transform else {
            encoded.chunks_exact_mut(3).zip(wide.chunks_exact(4)).for_each(|(rgb, wide)| rgb.copy_from_slice(&wide[..3]));
            return encoded;
        };
        let width = managed.len() / 3;
        let source = if is_grey {
            encoded.iter_mut().zip(wide.chunks_exact(4)).for_each(|(grey, wide)| *grey = wide[0]);
            &encoded[..width]
        } else {
            encoded.chunks_exact_mut(3).zip(wide.chunks_exact(4)).for_each(|(rgb, wide)| rgb.copy_from_slice(&wide[..3]));
            &encoded[..]
        };
        transform.transform(source, managed).expect("one row in, one row out");
        managed
    }
}

/// Whether a profile's primaries and curve are sRGB's, so that no conversion is needed.
fn is_srgb(profile: &ColorProfile) -> bool {
    let srgb = ColorProfile::new_srgb();
    let close =
        |a: moxcms::Xyzd, b: moxcms::Xyzd| (a.x - b.x).abs() < 2e-3 && (a.y - b.y).abs() < 2e-3 && (a.z - b.z).abs() < 2e-3;
    let has_primaries = close(profile.red_colorant, srgb.red_colorant)
        && close(profile.green_colorant, srgb.green_colorant)
        && close(profile.blue_colorant, srgb.blue_colorant);
    // The usual sRGB profiles hold the curve as a table of 1024 entries; its middle value distinguishes it from a pure gamma.
    let has_curve = match &profile.red_trc {
        Some(moxcms::ToneReprCurve::Lut(table)) if table.len() > 16 => {
            let middle = f32::from(table[table.len() / 2]) / 65535.0;
            (middle - srgb_to_linear((table.len() / 2) as f32 / (table.len() - 1) as f32)).abs() < 1e-3
        }
        Some(moxcms::ToneReprCurve::Parametric(p)) => {
            p.len() >= 5 && (p[0] - 2.4).abs() < 1e-2 && (p[1] - 1.0 / 1.055).abs() < 1e-2
        }
        _ => false,
    };
    has_primaries && has_curve
}

fn from_luma(v: u8, alpha: u8) -> [u16; 4] {
    let v = u16::from(v) * 257;
    [v, v, v, u16::from(alpha) * 257]
}

fn from_rgb([r, g, b]: [u8; 3], alpha: u8) -> [u16; 4] {
    [u16::from(r) * 257, u16::from(g) * 257, u16::from(b) * 257, u16::from(alpha) * 257]
}

/// Float pictures are linear light already.
fn light_band(samples: &[f32], width: u32, first: u32, count: u32) -> Vec<[f32; 4]> {
    let row = width as usize * 3;
    let sound = |v: f32| if v.is_finite() { v.clamp(0.0, 1.0) } else { 0.0 };
    samples[first as usize * row..(first + count) as usize * row]
        .chunks_exact(3)
        .map(|p| [sound(p[0]), sound(p[1]), sound(p[2]), 1.0])
        .collect()
}
