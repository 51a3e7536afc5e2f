//! Pictures as PNG files.

use super::failure::Failure;
use super::output;
use image::ImageFormat;
use std::io::Cursor;

/// Writes a picture as PNG.
pub(super) fn png(name: &str, picture: &image::DynamicImage) -> Result<(), Failure> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(|error| Failure::Work(format!("{name}: {error}")))?;
    output::write(name, |out| out.write_all(bytes.get_ref()))
}
