//! Tool paths as the marks that they leave on the paper.

use super::{Job, PenPaths, Plot, Toolpath};
use crate::drawing::{Dot, Drawing, Ink, Layer, Mark, Stroke};
use crate::geometry::BezPath;
use crate::write::write_marks;
use std::io;

impl Job<'_> {
    /// Writes its tool paths as JSON in drawing order: lines with the nib's width, touches as dots with its radius.
    pub fn write_marks(&self, mut out: impl io::Write) -> io::Result<()> {
        let plot = self.plot();
        write_marks(&as_drawn(plot), |layer| plot.pens[layer].nib, &mut out)
    }
}

/// The drawing that the nibs leave: a layer per use of a pen, its marks in drawing order. A path is a stroke of the nib's width, a
/// touch is a dot.
fn as_drawn(plot: &Plot) -> Drawing {
    Drawing { page: plot.page, layers: plot.pens.iter().map(layer).collect() }
}

fn layer(pen: &PenPaths) -> Layer {
    let marks = pen.paths.iter().map(|path| mark(path, pen.nib)).collect();
    Layer { ink: Ink::Colour(pen.colour), handling: pen.handling, marks, ..Layer::new(&pen.name, pen.number) }
}

fn mark(path: &Toolpath, nib: f64) -> Mark {
    if path.is_touch() {
        return Mark::Dot(Dot::circle(path.first(), 0.5 * nib));
    }
    let mut curve = BezPath::new();
    curve.move_to(path.first());
    path.points()[1..].iter().for_each(|p| curve.line_to(*p));
    Mark::Stroke(Stroke::even(curve, nib).in_group(path.group))
}
