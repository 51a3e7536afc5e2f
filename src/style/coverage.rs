//! The ink that marks lay down, on the working grid.

use crate::drawing::Mark;
use crate::raster::{Raster, reduce};
use crate::source::Placement;

/// The share of each working pixel under the ink of dots and strokes, by a grid twice as fine.
pub(super) fn covered(marks: &[Mark], placement: &Placement) -> Raster<f32> {
    const FINER: f64 = 2.0;
    let (columns, rows) = (2 * placement.columns, 2 * placement.rows);
    let mut fine = Raster::filled(columns, rows, 0.0_f32);
    let scale = FINER / placement.mm_per_pixel();
    for mark in marks {
        let (points, widths) = match mark {
            Mark::Stroke(stroke) => stroke.sampled(1.0 / scale),
            Mark::Dot(dot) => (vec![dot.centre], vec![2.0 * dot.radius]),
            Mark::Area(_) => continue,
        };
        for (p, width) in points.iter().zip(widths) {
            let (p, radius) = (placement.to_grid(*p), 0.5 * width * scale);
            let (x, y) = (FINER * p.x - 0.5, FINER * p.y - 0.5);
            let range = |at: f64, most: usize| {
                ((at - radius).ceil().max(0.0) as usize)..((at + radius).floor() + 1.0).clamp(0.0, most as f64) as usize
            };
            for (row, column) in range(y, rows).flat_map(|row| range(x, columns).map(move |column| (row, column))) {
                if (column as f64 - x).hypot(row as f64 - y) <= radius {
                    fine.set(column, row, 1.0);
                }
            }
        }
    }
    reduce(&fine, 2)
}
