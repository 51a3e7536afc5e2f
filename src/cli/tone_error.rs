//! The last of the stages: where the drawing is darker or lighter than the photograph asks.

use super::failure::Failure;
use super::task::Task;
use crate::drawing::Drawing;
use crate::source::Placement;
use crate::style::tone_error;
use image::{DynamicImage, Rgba, RgbaImage};

/// What the eye does not resolve, as a share of the picture's longer side and at least in millimetres: about three dots.
const REACH: f64 = 0.015;
const LEAST_REACH: f64 = 1.0;
/// The error that is shown in full colour.
const FULL: f32 = 0.3;
/// Too much ink, and too little.
const DARK: [u8; 3] = [214, 40, 40];
const LIGHT: [u8; 3] = [30, 90, 220];

/// Red where there is too much ink, blue where there is too little, transparent where it is right. `None` in colours: there the pens'
/// mixture is meant, not their ink.
pub(super) fn picture(task: &Task<'_>, drawing: &Drawing) -> Result<Option<DynamicImage>, Failure> {
    if task.palette.is_some() {
        return Ok(None);
    }
    let layout = &task.layout;
    let placement = Placement::new(layout.picture, task.resolution(&task.manner.settings, layout.picture));
    let portrait = task.portrait(&task.manner.known, placement)?;
    let upright = drawing.transformed(layout.turning.matrix(&layout.page).inverse());
    let reach = (REACH * layout.picture.width().max(layout.picture.height())).max(LEAST_REACH);
    let error = tone_error(&upright, &portrait, reach);
    let pixel = |x: u32, y: u32| {
        let error = error.get(x as usize, y as usize);
        let [r, g, b] = if error > 0.0 { DARK } else { LIGHT };
        Rgba([r, g, b, (255.0 * (error.abs() / FULL).min(1.0)).round() as u8])
    };
    Ok(Some(RgbaImage::from_fn(error.width() as u32, error.height() as u32, pixel).into()))
}
