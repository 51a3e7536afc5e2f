//! Outlines as path data, on the grid of 0.001 mm.

use crate::geometry::{BezPath, Point};
use crate::write::number::{decimal, thousandths};
use kurbo::PathEl;

/// Path data in relative coordinates on the grid of 0.001 mm.
pub(crate) fn path_data(text: &mut String, path: &BezPath) {
    let mut writer = PathData { text, at: (0, 0), start: (0, 0), last: ' ' };
    for element in path.elements() {
        match *element {
            PathEl::MoveTo(p) => writer.move_to(p),
            PathEl::LineTo(p) => writer.relative('l', &[p]),
            PathEl::QuadTo(a, p) => writer.relative('q', &[a, p]),
            PathEl::CurveTo(a, b, p) => writer.relative('c', &[a, b, p]),
            PathEl::ClosePath => writer.close(),
        }
    }
}

struct PathData<'a> {
    text: &'a mut String,
    at: (i64, i64),
    start: (i64, i64),
    last: char,
}

impl PathData<'_> {
    fn move_to(&mut self, p: Point) {
        let (x, y) = (thousandths(p.x), thousandths(p.y));
        self.text.push('M');
        decimal(self.text, x, 3);
        self.text.push(' ');
        decimal(self.text, y, 3);
        self.at = (x, y);
        self.start = (x, y);
        self.last = 'M';
    }

    /// A command whose points are relative to where the pen is; the letter is left out when it repeats.
    fn relative(&mut self, command: char, points: &[Point]) {
        let mut separated = self.last != command;
        if separated {
            self.text.push(command);
            self.last = command;
        }
        let mut end = self.at;
        for p in points {
            end = (thousandths(p.x), thousandths(p.y));
            for value in [end.0 - self.at.0, end.1 - self.at.1] {
                // A sign or a second point separates too.
                let has_point = value.abs() < 1000 && value != 0;
                if !separated && value >= 0 && !(has_point && ends_in_fraction(self.text)) {
                    self.text.push(' ');
                }
                decimal(self.text, value, 3);
                separated = false;
            }
        }
        self.at = end;
    }

    fn close(&mut self) {
        self.text.push('z');
        self.at = self.start;
        self.last = 'z';
    }
}

/// True if the last number written has a decimal point.
fn ends_in_fraction(text: &str) -> bool {
    text.bytes().rev().find(|b| !b.is_ascii_digit()) == Some(b'.')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_separated_only_where_they_must_be() {
        let path = BezPath::from_svg("M1,2 C1.25,2.5 1.5,2 2.75,3.125 L2.75,4 L3.25,4.5 Z").unwrap();
        let mut text = String::new();
        path_data(&mut text, &path);
        assert_eq!(text, "M1 2c.25.5.5 0 1.75 1.125l0 .875.5.5z");
        assert_eq!(BezPath::from_svg(&text).unwrap().elements().len(), path.elements().len());
    }
}
