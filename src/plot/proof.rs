//! Proof of a plot as SVG: what its ink looks like on paper when the pens are not quite in register.

use super::preview::{ink, layer, number, rectangle};
use super::{Job, Plot};
use crate::drawing::Colour;
use crate::elementary::Elementary as _;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::io;

/// Direction of the first pen's error, in turns; no pen's lies along an axis.
const FIRST: f64 = 0.1;

impl Job<'_> {
    /// Writes what its ink looks like on paper as an SVG, with pens that miss each other by up to `registration_mm`, from 0.
    pub fn write_proof(&self, registration_mm: f64, mut out: impl io::Write) -> io::Result<()> {
        write_proof(self.plot(), registration_mm, &mut out)
    }
}

/// Writes the inks in their own colours, multiplied where they lie on one another. Each pen misses in a direction of its own, so that
/// two pens are at most `registration` millimetres off one another. Ink that takes no light from the paper covers what is below.
fn write_proof(plot: &Plot, registration: f64, out: &mut dyn io::Write) -> io::Result<()> {
    let sheet = plot.page.rect();
    let (width, height) = (number(sheet.width()), number(sheet.height()));
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
         width=\"{width}mm\" height=\"{height}mm\" viewBox=\"0 0 {width} {height}\">\n"
    );
    layer(&mut text, "% sheet", &rectangle(sheet, &format!("fill=\"{}\"", plot.page.paper)));
    let mut numbers: Vec<u32> = plot.pens.iter().map(|pen| pen.number).collect();
    numbers.sort_unstable();
    numbers.dedup();
    for pen in &plot.pens {
        let place = numbers.iter().position(|number| *number == pen.number).unwrap_or(0);
        let angle = TAU * (place as f64 / numbers.len() as f64 + FIRST);
        let off = if numbers.len() > 1 { 0.5 * registration } else { 0.0 };
        let (x, y) = (number(off * angle.cosine()), number(off * angle.sine()));
        let blend = if takes_light(pen.colour, plot.page.paper) { " style=\"mix-blend-mode:multiply\"" } else { "" };
        let _ = writeln!(text, "<g transform=\"translate({x} {y})\"{blend}>");
        text += &ink(pen, pen.colour);
        text.push_str("</g>\n");
        out.write_all(text.as_bytes())?;
        text.clear();
    }
    out.write_all(b"</svg>\n")
}

fn takes_light(ink: Colour, paper: Colour) -> bool {
    ink.r < paper.r || ink.g < paper.g || ink.b < paper.b
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Handling, Page};
    use crate::geometry::Point;
    use crate::plot::{PenPaths, Toolpath};

    #[test]
    fn pens_miss_each_other_by_no_more_than_was_said() {
        let pen = |number: u32, colour: &str| PenPaths {
            number,
            name: format!("pen {number}"),
            colour: colour.parse().unwrap(),
            nib: 0.3,
            handling: Handling::default(),
            paths: vec![Toolpath::through(Point::new(10.0, 10.0), [Point::new(20.0, 10.0)])],
        };
        let pens = vec![pen(1, "#f4dc2c"), pen(2, "#1b9fd0"), pen(3, "#bf3a8f"), pen(4, "white")];
        let page = Page { paper: "#c9b28f".parse().unwrap(), ..Page::new(100.0, 50.0) };
        let mut bytes = Vec::new();
        write_proof(&Plot { page, pens }, 0.3, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let moves: Vec<Point> = text
            .split("translate(")
            .skip(1)
            .map(|rest| {
                let numbers: Vec<f64> = rest.split(')').next().unwrap().split(' ').map(|v| v.parse().unwrap()).collect();
                Point::new(numbers[0], numbers[1])
            })
            .collect();
        let farthest = moves.iter().flat_map(|a| moves.iter().map(move |b| a.distance(*b))).fold(0.0, f64::max);
        assert!(moves.len() == 4 && (farthest - 0.3).abs() < 2e-3, "{moves:?}");
        assert_eq!(text.matches("multiply").count(), 3, "a white pen on toned paper covers");
    }
}
