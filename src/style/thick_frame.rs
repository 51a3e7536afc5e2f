//! Thick dark frames of spectacles, as a mask: a line along each rim would be a wire.

use super::spectacles::frame_lines;
use crate::raster::{Raster, components, dilate, fast_gaussian, filled_polygon, median, remove_components};
use crate::source::{Landmarks, outlines};

/// Darker than this a frame may be solid: lighter ones are horn or clear, and have form.
const DARK: f32 = 0.30;
/// Where between the frame and what is around it the frame ends, in lightness.
const BORDER: f32 = 0.32;
/// How far a frame reaches from its line, and how far beyond that what is around it is measured, in distances of the eyes.
const REACH: f64 = 0.11;
const AROUND: f64 = 0.06;
/// Mean width in distances of the eyes from which a frame is thick: black wire seen in a photograph has 0.03, horn rims 0.07 (portraits of
/// five with spectacles).
const THICK: f64 = 0.05;
/// Room around the lids, in distances of the eyes: lashes are no frame.
const LIDS: f64 = 0.05;

/// 1 in a face's thick frame; none if it has none.
pub(super) fn thick_frame(face: &Landmarks, lightness: &Raster<f32>) -> Option<Raster<u8>> {
    let frame = face.spectacles.as_ref()?;
    let (columns, rows) = (lightness.width(), lightness.height());
    let apart = face.eye_distance();
    let pixels = |share: f64| (share * apart).round().max(1.0) as usize;
    let line = frame_lines(frame, columns, rows);
    let values = |mask: &Raster<u8>| -> Vec<f32> {
        mask.pixels().iter().zip(lightness.pixels()).filter(|(is_in, _)| **is_in == 1).map(|(_, v)| *v).collect()
    };
    let dark = median(values(&line)).filter(|dark| *dark < DARK)?;
    let near = dilate(&line, pixels(REACH));
    let around = dilate(&near, pixels(AROUND)).zip_map(&near, |wide, near| wide * (1 - near));
    let border = dark + BORDER * (median(values(&around))? - dark).max(0.0);
    let lids = [&outlines::LEFT_EYE, &outlines::RIGHT_EYE].map(|lids| polygon(face, lids, columns, rows));
    let lids = dilate(&lids[0].zip_map(&lids[1], u8::max), pixels(LIDS));
    let smooth = fast_gaussian(lightness, (0.008 * apart).max(0.5) as f32);
    let is_dark = smooth.zip_map(&near.zip_map(&lids, |near, lids| near * (1 - lids)), |v, near| near * u8::from(v < border));
    let grown = joined_to(&is_dark, &line);
    let area = grown.pixels().iter().filter(|v| **v == 1).count() as f64;
    let length = line.pixels().iter().filter(|v| **v == 1).count() as f64;
    (area > THICK * apart * length).then_some(grown)
}

fn polygon(face: &Landmarks, of: &[usize], columns: usize, rows: usize) -> Raster<u8> {
    filled_polygon(columns, rows, &face.line(of).iter().map(|p| [p.x, p.y]).collect::<Vec<_>>())
}

/// The connected parts of a mask that a line runs through.
fn joined_to(mask: &Raster<u8>, line: &Raster<u8>) -> Raster<u8> {
    let (labels, count) = components(mask);
    let mut is_met = vec![false; count + 1];
    for (label, line) in labels.pixels().iter().zip(line.pixels()) {
        is_met[*label as usize] |= *line == 1;
    }
    remove_components(mask, &labels, |label| is_met[label as usize])
}
