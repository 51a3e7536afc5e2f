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
mod png;
mod portrait;
mod scribbles;

pub use colour::{lab, lightness, linear_to_srgb, luminance, srgb_to_linear};
pub use decode::{Limits, Photograph, SourceInfo};
pub use depth::DepthSense;
pub use error::SourceError;
pub use landmarks::{Iris, LEAST_FACE_WIDTH, Landmarks, POINTS, outlines};
pub use portrait::{Crop, MaskRole, Placement, Portrait, ToneCurve, ToneTarget, fill_box};
pub use scribbles::Scribbles;
