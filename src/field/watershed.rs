//! Marker-based watershed (Beucher and Lantuejoul 1979, by flooding as in Meyer 1991): each marker's basin.

use crate::raster::Raster;
use std::collections::VecDeque;

/// Number of distinct heights.
const LEVELS: usize = 256;

/// Floods `relief` (0 low to 1 high, such as gradient magnitude) from the markers (above 0) until every pixel has a marker's label;
/// basins meet on the ridges. Pixels stay 0 only if there is no marker.
pub fn watershed(relief: &Raster<f32>, markers: &Raster<i32>) -> Raster<i32> {
    let mut labels = markers.map(|label| label.max(0));
    let (width, height) = (relief.width(), relief.height());
    let level = |at: usize| ((relief.pixels()[at].clamp(0.0, 1.0) * (LEVELS - 1) as f32).round() as usize).min(LEVELS - 1);
    let mut queues: Vec<VecDeque<usize>> = vec![VecDeque::new(); LEVELS];
    for (at, &label) in markers.pixels().iter().enumerate() {
        if label > 0 {
            queues[level(at)].push_back(at);
        }
    }
    let mut water = 0;
    while water < LEVELS {
        let Some(at) = queues[water].pop_front() else {
            water += 1;
            continue;
        };
        let (x, y) = (at % width, at / width);
        let sides =
            [(x > 0, at.wrapping_sub(1)), (x + 1 < width, at + 1), (y > 0, at.wrapping_sub(width)), (y + 1 < height, at + width)];
        for (_, side) in sides.into_iter().filter(|(is_there, _)| *is_there) {
            if labels.pixels()[side] == 0 {
                labels.pixels_mut()[side] = labels.pixels()[at];
                queues[level(side).max(water)].push_back(side);
            }
        }
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    #[test]
    fn basins_meet_on_the_ridge() {
        // A ridge along x = 30 that bends, markers far off it on both sides.
        let ridge = |y: usize| 30.0 + 6.0 * (y as f32 / 9.0).sine();
        let relief = Raster::from_fn(70, 50, |x, y| (1.0 - (x as f32 - ridge(y)).abs() / 8.0).max(0.0));
        let mut markers = Raster::filled(70, 50, 0);
        markers.set(3, 4, 1);
        markers.set(60, 40, 2);
        let labels = watershed(&relief, &markers);
        for y in 0..50 {
            let border = labels.row(y).iter().position(|l| *l == 2).unwrap();
            assert!((border as f32 - ridge(y)).abs() <= 1.5, "row {y}: {border} for {}", ridge(y));
            assert!(labels.row(y)[border..].iter().all(|l| *l == 2));
        }
    }
}
