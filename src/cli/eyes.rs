//! Checks that a drawing is fine enough for the eyes in it.

use super::arguments::CropPart;
use super::layout::Layout;
use crate::source::Landmarks;

/// Landmark indices of the corners of the right and of the left eye.
const CORNERS: [(usize, usize); 2] = [(33, 133), (362, 263)];
/// Minimum number of pitches across an eye. At 4 nobody is recognised; at 6 lids and pupil are distinct (judged on hedcuts of sixteen
/// portraits, 90 mm to 20 mm wide).
const LEAST_PITCHES: f64 = 5.0;

/// A notice if the eyes of the largest face are too small for the pitch, with the options that help.
pub(super) fn eyes_notice(faces: &[Landmarks], layout: &Layout, pitch: f64, crop: Option<CropPart>) -> Option<String> {
    let face = faces.first()?;
    let scale = layout.picture.width() / layout.crop.width;
    let eye = |(a, b): (usize, usize)| (face.point(b) - face.point(a)).hypot() * scale;
    let width = CORNERS.map(eye).into_iter().fold(0.0, f64::max);
    let enough = (100.0 * width / LEAST_PITCHES).floor() / 100.0;
    if width <= 0.0 || width >= LEAST_PITCHES * pitch || enough <= 0.0 {
        return None;
    }
    let closer = if crop.is_none() { " or --crop head" } else { "" };
    Some(format!(
        "the eyes are {width:.1} mm wide, too small for a pitch of {pitch} mm: --pitch {enough}mm{closer} or a larger --size shows them"
    ))
}
