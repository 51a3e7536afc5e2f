//! Unites areas of one pen that overlap or touch. Filled one by one, each would stay half a nib off the common borders, and
//! overlaps would be drawn twice.

use crate::drawing::{Area, Mark};
use crate::geometry::{OffsetOutline, Rect, WideSegment, estimated_crossings};
use crate::interrupt::Interrupt;
use crate::parallel::mapped;
use kurbo::Shape;

/// Maximum cells per side of the grid in which neighbours are searched.
const CELLS: usize = 512;
/// Maximum vertices of all areas that are united: half a million take a second or two and a few hundred megabytes.
const MOST_VERTICES: usize = 2_000_000;
/// Maximum crossings of all their borders.
const MOST_CROSSINGS: f64 = 1_000_000.0;

/// The result of uniting areas.
pub(super) struct United {
    /// For each mark, true if it is part of one of the shapes and not drawn by itself.
    pub is_part: Vec<bool>,
    /// Connected shapes.
    pub shapes: Vec<OffsetOutline>,
}

/// Unites the areas that may meet among some marks, or none if that is too much work. Curves are flattened to `tolerance`.
pub(super) fn united(marks: &[Mark], tolerance: f64, interrupt: &Interrupt) -> United {
    let areas: Vec<(usize, &Area, Rect)> = marks.iter().enumerate().filter_map(|(i, mark)| area(i, mark)).collect();
    let mut united = United { is_part: vec![false; marks.len()], shapes: Vec::new() };
    let boxes: Vec<Rect> = areas.iter().map(|(.., bounds)| *bounds).collect();
    let has_neighbours = crowded(&boxes);
    let meeting: Vec<(usize, &Area)> =
        areas.iter().zip(has_neighbours).filter(|(_, meets)| *meets).map(|((i, area, _), _)| (*i, *area)).collect();
    if meeting.len() < 2 {
        return united;
    }
    let outline = |area: &Area| (!interrupt.is_raised()).then(|| OffsetOutline::new(&area.outline, tolerance));
    let outlines: Vec<OffsetOutline> = mapped(&meeting, &|(_, area)| outline(area)).into_iter().flatten().collect();
    if interrupt.is_raised() || outlines.iter().map(OffsetOutline::len).sum::<usize>() > MOST_VERTICES || is_tangled(&outlines) {
        return united;
    }
    meeting.iter().for_each(|(i, _)| united.is_part[*i] = true);
    united.shapes = OffsetOutline::united(&outlines);
    united
}

fn area(index: usize, mark: &Mark) -> Option<(usize, &Area, Rect)> {
    let Mark::Area(area) = mark else { return None };
    let bounds = area.outline.bounding_box();
    (bounds.is_finite() && !area.outline.is_empty()).then_some((index, area, bounds))
}

fn is_tangled(outlines: &[OffsetOutline]) -> bool {
    let threads: Vec<WideSegment> = outlines.iter().flat_map(OffsetOutline::threads).collect();
    estimated_crossings(&threads) > MOST_CROSSINGS
}

/// For each box, true if it shares a grid cell with another.
fn crowded(boxes: &[Rect]) -> Vec<bool> {
    let Some(all) = boxes.iter().copied().reduce(|a, b| a.union(b)) else { return Vec::new() };
    let side = (4.0 * (boxes.len() as f64).sqrt()) as usize;
    let side = side.clamp(1, CELLS);
    let cell = |v: f64, low: f64, extent: f64| (((v - low) / extent.max(1e-9) * side as f64) as usize).min(side - 1);
    let corners = |b: &Rect| {
        let (x, y) = (|v| cell(v, all.x0, all.width()), |v| cell(v, all.y0, all.height()));
        (x(b.x0), y(b.y0), x(b.x1) + 1, y(b.y1) + 1)
    };
    // Each box adds 1 to its cells: first as differences, which are summed to counts, then to sums of counts.
    let width = side + 1;
    let mut counts = vec![0_i64; width * width];
    for b in boxes {
        let (x0, y0, x1, y1) = corners(b);
        counts[y0 * width + x0] += 1;
        counts[y1 * width + x1] += 1;
        counts[y0 * width + x1] -= 1;
        counts[y1 * width + x0] -= 1;
    }
    sum_up(&mut counts, width);
    // Summed-area table with a leading row and column of zeros.
    let mut sums = vec![0_i64; width * width];
    for (y, x) in (0..side).flat_map(|y| (0..side).map(move |x| (y, x))) {
        sums[(y + 1) * width + x + 1] = counts[y * width + x];
    }
    sum_up(&mut sums, width);
    let is_crowded = |b: &Rect| {
        let (x0, y0, x1, y1) = corners(b);
        let inside = sums[y1 * width + x1] - sums[y0 * width + x1] - sums[y1 * width + x0] + sums[y0 * width + x0];
        inside > ((x1 - x0) * (y1 - y0)) as i64
    };
    boxes.iter().map(is_crowded).collect()
}

/// Replaces each cell by the sum of all cells above and to the left, itself included.
fn sum_up(cells: &mut [i64], width: usize) {
    for i in 0..cells.len() {
        let (x, y) = (i % width, i / width);
        let left = if x > 0 { cells[i - 1] } else { 0 };
        let above = if y > 0 { cells[i - width] } else { 0 };
        let both = if x > 0 && y > 0 { cells[i - width - 1] } else { 0 };
        cells[i] += left + above - both;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::BezPath;

    fn mark(text: &str) -> Mark {
        Mark::Area(Area { outline: BezPath::from_svg(text).unwrap(), colour: None })
    }

    #[test]
    fn areas_that_meet_are_one_whichever_way_they_turn_and_others_stay() {
        let marks = [
            mark("M0,0 H10 V10 H0 Z"),
            mark("M9.9,0 V10 H20 V0 Z"),
            mark("M100,100 H110 V110 H100 Z"),
            mark("M50,0 H60 V1 H50 Z"),
        ];
        let united = united(&marks, 0.01, &Interrupt::never());
        assert_eq!(united.is_part, [true, true, false, false]);
        assert_eq!(united.shapes.len(), 1);
        assert!((united.shapes[0].path().area().abs() - 200.0).abs() < 1e-3);
    }

    #[test]
    fn boxes_that_share_no_cell_are_alone() {
        let boxes: Vec<Rect> = (0..100).map(|i| Rect::from_origin_size((f64::from(i), 0.0), (0.001, 0.001))).collect();
        assert_eq!(crowded(&[boxes[0], boxes[99], boxes[99]]), [false, true, true]);
        assert!(crowded(&[]).is_empty());
    }
}
