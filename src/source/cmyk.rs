//! CMYK JPEGs through their embedded profile. The decoder behind `image` converts ideal inks to RGB; a press's inks are not
//! ideal: its cyan is no screen's cyan.

use super::error::SourceError;
use image::RgbImage;
use moxcms::{ColorProfile, DataColorSpace, Layout, TransformOptions};
use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;

/// Decodes to 8-bit sRGB through the embedded profile.
pub(super) fn decode(bytes: &[u8], profile: &[u8]) -> Result<RgbImage, SourceError> {
    let damaged = |error: &dyn std::fmt::Display| SourceError::Damaged { format: "JPEG", reason: error.to_string() };
    let reject = |error: moxcms::CmsError| SourceError::Profile(error.to_string());
    let source = ColorProfile::new_from_slice(profile).map_err(reject)?;
    if source.color_space != DataColorSpace::Cmyk {
        return Err(SourceError::Profile(format!("a {:?} profile in a CMYK picture", source.color_space)));
    }
    let limit = usize::from(u16::MAX);
    let options = DecoderOptions::default().set_strict_mode(false).set_max_width(limit).set_max_height(limit);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|error| damaged(&error))?;
    let stored = decoder.input_colorspace().unwrap_or(ColorSpace::CMYK);
    decoder.set_options(options.jpeg_set_out_colorspace(stored));
    let mut inks = decoder.decode().map_err(|error| damaged(&error))?;
    let (width, height) = decoder.dimensions().ok_or_else(|| damaged(&"it has no size"))?;
    if stored == ColorSpace::YCCK {
        inks.chunks_exact_mut(4).for_each(ycc_to_rgb);
    }
    // Stored inverted, by Adobe's convention: 255 is no ink.
    for ink in &mut inks {
        *ink = 255 - *ink;
    }
    let transform = source
        .create_transform_8bit(Layout::Rgba, &ColorProfile::new_srgb(), Layout::Rgb, TransformOptions::default())
        .map_err(reject)?;
    let mut rgb = vec![0_u8; width * height * 3];
    transform.transform(&inks, &mut rgb).map_err(reject)?;
    RgbImage::from_raw(width as u32, height as u32, rgb).ok_or_else(|| damaged(&"its size is not that of its pixels"))
}

/// Converts the first three of four samples from luma and chroma to red, green, blue (JFIF's equations); the fourth, black,
/// stays.
fn ycc_to_rgb(pixel: &mut [u8]) {
    let (y, cb, cr) = (f32::from(pixel[0]), f32::from(pixel[1]) - 128.0, f32::from(pixel[2]) - 128.0);
    let byte = |v: f32| v.round().clamp(0.0, 255.0) as u8;
    pixel[0] = byte(y + 1.402 * cr);
    pixel[1] = byte(y - 0.344_136 * cb - 0.714_136 * cr);
    pixel[2] = byte(y + 1.772 * cb);
}
