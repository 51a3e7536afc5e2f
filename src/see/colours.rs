//! Colours of the subject and of the background, each where it occurs.
//!
//! Pixels that are certainly one or the other are counted in a lattice over position and colour, which is then blurred. The
//! evidence for a pixel is the ratio of both counts at its position and colour. A red beside black hair is flag if there is red
//! flag nearby and no red on the person nearby; the same red in a jacket is not.

use crate::elementary::Elementary as _;
use crate::parallel::collected;
use crate::raster::Raster;
use crate::source::{lab, srgb_to_linear};

/// Nodes along the longer side of the picture, along L*, and along a* and b*; and the step of the last three in units of Lab.
const PLACES: usize = 5;
const LIGHTNESSES: usize = 13;
const HUES: usize = 16;
const STEP: f32 = 8.0;
const SIZE: [usize; 5] = [PLACES, PLACES, LIGHTNESSES, HUES, HUES];
/// Number of 1 2 1 blurs of each axis: two along positions.
const BLURS: [usize; 5] = [2, 2, 1, 1, 1];
/// Pixels added to both counts, so that rare colours give little evidence.
const UNKNOWN: f32 = 0.5;

/// A pixel's position in the lattice, in nodes.
type Place = [f32; 5];

/// The position of each pixel of the picture in the lattice.
pub(super) struct Colours(Raster<Place>);

impl Colours {
    /// From a picture in byte values as floats.
    pub(super) fn new(picture: &Raster<[f32; 3]>) -> Self {
        let scale = PLACES as f32 / picture.width().max(picture.height()) as f32;
        Self(Raster::from_fn(picture.width(), picture.height(), |x, y| {
            let [l, a, b] = lab(picture.get(x, y).map(|v| srgb_to_linear(v / 255.0)));
            let half = 0.5 * HUES as f32;
            let place = [(x as f32 + 0.5) * scale, (y as f32 + 0.5) * scale, l / STEP, a / STEP + half, b / STEP + half];
            let mut axes = place.into_iter().zip(SIZE);
            std::array::from_fn(|_| axes.next().map_or(0.0, |(v, size)| v.clamp(0.0, size as f32 - 0.01)))
        }))
    }

    /// The logarithm of how much more often pixels marked in `subject` have such a colour nearby than those marked in `ground`.
    pub(super) fn log_ratio(&self, subject: &Raster<u8>, ground: &Raster<u8>) -> Raster<f32> {
        let mut lattice = vec![[0.0_f32; 2]; SIZE.iter().product()];
        for ((place, &subject), &ground) in self.0.pixels().iter().zip(subject.pixels()).zip(ground.pixels()) {
            let node = &mut lattice[index(place.map(|v| v as usize))];
            node[0] += f32::from(subject);
            node[1] += f32::from(ground);
        }
        for (axis, times) in BLURS.into_iter().enumerate() {
            (0..times).for_each(|_| lattice = blurred(&lattice, axis));
        }
        self.0.map(|place| {
            let [subject, ground] = at(&lattice, place);
            ((subject + UNKNOWN) / (ground + UNKNOWN)).logarithm()
        })
    }
}

/// The node's index; the last axis varies fastest.
fn index(node: [usize; 5]) -> usize {
    node.into_iter().zip(SIZE).fold(0, |number, (i, size)| number * size + i)
}

/// Blur by 1 2 1 along an axis, with zeros beyond its ends.
fn blurred(lattice: &[[f32; 2]], axis: usize) -> Vec<[f32; 2]> {
    let step: usize = SIZE[axis + 1..].iter().product();
    let along = |i: usize| i / step % SIZE[axis];
    let value = |i: usize| {
        let before = if along(i) > 0 { lattice[i - step] } else { [0.0; 2] };
        let after = if along(i) + 1 < SIZE[axis] { lattice[i + step] } else { [0.0; 2] };
        let smooth = |k: usize| 0.25 * (before[k] + after[k]) + 0.5 * lattice[i][k];
        [smooth(0), smooth(1)]
    };
    collected(lattice.len(), &value)
}

/// Linear interpolation along each axis between the nodes around a position; node centres are at halves.
fn at(lattice: &[[f32; 2]], place: Place) -> [f32; 2] {
    let mut low = [0; 5];
    let mut high = [0; 5];
    let mut part = [0.0; 5];
    for (axis, v) in place.into_iter().enumerate() {
        let v = (v - 0.5).clamp(0.0, (SIZE[axis] - 1) as f32);
        (low[axis], part[axis]) = (v as usize, v.fract());
        high[axis] = (low[axis] + 1).min(SIZE[axis] - 1);
    }
    let mut sum = [0.0; 2];
    for corner in 0..1_usize << 5 {
        let (mut weight, mut node) = (1.0_f32, 0);
        for axis in 0..5 {
            let (share, nearest) = if corner >> axis & 1 == 1 { (part[axis], high[axis]) } else { (1.0 - part[axis], low[axis]) };
            weight *= share;
            node = node * SIZE[axis] + nearest;
        }
        let node = lattice[node];
        sum = [sum[0] + weight * node[0], sum[1] + weight * node[1]];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_belongs_to_what_has_it_nearby() {
        // A red coat at the lower right, a red flag at the upper left, blue elsewhere.
        let is_red = |x: usize, y: usize| (x >= 32) == (y >= 32);
        let picture = Raster::from_fn(64, 64, |x, y| if is_red(x, y) { [200.0, 20.0, 30.0] } else { [30.0, 60.0, 180.0] });
        let subject = Raster::from_fn(64, 64, |x, y| u8::from(x >= 32 && y >= 32 && (x + y) % 2 == 0));
        let ground = Raster::from_fn(64, 64, |x, y| u8::from(!(x >= 32 && y >= 32) && (x + y) % 2 == 0));
        let said = Colours::new(&picture).log_ratio(&subject, &ground);
        assert!(said.get(56, 56) > 1.0 && said.get(8, 8) < -1.0 && said.get(56, 8) < -1.0);
    }
}
