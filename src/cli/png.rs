//! Pictures as PNG files.

use super::failure::Failure;
use super::output;
use image::codecs::png::PngEncoder;

/// Writes a picture as PNG.
pub(super) fn png(name: &str, picture: &image::DynamicImage) -> Result<(), Failure> {
    let mut bytes = Vec::new();
    // Not by the format's name: that would build the encoders of all formats.
    let encoder = PngEncoder::new(&mut bytes);
    picture.write_with_encoder(encoder).map_err(|error| Failure::Work(format!("{name}: {error}")))?;
    output::write(name, |out| out.write_all(&bytes))
}
