//! The part of a photograph that is drawn: given in pixels or percent, or by the faces in it.

use super::arguments::{CropNumber, CropPart, PictureOptions};
use super::failure::Failure;
use crate::geometry::Rect;
use crate::source::{Crop, Landmarks, Photograph, fill_box, outlines};

/// Margin around a face for head and shoulders: `side` in face widths from the face's middle, `above` the forehead and `below` the
/// chin in face heights. High hair takes 0.57 above the forehead; the box has the proportions of a newspaper's half column.
const HEAD: Room = Room { side: 1.1, above: 0.68, below: 0.57 };
/// Margin for the face alone.
const FACE: Room = Room { side: 0.66, above: 0.22, below: 0.12 };

/// What `--fit cover` does not cut of a head, with its hair.
const WHOLE: Room = Room { side: 0.62, above: 0.5, below: 0.1 };
/// The tip of the nose: a face is in a crop if it is. And the pixels by which lengths may differ that are the same.
const NOSE: usize = 1;
const ROUNDING: f64 = 1e-6;

struct Room {
    side: f64,
    above: f64,
    below: f64,
}

impl Room {
    /// The box of a face with this margin around it.
    fn round(&self, face: &Landmarks) -> Rect {
        let oval = face.line(&outlines::OVAL);
        let upright = oval.iter().fold(Rect::from_points(oval[0], oval[0]), |all, p| all.union_pt(*p));
        let (middle, width) = (upright.center().x, face.width().max(upright.width()));
        Rect::new(
            middle - self.side * width,
            upright.y0 - self.above * upright.height(),
            middle + self.side * width,
            upright.y1 + self.below * upright.height(),
        )
    }
}

/// The part of a crop that fills a box of these proportions (`--fit cover`): its middle, moved as little as keeps the heads in the crop whole,
/// the largest ones where not all fit.
pub(super) fn covering(crop: Crop, (width, height): (f64, f64), faces: &[Landmarks]) -> Crop {
    let middle = fill_box(crop, width, height);
    let all = Rect::new(crop.x, crop.y, crop.x + crop.width, crop.y + crop.height);
    let fits = |heads: Rect| heads.width() <= middle.width + ROUNDING && heads.height() <= middle.height + ROUNDING;
    // Faces come in the order of their size.
    let known = faces.iter().filter(|face| all.contains(face.point(NOSE)));
    let heads = known.map(|face| WHOLE.round(face).intersect(all)).fold(None, |kept: Option<Rect>, head| match kept {
        Some(kept) if fits(kept.union(head)) => Some(kept.union(head)),
        Some(kept) => Some(kept),
        None => Some(head),
    });
    let Some(heads) = heads else { return middle };
    let moved = |at: f64, length: f64, [from, to]: [f64; 2], [first, last]: [f64; 2]| {
        // A head larger than the part keeps its middle.
        let kept = if to - from > length { 0.5 * (from + to - length) } else { at.max(to - length).min(from) };
        kept.min(last - length).max(first)
    };
    let x = moved(middle.x, middle.width, [heads.x0, heads.x1], [all.x0, all.x1]);
    let y = moved(middle.y, middle.height, [heads.y0, heads.y1], [all.y0, all.y1]);
    Crop { x, y, ..middle }
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
    let Some(all) = faces.iter().map(|face| room.round(face)).reduce(|a, b| a.union(b)) else {
        return Err(Failure::Work(format!(
            "{}: no face is known in it, which --crop {name} needs; give the part with --crop X,Y,W,H",
            options.photo
        )));
    };
    let part = Crop { x: all.x0.round(), y: all.y0.round(), width: all.width().round(), height: all.height().round() };
    part.within(photograph).map_err(|error| Failure::about(&options.photo)(&error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::source::Iris;

    /// A face 100 wide and 140 high about a point.
    fn face(x: f64, y: f64) -> Landmarks {
        let mut points = vec![[x, y, 0.0]; 468];
        for (i, (dx, dy)) in [(10, (0.0, -70.0)), (152, (0.0, 70.0)), (234, (-50.0, 0.0)), (454, (50.0, 0.0))] {
            points[i] = [x + dx, y + dy, 0.0];
        }
        Landmarks { points, irises: [Iris { centre: Point::new(x, y), radius: 4.0 }; 2], spectacles: None, pearls: Vec::new() }
    }

    #[test]
    fn a_box_that_is_filled_keeps_heads_whole_and_stays_in_the_crop() {
        let all = Crop { x: 0.0, y: 0.0, width: 1000.0, height: 2000.0 };
        let top = |faces: &[Landmarks]| covering(all, (100.0, 100.0), faces).y;
        assert_eq!(top(&[]), 500.0, "the middle");
        assert_eq!(top(&[face(500.0, 900.0)]), 500.0, "the head is in it");
        assert_eq!(top(&[face(500.0, 400.0)]), 260.0, "hair above a forehead at 330");
        assert_eq!(top(&[face(500.0, 60.0)]), 0.0, "not beyond the photograph");
        assert_eq!(top(&[face(500.0, 1900.0)]), 984.0, "room below a chin at 1970");
        assert_eq!(top(&[face(500.0, 300.0), face(500.0, 1700.0)]), 160.0, "too far apart: the first");
    }

    #[test]
    fn faces_outside_a_crop_do_not_count_and_crops_inside_a_head_do_no_harm() {
        let right = Crop { x: 600.0, y: 0.0, width: 400.0, height: 2000.0 };
        let part = |faces: &[Landmarks]| covering(right, (100.0, 200.0), faces);
        assert_eq!(part(&[face(100.0, 1900.0), face(800.0, 400.0)]), part(&[face(800.0, 400.0)]));
        for percent in 1..200 {
            let inside =
                Crop { x: 20.48 * f64::from(percent) / 3.0, y: 7.13, width: 10.8 + f64::from(percent) / 7.0, height: 90.3 };
            let part = covering(inside, (90.0, 110.0), &[face(inside.x + 3.0, 50.0)]);
            assert!(part.x >= inside.x && part.x + part.width <= inside.x + inside.width + 1e-6);
        }
    }
}
