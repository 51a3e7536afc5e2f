//! The gap between hair and neck: dark as its shade is, the network and the colours take it for the ground, and paper shines through
//! beside the jaw.

use super::head::Head;
use super::view::{View, on_view};
use crate::raster::{Raster, components, dilate};
use crate::source::{byte_to_linear, lab};
use std::ops::Range;

/// The widest gap, in widths of the face: beside a wider one the ground is seen.
const WIDEST: f64 = 0.22;
/// L* up to which a gap is shade in full, and from which it is ground.
const SHADE: [f32; 2] = [14.0, 22.0];
/// From this share of a person on a pixel is none of the gap.
const WHOLE: u8 = 230;

/// The least area of a gap, in areas of a square on the face's width: smaller ones do not show, and every changed pixel places the dots of
/// a whole drawing anew. Of the sixteen portraits the two gaps that show have 0.015 and 0.0028 (13, 12), the others at most 0.0008.
const LEAST: f64 = 0.002;

/// The people with the shaded gaps beside their necks, 0 to 255.
pub(super) fn with_shaded_gaps(person: Raster<u8>, view: &View, heads: &[Head]) -> Raster<u8> {
    heads.iter().fold(person, |person, head| with_gaps_at(head, &person, view))
}

/// The people with the shaded gaps beside one neck.
fn with_gaps_at(head: &Head, person: &Raster<u8>, view: &View) -> Raster<u8> {
    let size = (person.width(), person.height());
    let widest = WIDEST * head.width / view.step().x;
    let mut shaded = Raster::filled(size.0, size.1, 0);
    for y in 0..size.1 {
        let is_at_neck = |x: usize| head.is_at_neck(on_view(view.part, size, (x, y)));
        for gap in gaps(person, y).into_iter().filter(|gap| gap.len() as f64 <= widest) {
            if is_at_neck(gap.start) && is_at_neck(gap.end - 1) {
                gap.for_each(|x| shaded.set(x, y, shade(view.pixels.get(x, y))));
            }
        }
    }
    let least = LEAST * head.width * head.width / (view.step().x * view.step().y);
    person.zip_map(&without_small_pieces(&shaded, least), Ord::max)
}

/// What remains when pieces of fewer pixels are taken away.
fn without_small_pieces(shaded: &Raster<u8>, least: f64) -> Raster<u8> {
    let (labels, count) = components(&shaded.map(|v| u8::from(v > 127)));
    let mut areas = vec![0_usize; count + 1];
    labels.pixels().iter().for_each(|label| areas[*label as usize] += 1);
    let kept = labels.map(|label| u8::from(label != 0 && areas[label as usize] as f64 >= least));
    shaded.zip_map(&dilate(&kept, 1), |v, kept| v * kept)
}

/// The runs of a row that are no person between people.
fn gaps(person: &Raster<u8>, y: usize) -> Vec<Range<usize>> {
    let mut gaps = Vec::new();
    let mut start = None;
    for (x, v) in person.row(y).iter().enumerate() {
        match (start, *v < WHOLE) {
            (None, true) => start = Some(x),
            (Some(from), false) => {
                gaps.push(from..x);
                start = None;
            }
            _ => {}
        }
    }
    // A run from the picture's edge has people on one side alone.
    gaps.retain(|gap| gap.start > 0);
    gaps
}

/// Share of a person that a pixel of a gap has by its shade, 0 to 255.
fn shade(pixel: [u8; 3]) -> u8 {
    let light = lab(pixel.map(byte_to_linear))[0];
    (255.0 * ((SHADE[1] - light) / (SHADE[1] - SHADE[0])).clamp(0.0, 1.0)).round() as u8
}

#[cfg(test)]
mod tests {
    use super::super::head::tests::face;
    use super::*;
    use crate::geometry::Rect;

    /// A neck, and hair beside it with a gap of a width between them, of a grey.
    fn in_the_gap(width: usize, height: usize, grey: u8) -> u8 {
        let heads = [Head::new(&face(150.0, 110.0, 0.0))];
        let (across, down) = (190..190 + width, 145..145 + height);
        let is_gap = |x: usize, y: usize| across.contains(&x) && down.contains(&y);
        let person = Raster::from_fn(300, 250, |x, y| if is_gap(x, y) || x > 260 { 0 } else { 255 });
        let pixels = Raster::from_fn(300, 250, |x, y| if is_gap(x, y) { [grey; 3] } else { [150; 3] });
        let view = View::new(pixels, Rect::new(0.0, 0.0, 300.0, 250.0));
        with_shaded_gaps(person, &view, &heads).get(192, 147)
    }

    #[test]
    fn a_narrow_dark_gap_is_the_persons_and_a_wide_a_light_or_a_short_one_is_not() {
        assert_eq!(in_the_gap(10, 60, 20), 255);
        assert_eq!(in_the_gap(10, 60, 120), 0);
        assert_eq!(in_the_gap(60, 60, 20), 0);
        assert_eq!(in_the_gap(4, 4, 20), 0);
    }
}
