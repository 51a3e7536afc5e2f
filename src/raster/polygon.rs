//! The inside of a polygon.

use super::Raster;

/// The pixels (1) whose centres lie inside a closed polygon of corners in pixel units, by the even-odd rule.
pub fn filled_polygon(width: usize, height: usize, corners: &[[f64; 2]]) -> Raster<u8> {
    let mut inside = Raster::filled(width, height, 0_u8);
    for y in 0..height {
        let centre = y as f64 + 0.5;
        let ends = corners.iter().zip(corners.iter().cycle().skip(1));
        let mut crossings: Vec<f64> = ends
            .filter(|([_, y0], [_, y1])| (*y0 <= centre) != (*y1 <= centre))
            .map(|([x0, y0], [x1, y1])| x0 + (centre - y0) / (y1 - y0) * (x1 - x0))
            .collect();
        crossings.sort_unstable_by(f64::total_cmp);
        for span in crossings.chunks_exact(2) {
            let column = |x: f64| ((x - 0.5).ceil().max(0.0) as usize).min(width);
            (column(span[0])..column(span[1])).for_each(|x| inside.set(x, y, 1));
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_that_leaves_the_raster_is_cut() {
        let filled = filled_polygon(6, 4, &[[-4.0, 0.0], [9.0, 0.0], [2.5, 6.5]]);
        let rows: Vec<usize> = (0..4).map(|y| filled.row(y).iter().filter(|v| **v == 1).count()).collect();
        // On the last row the right side passes through the centre of the last pixel, which is outside.
        assert_eq!(rows, [6, 6, 6, 5]);
        let small = filled_polygon(6, 4, &[[1.0, 1.0], [4.0, 1.0], [4.0, 3.0], [1.0, 3.0]]);
        assert_eq!((small.pixels().iter().filter(|v| **v == 1).count(), small.get(1, 1), small.get(4, 2)), (6, 1, 0));
    }
}
