//! The photograph as smaller sRGB bytes, the networks' input; and rasters of bytes as photographs, for computed masks.

use super::colour::linear_to_srgb;
use super::decode::{Photograph, SourceInfo};
use super::error::SourceError;
use super::linear::Lineariser;
use super::placement::Crop;
use super::resample::resample_by;
use crate::raster::Raster;
use fast_image_resize::images::{TypedImage, TypedImageRef};
use fast_image_resize::pixels::U8x3;
use fast_image_resize::{FilterType, ResizeAlg, ResizeOptions, Resizer};
use image::{DynamicImage, GenericImageView, GrayImage, ImageBuffer, Luma, Primitive, RgbImage};

impl Photograph {
    /// A part of the photograph as sRGB bytes on white, `columns` by `rows` pixels. Pixels of 8 bits without alpha are averaged
    /// as stored (not as light): it costs a tenth, and the networks' training pictures were reduced the same way.
    pub fn encoded(&self, crop: Crop, columns: usize, rows: usize) -> Result<Raster<[u8; 3]>, SourceError> {
        let crop = crop.within(self)?;
        let size = (columns, rows);
        let small = match &self.pixels {
            DynamicImage::ImageLuma8(grey) => {
                // As three equal channels: a second kind of pixel would be a second set of filters to build.
                let colour: Vec<u8> = grey.as_raw().iter().flat_map(|v| [*v; 3]).collect();
                let bytes = resized(&colour, self.width(), crop, size).map(|[v, ..]| v);
                GrayImage::from_raw(columns as u32, rows as u32, bytes.into_vec()).map(DynamicImage::ImageLuma8)
            }
            DynamicImage::ImageRgb8(colour) => {
                let pixels = resized(colour.as_raw(), self.width(), crop, size);
                if !self.lineariser.is_managed() {
                    return Ok(pixels);
                }
                RgbImage::from_raw(columns as u32, rows as u32, pixels.into_vec().concat()).map(DynamicImage::ImageRgb8)
            }
            _ => None,
        };
        let light = match small {
            Some(small) => Raster::from_vec(columns, rows, self.lineariser.rows(&small, 0, rows as u32)),
            None => resample_by(self, crop, size, FilterType::Bilinear)?,
        };
        let byte = |v: f32| (255.0 * linear_to_srgb(v.clamp(0.0, 1.0))).round() as u8;
        Ok(light.map(|[r, g, b, _]| [byte(r), byte(g), byte(b)]))
    }

    /// A copy whose longer side has `longest` pixels: grey and transparent pictures as stored, colours as sRGB bytes. None if it would
    /// not be smaller.
    #[cfg(feature = "cli")]
    pub(crate) fn small_copy(&self, longest: u32) -> Option<DynamicImage> {
        let [width, height] = [self.width(), self.height()];
        if width.max(height) <= longest {
            return None;
        }
        let scale = f64::from(longest) / f64::from(width.max(height));
        let [columns, rows] = [width, height].map(|side| ((f64::from(side) * scale).round() as u32).max(1));
        if self.lineariser.has_plain_grey(&self.pixels) || self.has_alpha() {
            return (!self.lineariser.is_managed()).then(|| self.pixels.thumbnail_exact(columns, rows));
        }
        let small = self.encoded(Crop::all(self), columns as usize, rows as usize).ok()?;
        RgbImage::from_raw(columns, rows, small.into_vec().concat()).map(DynamicImage::ImageRgb8)
    }

    /// True if any pixel is transparent: the alpha channel then marks the subject.
    pub fn is_cut_out(&self) -> bool {
        self.has_alpha() && self.pixels.pixels().any(|(.., pixel)| pixel.0[3] < 255)
    }

    /// Grey bytes as a picture, such as a computed mask.
    pub fn from_grey(grey: &Raster<u8>) -> Self {
        Self::of_pixels(DynamicImage::ImageLuma8(grey_image(grey)))
    }

    /// A grey picture of 16 bits, such as a depth map.
    pub fn from_deep_grey(grey: &Raster<u16>) -> Self {
        Self::of_pixels(DynamicImage::ImageLuma16(grey_image(grey)))
    }

    fn of_pixels(pixels: DynamicImage) -> Self {
        let info = SourceInfo { format: "raster", sha256: String::new(), warnings: Vec::new() };
        Self { pixels, lineariser: Lineariser::srgb(), info }
    }
}

/// A raster as an image of one channel.
pub(crate) fn grey_image<T>(grey: &Raster<T>) -> ImageBuffer<Luma<T>, Vec<T>>
where
    T: Primitive + Send + Sync,
    Luma<T>: image::Pixel<Subpixel = T>,
{
    ImageBuffer::from_fn(grey.width() as u32, grey.height() as u32, |x, y| Luma([grey.get(x as usize, y as usize)]))
}

/// Resizes a crop of stored pixels of three bytes, `width` per row; each output pixel is the mean of the input around it.
fn resized(bytes: &[u8], width: u32, crop: Crop, (columns, rows): (usize, usize)) -> Raster<[u8; 3]> {
    let height = (bytes.len() / (3 * width as usize)) as u32;
    let source = TypedImageRef::<U8x3>::from_buffer(width, height, bytes).expect("the bytes fill the picture");
    let mut small = TypedImage::<U8x3>::new(columns as u32, rows as u32);
    let options = ResizeOptions::new()
        .resize_alg(ResizeAlg::Convolution(FilterType::Bilinear))
        .crop(crop.x, crop.y, crop.width, crop.height)
        .use_alpha(false);
    Resizer::new().resize_typed(&source, &mut small, &options).expect("the crop lies inside the picture");
    Raster::from_vec(columns, rows, small.pixels().iter().map(|pixel| pixel.0).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_back_and_a_smaller_picture_has_their_mean() {
        let grey = Raster::from_fn(8, 8, |x, y| ((x * 31 + y * 17) % 256) as u8);
        let photograph = Photograph::from_grey(&grey);
        let same = photograph.encoded(Crop::all(&photograph), 8, 8).unwrap();
        assert!(same.pixels().iter().zip(grey.pixels()).all(|(rgb, g)| *rgb == [*g; 3]));
        let board = Photograph::from_grey(&Raster::from_fn(64, 64, |x, y| if (x + y) % 2 == 0 { 255 } else { 0 }));
        let [middle, ..] = board.encoded(Crop::all(&board), 4, 4).unwrap().get(2, 2);
        assert!((i32::from(middle) - 128).abs() <= 1, "the mean of 0 and 255 is 128, not {middle}");
        assert!(!board.is_cut_out());
    }
}
