//! Frames around rasters, and parts of rasters.

use super::Raster;
use std::ops::Range;

impl<T: Copy + Default + Send + Sync> Raster<T> {
    /// The raster with `margin` more pixels on each side, which repeat the nearest border pixel.
    #[must_use]
    pub fn framed(&self, margin: usize) -> Self {
        Self::from_fn(self.width() + 2 * margin, self.height() + 2 * margin, |x, y| {
            self.clamped(x as isize - margin as isize, y as isize - margin as isize)
        })
    }

    /// The raster without `margin` pixels on each side; each side must be at least `2 margin` long.
    #[must_use]
    pub fn unframed(&self, margin: usize) -> Self {
        self.part(&(margin..self.width() - margin), &(margin..self.height() - margin))
    }

    /// Some columns and rows, all inside the raster.
    #[must_use]
    pub fn part(&self, columns: &Range<usize>, rows: &Range<usize>) -> Self {
        Self::from_fn(columns.len(), rows.len(), |x, y| self.get(x + columns.start, y + rows.start))
    }
}

impl Raster<f32> {
    /// The columns and rows that hold everything above a value; none if nothing is.
    pub fn extent_above(&self, least: f32) -> Option<[Range<usize>; 2]> {
        let has = |x: usize, y: usize| self.get(x, y) > least;
        let columns: Vec<usize> = (0..self.width()).filter(|x| (0..self.height()).any(|y| has(*x, y))).collect();
        let rows: Vec<usize> = (0..self.height()).filter(|y| (0..self.width()).any(|x| has(x, *y))).collect();
        Some([*columns.first()?..columns.last()? + 1, *rows.first()?..rows.last()? + 1])
    }

    /// The same with room around them, as far as the raster goes.
    pub fn extent_with_room(&self, least: f32, room: usize) -> Option<[Range<usize>; 2]> {
        let [columns, rows] = self.extent_above(least)?;
        let wider = |range: Range<usize>, most: usize| range.start.saturating_sub(room)..(range.end + room).min(most);
        Some([wider(columns, self.width()), wider(rows, self.height())])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_comes_off_again() {
        let raster = Raster::from_fn(3, 2, |x, y| x + 10 * y);
        let framed = raster.framed(4);
        assert_eq!((framed.width(), framed.height()), (11, 10));
        assert_eq!((framed.get(0, 0), framed.get(10, 9)), (0, 12));
        assert_eq!(framed.unframed(4), raster);
    }
}
