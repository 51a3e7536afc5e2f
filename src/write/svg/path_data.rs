//! Outlines and discs as path data, in relative coordinates on a grid.

use crate::geometry::{BezPath, Point};
use crate::write::number::decimal;
use kurbo::PathEl;

/// Places and radii are counted in 0.0001 mm.
const COUNTED_PER_MM: f64 = 10_000.0;

/// The grids of a file, in 0.0001 mm, and its unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    outlines: i64,
    radii: i64,
    /// Digits of the file's unit that are counted: 4 if it is the millimetre, 2 if it is 0.01 mm.
    digits: u32,
    steps: Steps,
}

/// The steps of an outline that are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Steps {
    /// All: a pen that goes nowhere draws a point.
    All,
    /// Those that are not nothing on the grid: filled shapes lose nothing.
    Long,
}

impl Grid {
    /// Of a sheet that a machine or a press reads: places to 0.001 mm, radii to 0.0001 mm, since 0.001 mm of a small dot's radius is a
    /// percent of its ink.
    pub(crate) const SHEET: Self = Self { outlines: 10, radii: 1, digits: 4, steps: Steps::All };
    /// Of a picture in a page: places to a pixel of a film at 2540 dpi, radii to a tenth of it. The unit is that pixel, 0.01 mm, so
    /// that places are whole numbers: a decimal point less each is a quarter of the file.
    pub(crate) const PAGE: Self = Self { outlines: 100, radii: 10, digits: 2, steps: Steps::Long };

    /// One of the file's units, as it is counted.
    const fn unit(self) -> i64 {
        10_i64.pow(self.digits)
    }

    /// The file's units in a millimetre.
    pub(crate) fn units_per_mm(self) -> f64 {
        COUNTED_PER_MM / self.unit() as f64
    }
}

/// Path data of one outline, or of an open line, of a sheet.
pub(crate) fn path_data(text: &mut String, path: &BezPath) {
    PathData::new(text, Grid::SHEET).outline(path);
}

/// Writes one path's data: the first move is absolute, everything else is relative to where it is.
pub(crate) struct PathData<'a> {
    text: &'a mut String,
    grid: Grid,
    at: [i64; 2],
    start: [i64; 2],
    /// The command that a number without a letter continues; none before the first.
    last: Option<char>,
}

impl<'a> PathData<'a> {
    pub(crate) const fn new(text: &'a mut String, grid: Grid) -> Self {
        Self { text, grid, at: [0, 0], start: [0, 0], last: None }
    }

    /// Appends an outline or an open line.
    pub(crate) fn outline(&mut self, path: &BezPath) {
        for element in path.elements() {
            match *element {
                PathEl::MoveTo(p) => self.move_to(p),
                PathEl::LineTo(p) => self.relative('l', &[p]),
                PathEl::QuadTo(a, p) => self.relative('q', &[a, p]),
                PathEl::CurveTo(a, b, p) => self.relative('c', &[a, b, p]),
                PathEl::ClosePath => self.close(),
            }
        }
    }

    /// Appends a disc as two half circles.
    pub(crate) fn disc(&mut self, centre: Point, radius: f64) {
        self.move_to(Point::new(centre.x - radius, centre.y));
        let radius = on_grid(radius, self.grid.radii);
        let across = 2 * radius;
        self.numbers('a', &[radius, radius, 0, 0, 0, across, 0, radius, radius, 0, 0, 0, -across, 0]);
        self.close();
    }

    /// Appends a disc as one arc that ends a step of the grid from its start, in three fifths of the text of two half circles. What
    /// the closing line cuts off is less than a thousandth of a dot of 0.1 mm.
    pub(crate) fn one_arc_disc(&mut self, centre: Point, radius: f64) {
        /// Below this radius in millimetres the closing line would cut off some of the ink.
        const LEAST_RADIUS: f64 = 0.02;
        if radius < LEAST_RADIUS {
            return self.disc(centre, radius);
        }
        let step = self.grid.outlines;
        self.move_to(Point::new(centre.x - 0.5 * step as f64 / COUNTED_PER_MM, centre.y - radius));
        let radius = on_grid(radius, self.grid.radii);
        let large = self.grid.unit();
        self.numbers('a', &[radius, radius, 0, large, 0, step, 0]);
        self.close();
    }

    /// A command with these numbers.
    fn numbers(&mut self, command: char, values: &[i64]) {
        let mut is_separated = self.command(command);
        for value in values {
            self.number(*value, is_separated);
            is_separated = false;
        }
    }

    fn place(&self, p: Point) -> [i64; 2] {
        [on_grid(p.x, self.grid.outlines), on_grid(p.y, self.grid.outlines)]
    }

    fn move_to(&mut self, p: Point) {
        let to = self.place(p);
        let [x, y] = if self.last.is_none() {
            self.text.push('M');
            self.last = Some('M');
            to
        } else {
            self.text.push('m');
            // Numbers that follow are a line.
            self.last = Some('l');
            [to[0] - self.at[0], to[1] - self.at[1]]
        };
        self.number(x, true);
        self.number(y, false);
        (self.at, self.start) = (to, to);
    }

    /// A command whose points are relative to where the pen is; none if they all are where it is.
    fn relative(&mut self, command: char, points: &[Point]) {
        if self.grid.steps == Steps::Long && points.iter().all(|p| self.place(*p) == self.at) {
            return;
        }
        let mut is_separated = self.command(command);
        let mut end = self.at;
        for p in points {
            end = self.place(*p);
            for value in [end[0] - self.at[0], end[1] - self.at[1]] {
                self.number(value, is_separated);
                is_separated = false;
            }
        }
        self.at = end;
    }

    /// A command's letter, left out where it repeats; true if it was written.
    fn command(&mut self, command: char) -> bool {
        let is_new = self.last != Some(command);
        if is_new {
            self.text.push(command);
            self.last = Some(command);
        }
        is_new
    }

    /// A number, with a space before it unless a letter, its sign or its decimal point separates it from the one before.
    fn number(&mut self, value: i64, is_separated: bool) {
        let has_point = value != 0 && value.abs() < self.grid.unit();
        if !is_separated && value >= 0 && !(has_point && ends_in_fraction(self.text)) {
            self.text.push(' ');
        }
        decimal(self.text, value, self.grid.digits);
    }

    fn close(&mut self) {
        self.text.push('z');
        self.at = self.start;
        self.last = Some('z');
    }
}

/// A length in 0.0001 mm, a multiple of `step` of them.
fn on_grid(mm: f64, step: i64) -> i64 {
    (mm * COUNTED_PER_MM / step as f64).round() as i64 * step
}

/// True if the last number written has a decimal point.
fn ends_in_fraction(text: &str) -> bool {
    text.bytes().rev().find(|b| !b.is_ascii_digit()) == Some(b'.')
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Shape;

    #[test]
    fn numbers_are_separated_only_where_they_must_be() {
        let path = BezPath::from_svg("M1,2 C1.25,2.5 1.5,2 2.75,3.125 L2.75,4 L3.25,4.5 Z").unwrap();
        let mut text = String::new();
        path_data(&mut text, &path);
        assert_eq!(text, "M1 2c.25.5.5 0 1.75 1.125l0 .875.5.5z");
        assert_eq!(BezPath::from_svg(&text).unwrap().elements().len(), path.elements().len());
    }

    /// A shape loses nothing without them; of a line with round ends they are its points.
    #[test]
    fn steps_of_no_length_are_left_out_of_shapes_alone() {
        let path = BezPath::from_svg("M1,2 L2,2 L2.001,2 C2.001,2.001 2,2.002 2,2 L2,3 Z").unwrap();
        let data = |grid: Grid| {
            let mut text = String::new();
            PathData::new(&mut text, grid).outline(&path);
            text
        };
        assert_eq!(data(Grid::PAGE), "M100 200l100 0 0 100z");
        assert!(data(Grid::SHEET).contains('c'), "{}", data(Grid::SHEET));
    }

    #[test]
    fn several_outlines_and_discs_stay_where_they_are() {
        let mut text = String::new();
        let mut data = PathData::new(&mut text, Grid::PAGE);
        data.disc(Point::new(3.0, 4.0), 0.5);
        data.outline(&BezPath::from_svg("M6,4 L6.5,4.125 L6,5 Z M1,1 L2,1").unwrap());
        data.outline(&BezPath::from_svg("M2,2 L2.25,3").unwrap());
        assert_eq!(text, "M250 400a50 50 0 0 0 100 0 50 50 0 0 0-100 0zm350 0 50 13-50 87zm-500-300 100 0m0 100 25 100",);
        let read = BezPath::from_svg(&text).unwrap();
        let parts: Vec<BezPath> = read.elements().split(|e| matches!(e, PathEl::MoveTo(_))).map(|_| BezPath::new()).collect();
        assert_eq!(parts.len(), 5, "four moves");
        assert!((read.bounding_box().x1 - 650.0).abs() < 1e-9 && (read.bounding_box().y1 - 500.0).abs() < 1e-9);
    }

    #[test]
    fn a_disc_of_one_arc_is_a_disc() {
        for radius in [0.01, 0.02, 0.05, 0.166, 0.4] {
            let mut text = String::new();
            PathData::new(&mut text, Grid::PAGE).one_arc_disc(Point::new(3.0, 4.0), radius);
            let read = BezPath::from_svg(&text).unwrap();
            let share = read.area().abs() / (std::f64::consts::PI * (100.0 * radius).powi(2));
            assert!((share - 1.0).abs() < 0.006, "{text}: {share}");
            assert!(read.bounding_box().center().distance(Point::new(300.0, 400.0)) < 0.8, "{text}");
            let mut halves = String::new();
            PathData::new(&mut halves, Grid::PAGE).disc(Point::new(3.0, 4.0), radius);
            assert!(read.area() * BezPath::from_svg(&halves).unwrap().area() > 0.0, "they turn alike");
        }
    }
}
