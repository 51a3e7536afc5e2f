//! The ink that marks lay down, on the working grid.

use crate::drawing::{Dot, Mark};
use crate::elementary::Elementary as _;
use crate::geometry::{BezPath, Point, flatten};
use crate::raster::{Raster, each_pixel_inside, reduce};
use crate::source::Placement;

/// Working pixels are halved, so that a dot of one pixel has an area.
const FINER: usize = 2;
/// Flattening tolerance of areas, in fine pixels.
const TOLERANCE: f64 = 0.2;

/// The share of each working pixel under the ink of marks.
pub(crate) fn covered<'a>(marks: impl IntoIterator<Item = &'a Mark>, placement: &Placement) -> Raster<f32> {
    darkened(marks.into_iter().map(|mark| (mark, 1.0)), placement)
}

/// How dark each working pixel is under marks that hide what they cover, by a grid twice as fine. Each comes with its darkness, 0 to 1.
pub(super) fn darkened<'a>(marks: impl IntoIterator<Item = (&'a Mark, f32)>, placement: &Placement) -> Raster<f32> {
    let mut fine = Raster::filled(FINER * placement.columns, FINER * placement.rows, 0.0_f32);
    let scale = FINER as f64 / placement.mm_per_pixel();
    for (mark, ink) in marks {
        match mark {
            Mark::Stroke(stroke) => {
                let (points, widths) = stroke.sampled(1.0 / scale);
                points.iter().zip(widths).for_each(|(p, width)| cover_disc(&mut fine, placement, (*p, 0.5 * width * scale), ink));
            }
            Mark::Dot(Dot { centre, radius, outline: None, .. }) => {
                cover_disc(&mut fine, placement, (*centre, radius * scale), ink);
            }
            Mark::Dot(dot) => cover_area(&mut fine, placement, &dot.path(), ink),
            Mark::Area(area) => cover_area(&mut fine, placement, &area.outline, ink),
        }
    }
    reduce(&fine, FINER)
}

/// The grid's point in fine pixels.
fn on_fine(placement: &Placement, p: Point) -> Point {
    let p = placement.to_grid(p);
    Point::new(FINER as f64 * p.x, FINER as f64 * p.y)
}

fn cover_disc(fine: &mut Raster<f32>, placement: &Placement, (centre, radius): (Point, f64), ink: f32) {
    let (columns, rows) = (fine.width(), fine.height());
    let p = on_fine(placement, centre);
    let (x, y) = (p.x - 0.5, p.y - 0.5);
    let range = |at: f64, most: usize| {
        ((at - radius).ceil().max(0.0) as usize)..((at + radius).floor() + 1.0).clamp(0.0, most as f64) as usize
    };
    for (row, column) in range(y, rows).flat_map(|row| range(x, columns).map(move |column| (row, column))) {
        if (column as f64 - x).hypotenuse(row as f64 - y) <= radius {
            fine.set(column, row, ink);
        }
    }
}

fn cover_area(fine: &mut Raster<f32>, placement: &Placement, outline: &BezPath, ink: f32) {
    let tolerance = TOLERANCE * placement.mm_per_pixel() / FINER as f64;
    let corners = |(points, _): (Vec<Point>, bool)| {
        points.into_iter().map(|p| on_fine(placement, p)).map(|p| [p.x, p.y]).collect::<Vec<_>>()
    };
    let polygons: Vec<Vec<[f64; 2]>> = flatten(outline, tolerance).into_iter().map(corners).collect();
    let (columns, rows) = (fine.width(), fine.height());
    each_pixel_inside(columns, rows, &polygons, |x, y| fine.set(x, y, ink));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Area;
    use crate::geometry::Rect;
    use kurbo::Shape;

    #[test]
    fn every_kind_of_mark_covers_its_area() {
        let placement = Placement::new(Rect::new(0.0, 0.0, 20.0, 10.0), 8.0);
        let ring = kurbo::Circle::new((10.0, 5.0), 2.0).to_path(1e-3);
        let area = |outline: &BezPath| Mark::Area(Area { outline: outline.clone(), colour: None });
        let mm2 = |mark: Mark| {
            let sum: f32 = covered([&mark], &placement).pixels().iter().sum();
            f64::from(sum) * placement.mm_per_pixel().powi(2)
        };
        let disc = 4.0 * std::f64::consts::PI;
        assert!((mm2(Mark::Dot(Dot::circle(Point::new(10.0, 5.0), 2.0))) - disc).abs() < 0.1);
        assert!((mm2(area(&ring)) - disc).abs() < 0.1);
        let mut holed = ring;
        holed.extend(kurbo::Circle::new((10.0, 5.0), 1.0).to_path(1e-3).reverse_subpaths());
        assert!((mm2(area(&holed)) - 0.75 * disc).abs() < 0.1);
    }
}
