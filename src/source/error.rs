//! Errors of image files.

use thiserror::Error;

/// Why an image could not be used. The caller adds the file's name.
#[derive(Debug, Error)]
pub enum SourceError {
    /// The bytes could not be read.
    #[error("cannot be read: {0}")]
    Io(#[from] std::io::Error),
    /// The file is empty.
    #[error("is empty; give a JPEG, PNG, WebP, TIFF, BMP or GIF photograph")]
    Empty,
    /// The first bytes match no known image format.
    #[error("is not in a known image format (it begins with {0}); give a JPEG, PNG, WebP, TIFF, BMP or GIF photograph")]
    Unrecognised(String),
    /// The header is damaged or needs a feature that the decoder does not support.
    #[error("is a {format} image that cannot be decoded: {reason}")]
    Damaged {
        /// The format, detected by content.
        format: &'static str,
        /// The decoder's message.
        reason: String,
    },
    /// The file ends early.
    #[error("is a {format} image that ends too early: the file is truncated; copy it again from its source")]
    Truncated {
        /// The format, detected by content.
        format: &'static str,
    },
    /// Width or height is zero.
    #[error("is a {format} image of {width} x {height} px, which has no pixels")]
    NoPixels {
        /// The format, detected by content.
        format: &'static str,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// More pixels or bytes than allowed.
    #[error(
        "is a {format} image of {width} x {height} px, beyond the limit of {limit}; scale it down first (drypoint never needs more than about 6 pixels per dot)"
    )]
    TooLarge {
        /// The format, detected by content.
        format: &'static str,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// The limit, with its unit.
        limit: String,
    },
    /// The file has more bytes than allowed.
    #[error("is larger than the limit of {0} MB; scale it down or save it as JPEG")]
    TooManyBytes(u64),
    /// The colour profile cannot be used.
    #[error("has a colour profile that cannot be used ({0}); convert the picture to sRGB first")]
    Profile(String),
    /// A mask or depth map has other proportions than the photograph.
    #[error(
        "is {width} x {height} px, but the photograph is {expected_width} x {expected_height} px; a mask needs the photograph's proportions (after its EXIF turn), at any size"
    )]
    OtherSize {
        /// Columns of the mask.
        width: u32,
        /// Rows of the mask.
        height: u32,
        /// Columns of the photograph.
        expected_width: u32,
        /// Rows of the photograph.
        expected_height: u32,
    },
    /// Scribbles with no colour, or with too many to be regions.
    #[error(
        "has {colours} colours that could mark regions; mark 1 to {most} regions, one flat colour each, on black or transparent, without soft brushes or JPEG"
    )]
    Scribbles {
        /// Number of colours that cover enough of the picture.
        colours: usize,
        /// Most colours allowed.
        most: usize,
    },
    /// The crop has no pixel, or lies outside the picture.
    #[error("has no pixel inside the crop {x},{y},{w},{h}: the picture is {width} x {height} px")]
    EmptyCrop {
        /// Left border of the crop in pixels.
        x: f64,
        /// Upper border.
        y: f64,
        /// Width.
        w: f64,
        /// Height.
        h: f64,
        /// Columns of the picture.
        width: u32,
        /// Rows of the picture.
        height: u32,
    },
    /// The working raster would be too large.
    #[error("would need {pixels} working pixels on this page at this pitch, beyond the limit of {limit}")]
    WorkTooLarge {
        /// Pixels needed.
        pixels: u64,
        /// Pixels allowed.
        limit: u64,
    },
}
