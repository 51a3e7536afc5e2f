//! Decoding with limits that are checked before anything is allocated.

use super::cmyk;
use super::error::SourceError;
use super::jpeg;
use super::linear::Lineariser;
use super::png;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader};
use sha2::{Digest, Sha256};
use std::io::{Cursor, Read};

/// Limits on the size of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Most pixels.
    pub pixels: u64,
    /// Most bytes, of the file and of its decoded pixels.
    pub bytes: u64,
}

impl Default for Limits {
    /// 200 megapixels and 2 GB.
    fn default() -> Self {
        Self { pixels: 200_000_000, bytes: 2_000_000_000 }
    }
}

/// What is known about a picture's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceInfo {
    /// The format, detected by content, such as `JPEG`.
    pub format: &'static str,
    /// SHA-256 of the file's bytes, in hexadecimal.
    pub sha256: String,
    /// Things a user should know, such as a colour profile that could not be used.
    pub warnings: Vec<String>,
}

/// A decoded picture, upright, in its own encoding.
#[derive(Debug)]
pub struct Photograph {
    pub(super) pixels: DynamicImage,
    pub(super) lineariser: Lineariser,
    /// What is known about its file.
    pub info: SourceInfo,
}

impl Photograph {
    /// Reads and decodes a picture: format by content, EXIF orientation applied.
    pub fn read(mut reader: impl Read, limits: Limits) -> Result<Self, SourceError> {
        let mut bytes = Vec::new();
        reader.by_ref().take(limits.bytes + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > limits.bytes {
            return Err(SourceError::TooManyBytes(limits.bytes / 1_000_000));
        }
        Self::decode(&bytes, limits)
    }

    /// Decodes a picture that is already in memory.
    ///
    /// ```
    /// # let mut png = std::io::Cursor::new(Vec::new());
    /// # image::DynamicImage::new_luma8(40, 30).write_to(&mut png, image::ImageFormat::Png).unwrap();
    /// # let bytes = png.into_inner();
    /// use drypoint::source::{Limits, Photograph};
    ///
    /// let photograph = Photograph::decode(&bytes, Limits::default())?;
    /// assert_eq!((photograph.width(), photograph.height()), (40, 30));
    /// # Ok::<(), drypoint::source::SourceError>(())
    /// ```
    pub fn decode(bytes: &[u8], limits: Limits) -> Result<Self, SourceError> {
        if bytes.is_empty() {
            return Err(SourceError::Empty);
        }
        let kind = image::guess_format(bytes).map_err(|_| SourceError::Unrecognised(first_bytes(bytes)))?;
        let format = format_name(kind).ok_or_else(|| SourceError::Unrecognised(first_bytes(bytes)))?;
        if kind == ImageFormat::Jpeg && !jpeg::is_whole(bytes) {
            return Err(SourceError::Truncated { format });
        }
        if let Some(length) = png::uneven_palette(bytes).filter(|_| kind == ImageFormat::Png) {
            let reason = format!("its palette has {length} bytes, not a multiple of 3");
            return Err(SourceError::Damaged { format, reason });
        }
        let mut decoder =
            ImageReader::with_format(Cursor::new(bytes), kind).into_decoder().map_err(|error| describe(format, &error))?;
        check_limits(format, &decoder, limits)?;
        let orientation = decoder.orientation().unwrap_or(image::metadata::Orientation::NoTransforms);
        let profile = decoder.icc_profile().unwrap_or(None);
        let is_cmyk = kind == ImageFormat::Jpeg && jpeg::is_cmyk(bytes);
        let mut pixels = match &profile {
            Some(profile) if is_cmyk => DynamicImage::ImageRgb8(cmyk::decode(bytes, profile)?),
            _ => DynamicImage::from_decoder(decoder).map_err(|error| describe(format, &error))?,
        };
        pixels.apply_orientation(orientation);
        let (lineariser, warnings) = match profile {
            Some(profile) if !is_cmyk => (Lineariser::from_profile(&profile, &pixels)?, Vec::new()),
            None if is_cmyk => (
                Lineariser::srgb(),
                vec!["it is CMYK without a profile, so ideal inks are assumed; convert it to RGB for exact tone".to_owned()],
            ),
            _ => (Lineariser::srgb(), Vec::new()),
        };
        let info = SourceInfo { format, sha256: sha256(bytes), warnings };
        Ok(Self { pixels, lineariser, info })
    }

    /// Columns, after EXIF orientation.
    pub fn width(&self) -> u32 {
        self.pixels.width()
    }

    /// Rows, after EXIF orientation.
    pub fn height(&self) -> u32 {
        self.pixels.height()
    }

    /// Bytes of memory that its pixels take.
    pub fn bytes(&self) -> usize {
        self.pixels.as_bytes().len()
    }

    /// Whether the picture has an alpha channel.
    pub fn has_alpha(&self) -> bool {
        self.pixels.color().has_alpha()
    }
}

fn check_limits(format: &'static str, decoder: &impl ImageDecoder, limits: Limits) -> Result<(), SourceError> {
    let (width, height) = decoder.dimensions();
    let too_large = |limit: String| SourceError::TooLarge { format, width, height, limit };
    if width == 0 || height == 0 {
        Err(SourceError::NoPixels { format, width, height })
    } else if u64::from(width) * u64::from(height) > limits.pixels {
        Err(too_large(format!("{} megapixels", limits.pixels / 1_000_000)))
    } else if decoder.total_bytes() > limits.bytes {
        Err(too_large(format!("{} MB of pixels", limits.bytes / 1_000_000)))
    } else {
        Ok(())
    }
}

const fn format_name(format: ImageFormat) -> Option<&'static str> {
    Some(match format {
        ImageFormat::Jpeg => "JPEG",
        ImageFormat::Png => "PNG",
        ImageFormat::WebP => "WebP",
        ImageFormat::Tiff => "TIFF",
        ImageFormat::Bmp => "BMP",
        ImageFormat::Gif => "GIF",
        ImageFormat::Pnm => "PNM",
        ImageFormat::Qoi => "QOI",
        ImageFormat::Hdr => "Radiance HDR",
        _ => return None,
    })
}

/// Longest reason that is told, in characters: a TIFF of thousands of channels has each of them named.
const LONGEST_REASON: usize = 240;

fn describe(format: &'static str, error: &ImageError) -> SourceError {
    // Keep the message on one line.
    let whole = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    let reason = match whole.char_indices().nth(LONGEST_REASON) {
        Some((end, _)) => format!("{}...", &whole[..end]),
        None => whole,
    };
    let is_early_end = matches!(error, ImageError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof)
        || ["unexpected end", "UnexpectedEof", "failed to fill whole buffer", "unexpected EOF"]
            .iter()
            .any(|words| reason.contains(words));
    if is_early_end { SourceError::Truncated { format } } else { SourceError::Damaged { format, reason } }
}

fn first_bytes(bytes: &[u8]) -> String {
    let shown: Vec<String> = bytes.iter().take(8).map(|b| format!("{b:02x}")).collect();
    shown.join(" ")
}

/// SHA-256 of bytes, in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |text, b| text + &format!("{b:02x}"))
}
