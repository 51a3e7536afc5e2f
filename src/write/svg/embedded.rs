//! SVG to be placed in a page: no sheet, the box of the ink, one path per layer and colour, black as the text's colour.

use super::names::Names;
use super::path_data::{Grid, PathData};
use super::{SvgHead, finish, metadata};
use crate::drawing::{Colour, Dot, Drawing, Layer, Mark};
use crate::geometry::{BezPath, Point, Rect, with_fewer_curves};
use crate::parallel::mapped;
use crate::write::number::{decimal, thousandths};
use kurbo::{ParamCurve, Shape};
use std::io;
use svg::Node;
use svg::node::element::{Path, SVG, Title};

/// Deviation of an outline from the exact one, in millimetres: a pixel of a film at 2540 dpi. With half of it hair takes a quarter
/// more.
const ACCURACY: f64 = 0.01;
/// Height of the rows in which shapes are written, in millimetres: twice the pitch of a fine drawing.
const ROW: f64 = 1.0;
/// Deviation of the outlines that are made simpler, in millimetres: a fifth of what that may add.
const EXACT: f64 = 0.002;

/// Writes a drawing's ink without its sheet. Ink that is black takes the colour of the text around it (`currentColor`); the ground
/// stays transparent, and the size is that of the ink in millimetres.
///
/// ```
/// use drypoint::{drawing::{Dot, Drawing, Layer, Mark, Page}, geometry::Point, write::{SvgHead, write_embedded_svg}};
///
/// let mut layer = Layer::new("dots", 1);
/// layer.marks.push(Mark::Dot(Dot::circle(Point::new(5.0, 5.0), 0.5)));
/// let mut bytes = Vec::new();
/// write_embedded_svg(&Drawing { page: Page::new(10.0, 10.0), layers: vec![layer] }, &SvgHead::default(), &mut bytes)?;
/// assert!(String::from_utf8_lossy(&bytes).contains("viewBox=\"450 450 100 100\""));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_embedded_svg(drawing: &Drawing, head: &SvgHead, out: &mut impl io::Write) -> io::Result<()> {
    let names = Names::of(drawing, head);
    let ink = drawing.bounding_box().unwrap_or(drawing.page.rect());
    let title = names.of_part("title");
    let mut document = SVG::new()
        .set("width", format!("{}mm", number(ink.width())))
        .set("height", format!("{}mm", number(ink.height())))
        .set("viewBox", view_box(ink))
        .set("fill", "currentColor")
        .set("role", "img")
        .set("aria-labelledby", title.as_str())
        .add(Title::new(head.title.as_str()).set("id", title));
    if let Some(metadata) = metadata(head, None) {
        document.append(metadata);
    }
    for (i, layer) in drawing.layers.iter().enumerate() {
        let name = names.of_layer(i);
        for (j, run) in layer.marks.chunk_by(|a, b| a.colour() == b.colour()).enumerate() {
            let again = if j > 0 { format!(".{}", j + 1) } else { String::new() };
            let mut path = Path::new().set("id", format!("{name}-ink{again}")).set("d", data(run));
            if let Some(colour) = colour(layer, run) {
                path = path.set("fill", colour.to_string());
            }
            document.append(path);
        }
    }
    finish(&document, out)
}

/// The colour of a run of marks; none for black ink.
fn colour(layer: &Layer, run: &[Mark]) -> Option<Colour> {
    let own = run.first().and_then(Mark::colour);
    own.or(Some(layer.ink.colour()).filter(|ink| *ink != Colour::BLACK))
}

fn number(mm: f64) -> String {
    let mut text = String::new();
    decimal(&mut text, thousandths(mm), 3);
    text
}

/// The ink's box in the unit of the path data.
fn view_box(ink: Rect) -> String {
    [ink.x0, ink.y0, ink.width(), ink.height()].map(|mm| number(mm * Grid::PAGE.units_per_mm())).join(" ")
}

/// The path data of marks, all turning in one direction, so that the nonzero rule fills their union.
fn data(marks: &[Mark]) -> String {
    let mut shapes: Vec<Shaped> = mapped(marks, &Shaped::of);
    // Neighbours have short moves between them.
    shapes.sort_by_cached_key(Shaped::place);
    let mut text = String::new();
    let mut data = PathData::new(&mut text, Grid::PAGE);
    for shape in &shapes {
        match shape {
            Shaped::Disc(centre, radius) => data.one_arc_disc(*centre, *radius),
            Shaped::Outline(outline) => data.outline(outline),
        }
    }
    text
}

/// A mark as it is filled.
enum Shaped {
    Disc(Point, f64),
    Outline(BezPath),
}

impl Shaped {
    fn of(mark: &Mark) -> Self {
        match mark {
            Mark::Dot(Dot { centre, radius, outline: None, .. }) => Self::Disc(*centre, *radius),
            Mark::Dot(Dot { outline: Some(outline), .. }) => Self::Outline(plain(outline)),
            Mark::Stroke(stroke) => Self::Outline(plain(&stroke.ink_outline(EXACT))),
            Mark::Area(area) => Self::Outline(plain(&area.outline)),
        }
    }

    /// Where the shape starts, along rows that are read forth and back.
    fn place(&self) -> (i64, i64) {
        let at = match self {
            Self::Disc(centre, _) => *centre,
            Self::Outline(outline) => outline.segments().next().map_or(Point::ZERO, |first| first.start()),
        };
        let row = (at.y / ROW).floor() as i64;
        let along = (at.x * 1000.0).round() as i64;
        (row, if row % 2 == 0 { along } else { -along })
    }
}

/// An outline with as few curves as print needs, turning like a disc's.
fn plain(outline: &BezPath) -> BezPath {
    let outline = with_fewer_curves(outline, ACCURACY);
    if outline.area() > 0.0 { outline.reverse_subpaths() } else { outline }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Area, Page, Stroke};

    fn drawing() -> Drawing {
        let mut layer = Layer::new("dots", 1);
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(5.0, 5.0), 1.0)));
        layer.marks.push(Mark::Stroke(Stroke::even(BezPath::from_svg("M2,5 L8,5").unwrap(), 0.5)));
        layer.marks.push(Mark::Area(Area { outline: BezPath::from_svg("M4,4 V6 H6 V4 Z").unwrap(), colour: None }));
        Drawing { page: Page::new(10.0, 10.0), layers: vec![layer] }
    }

    fn text(head: &SvgHead) -> String {
        let mut bytes = Vec::new();
        write_embedded_svg(&drawing(), head, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn overlapping_marks_of_any_direction_are_one_shape_without_holes() {
        let tree = usvg::Tree::from_str(&text(&SvgHead::default()), &usvg::Options::default()).unwrap();
        let mut pixels = resvg::tiny_skia::Pixmap::new(700, 200).unwrap();
        let scale = 700.0 / tree.size().width();
        resvg::render(&tree, resvg::tiny_skia::Transform::from_scale(scale, scale), &mut pixels.as_mut());
        let middle = pixels.pixel(350, 100).unwrap();
        assert_eq!((middle.alpha(), middle.red()), (255, 0));
        assert_eq!(pixels.pixel(2, 2).unwrap().alpha(), 0, "the ground is transparent");
    }

    #[test]
    fn it_has_a_tight_box_a_title_and_names_of_its_own() {
        let one = text(&SvgHead { title: "One".into(), ..SvgHead::default() });
        assert!(one.contains("viewBox=\"175 400 650 200\"") && one.contains("width=\"6.5mm\""), "{one}");
        assert!(one.contains("role=\"img\"") && one.contains(">\nOne") || one.contains(">One<"), "{one}");
        assert_eq!(one.matches("<path").count(), 1);
        let id = |text: &str| text.split("id=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        assert_ne!(id(&one), id(&text(&SvgHead { title: "Two".into(), ..SvgHead::default() })));
    }
}
