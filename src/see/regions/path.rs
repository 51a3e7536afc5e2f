//! Colour distance of pixels from the bare skin of the face along a path: shade changes gradually, hair and hats begin at an
//! edge.

use crate::raster::Raster;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Cost of a step of one pixel in a flat area: almost nothing, but it makes the shortest path win.
const GROUND: f32 = 0.02;
/// A step with this colour difference costs 1, with twice the difference 4.
const UNIT: f32 = 3.0;
/// Fixed-point resolution of costs, so that the order of summation does not matter.
const PARTS: f32 = 4096.0;
/// Paths that cost more than this are not followed.
const FARTHEST: f32 = 40.0;

/// The least cost of a path to each pixel from any marked pixel through `open` pixels; infinite where there is none.
pub(super) fn path_from(colours: &Raster<[f32; 3]>, open: &Raster<bool>, from: &Raster<bool>) -> Raster<f32> {
    let (width, height) = (colours.width(), colours.height());
    let mut costs = Raster::filled(width, height, u32::MAX);
    let mut front = BinaryHeap::new();
    for (i, _) in from.pixels().iter().enumerate().filter(|(i, is)| **is && open.pixels()[*i]) {
        costs.pixels_mut()[i] = 0;
        front.push(Reverse((0_u32, i)));
    }
    let limit = (FARTHEST * PARTS) as u32;
    while let Some(Reverse((cost, i))) = front.pop() {
        if cost > costs.pixels()[i] || cost > limit {
            continue;
        }
        let (x, y) = ((i % width) as isize, (i / width) as isize);
        for (dx, dy) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
            let length = if dx == 0 || dy == 0 { 1.0 } else { std::f32::consts::SQRT_2 };
            if !colours.contains(x + dx, y + dy) {
                continue;
            }
            let next = (y + dy) as usize * width + (x + dx) as usize;
            if open.pixels()[next] {
                let total = cost.saturating_add(step(colours.pixels()[i], colours.pixels()[next], length));
                if total < costs.pixels()[next] {
                    costs.pixels_mut()[next] = total;
                    front.push(Reverse((total, next)));
                }
            }
        }
    }
    costs.map(|cost| if cost == u32::MAX { f32::INFINITY } else { cost as f32 / PARTS })
}

fn step(a: [f32; 3], b: [f32; 3], length: f32) -> u32 {
    let square: f32 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    let slope = square / (length * length * UNIT * UNIT);
    ((GROUND + slope) * length * PARTS).clamp(1.0, FARTHEST * PARTS) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gradual_way_is_short_and_an_edge_is_far() {
        let gradual = Raster::from_fn(60, 5, |x, _| [x as f32, 0.0, 0.0]);
        let edge = Raster::from_fn(60, 5, |x, _| [if x < 30 { 0.0 } else { 59.0 }, 0.0, 0.0]);
        let open = Raster::filled(60, 5, true);
        let from = Raster::from_fn(60, 5, |x, _| x == 0);
        let (near, far) = (path_from(&gradual, &open, &from).get(59, 2), path_from(&edge, &open, &from).get(59, 2));
        assert!(near < 10.0 && far > 30.0, "{near} {far}");
        let closed = Raster::from_fn(60, 5, |x, _| x != 30);
        assert!(path_from(&gradual, &closed, &from).get(59, 2).is_infinite());
    }
}
