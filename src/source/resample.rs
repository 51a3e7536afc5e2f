//! Photographs and masks at the working resolution, in bands, so that memory does not grow with the photograph.

use super::decode::Photograph;
use super::error::SourceError;
use super::placement::{Crop, Placement, inside};
use crate::geometry::Rect;
use crate::parallel::collected;
use crate::raster::Raster;
use fast_image_resize::images::{TypedImage, TypedImageRef};
use fast_image_resize::pixels::{F32, F32x4, InnerPixel};
use fast_image_resize::{FilterType, PixelTrait, ResizeAlg, ResizeOptions, Resizer};

/// Rows of the working raster resampled at once.
const BAND: usize = 64;
/// Most working pixels, whatever the style; a style takes 80 to 500 bytes for each, and reports its need beforehand.
const WORK_LIMIT: u64 = 60_000_000;

/// Linear light on white, and alpha, at the working resolution.
pub(super) fn resample(photograph: &Photograph, crop: Crop, placement: Placement) -> Result<Raster<[f32; 4]>, SourceError> {
    resample_by(photograph, inside(crop, photograph), (placement.columns, placement.rows), FilterType::Lanczos3)
}

/// Linear light on white, and alpha, of a crop inside the photograph, resampled to another size by a filter that reaches at most
/// three pixels.
pub(super) fn resample_by(
    photograph: &Photograph,
    crop: Crop,
    (columns, rows): (usize, usize),
    filter: FilterType,
) -> Result<Raster<[f32; 4]>, SourceError> {
    in_bands(photograph, crop, (columns, rows), |first, count, window, size| {
        let source = photograph.lineariser.rows(&photograph.pixels, first, count);
        let pixels: Vec<F32x4> = source.iter().map(|&p| F32x4::new(p)).collect();
        resize_band(&pixels, photograph.width(), window, size, filter).iter().map(|p| p.0).collect()
    })
}

/// As [`resample`], for a plain grey picture: one plane instead of four, in a quarter of the time.
pub(super) fn resample_grey(mask: &Photograph, crop: Crop, placement: Placement) -> Result<Raster<f32>, SourceError> {
    in_bands(mask, inside(crop, mask), (placement.columns, placement.rows), |first, count, window, size| {
        let source = mask.lineariser.grey_rows(&mask.pixels, first, count);
        let pixels: Vec<F32> = source.into_iter().map(F32::new).collect();
        resize_band(&pixels, mask.width(), window, size, FilterType::Lanczos3).iter().map(|p| p.0).collect()
    })
}

/// Resizes band after band: `resized` gets the photograph's rows that a band needs, first and count, the band's window in them, and
/// its own size.
fn in_bands<T: Copy + Send>(
    photograph: &Photograph,
    crop: Crop,
    (columns, rows): (usize, usize),
    resized: impl Fn(u32, u32, Rect, (usize, usize)) -> Vec<T> + Sync,
) -> Result<Raster<T>, SourceError> {
    let pixels = columns as u64 * rows as u64;
    if pixels > WORK_LIMIT {
        return Err(SourceError::WorkTooLarge { pixels, limit: WORK_LIMIT });
    }
    let scale = crop.height / rows as f64;
    // Lanczos 3 reaches three working pixels, and at least three of the photograph's.
    let reach = (3.0 * scale.max(1.0)).ceil() + 1.0;
    let bands: Vec<Vec<T>> = collected(rows.div_ceil(BAND), &|band| {
        let (first, last) = (band * BAND, ((band + 1) * BAND).min(rows));
        let (top, bottom) = (crop.y + first as f64 * scale, crop.y + last as f64 * scale);
        let first_source = (top - reach).floor().max(0.0) as u32;
        let end_source = ((bottom + reach).ceil() as u32).min(photograph.height());
        let window = Rect::new(crop.x, top - f64::from(first_source), crop.x + crop.width, bottom - f64::from(first_source));
        resized(first_source, end_source - first_source, window, (columns, last - first))
    });
    Ok(Raster::from_vec(columns, rows, bands.concat()))
}

fn resize_band<P: InnerPixel + PixelTrait>(
    source: &[P],
    width: u32,
    window: Rect,
    (columns, rows): (usize, usize),
    filter: FilterType,
) -> Vec<P> {
    let height = (source.len() / width as usize) as u32;
    let view = TypedImageRef::new(width, height, source).expect("the band fills its rows");
    let mut band = TypedImage::<P>::new(columns as u32, rows as u32);
    let options = ResizeOptions::new()
        .resize_alg(ResizeAlg::Convolution(filter))
        .crop(window.x0, window.y0, window.width(), window.height().min(f64::from(height) - window.y0))
        .use_alpha(false);
    Resizer::new().resize_typed(&view, &mut band, &options).expect("the window lies inside the band");
    band.pixels().to_vec()
}
