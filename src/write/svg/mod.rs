//! SVG in millimetres: a drawing with its ink, or a plot's tool paths, in layers as Inkscape and plotter programs read them.
//!
//! ```text
//! svg  width="90mm" height="120mm" viewBox="0 0 90 120"
//!   title, desc, metadata (the recipe)
//!   g id="layer1_3f0a91c2" inkscape:groupmode="layer" inkscape:label="1 dots"
//!     g id="layer1_3f0a91c2-dots"     circles and blobs
//!     g id="layer1_3f0a91c2-lines"    strokes of one width, as stroked paths
//!     g id="layer1_3f0a91c2-swells"   strokes of varying width, as outlines
//!     g id="layer1_3f0a91c2-areas"    filled outlines
//! ```
//!
//! The group's id names the kind of its paths, since readers turn circles into paths. Marks stay in painting order, so a kind
//! that recurs gets a new group (`-dots.2`). The number in
//! ids is the drawing's own, so that several drawings may stand in one page.

mod embedded;
mod names;
mod path_data;

use crate::parallel::mapped;
pub use embedded::write_embedded_svg;
pub(crate) use names::Names;
pub(crate) use path_data::path_data;
use path_data::{Grid, PathData};

use super::number::{decimal, thousandths};
use crate::drawing::{Area, Colour, Dot, Drawing, Ends, Layer, Mark, Mixing, Page, Width};
use std::fmt::Write as _;
use std::io;
use svg::Node;
use svg::node::Blob;
use svg::node::element::{Description, Element, Group, Rectangle, SVG, Title};

/// Title, description and recipe at the head of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SvgHead {
    /// Short name of the picture.
    pub title: String,
    /// One sentence describing it.
    pub description: String,
    /// Everything needed to reproduce the picture, as JSON; empty for none.
    pub recipe: String,
}

/// Writes a drawing with its ink at exact size.
///
/// ```
/// use drypoint::{drawing::{Dot, Drawing, Layer, Mark, Page}, geometry::Point, write::{SvgHead, write_svg}};
///
/// let mut layer = Layer::new("dots", 1);
/// layer.marks.push(Mark::Dot(Dot::circle(Point::new(5.0, 5.0), 0.4)));
/// let mut bytes = Vec::new();
/// write_svg(&Drawing { page: Page::new(10.0, 10.0), layers: vec![layer] }, &SvgHead::default(), &mut bytes)?;
/// assert!(bytes.starts_with(b"<svg"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_svg(drawing: &Drawing, head: &SvgHead, out: &mut impl io::Write) -> io::Result<()> {
    let names = Names::of(drawing, head);
    let mut document = document(&drawing.page, head, None, &names);
    let mixes = drawing.layers.iter().any(|layer| layer.ink.colour() != drawing.layers[0].ink.colour());
    for (i, layer) in drawing.layers.iter().enumerate() {
        let name = names.of_layer(i);
        let mut group = layer_group(&name, &format!("{} {}", layer.pen, layer.name), layer.ink.colour());
        if mixes && layer.mixing == Mixing::Add {
            // As on paper: ink over ink is darker than either.
            group = group.set("style", "mix-blend-mode:multiply");
        }
        for run in runs(&name, layer) {
            group.append(run);
        }
        document.append(group);
    }
    finish(&document, out)
}

/// Writes a document and ends its last line.
pub(crate) fn finish(document: &SVG, out: &mut dyn io::Write) -> io::Result<()> {
    svg::write(&mut *out, document)?;
    out.write_all(b"\n")
}

/// A document of a page's size with its head; `machine` goes into the metadata.
pub(crate) fn document(page: &Page, head: &SvgHead, machine: Option<&str>, names: &Names) -> SVG {
    let (mut width, mut height) = (String::new(), String::new());
    decimal(&mut width, thousandths(page.width), 3);
    decimal(&mut height, thousandths(page.height), 3);
    let mut document = SVG::new()
        .set("xmlns:inkscape", "http://www.inkscape.org/namespaces/inkscape")
        .set("width", format!("{width}mm"))
        .set("height", format!("{height}mm"))
        .set("viewBox", format!("0 0 {width} {height}"))
        .add(Title::new(head.title.as_str()))
        .add(Description::new().add(svg::node::Text::new(head.description.as_str())));
    if let Some(metadata) = metadata(head, machine) {
        document.append(metadata);
    }
    if page.paper != Colour::WHITE {
        document.append(
            Rectangle::new()
                .set("id", names.of_part("paper"))
                .set("width", width)
                .set("height", height)
                .set("fill", page.paper.to_string()),
        );
    }
    document
}

/// The recipe and the machine, if there are any.
fn metadata(head: &SvgHead, machine: Option<&str>) -> Option<Element> {
    let recipe = Some(head.recipe.as_str()).filter(|recipe| !recipe.is_empty());
    if recipe.is_none() && machine.is_none() {
        return None;
    }
    // In RDF, the only vocabulary that SVG validators allow in metadata.
    let mut description = Element::new("rdf:Description");
    description.assign("rdf:about", "");
    for (name, text) in [("drypoint:recipe", recipe), ("drypoint:machine", machine)] {
        let Some(text) = text else { continue };
        let mut element = Element::new(name);
        element.assign("xmlns:drypoint", "urn:drypoint");
        element.append(svg::node::Text::new(text));
        description.append(element);
    }
    let mut rdf = Element::new("rdf:RDF");
    rdf.assign("xmlns:rdf", "http://www.w3.org/1999/02/22-rdf-syntax-ns#");
    rdf.append(description);
    let mut metadata = Element::new("metadata");
    metadata.append(rdf);
    Some(metadata)
}

pub(crate) fn layer_group(id: &str, label: &str, colour: Colour) -> Group {
    Group::new()
        .set("id", id)
        .set("inkscape:groupmode", "layer")
        .set("inkscape:label", label)
        .set("fill", colour.to_string())
        .set("stroke", "none")
}

pub(crate) fn lines_group(id: &str, width: &str, colour: Colour) -> Group {
    Group::new()
        .set("id", id)
        .set("fill", "none")
        .set("stroke", colour.to_string())
        .set("stroke-width", width)
        .set("stroke-linecap", "round")
        .set("stroke-linejoin", "round")
}

/// The kind of marks in a group of paths.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Dots,
    Lines,
    Swells,
    Areas,
}

impl Kind {
    fn of(mark: &Mark) -> Self {
        match mark {
            Mark::Dot(_) => Self::Dots,
            Mark::Stroke(stroke) => match stroke.width() {
                Width::Constant(_) => Self::Lines,
                Width::Along(_) => Self::Swells,
            },
            Mark::Area(_) => Self::Areas,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Dots => "dots",
            Self::Lines => "lines",
            Self::Swells => "swells",
            Self::Areas => "areas",
        }
    }
}

/// Maximum number of dots written as circles; more are combined into paths. Readers (usvg, librsvg) refuse about 1,000,000
/// elements, and the file may hold other marks too.
const MOST_CIRCLES: usize = 600_000;
/// Circles per combined path.
const CIRCLES_PER_PATH: usize = 1000;

/// A run of fewer marks is written by one thread.
const LEAST_SHARED: usize = 256;

/// The layer's marks, with one group per run of the same kind.
fn runs(layer_id: &str, layer: &Layer) -> Vec<Group> {
    let runs: Vec<&[Mark]> = layer.marks.chunk_by(|a, b| Kind::of(a) == Kind::of(b)).collect();
    let texts = mapped(&runs, &|run| text_of(run));
    let mut seen = [0_usize; 4];
    let group = |(run, text): (&[Mark], String)| {
        let kind = Kind::of(&run[0]);
        seen[kind as usize] += 1;
        let again = if seen[kind as usize] > 1 { format!(".{}", seen[kind as usize]) } else { String::new() };
        let id = format!("{layer_id}-{}{again}", kind.name());
        if kind == Kind::Lines {
            let mut width = String::new();
            decimal(&mut width, thousandths(constant_width(&run[0])), 3);
            return lines_group(&id, &width, layer.ink.colour()).add(Blob::new(text));
        }
        Group::new().set("id", id).add(Blob::new(text))
    };
    runs.into_iter().zip(texts).map(group).collect()
}

/// The paths and circles of a run of one kind.
fn text_of(run: &[Mark]) -> String {
    let mut text = String::new();
    match Kind::of(&run[0]) {
        Kind::Lines => {
            let width = constant_width(&run[0]);
            run.iter().for_each(|mark| line(&mut text, mark, width));
        }
        Kind::Dots if run.len() > MOST_CIRCLES => run
            .chunk_by(|a, b| a.colour() == b.colour())
            .flat_map(|same| same.chunks(CIRCLES_PER_PATH))
            .for_each(|dots| bundle(&mut text, dots)),
        _ if run.len() < LEAST_SHARED => run.iter().for_each(|mark| filled(&mut text, mark)),
        _ => {
            let shares: Vec<&[Mark]> = run.chunks(LEAST_SHARED).collect();
            let texts = mapped(&shares, &|share| {
                let mut text = String::new();
                share.iter().for_each(|mark| filled(&mut text, mark));
                text
            });
            text = texts.concat();
        }
    }
    text
}

fn constant_width(mark: &Mark) -> f64 {
    match mark {
        Mark::Stroke(stroke) => stroke.widest(),
        _ => 0.0,
    }
}

fn line(text: &mut String, mark: &Mark, usual_width: f64) {
    let Mark::Stroke(stroke) = mark else { return };
    text.push_str("<path d=\"");
    path_data(text, stroke.curve());
    text.push('"');
    if thousandths(constant_width(mark)) != thousandths(usual_width) {
        text.push_str(" stroke-width=\"");
        decimal(text, thousandths(constant_width(mark)), 3);
        text.push('"');
    }
    if stroke.ends == Ends::Flat && !stroke.is_closed() {
        text.push_str(" stroke-linecap=\"butt\"");
    }
    if let Some(colour) = stroke.colour {
        let _ = write!(text, " stroke=\"{colour}\"");
    }
    text.push_str("/>\n");
}

/// Decimals of a radius: four, since 0.001 mm of a small dot's radius is a percent of its ink.
const RADIUS_DIGITS: u32 = 4;
const RADIUS_SCALE: f64 = 10_000.0;

fn filled(text: &mut String, mark: &Mark) {
    match mark {
        Mark::Dot(Dot { centre, radius, outline: None, .. }) => {
            text.push_str("<circle cx=\"");
            decimal(text, thousandths(centre.x), 3);
            text.push_str("\" cy=\"");
            decimal(text, thousandths(centre.y), 3);
            text.push_str("\" r=\"");
            decimal(text, (radius * RADIUS_SCALE).round() as i64, RADIUS_DIGITS);
            text.push('"');
        }
        Mark::Dot(Dot { outline: Some(outline), .. }) => {
            text.push_str("<path d=\"");
            path_data(text, outline);
            text.push('"');
        }
        Mark::Stroke(stroke) => {
            text.push_str("<path d=\"");
            path_data(text, &stroke.outline().unwrap_or_default());
            text.push('"');
        }
        Mark::Area(Area { outline, .. }) => {
            text.push_str("<path d=\"");
            path_data(text, outline);
            text.push('"');
        }
    }
    if let Some(colour) = mark.colour() {
        let _ = write!(text, " fill=\"{colour}\"");
    }
    text.push_str("/>\n");
}

/// Writes dots of one colour as the subpaths of one path.
fn bundle(text: &mut String, dots: &[Mark]) {
    text.push_str("<path d=\"");
    let mut data = PathData::new(text, Grid::SHEET);
    for mark in dots {
        match mark {
            Mark::Dot(Dot { centre, radius, outline: None, .. }) => data.disc(*centre, *radius),
            Mark::Dot(Dot { outline: Some(outline), .. }) => data.outline(outline),
            _ => {}
        }
    }
    text.push('"');
    if let Some(colour) = dots.first().and_then(Mark::colour) {
        let _ = write!(text, " fill=\"{colour}\"");
    }
    text.push_str("/>\n");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Stroke;
    use crate::geometry::{BezPath, Point};

    fn written(drawing: &Drawing) -> String {
        let mut bytes = Vec::new();
        let head = SvgHead { title: "A & B".into(), description: "<test>".into(), recipe: "{\"seed\":1}".into() };
        write_svg(drawing, &head, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    fn drawing() -> Drawing {
        let mut layer = Layer::new("dots", 1);
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(1.5, 2.25), 0.123_45)));
        layer.marks.push(Mark::Stroke(Stroke::even(BezPath::from_svg("M0,0 L10,0 C10,1 9,2 8,2").unwrap(), 0.3)));
        layer.marks.push(Mark::Dot(Dot::circle(Point::new(4.0, 4.0), 1.0)));
        Drawing { page: Page::new(90.0, 120.0), layers: vec![layer] }
    }

    #[test]
    fn it_is_short_and_says_what_it_is() {
        let text = written(&drawing());
        assert!(text.contains("<circle cx=\"1.5\" cy=\"2.25\" r=\".1235\"/>"), "{text}");
        assert!(text.contains("width=\"90mm\"") && text.contains("viewBox=\"0 0 90 120\""));
        assert!(text.contains("inkscape:label=\"1 dots\""));
        assert!(text.contains("d=\"M0 0l10 0c0 1-1 2-2 2\""), "{text}");
        assert!(text.contains("-dots.2\""));
        assert!(text.contains("A &amp; B") && text.contains("&lt;test&gt;"));
    }

    #[test]
    fn bundled_dots_are_the_same_discs() {
        let dots = [Mark::Dot(Dot::circle(Point::new(3.0, 4.0), 0.5)), Mark::Dot(Dot::circle(Point::new(6.0, 4.0), 0.25))];
        let mut text = String::new();
        bundle(&mut text, &dots);
        assert_eq!(text, "<path d=\"M2.5 4a.5.5 0 0 0 1 0 .5.5 0 0 0-1 0zm3.25 0a.25.25 0 0 0 .5 0 .25.25 0 0 0-.5 0z\"/>\n");
        let path = BezPath::from_svg(text.split('"').nth(1).unwrap()).unwrap();
        let area: f64 = dots.iter().map(Mark::area).sum();
        assert!((kurbo::Shape::area(&path).abs() - area).abs() < 1e-3);
    }

    #[test]
    fn it_parses() {
        let tree = usvg::Tree::from_str(&written(&drawing()), &usvg::Options::default()).unwrap();
        assert!((f64::from(tree.size().width()) - 90.0 * 96.0 / 25.4).abs() < 0.01);
    }
}
