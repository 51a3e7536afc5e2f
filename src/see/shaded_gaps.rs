//! The gap between hair and neck: dark as its shade is, the network and the colours take it for the ground, and paper shines through
//! beside the jaw.

use super::head::Head;
use super::view::{View, on_view};
use crate::raster::Raster;
use crate::source::{lab, srgb_to_linear};
use std::ops::Range;

/// The widest gap, in widths of the face: beside a wider one the ground is seen.
const WIDEST: f64 = 0.22;
/// L* up to which a gap is shade in full, and from which it is ground.
const SHADE: [f32; 2] = [14.0, 22.0];
/// From this share of a person on a pixel is none of the gap.
const WHOLE: u8 = 230;

/// The people with the shaded gaps beside their necks, 0 to 255.
pub(super) fn with_shaded_gaps(mut person: Raster<u8>, view: &View, heads: &[Head]) -> Raster<u8> {
    let size = (person.width(), person.height());
    for head in heads {
        let widest = WIDEST * head.width / view.step().x;
        for y in 0..size.1 {
            let is_at_neck = |x: usize| head.is_at_neck(on_view(view.part, size, (x, y)));
            for gap in gaps(&person, y).into_iter().filter(|gap| gap.len() as f64 <= widest) {
                if is_at_neck(gap.start) && is_at_neck(gap.end - 1) {
                    shade(&mut person, view, y, gap);
                }
            }
        }
    }
    person
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

/// Gives the dark of a gap to the person.
fn shade(person: &mut Raster<u8>, view: &View, y: usize, gap: Range<usize>) {
    for x in gap {
        let light = lab(view.pixels.get(x, y).map(|v| srgb_to_linear(f32::from(v) / 255.0)))[0];
        let share = ((SHADE[1] - light) / (SHADE[1] - SHADE[0])).clamp(0.0, 1.0);
        person.set(x, y, person.get(x, y).max((255.0 * share).round() as u8));
    }
}

#[cfg(test)]
mod tests {
    use super::super::head::tests::face;
    use super::*;
    use crate::geometry::Rect;

    /// A neck, and hair beside it with a gap of a width between them, of a grey.
    fn in_the_gap(width: usize, grey: u8) -> u8 {
        let heads = [Head::new(&face(150.0, 110.0, 0.0))];
        let gap = 190..190 + width;
        let is_gap = |x: usize, y: usize| gap.contains(&x) && y > 120;
        let person = Raster::from_fn(300, 250, |x, y| if is_gap(x, y) || x > 260 { 0 } else { 255 });
        let pixels = Raster::from_fn(300, 250, |x, y| if is_gap(x, y) { [grey; 3] } else { [150; 3] });
        let view = View::new(pixels, Rect::new(0.0, 0.0, 300.0, 250.0));
        with_shaded_gaps(person, &view, &heads).get(192, 150)
    }

    #[test]
    fn a_narrow_dark_gap_is_the_persons_and_a_wide_or_a_light_one_is_not() {
        assert_eq!(in_the_gap(10, 20), 255);
        assert_eq!(in_the_gap(10, 120), 0);
        assert_eq!(in_the_gap(60, 20), 0);
    }
}
