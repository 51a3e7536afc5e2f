//! What lies where on the sheet, in cells: x right from 0 to 10, y down from 0 to 14. The printer and the reader share nothing else.
//!
//! ```text
//!   O  | code  |  O     rows 0 and 13: corner marks, the code, the field for a grey card
//!   .  #  #  #  #       rows 1 to 12: patches and bare paper, with a dot at every second corner of the cells
//!   #  #  .  #  #
//!   O [ grey ]    O     the hollow mark is the upper left one
//! ```

use crate::geometry::{Point, Rect, Vec2};

/// Columns and rows of cells.
pub(super) const COLUMNS: usize = 10;
pub(super) const ROWS: usize = 14;
/// Most pens on a sheet.
pub(super) const MOST_PENS: usize = 8;
/// Version of this arrangement, as the code row tells it.
pub(super) const VERSION: u32 = 1;
/// Coverages of a ramp that are aimed at, besides the solid patch. The nib decides what is possible.
pub(super) const RAMP: [f64; 4] = [0.15, 0.3, 0.5, 0.7];
/// Side of a patch, and of the window in its middle that is read. The rest is for pens that lie off, and for blur.
pub(super) const PATCH: f64 = 0.74;
pub(super) const WINDOW: f64 = 0.5;
/// Outer and inner radius of a corner mark's ring; radius of the disc inside it, and of the hole in the first mark's disc.
pub(super) const RING: [f64; 2] = [0.42, 0.28];
pub(super) const DISC: f64 = 0.14;
pub(super) const HOLE: f64 = 0.07;
/// Radius of the dots between the patches.
pub(super) const NODE: f64 = 0.08;
/// Height of labels. They stand in the gaps below patches, so that the gaps beside them stay bare.
pub(super) const LABEL: f64 = 0.11;
/// The field for a grey card, outlined.
pub(super) const GREY: Rect = Rect::new(1.25, 13.18, 4.75, 13.86);
/// Number of bits of the code, and where its first one begins.
pub(super) const BITS: usize = 16;
const FIRST_BIT: Point = Point::new(1.0, 0.25);
const BIT: f64 = 0.5;
/// Size of the bar of a bit: it fills the left half of its place for 1, the right half for 0.
const BAR: Vec2 = Vec2::new(0.17, 0.5);
/// Largest number of copies of each patch.
const MOST_COPIES: usize = 3;

/// Centres of the corner marks, clockwise from the upper left one, which has a hole.
pub(super) const CORNERS: [Point; 4] = [
    Point::new(0.5, 0.5),
    Point::new(COLUMNS as f64 - 0.5, 0.5),
    Point::new(COLUMNS as f64 - 0.5, ROWS as f64 - 0.5),
    Point::new(0.5, ROWS as f64 - 0.5),
];

/// What a cell holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Patch {
    /// Bare paper.
    Paper,
    /// One pen, filled. Pens count from 0.
    Solid(usize),
    /// One pen at a step of the ramp, from 0.
    Ramp(usize, usize),
    /// Two pens, both filled, the first below.
    Pair(usize, usize),
    /// All pens, filled.
    All,
}

/// A cell with its patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub patch: Patch,
    pub centre: Point,
}

impl Cell {
    /// The inked square.
    pub(super) fn area(&self) -> Rect {
        Rect::from_center_size(self.centre, (PATCH, PATCH))
    }

    /// The part of it that is read.
    pub(super) fn window(&self) -> Rect {
        Rect::from_center_size(self.centre, (WINDOW, WINDOW))
    }
}

/// All cells of a sheet of this many pens, paper among them. Patches occur as often as there is room, copies far apart; every fifth
/// cell at least is paper.
pub(super) fn cells(pens: usize) -> Vec<Cell> {
    let places = (1..ROWS - 1).flat_map(|row| (0..COLUMNS).map(move |column| (column, row)));
    let (bare, free): (Vec<_>, Vec<_>) = places.partition(|(column, row)| (column + 2 * row) % 5 == 0);
    let patches = patches(pens, free.len());
    let at = |(column, row): (usize, usize)| Point::new(column as f64 + 0.5, row as f64 + 0.5);
    let mut cells: Vec<Cell> = bare.into_iter().map(|place| Cell { patch: Patch::Paper, centre: at(place) }).collect();
    let mut given = vec![Patch::Paper; free.len()];
    for (i, patch) in patches.iter().enumerate() {
        given[i * free.len() / patches.len()] = *patch;
    }
    cells.extend(free.into_iter().zip(given).map(|(place, patch)| Cell { patch, centre: at(place) }));
    cells
}

/// The patches in their order on the sheet: whole copies, then more copies of the solid ones.
fn patches(pens: usize, room: usize) -> Vec<Patch> {
    let mut once: Vec<Patch> = Vec::new();
    for pen in 0..pens {
        once.push(Patch::Solid(pen));
        once.extend((0..RAMP.len()).map(|step| Patch::Ramp(pen, step)));
    }
    once.extend((0..pens).flat_map(|a| (a + 1..pens).map(move |b| Patch::Pair(a, b))));
    if pens > 2 {
        once.push(Patch::All);
    }
    let copies = (room / once.len().max(1)).clamp(1, MOST_COPIES);
    let mut all: Vec<Patch> = (0..copies).flat_map(|_| once.iter().copied()).collect();
    let solids = pens * ((room - all.len()) / pens.max(1)).min(MOST_COPIES - copies);
    all.extend((0..solids).map(|i| Patch::Solid(i % pens)));
    all
}

/// The centres of the dots between the patches.
pub(super) fn nodes() -> impl Iterator<Item = Point> {
    (1..ROWS).step_by(2).flat_map(|y| (1..COLUMNS).step_by(2).map(move |x| Point::new(x as f64, y as f64)))
}

/// The bar of a bit if it is 1 (left) or 0 (right).
pub(super) fn bar(bit: usize, is_set: bool) -> Rect {
    let left = FIRST_BIT + Vec2::new(bit as f64 * BIT + if is_set { 0.0 } else { 0.5 * BIT }, 0.0);
    Rect::from_origin_size(left + Vec2::new(0.5 * (0.5 * BIT - BAR.x), 0.0), BAR.to_size())
}

/// Where the ink of a patch's pens lies: the number of lines and their distance, of a step of the ramp. The window holds whole periods, so
/// that its mean does not depend on where it begins.
pub(super) fn hatch(step: usize, nib: f64, window: f64) -> (usize, f64) {
    let lines = (RAMP[step] * window / nib).round().max(1.0);
    (lines as usize, window / lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_patch_is_there_and_copies_are_far_apart() {
        for pens in 1..=MOST_PENS {
            let cells = cells(pens);
            assert_eq!(cells.len(), COLUMNS * (ROWS - 2));
            let paper = cells.iter().filter(|cell| cell.patch == Patch::Paper).count();
            assert!(paper >= 24, "{pens}: {paper}");
            for pen in 0..pens {
                let solids: Vec<Point> = cells.iter().filter(|c| c.patch == Patch::Solid(pen)).map(|c| c.centre).collect();
                assert!(solids.len() >= 2 && solids[0].distance(solids[1]) > 3.0, "{pens} {pen}: {solids:?}");
                for step in 0..RAMP.len() {
                    assert!(cells.iter().any(|c| c.patch == Patch::Ramp(pen, step)));
                }
                for other in pen + 1..pens {
                    assert!(cells.iter().any(|c| c.patch == Patch::Pair(pen, other)));
                }
            }
            assert_eq!(cells.iter().any(|c| c.patch == Patch::All), pens > 2);
        }
    }

    #[test]
    fn hatching_fits_its_window() {
        for (nib, window) in [(0.1, 6.0), (0.3, 6.5), (1.0, 6.0)] {
            let made: Vec<f64> = (0..RAMP.len()).map(|step| nib / hatch(step, nib, window).1).collect();
            assert!(made.windows(2).all(|pair| pair[0] < pair[1]), "{nib}: {made:?}");
            assert!(made.iter().zip(RAMP).all(|(made, aim)| (made - aim).abs() < 0.09), "{nib}: {made:?}");
        }
    }

    #[test]
    fn the_code_lies_between_the_marks() {
        assert!(bar(0, true).x0 > CORNERS[0].x + RING[0] && bar(BITS - 1, false).x1 < CORNERS[1].x - RING[0]);
        assert!(GREY.x0 > CORNERS[3].x + RING[0] && GREY.y0 > ROWS as f64 - 1.0 + NODE);
    }
}
