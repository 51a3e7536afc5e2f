//! Several drawings on one sheet, with the same pens' layers merged.

use crate::drawing::{Drawing, Layer, Mark, Page, Stroke};
use crate::geometry::{Affine, BezPath, Point, Rect};
use thiserror::Error;

/// Crop marks: their length, their distance from the corner and their width in millimetres, as printers use them.
const CROP_LENGTH: f64 = 4.0;
const CROP_DISTANCE: f64 = 2.0;
const CROP_WIDTH: f64 = 0.1;
/// Differences of lengths that are rounding, in millimetres.
const ROUNDING: f64 = 1e-6;

/// Why drawings do not go on a sheet.
#[derive(Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SheetError {
    /// More drawings than cells.
    #[error("{drawings} drawings are more than the {cells} cells of the sheet")]
    TooMany {
        /// Number of drawings.
        drawings: usize,
        /// Number of cells.
        cells: usize,
    },
    /// Margins and gaps leave nothing.
    #[error("margin and gaps leave no room for {columns} x {rows} cells on a sheet of {width} x {height} mm")]
    NoRoom {
        /// Cells side by side.
        columns: usize,
        /// Cells above one another.
        rows: usize,
        /// The sheet's width in millimetres.
        width: f64,
        /// The sheet's height in millimetres.
        height: f64,
    },
}

/// The cells of a sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The sheet.
    pub page: Page,
    /// Free border in millimetres.
    pub margin: f64,
    /// Space between cells in millimetres.
    pub gap: f64,
    /// Cells side by side, from 1.
    pub columns: usize,
    /// Cells above one another, from 1.
    pub rows: usize,
}

/// Whether corners of the pictures are marked for cutting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CropMarks {
    /// Not marked.
    #[default]
    None,
    /// Two short lines at each corner.
    Corners,
}

/// A drawing and the box of its picture, which is placed and cut out.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The drawing.
    pub drawing: Drawing,
    /// The part of its page that matters, in millimetres.
    pub picture: Rect,
}

impl Grid {
    /// The grid for a number of pictures on a page: about as wide as high in cells of the picture's proportions.
    pub fn for_count(count: usize, page: Page, picture: (f64, f64)) -> (usize, usize) {
        let rows_for = |columns: usize| count.div_ceil(columns);
        // The cells in which such a picture is largest.
        let side = |columns: usize| {
            let (width, height) = (page.width / columns as f64, page.height / rows_for(columns) as f64);
            (width / picture.0).min(height / picture.1)
        };
        let best = (1..=count.max(1)).max_by(|a, b| side(*a).total_cmp(&side(*b)).then(b.cmp(a))).unwrap_or(1);
        (best, rows_for(best).max(1))
    }

    /// The cells by rows from the upper left corner.
    pub fn cells(&self) -> Result<Vec<Rect>, SheetError> {
        let side = |length: f64, count: usize| (length - 2.0 * self.margin - self.gap * (count as f64 - 1.0)) / count as f64;
        let (width, height) = (side(self.page.width, self.columns), side(self.page.height, self.rows));
        if width < 1.0 || height < 1.0 {
            let (columns, rows) = (self.columns, self.rows);
            return Err(SheetError::NoRoom { columns, rows, width: self.page.width, height: self.page.height });
        }
        let at = |column: usize, row: usize| {
            let corner =
                Point::new(self.margin + column as f64 * (width + self.gap), self.margin + row as f64 * (height + self.gap));
            Rect::from_origin_size(corner, (width, height))
        };
        Ok((0..self.rows).flat_map(|row| (0..self.columns).map(move |column| at(column, row))).collect())
    }

    /// The pieces in their cells, each in the middle and at its own size unless that is larger than the cell. Layers of one pen, ink
    /// and way of mixing are one layer, so that a plotter changes pens once.
    pub fn filled(&self, pieces: &[Piece], marks: CropMarks) -> Result<Drawing, SheetError> {
        let cells = self.cells()?;
        if pieces.len() > cells.len() {
            return Err(SheetError::TooMany { drawings: pieces.len(), cells: cells.len() });
        }
        let mut sheet = Drawing { page: self.page, layers: Vec::new() };
        let mut crops = Layer::new("crop marks", 1);
        let mut groups = 0;
        for (piece, cell) in pieces.iter().zip(cells) {
            let scale = scale_into(piece.picture, cell);
            let move_to = Affine::translate(cell.center().to_vec2())
                * Affine::scale(scale)
                * Affine::translate(-piece.picture.center().to_vec2());
            groups = add(&mut sheet, &piece.drawing.transformed(move_to), groups);
            if marks == CropMarks::Corners {
                let picture = Rect::from_center_size(cell.center(), piece.picture.size() * scale);
                crops.marks.extend(crop_marks(picture));
            }
        }
        if !crops.marks.is_empty() {
            sheet.layers.push(crops);
        }
        Ok(sheet)
    }
}

/// The scale at which a picture fits into a cell; it never grows.
pub fn scale_into(picture: Rect, cell: Rect) -> f64 {
    let scale = (cell.width() / picture.width()).min(cell.height() / picture.height());
    if scale > 1.0 - ROUNDING { 1.0 } else { scale }
}

/// Adds a drawing's layers to those of the same pen; returns the first free number of a group.
fn add(sheet: &mut Drawing, drawing: &Drawing, first_group: u32) -> u32 {
    let mut next = first_group;
    for layer in &drawing.layers {
        let mut layer = layer.clone();
        for mark in &mut layer.marks {
            if let Mark::Stroke(Stroke { group: Some(group), .. }) = mark {
                *group += first_group;
                next = next.max(*group + 1);
            }
        }
        let is_alike = |other: &&mut Layer| {
            (other.pen, &other.ink, other.mixing, other.handling) == (layer.pen, &layer.ink, layer.mixing, layer.handling)
        };
        match sheet.layers.iter_mut().find(is_alike) {
            Some(known) => known.marks.append(&mut layer.marks),
            None => sheet.layers.push(layer),
        }
    }
    next
}

fn crop_marks(picture: Rect) -> Vec<Mark> {
    let corners = [(picture.x0, picture.y0, -1.0, -1.0), (picture.x1, picture.y0, 1.0, -1.0)]
        .into_iter()
        .chain([(picture.x0, picture.y1, -1.0, 1.0), (picture.x1, picture.y1, 1.0, 1.0)]);
    let line = |from: Point, to: Point| {
        let mut curve = BezPath::new();
        curve.move_to(from);
        curve.line_to(to);
        Mark::Stroke(Stroke::even(curve, CROP_WIDTH))
    };
    let (near, far) = (CROP_DISTANCE, CROP_DISTANCE + CROP_LENGTH);
    corners
        .flat_map(|(x, y, dx, dy)| {
            [
                line(Point::new(x + near * dx, y), Point::new(x + far * dx, y)),
                line(Point::new(x, y + near * dy), Point::new(x, y + far * dy)),
            ]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Dot;

    fn piece(width: f64, height: f64, pen: u32) -> Piece {
        let mut layer = Layer::new("dots", pen);
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(0.5 * width, 0.5 * height), 1.0)));
        Piece {
            drawing: Drawing { page: Page::new(width, height), layers: vec![layer] },
            picture: Rect::new(0.0, 0.0, width, height),
        }
    }

    fn grid(columns: usize, rows: usize) -> Grid {
        Grid { page: Page::new(100.0, 60.0), margin: 5.0, gap: 10.0, columns, rows }
    }

    #[test]
    fn pictures_lie_in_the_middle_of_their_cells_and_never_grow() {
        let sheet = grid(2, 1).filled(&[piece(10.0, 10.0, 1), piece(80.0, 20.0, 1)], CropMarks::None).unwrap();
        assert_eq!(sheet.layers.len(), 1);
        let boxes: Vec<Rect> = sheet.marks().map(Mark::bounding_box).collect();
        assert!((boxes[0].center() - Point::new(25.0, 30.0)).hypot() < 1e-9 && (boxes[0].width() - 2.0).abs() < 1e-9);
        assert!((boxes[1].center() - Point::new(75.0, 30.0)).hypot() < 1e-9 && (boxes[1].width() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn pens_keep_their_layers_and_crop_marks_have_their_own() {
        let sheet = grid(2, 2).filled(&[piece(9.0, 9.0, 1), piece(9.0, 9.0, 2), piece(9.0, 9.0, 1)], CropMarks::Corners).unwrap();
        let counts: Vec<usize> = sheet.layers.iter().map(|layer| layer.marks.len()).collect();
        assert_eq!(counts, [2, 1, 24]);
        assert_eq!(sheet.layers[2].name, "crop marks");
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let many = vec![piece(9.0, 9.0, 1); 3];
        assert_eq!(grid(2, 1).filled(&many, CropMarks::None), Err(SheetError::TooMany { drawings: 3, cells: 2 }));
        assert!(matches!(grid(10, 1).cells(), Err(SheetError::NoRoom { .. })));
    }

    #[test]
    fn a_grid_suits_the_pictures() {
        let a4 = Page::new(210.0, 297.0);
        assert_eq!(Grid::for_count(1, a4, (90.0, 120.0)), (1, 1));
        assert_eq!(Grid::for_count(4, a4, (90.0, 120.0)), (2, 2));
        assert_eq!(Grid::for_count(3, Page::new(300.0, 100.0), (90.0, 120.0)), (3, 1));
    }
}
