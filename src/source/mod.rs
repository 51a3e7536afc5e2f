//! From bytes to a [`Portrait`]: decoding, orientation, colour management, alpha, resampling, tone.
//!
//! In: a reader over an image file of any supported format. Out: a [`Photograph`] (the file's pixels, upright), and from it a
//! [`Portrait`] at a style's working resolution, or sRGB bytes at any smaller size. Nothing here opens files or knows of styles.

mod cmyk;
mod colour;
mod decode;
mod depth;
mod encoded;
mod error;
mod jpeg;
mod landmarks;
mod linear;
mod lit_side;
mod mask_role;
mod placement;
mod png;
mod portrait;
mod prepared;
mod resample;
mod scribbles;
mod spectacles;

#[cfg(feature = "cli")]
pub(crate) use encoded::grey_image;

#[cfg(feature = "see")]
pub(crate) use colour::byte_to_linear;
#[doc(hidden)]
pub use colour::{lab, lightness, linear_to_srgb, luminance, srgb_to_linear};
#[cfg(feature = "cli")]
pub(crate) use decode::hexadecimal;
#[doc(hidden)]
pub use decode::sha256;
pub use decode::{Limits, Photograph, SourceInfo};
pub use depth::DepthSense;
pub use error::SourceError;
pub use landmarks::{Iris, Landmarks};
#[doc(hidden)]
pub use landmarks::{LEAST_FACE_WIDTH, POINTS, outlines};
pub use mask_role::MaskRole;
#[doc(hidden)]
pub use placement::fill_box;
pub use placement::{Crop, Placement};
#[doc(hidden)]
pub use portrait::mask_on;
pub use portrait::{Portrait, ToneCurve, ToneTarget};
pub(crate) use prepared::Prepared;
pub use scribbles::Scribbles;
pub use spectacles::Spectacles;
