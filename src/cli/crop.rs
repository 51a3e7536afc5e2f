//! The part of a photograph that is drawn: given in pixels or percent, or by the faces in it.

use super::arguments::{CropNumber, CropPart, PictureOptions};
use super::failure::Failure;
use crate::geometry::Rect;
use crate::source::{Crop, Landmarks, Photograph, outlines};

/// Margin around a face for head and shoulders: `side` in face widths from the face's middle, `above` the forehead and `below` the
/// chin in face heights. High hair takes 0.57 above the forehead; the box has the proportions of a newspaper's half column.
const HEAD: Room = Room { side: 1.1, above: 0.68, below: 0.57 };
/// Margin for the face alone.
const FACE: Room = Room { side: 0.66, above: 0.22, below: 0.12 };

struct Room {
    side: f64,
    above: f64,
    below: f64,
}

/// The part of the photograph that is drawn. It may exceed the photograph by 0.01 px, for percentages that do not quite add up.
/// The photograph may be a copy of one of another `size`, in whose pixels boxes are given.
pub(super) fn part(
    options: &PictureOptions,
    photograph: &Photograph,
    size: [u32; 2],
    faces: &[Landmarks],
) -> Result<Crop, Failure> {
    let crop = match options.crop {
        None => Crop::all(photograph),
        Some(CropPart::Box(numbers)) => requested_crop(numbers, photograph, size),
        Some(CropPart::Head) => return round_faces(&HEAD, "head", options, photograph, faces),
        Some(CropPart::Face) => return round_faces(&FACE, "face", options, photograph, faces),
    };
    let within = crop.within(photograph).map_err(|error| Failure::about(&options.photo)(&error))?;
    let ends = |crop: Crop| [crop.x, crop.y, crop.x + crop.width, crop.y + crop.height];
    if ends(crop).into_iter().zip(ends(within)).any(|(asked, there)| (asked - there).abs() > 0.01) {
        let [across, down] = [photograph.width(), photograph.height()].map(f64::from);
        let [across, down] = [f64::from(size[0]) / across, f64::from(size[1]) / down];
        let shown = |crop: Crop| {
            let numbers = [crop.x * across, crop.y * down, crop.width * across, crop.height * down];
            numbers.map(|px| format!("{}", (px * 100.0).round() / 100.0)).join(",")
        };
        return Err(Failure::Work(format!(
            "--crop {} reaches beyond {}, which is {} x {} px; the part inside it is --crop {}",
            shown(crop),
            if options.photo == "-" { "the photograph" } else { &options.photo },
            size[0],
            size[1],
            shown(within)
        )));
    }
    Ok(within)
}

fn requested_crop([x, y, w, h]: [CropNumber; 4], photograph: &Photograph, size: [u32; 2]) -> Crop {
    let whole = Crop::all(photograph);
    let pixels = |number: CropNumber, of: f64, itself: u32| match number {
        CropNumber::Pixels(pixels) => pixels * of / f64::from(itself),
        CropNumber::Percent(percent) => percent / 100.0 * of,
    };
    let (across, down) = (|number| pixels(number, whole.width, size[0]), |number| pixels(number, whole.height, size[1]));
    Crop { x: across(x), y: down(y), width: across(w), height: down(h) }
}

/// The box of all faces with a margin around each, clipped to the photograph.
fn round_faces(
    room: &Room,
    name: &str,
    options: &PictureOptions,
    photograph: &Photograph,
    faces: &[Landmarks],
) -> Result<Crop, Failure> {
    let boxes = faces.iter().map(|face| {
        let oval = face.line(&outlines::OVAL);
        let upright = oval.iter().fold(Rect::from_points(oval[0], oval[0]), |all, p| all.union_pt(*p));
        let (middle, width) = (upright.center().x, face.width().max(upright.width()));
        Rect::new(
            middle - room.side * width,
            upright.y0 - room.above * upright.height(),
            middle + room.side * width,
            upright.y1 + room.below * upright.height(),
        )
    });
    let Some(all) = boxes.reduce(|a, b| a.union(b)) else {
        return Err(Failure::Work(format!(
            "{}: no face is known in it, which --crop {name} needs; give the part with --crop X,Y,W,H",
            options.photo
        )));
    };
    let part = Crop { x: all.x0.round(), y: all.y0.round(), width: all.width().round(), height: all.height().round() };
    part.within(photograph).map_err(|error| Failure::about(&options.photo)(&error))
}
