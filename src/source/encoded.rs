//! The photograph as sRGB bytes, smaller: what networks look at. And rasters of bytes as photographs, for masks that were not painted.

use super::colour::linear_to_srgb;
use super::decode::{Photograph, SourceInfo};
use super::error::SourceError;
use super::linear::Lineariser;
use super::portrait::{Crop, resample_by};
use crate::raster::Raster;
use fast_image_resize::FilterType;
use image::{DynamicImage, GenericImageView, GrayImage};

impl Photograph {
    /// A part of it as sRGB bytes on white, `columns` by `rows` large, each pixel the mean of the light that falls on it.
    pub fn encoded(&self, crop: Crop, columns: usize, rows: usize) -> Result<Raster<[u8; 3]>, SourceError> {
        let light = resample_by(self, crop.within(self)?, (columns, rows), FilterType::Bilinear)?;
        let byte = |v: f32| (255.0 * linear_to_srgb(v.clamp(0.0, 1.0))).round() as u8;
        Ok(light.map(|[r, g, b, _]| [byte(r), byte(g), byte(b)]))
    }

    /// Whether something of it is transparent, so that it shows its subject already.
    pub fn is_cut_out(&self) -> bool {
        self.has_alpha() && self.pixels.pixels().any(|(.., pixel)| pixel.0[3] < 255)
    }

    /// Grey bytes as a picture, such as a mask that was found.
    ///
    /// # Panics
    /// Never: a raster's pixels fill it.
    pub fn from_grey(grey: &Raster<u8>) -> Self {
        let pixels = GrayImage::from_raw(grey.width() as u32, grey.height() as u32, grey.pixels().to_vec());
        let info = SourceInfo { format: "raster", sha256: String::new(), warnings: Vec::new() };
        Self {
            pixels: DynamicImage::ImageLuma8(pixels.expect("a raster's pixels fill it")),
            lineariser: Lineariser::srgb(),
            info,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_back_and_a_smaller_picture_has_the_mean_light() {
        let grey = Raster::from_fn(8, 8, |x, y| ((x * 31 + y * 17) % 256) as u8);
        let photograph = Photograph::from_grey(&grey);
        let same = photograph.encoded(Crop::all(&photograph), 8, 8).unwrap();
        assert!(same.pixels().iter().zip(grey.pixels()).all(|(rgb, g)| *rgb == [*g; 3]));
        let board = Photograph::from_grey(&Raster::from_fn(64, 64, |x, y| if (x + y) % 2 == 0 { 255 } else { 0 }));
        let [middle, ..] = board.encoded(Crop::all(&board), 4, 4).unwrap().get(2, 2);
        assert!((i32::from(middle) - 188).abs() <= 1, "half the light is 188 in sRGB, not {middle}");
        assert!(!board.is_cut_out());
    }
}
