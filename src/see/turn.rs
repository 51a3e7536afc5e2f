//! Quarter turns between a photograph and its upright picture.

use crate::geometry::{Point, Rect};
use crate::raster::Raster;

/// The rotation, in clockwise quarter turns, that brings the photograph upright.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Turn {
    quarters: u8,
    /// Columns and rows of the photograph.
    size: [u32; 2],
}

impl Turn {
    pub(super) const fn new(quarters: u8, size: [u32; 2]) -> Self {
        Self { quarters: quarters % 4, size }
    }

    /// The rotation plus `quarters` clockwise.
    pub(super) const fn further(self, quarters: u8) -> Self {
        Self::new(self.quarters + quarters, self.size)
    }

    /// Width and height of the upright picture.
    pub(super) fn upright_size(self) -> [f64; 2] {
        let [w, h] = self.size.map(f64::from);
        if self.quarters.is_multiple_of(2) { [w, h] } else { [h, w] }
    }

    /// Maps a point of the upright picture to the photograph.
    pub(super) fn back(self, p: Point) -> Point {
        let [w, h] = self.size.map(f64::from);
        match self.quarters {
            0 => p,
            1 => Point::new(p.y, h - p.x),
            2 => Point::new(w - p.x, h - p.y),
            _ => Point::new(w - p.y, p.x),
        }
    }

    /// Maps a box of the upright picture to the photograph.
    pub(super) fn box_back(self, r: Rect) -> Rect {
        Rect::from_points(self.back(r.origin()), self.back(Point::new(r.x1, r.y1)))
    }

    /// Rotates a raster over the photograph, or over a part of it, upright.
    pub(super) fn raster<T: Copy + Default + Send + Sync>(self, raster: &Raster<T>) -> Raster<T> {
        let (w, h) = (raster.width(), raster.height());
        match self.quarters {
            0 => raster.clone(),
            1 => Raster::from_fn(h, w, |x, y| raster.get(y, h - 1 - x)),
            2 => Raster::from_fn(w, h, |x, y| raster.get(w - 1 - x, h - 1 - y)),
            _ => Raster::from_fn(h, w, |x, y| raster.get(w - 1 - y, x)),
        }
    }

    /// Rotates a raster over the upright picture back to the photograph.
    pub(super) fn raster_back<T: Copy + Default + Send + Sync>(self, raster: &Raster<T>) -> Raster<T> {
        Self::new(4 - self.quarters, self.size).raster(raster)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_rasters_turn_alike() {
        let photograph = Raster::from_fn(5, 3, |x, y| 10 * x + y);
        for quarters in 0..4 {
            let turn = Turn::new(quarters, [5, 3]);
            let upright = turn.raster(&photograph);
            let [w, h] = turn.upright_size();
            assert_eq!([upright.width() as f64, upright.height() as f64], [w, h]);
            for (x, y) in [(0, 0), (1, 2), (2, 1)] {
                let p = turn.back(Point::new(x as f64 + 0.5, y as f64 + 0.5));
                assert_eq!(upright.get(x, y), photograph.get(p.x as usize, p.y as usize), "{quarters} quarters");
            }
            assert_eq!(turn.raster_back(&upright), photograph);
        }
    }
}
