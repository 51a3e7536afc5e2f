//! The sheet on a page, as shapes for each pen.

use super::SheetError;
use super::code;
use super::grid::{self, Cell, Patch};
use crate::elementary::turned_by;
use crate::geometry::stroke_letters as font;
use crate::geometry::{Affine, Point, Rect, Vec2};

/// Smallest side of a cell in millimetres, also in widths of the broadest nib: the palest ramp has one line then.
const LEAST_CELL: f64 = 11.0;
const NIBS: f64 = 12.0;
/// Side of a cell in millimetres that suffices: larger patches only take time.
const ENOUGH: f64 = 16.0;
/// Widths of nibs that are drawn, in millimetres.
const DRAWN: std::ops::RangeInclusive<f64> = 0.01..=20.0;
/// Least height of a label in widths of the nib that writes it.
const READABLE: f64 = 3.5;

/// A sheet of patches for the pens of one box, laid out on a page.
///
/// ```
/// use drypoint::colour::sheet::{PenSheet, SheetShape};
///
/// // Yellow, red and black, of 0.3 mm each, on A5 with a margin of 8 mm; black draws the marks.
/// let sheet = PenSheet::new([148.0, 210.0], 8.0, &[0.3, 0.3, 0.3], 2)?;
/// assert_eq!(sheet.cell(), 13.0);
/// let marks = sheet.marks();
/// let filled = marks.iter().filter(|mark| mark.pen == 0 && matches!(mark.shape, SheetShape::Rect(_)));
/// assert!(filled.count() > 8);
/// # Ok::<(), drypoint::colour::sheet::SheetError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PenSheet {
    nibs: Vec<f64>,
    darkest: usize,
    cell: f64,
    placed: Affine,
}

/// Ink of one pen on the sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetMark {
    /// The pen, from 0, in the order given.
    pub pen: usize,
    /// What it is for.
    pub role: SheetRole,
    /// Its shape on the page, in millimetres.
    pub shape: SheetShape,
}

/// What a mark is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SheetRole {
    /// By which the reader finds the sheet.
    Fiducial,
    /// For people.
    Label,
    /// A filled patch of this pen alone, or its share of an overprint.
    Solid,
    /// A line of a ramp.
    Ramp,
}

/// A shape of ink; lengths in millimetres on the page, x right, y down.
#[derive(Clone, Debug, PartialEq)]
pub enum SheetShape {
    /// Filled; its border is the ink's, not the pen's path.
    Rect(Rect),
    /// Filled.
    Disc {
        /// Its centre.
        centre: Point,
        /// Its radius.
        radius: f64,
    },
    /// Filled between two circles.
    Ring {
        /// Its centre.
        centre: Point,
        /// Outer radius.
        outer: f64,
        /// Inner radius.
        inner: f64,
    },
    /// One pass of the nib along these points.
    Line(Vec<Point>),
}

impl PenSheet {
    /// Lays a sheet out for pens with nibs of these widths in millimetres, in the order in which they will be drawn (the first lowest).
    /// `page` is width and height, `margin` what stays free at every side, in millimetres. The pen `darkest` (from 0) draws marks and
    /// labels: it must stand out from the paper.
    ///
    /// On a page that is wider than high, the sheet lies on its side.
    pub fn new(page: [f64; 2], margin: f64, nibs: &[f64], darkest: usize) -> Result<Self, SheetError> {
        if nibs.is_empty() || nibs.len() > grid::MOST_PENS || darkest >= nibs.len() {
            return Err(SheetError::PenCount { given: nibs.len(), most: grid::MOST_PENS });
        }
        if let Some(nib) = nibs.iter().find(|nib| !DRAWN.contains(nib)) {
            return Err(SheetError::Nib { nib: *nib, least: *DRAWN.start(), most: *DRAWN.end() });
        }
        let broadest = nibs.iter().copied().fold(0.0, f64::max);
        let least = (2.0 * LEAST_CELL.max(NIBS * broadest)).ceil() / 2.0;
        let free = page.map(|side| side - 2.0 * margin.max(0.0));
        let (columns, rows) = (grid::COLUMNS as f64, grid::ROWS as f64);
        let is_upright = page[1] >= page[0];
        let (across, down) = if is_upright { (free[0], free[1]) } else { (free[1], free[0]) };
        let cell = code::size_within((across / columns).min(down / rows).min(ENOUGH.max(least)));
        if page.iter().any(|side| side.is_nan()) || cell < least {
            let needed = [columns, rows].map(|count| count * least + 2.0 * margin.max(0.0));
            return Err(SheetError::PageTooSmall { page, needed, broadest });
        }
        let middle = Vec2::new(0.5 * page[0], 0.5 * page[1]);
        let turn = if is_upright { 0.0 } else { -std::f64::consts::FRAC_PI_2 };
        let placed = Affine::translate(middle) * turned_by(turn) * Affine::scale(cell);
        let placed = placed * Affine::translate((-0.5 * columns, -0.5 * rows));
        Ok(Self { nibs: nibs.to_vec(), darkest, cell, placed })
    }

    /// Side of a cell in millimetres. Patches measure 0.74 of it; the sheet is ten cells by fourteen.
    pub const fn cell(&self) -> f64 {
        self.cell
    }

    /// All ink, in the order of the pens; of the darkest pen, marks and labels first.
    pub fn marks(&self) -> Vec<SheetMark> {
        let mut marks = self.fiducials();
        marks.extend(self.labels());
        let cells = grid::cells(self.nibs.len());
        marks.extend(cells.iter().flat_map(|cell| self.patch(cell)));
        marks.sort_by_key(|mark| mark.pen);
        marks
    }

    /// Coverages of the ramp's steps that the pen's lines make if they are as wide as its nib, 0 to 1.
    ///
    /// # Panics
    /// If there is no such pen.
    pub fn ramp(&self, pen: usize) -> [f64; 4] {
        nominal(self.nibs[pen], self.cell)
    }

    fn fiducials(&self) -> Vec<SheetMark> {
        let [outer, inner] = grid::RING.map(|radius| radius * self.cell);
        let mut shapes: Vec<SheetShape> = Vec::new();
        for (i, corner) in grid::CORNERS.into_iter().enumerate() {
            let (centre, radius) = (self.placed * corner, grid::DISC * self.cell);
            shapes.push(SheetShape::Ring { centre, outer, inner });
            shapes.push(if i == 0 {
                SheetShape::Ring { centre, outer: radius, inner: grid::HOLE * self.cell }
            } else {
                SheetShape::Disc { centre, radius }
            });
        }
        let bits = code::bits(self.nibs.len(), self.cell);
        shapes.extend(bits.iter().enumerate().map(|(i, bit)| self.rect(grid::bar(i, *bit))));
        let radius = grid::NODE * self.cell;
        shapes.extend(grid::nodes().map(|node| SheetShape::Disc { centre: self.placed * node, radius }));
        let field = grid::GREY;
        let corners =
            [(field.x0, field.y0), (field.x1, field.y0), (field.x1, field.y1), (field.x0, field.y1), (field.x0, field.y0)];
        shapes.push(self.line(corners.map(Point::from)));
        shapes.into_iter().map(|shape| SheetMark { pen: self.darkest, role: SheetRole::Fiducial, shape }).collect()
    }

    /// The pens' numbers below their patches, if the darkest pen's nib is fine enough.
    fn labels(&self) -> Vec<SheetMark> {
        let mut marks = Vec::new();
        if self.nibs[self.darkest] * READABLE > grid::LABEL * self.cell {
            return marks;
        }
        for cell in grid::cells(self.nibs.len()) {
            let text = match cell.patch {
                Patch::Paper | Patch::All => continue,
                Patch::Solid(pen) => (pen + 1).to_string(),
                Patch::Pair(a, b) => format!("{}+{}", a + 1, b + 1),
                Patch::Ramp(pen, step) => format!("{} {:.0}%", pen + 1, 100.0 * self.ramp(pen)[step]),
            };
            let left = cell.centre.x - 0.5 * font::width(&text, grid::LABEL);
            let top = cell.area().y1 + 0.5 * (1.0 - grid::PATCH - grid::LABEL);
            let lines = font::written(&text, Point::new(left, top), grid::LABEL);
            let shapes = lines.into_iter().map(|line| self.line(line));
            marks.extend(shapes.map(|shape| SheetMark { pen: self.darkest, role: SheetRole::Label, shape }));
        }
        marks
    }

    fn patch(&self, cell: &Cell) -> Vec<SheetMark> {
        let solid = |pen| SheetMark { pen, role: SheetRole::Solid, shape: self.rect(cell.area()) };
        match cell.patch {
            Patch::Paper => Vec::new(),
            Patch::Solid(pen) => vec![solid(pen)],
            Patch::Pair(a, b) => vec![solid(a), solid(b)],
            Patch::All => (0..self.nibs.len()).map(solid).collect(),
            Patch::Ramp(pen, step) => self.hatch(cell, pen, step),
        }
    }

    /// Upright lines at even distances; those beyond the window continue the pattern to the patch's border.
    fn hatch(&self, cell: &Cell, pen: usize, step: usize) -> Vec<SheetMark> {
        let nib = self.nibs[pen] / self.cell;
        let (lines, pitch) = grid::hatch(step, nib, grid::WINDOW);
        let beyond = ((0.5 * (grid::PATCH - grid::WINDOW - nib) / pitch + 0.5).floor()).max(0.0) as i32;
        let (left, half) = (cell.window().x0, 0.5 * (grid::PATCH - nib));
        let at = |i: i32| left + (f64::from(i) + 0.5) * pitch;
        let line = |i: i32| self.line([-half, half].map(|dy| Point::new(at(i), cell.centre.y + dy)));
        (-beyond..lines as i32 + beyond).map(|i| SheetMark { pen, role: SheetRole::Ramp, shape: line(i) }).collect()
    }

    fn rect(&self, area: Rect) -> SheetShape {
        SheetShape::Rect(self.placed.transform_rect_bbox(area))
    }

    fn line(&self, points: impl IntoIterator<Item = Point>) -> SheetShape {
        SheetShape::Line(points.into_iter().map(|p| self.placed * p).collect())
    }
}

/// Coverages of the ramp's steps for a nib and a cell, both in millimetres.
pub(super) fn nominal(nib: f64, cell: f64) -> [f64; 4] {
    let width = nib / cell;
    std::array::from_fn(|step| width / grid::hatch(step, width, grid::WINDOW).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extent(marks: &[SheetMark]) -> Rect {
        let boxes = marks.iter().map(|mark| match &mark.shape {
            SheetShape::Rect(rect) => *rect,
            SheetShape::Disc { centre, radius } | SheetShape::Ring { centre, outer: radius, .. } => {
                Rect::from_center_size(*centre, (2.0 * radius, 2.0 * radius))
            }
            SheetShape::Line(points) => points.iter().fold(Rect::from_points(points[0], points[0]), |b, p| b.union_pt(*p)),
        });
        boxes.reduce(|a, b| a.union(b)).unwrap()
    }

    #[test]
    fn sheets_keep_their_margin_on_every_page() {
        for page in [[148.0, 210.0], [210.0, 297.0], [297.0, 210.0], [215.9, 279.4], [841.0, 1189.0]] {
            for pens in 1..=8 {
                let sheet = PenSheet::new(page, 7.0, &vec![0.35; pens], pens - 1).unwrap();
                let extent = extent(&sheet.marks());
                assert!(extent.x0 >= 7.0 && extent.x1 <= page[0] - 7.0, "{page:?} {extent:?}");
                assert!(extent.y0 >= 7.0 && extent.y1 <= page[1] - 7.0, "{page:?} {extent:?}");
                let long = extent.width().max(extent.height()) / sheet.cell();
                assert!((13.0..14.0).contains(&long), "{long}");
            }
        }
    }

    #[test]
    fn ramps_cover_what_they_say() {
        let sheet = PenSheet::new([148.0, 210.0], 8.0, &[0.3, 0.8], 0).unwrap();
        for pen in 0..2 {
            let cells = grid::cells(2);
            let cell = cells.iter().find(|cell| cell.patch == Patch::Ramp(pen, 2)).unwrap();
            let lines = sheet.hatch(cell, pen, 2);
            let (nib, window) = ([0.3, 0.8][pen], grid::WINDOW * sheet.cell());
            let middle = sheet.placed * cell.centre;
            let inside =
                |mark: &&SheetMark| matches!(&mark.shape, SheetShape::Line(p) if (p[0].x - middle.x).abs() < 0.5 * window);
            let made = lines.iter().filter(inside).count() as f64 * nib / window;
            assert!((made - sheet.ramp(pen)[2]).abs() < 1e-9 && (made - 0.5).abs() < 0.07, "{made}");
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        let small = PenSheet::new([105.0, 148.0], 8.0, &[0.3], 0).unwrap_err();
        assert_eq!(small, SheetError::PageTooSmall { page: [105.0, 148.0], needed: [126.0, 170.0], broadest: 0.3 });
        assert!(matches!(PenSheet::new([148.0, 210.0], 8.0, &[1.5], 0), Err(SheetError::PageTooSmall { .. })));
        assert!(matches!(PenSheet::new([148.0, 210.0], 8.0, &[0.3; 9], 0), Err(SheetError::PenCount { given: 9, .. })));
        assert!(matches!(PenSheet::new([148.0, 210.0], 8.0, &[], 0), Err(SheetError::PenCount { given: 0, .. })));
        assert!(matches!(PenSheet::new([148.0, 210.0], 8.0, &[f64::NAN], 0), Err(SheetError::Nib { .. })));
        assert!(PenSheet::new([f64::NAN, 210.0], f64::NAN, &[0.3], 0).is_err());
    }
}
