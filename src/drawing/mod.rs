//! The stroke model: what a style produces, a press prints and a plotter draws.
//!
//! A [`Drawing`] is a page with layers of marks in painting order, in millimetres, y down, origin at the sheet's top left corner.
//! It knows nothing of pixels, machines or file formats.

mod colour;
mod cut;
mod held;
mod mark;
mod seen;
mod stroke;

pub use crate::geometry::Ends;
pub use colour::{Colour, ColourError, Ink};
pub use mark::{Area, Dot, Mark};
pub use stroke::{Stroke, Width};

use crate::geometry::{Affine, BezPath, Rect};

/// A sheet of paper with layers of ink.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The sheet.
    pub page: Page,
    /// Layers in painting order, the lowest first.
    pub layers: Vec<Layer>,
}

/// One item in painting order.
#[derive(Clone, Debug, PartialEq)]
pub enum Painted {
    /// A mark, by its layer and its index there.
    Mark {
        /// Index of the layer.
        layer: usize,
        /// Index of the mark.
        mark: usize,
    },
    /// White paint the colour of paper: it is never ink but hides what it covers.
    White(BezPath),
}

/// A sheet of paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Page {
    /// Width in millimetres, above 0.
    pub width: f64,
    /// Height in millimetres, above 0.
    pub height: f64,
    /// The paper's colour. Marks of this colour are still ink.
    pub paper: Colour,
}

/// Marks that one pen draws.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// The layer's name in files and reports, such as `dots`.
    pub name: String,
    /// The pen's number, from 1.
    pub pen: u32,
    /// The ink of marks without a colour of their own.
    pub ink: Ink,
    /// How its marks combine with what lies below.
    pub mixing: Mixing,
    /// Pause, speed and delay on a plotter.
    pub handling: Handling,
    /// Marks in painting order.
    pub marks: Vec<Mark>,
}

/// Pause, speed and delay of a layer on a plotter, as set by layer labels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Handling {
    /// Wait for the user first.
    pub pauses: bool,
    /// Drawing speed in percent of the machine's.
    pub speed_percent: Option<f64>,
    /// Wait this long first, in seconds.
    pub delay_seconds: f64,
}

impl Handling {
    /// The drawing speed, given the machine's usual one. The percentage is clamped to 1 to 500, since an `AxiDraw`'s maximum is
    /// 4.4 times its usual speed.
    pub fn speed(&self, machine: f64) -> f64 {
        machine * self.speed_percent.unwrap_or(100.0).clamp(1.0, 500.0) / 100.0
    }
}

/// How ink combines with what lies below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mixing {
    /// Ink on ink: what lies below stays.
    Add,
    /// Opaque paint: what lies below is hidden and need not be drawn.
    Paint,
}

impl Page {
    /// A white sheet.
    pub const fn new(width: f64, height: f64) -> Self {
        Self { width, height, paper: Colour::WHITE }
    }

    /// The sheet as a rectangle from (0, 0).
    pub const fn rect(&self) -> Rect {
        Rect::new(0.0, 0.0, self.width, self.height)
    }
}

impl Layer {
    /// An empty layer in black.
    pub fn new(name: &str, pen: u32) -> Self {
        Self {
            name: name.to_owned(),
            pen,
            ink: Ink::Black,
            mixing: Mixing::Add,
            handling: Handling::default(),
            marks: Vec::new(),
        }
    }

    /// Sum of the marks' areas in square millimetres. Overlaps count for each mark.
    pub fn ink_mm2(&self) -> f64 {
        self.marks.iter().map(Mark::area).sum()
    }

    /// Number of dots, strokes and areas in the layer.
    pub fn counts(&self) -> [usize; 3] {
        self.marks.iter().fold([0; 3], |mut counts, mark| {
            counts[match mark {
                Mark::Dot(_) => 0,
                Mark::Stroke(_) => 1,
                Mark::Area(_) => 2,
            }] += 1;
            counts
        })
    }
}

impl Drawing {
    /// The smallest rectangle around all ink, or none if there are no marks.
    pub fn bounding_box(&self) -> Option<Rect> {
        self.marks().map(Mark::bounding_box).reduce(|a, b| a.union(b))
    }

    /// All marks from the lowest to the topmost, layer by layer.
    pub fn painting_order(&self) -> Vec<Painted> {
        let marks = |(layer, it): (usize, &Layer)| (0..it.marks.len()).map(move |mark| Painted::Mark { layer, mark });
        self.layers.iter().enumerate().flat_map(marks).collect()
    }

    /// Every mark of every layer.
    pub fn marks(&self) -> impl Iterator<Item = &Mark> {
        self.layers.iter().flat_map(|layer| &layer.marks)
    }

    /// The drawing moved, rotated or uniformly scaled; the page is unchanged.
    #[must_use]
    pub fn transformed(&self, transform: Affine) -> Self {
        let mut moved = self.clone();
        for layer in &mut moved.layers {
            layer.marks = layer.marks.iter().map(|mark| mark.transformed(transform)).collect();
        }
        moved
    }

    /// The drawing without what lies outside `rect`. Dots that cross the border are cut.
    #[must_use]
    pub fn clipped(&self, rect: Rect) -> Self {
        let mut cut = self.clone();
        for layer in &mut cut.layers {
            layer.marks = layer.marks.iter().flat_map(|mark| mark.clipped(rect)).collect();
        }
        cut
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

    fn drawing() -> Drawing {
        let mut layer = Layer::new("dots", 1);
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(1.0, 1.0), 0.5)));
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(9.9, 5.0), 0.5)));
        Drawing { page: Page::new(10.0, 10.0), layers: vec![layer] }
    }

    #[test]
    fn ink_is_the_sum_of_the_marks() {
        assert!((drawing().layers[0].ink_mm2() - 0.5 * std::f64::consts::PI).abs() < 1e-9);
        assert_eq!(drawing().layers[0].counts(), [2, 0, 0]);
    }

    #[test]
    fn clipping_keeps_everything_on_the_page() {
        let cut = drawing().clipped(Rect::new(0.0, 0.0, 10.0, 10.0));
        assert_eq!(cut.layers[0].counts(), [2, 0, 0]);
        let bounds = cut.bounding_box().unwrap();
        assert!(bounds.x1 <= 10.0 && bounds.x0 >= 0.5 - 1e-9);
        let whole = drawing().layers[0].ink_mm2();
        assert!(cut.layers[0].ink_mm2() < whole);
    }

    #[test]
    fn scaling_scales_ink_by_its_square() {
        let twice = drawing().transformed(Affine::scale(2.0));
        assert!((twice.layers[0].ink_mm2() - 4.0 * drawing().layers[0].ink_mm2()).abs() < 1e-9);
    }
}
