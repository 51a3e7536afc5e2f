//! The inside of a polygon.

use super::Raster;

/// The pixels (1) whose centres lie inside a closed polygon of corners in pixel units, by the nonzero rule.
pub fn filled_polygon(width: usize, height: usize, corners: &[[f64; 2]]) -> Raster<u8> {
    let mut inside = Raster::filled(width, height, 0_u8);
    each_pixel_inside(width, height, &[corners], |x, y| inside.set(x, y, 1));
    inside
}

/// Calls with column and row of each pixel whose centre lies inside closed polygons, by the nonzero rule over all of them.
pub fn each_pixel_inside(width: usize, height: usize, polygons: &[impl AsRef<[[f64; 2]]>], mut paint: impl FnMut(usize, usize)) {
    let corners = || polygons.iter().flat_map(AsRef::as_ref);
    let (top, bottom) = corners().fold((f64::MAX, f64::MIN), |(top, bottom), [_, y]| (top.min(*y), bottom.max(*y)));
    let nearest = |at: f64, most: usize| ((at - 0.5).ceil().max(0.0) as usize).min(most);
    let mut crossings = Vec::new();
    for y in nearest(top, height)..nearest(bottom, height) {
        let centre = y as f64 + 0.5;
        crossings.clear();
        for polygon in polygons {
            let ends = polygon.as_ref().iter().zip(polygon.as_ref().iter().cycle().skip(1));
            let crossed = ends.filter(|([_, y0], [_, y1])| (*y0 <= centre) != (*y1 <= centre));
            crossings.extend(
                crossed.map(|([x0, y0], [x1, y1])| (x0 + (centre - y0) / (y1 - y0) * (x1 - x0), if y0 < y1 { 1 } else { -1 })),
            );
        }
        crossings.sort_unstable_by(|a: &(f64, i32), b| a.0.total_cmp(&b.0));
        let mut winding = 0;
        for (i, (from, turn)) in crossings.iter().enumerate() {
            winding += turn;
            let to = crossings.get(i + 1).map_or(*from, |(x, _)| *x);
            if winding != 0 {
                (nearest(*from, width)..nearest(to, width)).for_each(|x| paint(x, y));
            }
        }
    }
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
