//! A test on the sheet: a small drawing with a label above it.

use crate::geometry::stroke_letters as font;
use crate::geometry::{Point, Vec2};
use crate::plot::Toolpath;

/// Gap between tests, in millimetres.
pub(super) const GAP: f64 = 1.5;

/// A path with its pen and speed.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    /// The pen's number.
    pub pen: u32,
    /// Speed in percent of the machine's.
    pub speed_percent: Option<u32>,
    /// In the cell's own millimetres until the sheet is laid out.
    pub path: Toolpath,
}

/// A test with its label; its origin is the upper left corner.
#[derive(Clone, Debug, Default)]
pub(super) struct Cell {
    pub width: f64,
    pub height: f64,
    pub drawn: Vec<Drawn>,
}

impl Cell {
    /// A cell with text only.
    pub(super) fn text(text: &str, height: f64) -> Self {
        let mut cell = Self { width: font::width(text, height), height, drawn: Vec::new() };
        font::written(text, Point::ORIGIN, height).into_iter().for_each(|line| cell.add(line));
        cell
    }

    /// A label above an empty drawing of this size, and the offset at which the drawing begins.
    pub(super) fn labelled(label: &str, text_height: f64, width: f64, height: f64) -> (Self, Vec2) {
        let mut cell = Self::text(label, text_height);
        let top = text_height + 1.0;
        cell.width = cell.width.max(width);
        cell.height = top + height;
        (cell, Vec2::new(0.0, top))
    }

    /// Adds a line of the first pen.
    pub(super) fn add(&mut self, points: Vec<Point>) {
        Toolpath::new(points).into_iter().for_each(|path| self.add_path(path));
    }

    /// Adds a path of the first pen.
    pub(super) fn add_path(&mut self, path: Toolpath) {
        self.drawn.push(Drawn::by_first_pen(path));
    }

    /// The cell's paths with its corner at a place on the sheet.
    pub(super) fn placed(self, at: Vec2) -> Vec<Drawn> {
        self.drawn.into_iter().map(|drawn| drawn.moved(at)).collect()
    }
}

impl Drawn {
    /// A path of the first pen at its own speed.
    pub(super) const fn by_first_pen(path: Toolpath) -> Self {
        Self { pen: 1, speed_percent: None, path }
    }

    pub(super) fn moved(self, by: Vec2) -> Self {
        Self { path: self.path.moved(by), ..self }
    }
}

/// The outline of a square, closed.
pub(super) fn square(corner: Point, side: f64) -> Toolpath {
    let corners = [(side, 0.0), (side, side), (0.0, side), (0.0, 0.0)];
    Toolpath::through(corner, corners.map(|(x, y)| corner + Vec2::new(x, y)))
}
