//! Black that cannot be told from the ground behind it, such as a head's shadow on the wall: where an outline cannot be seen, the
//! shape of heads decides, not the network.

use super::head::Head;
use super::view::on_view;
use crate::geometry::Rect;
use crate::raster::{Raster, components, dilate, median};
use crate::source::{lab, srgb_to_linear};

/// L* below which a photograph shows no detail.
const BLACK: f32 = 10.0;
/// Least difference of L* across a visible outline. On sixteen portraits the outlines of black hair have 11 and more, and that of a
/// shadow that was taken for hair has 0.5.
const VISIBLE: f32 = 6.0;
/// Least area of a piece, in squared widths of the face: smaller ones are shade between locks.
const LEAST: f64 = 0.012;
/// Pixels on either side of an outline that are compared.
const RIM: usize = 2;
const BESIDE: isize = 3;

/// The decision without black pieces beside the heads whose outline cannot be seen. `picture` holds byte values as floats and lies
/// over `part` of the photograph, as does `decided`, the share of a person in each pixel, 0 to 1.
pub(super) fn without_unseen_black(decided: &Raster<f32>, picture: &Raster<[f32; 3]>, part: Rect, heads: &[Head]) -> Raster<f32> {
    let (columns, rows) = (decided.width(), decided.height());
    let light = picture.map(|colour| lab(colour.map(|v| srgb_to_linear(v / 255.0)))[0]);
    let is_person = |x: usize, y: usize| decided.get(x, y) > 0.5;
    let is_candidate = |x: usize, y: usize| {
        let place = on_view(part, (columns, rows), (x, y));
        is_person(x, y) && light.get(x, y) < BLACK && heads.iter().all(|head| head.is_beside(place))
    };
    let (labels, count) = components(&Raster::from_fn(columns, rows, |x, y| u8::from(is_candidate(x, y))));
    let rim = dilate(&Raster::from_fn(columns, rows, |x, y| u8::from(!is_person(x, y))), RIM);
    let mut pieces = vec![Piece::default(); count + 1];
    for y in 0..rows {
        for x in 0..columns {
            let label = labels.get(x, y) as usize;
            if label != 0 {
                pieces[label].area += 1;
                let is_worn = y + 1 < rows && labels.get(x, y + 1) == 0 && is_person(x, y + 1) && light.get(x, y + 1) < BLACK;
                pieces[label].on_clothing += usize::from(is_worn);
                if rim.get(x, y) != 0 {
                    pieces[label].inner.push(light.get(x, y));
                }
            } else if !is_person(x, y)
                && let Some(label) = near(&labels, &rim, x, y)
            {
                pieces[label].outer.push(light.get(x, y));
            }
        }
    }
    let widest = heads.iter().map(|head| head.width).fold(0.0, f64::max) * columns as f64 / part.width();
    let is_unseen: Vec<bool> = pieces.into_iter().map(|piece| piece.into_unseen(LEAST * widest * widest)).collect();
    Raster::from_fn(columns, rows, |x, y| if is_unseen[labels.get(x, y) as usize] { 0.0 } else { decided.get(x, y) })
}

/// A black piece beside a head: its area in pixels, over how many of them it stands on black clothing, and L* on either side of its outline.
#[derive(Clone, Default)]
struct Piece {
    area: usize,
    on_clothing: usize,
    inner: Vec<f32>,
    outer: Vec<f32>,
}

impl Piece {
    fn into_unseen(self, least: f64) -> bool {
        // A raised collar stands on the jacket and meets the ground at its end alone; a shadow meets it along its side.
        let along_ground = self.inner.len() / RIM;
        if self.on_clothing > along_ground {
            return false;
        }
        let contrast = median(self.outer).zip(median(self.inner)).map(|(outer, inner)| outer - inner);
        self.area as f64 >= least && contrast.is_some_and(|contrast| contrast < VISIBLE)
    }
}

/// The piece whose rim is near a pixel outside.
fn near(labels: &Raster<u32>, rim: &Raster<u8>, x: usize, y: usize) -> Option<usize> {
    let (x, y) = (x as isize, y as isize);
    let around = (-BESIDE..=BESIDE).flat_map(|dy| (-BESIDE..=BESIDE).map(move |dx| (x + dx, y + dy)));
    around.filter(|&(x, y)| rim.clamped(x, y) != 0).map(|(x, y)| labels.clamped(x, y) as usize).find(|label| *label != 0)
}

#[cfg(test)]
mod tests {
    use super::super::head::tests::face;
    use super::*;
    use crate::elementary::Elementary as _;

    /// A head with black beside its left cheek, on a wall that is this grey there.
    fn beside_the_cheek(wall: f32) -> f32 {
        let part = Rect::new(0.0, 0.0, 600.0, 600.0);
        let head = Head::new(&face(300.0, 250.0, 0.0));
        let is_face = |x: f64, y: f64| ((x - 300.0) / 50.0).hypotenuse((y - 250.0) / 70.0) < 1.0;
        let is_black = |x: f64, y: f64| (205.0..250.0).contains(&x) && (200.0..300.0).contains(&y);
        let at = |i: usize| (i as f64 + 0.5) * 600.0 / 256.0;
        let picture = Raster::from_fn(256, 256, |x, y| {
            let (x, y) = (at(x), at(y));
            [if is_face(x, y) {
                150.0
            } else if is_black(x, y) {
                5.0
            } else {
                wall
            }; 3]
        });
        let decided = Raster::from_fn(256, 256, |x, y| f32::from(u8::from(is_face(at(x), at(y)) || is_black(at(x), at(y)))));
        let left = without_unseen_black(&decided, &picture, part, &[head]);
        assert_eq!(left.get(128, 107), 1.0, "the face stays");
        left.get(92, 107)
    }

    #[test]
    fn black_on_black_goes_and_black_on_grey_is_hair() {
        assert_eq!((beside_the_cheek(8.0), beside_the_cheek(90.0)), (0.0, 1.0));
    }

    #[test]
    fn a_black_collar_that_stands_on_black_clothing_stays() {
        let piece = |on_clothing: usize, along: usize| Piece {
            area: 500,
            on_clothing,
            inner: vec![4.0; along * RIM],
            outer: vec![5.0; along],
        };
        assert!(piece(0, 20).into_unseen(100.0), "a shadow on the wall");
        assert!(!piece(40, 10).into_unseen(100.0));
    }
}
