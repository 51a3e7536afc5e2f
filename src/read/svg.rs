//! SVG as a drawing: usvg resolves the geometry, one pass over the XML the layers and kinds of marks.

use super::Dropped;
use super::layers::{Label, Outline, outline, with_layer_ids};
use crate::drawing::{Area, Colour, Dot, Drawing, Ends, Handling, Ink, Layer, Mark, Mixing, Page, Painted, Stroke, Width};
use crate::geometry::{Affine, BezPath, Point, Region, flatten};
use kurbo::{PathEl, Shape};
use thiserror::Error;
use usvg::tiny_skia_path::PathSegment;

/// usvg works in CSS pixels.
const MM_PER_PX: f64 = 25.4 / 96.0;
/// Flattening where a path must be clipped or dashed, in millimetres.
const CLIP_TOLERANCE: f64 = 0.005;

/// Coordinates beyond which a path is not taken, in millimetres.
const FARTHEST: f64 = 100_000.0;
/// Dashes in one path beyond which the pattern is not taken.
const MOST_DASHES: f64 = 20_000.0;

/// Why an SVG could not be read.
#[derive(Debug, Error)]
pub enum SvgError {
    /// Not text.
    #[error("is not an SVG: it is not UTF-8 text")]
    NotText,
    /// Broken XML.
    #[error("is not an SVG: {0}")]
    Xml(#[from] roxmltree::Error),
    /// Not SVG, or beyond usvg's limits.
    #[error("cannot be used as an SVG: {0}")]
    Svg(#[from] usvg::Error),
}

/// An SVG as a drawing, and what was not taken.
#[derive(Clone, Debug)]
pub struct Imported {
    /// Its sheet.
    pub page: Page,
    /// Layers in painting order.
    pub layers: Vec<ImportedLayer>,
    /// Its marks from the lowest to the uppermost, with the white between them.
    pub painting: Vec<Painted>,
    /// What was not taken, by kind.
    pub dropped: Dropped,
    /// The recipe, when drypoint wrote it.
    pub recipe: Option<String>,
    /// Whether it holds tool paths that drypoint wrote, which are never lowered again.
    pub is_toolpaths: bool,
}

/// One layer of an SVG.
#[derive(Clone, Debug)]
pub struct ImportedLayer {
    /// Its marks.
    pub layer: Layer,
    /// Areas that are the outlines of swelling strokes.
    pub swells: usize,
}

impl ImportedLayer {
    /// Dots, strokes and areas.
    pub fn counts(&self) -> [usize; 3] {
        let [dots, strokes, areas] = self.layer.counts();
        [dots, strokes + self.swells, areas - self.swells]
    }
}

impl Imported {
    /// The marks as a drawing.
    pub fn drawing(&self) -> Drawing {
        Drawing { page: self.page, layers: self.layers.iter().map(|l| l.layer.clone()).collect() }
    }
}

/// Reads an SVG. Layers are Inkscape's, by their labels' conventions; without any, each colour is a layer.
pub fn read_svg(bytes: &[u8]) -> Result<Imported, SvgError> {
    let text = std::str::from_utf8(bytes).map_err(|_| SvgError::NotText)?;
    let options = || roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    let text = with_layer_ids(text, &roxmltree::Document::parse_with_options(text, options())?);
    let document = roxmltree::Document::parse_with_options(&text, options())?;
    let outline = outline(&document);
    let tree = usvg::Tree::from_xmltree(&document, &usvg::Options::default())?;
    let page = Page::new(f64::from(tree.size().width()) * MM_PER_PX, f64::from(tree.size().height()) * MM_PER_PX);
    let mut importer = Importer::new(&outline);
    importer.group(tree.root(), Place { layer: None, kind: Kind::Foreign }, &[]);
    let is_toolpaths = importer.is_toolpaths;
    let (layers, painting, dropped) = importer.finish();
    Ok(Imported { page, layers, painting, dropped, recipe: outline.recipe.clone(), is_toolpaths })
}

/// What drypoint's own group ids say of the paths below them.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Foreign,
    Dots,
    Swells,
    Paper,
}

#[derive(Clone, Copy)]
struct Place {
    layer: Option<usize>,
    kind: Kind,
}

struct Importer<'a> {
    outline: &'a Outline,
    /// One for each label, then one for each colour met outside all labels.
    layers: Vec<ImportedLayer>,
    by_colour: Vec<(Colour, usize)>,
    painting: Vec<Painted>,
    dropped: Dropped,
    is_toolpaths: bool,
}

impl<'a> Importer<'a> {
    fn new(outline: &'a Outline) -> Self {
        let layers = outline.layers.iter().enumerate().map(|(i, label)| labelled(label, i as u32 + 1)).collect();
        let mut dropped = outline.dropped.clone();
        dropped.add("pen height (+H)", outline.layers.iter().filter(|label| label.height.is_some()).count());
        Self { outline, layers, by_colour: Vec::new(), painting: Vec::new(), dropped, is_toolpaths: false }
    }

    fn group(&mut self, group: &usvg::Group, place: Place, clips: &[Region]) {
        let place = self.place_of(group.id(), place);
        if place.layer.is_some_and(|layer| self.outline.layers.get(layer).is_some_and(|label| label.is_skipped)) {
            return;
        }
        if group.opacity().get() <= 0.0 {
            return self.dropped.count("invisible group");
        }
        let mut clips = clips.to_vec();
        let mut clip = group.clip_path();
        while let Some(path) = clip {
            clips.push(clip_region(path, to_mm(group.abs_transform())));
            clip = path.clip_path();
        }
        self.dropped.add("mask (its group is drawn whole)", usize::from(group.mask().is_some()));
        self.dropped.add("filter (its group is drawn plain)", group.filters().len());
        for node in group.children() {
            match node {
                usvg::Node::Group(group) => self.group(group, place, &clips),
                usvg::Node::Path(path) => self.path(path, place, &clips),
                usvg::Node::Image(_) => self.dropped.count("image"),
                usvg::Node::Text(_) => self.dropped.count("text"),
            }
        }
    }

    fn place_of(&mut self, id: &str, place: Place) -> Place {
        let layer = self.outline.by_id.get(id).copied().or(place.layer);
        let own = if self.outline.recipe.is_some() { id.split_once('-').map_or("", |(_, kind)| kind) } else { "" };
        let kind = match own.split('.').next().unwrap_or("") {
            "dots" => Kind::Dots,
            "swells" => Kind::Swells,
            "toolpaths" => {
                self.is_toolpaths = true;
                Kind::Foreign
            }
            _ => place.kind,
        };
        Place { layer, kind }
    }

    fn path(&mut self, path: &usvg::Path, place: Place, clips: &[Region]) {
        if !path.is_visible() || (path.id() == "paper" && self.outline.recipe.is_some()) || place.kind == Kind::Paper {
            return;
        }
        let transform = to_mm(path.abs_transform());
        let curve = transform * bez_path(path.data());
        let bounds = curve.control_box();
        if !bounds.is_finite() || [bounds.x0, bounds.y0, bounds.x1, bounds.y1].iter().any(|v| v.abs() > FARTHEST) {
            return self.dropped.count("path beyond 100 m");
        }
        let scale = transform.determinant().abs().sqrt();
        if let Some(fill) = path.fill() {
            if is_white(fill.paint()) {
                self.painting.push(Painted::White(clipped_outline(&curve, clips)));
            }
            if let Some(colour) = self.ink(fill.paint(), "fill") {
                self.filled(&curve, colour, place, clips);
            }
        }
        if let Some(stroke) = path.stroke()
            && let Some(colour) = self.ink(stroke.paint(), "stroke")
        {
            self.stroked(&curve, stroke, scale, colour, place, clips);
        }
    }

    /// A paint's colour, if it is ink: white is paper, gradients and patterns cannot be drawn with a pen.
    fn ink(&mut self, paint: &usvg::Paint, what: &str) -> Option<Colour> {
        match paint {
            usvg::Paint::Color(_) if is_white(paint) => {
                self.dropped.count(&format!("white {what}"));
                None
            }
            usvg::Paint::Color(c) => Some(Colour { r: c.red, g: c.green, b: c.blue }),
            usvg::Paint::Pattern(_) => {
                self.dropped.count(&format!("pattern {what}"));
                None
            }
            _ => {
                self.dropped.count(&format!("gradient {what}"));
                None
            }
        }
    }

    fn filled(&mut self, curve: &BezPath, colour: Colour, place: Place, clips: &[Region]) {
        let outline = clipped_outline(curve, clips);
        // A straight line is filled by default in SVG, with nothing.
        if outline.area().abs() < 1e-5 {
            return;
        }
        let index = self.layer_for(place, colour);
        let layer = &mut self.layers[index];
        let own_colour = (layer.layer.ink.colour() != colour).then_some(colour);
        layer.swells += usize::from(place.kind == Kind::Swells);
        if place.kind == Kind::Dots {
            // Very large drawings hold many dots in one path.
            self.paint(index, subpaths(&outline).into_iter().map(|piece| Mark::Dot(dot(piece, own_colour))));
        } else {
            self.paint(index, [Mark::Area(Area { outline, colour: own_colour })]);
        }
    }

    fn stroked(&mut self, curve: &BezPath, stroke: &usvg::Stroke, scale: f64, colour: Colour, place: Place, clips: &[Region]) {
        let width = f64::from(stroke.width().get()) * scale;
        let mut curve = curve.clone();
        if let Some(dashes) = stroke.dasharray() {
            let dashes: Vec<f64> = dashes.iter().map(|d| f64::from(*d) * scale).collect();
            if crate::geometry::curve_length(&curve) > MOST_DASHES * dashes.iter().sum::<f64>() {
                self.dropped.count("dash pattern too fine (its line is drawn whole)");
            } else {
                curve = kurbo::dash(curve.iter(), f64::from(stroke.dashoffset()) * scale, &dashes).collect();
            }
        }
        for clip in clips {
            curve = clip_curve(&curve, clip);
        }
        let index = self.layer_for(place, colour);
        let own_colour = (self.layers[index].layer.ink.colour() != colour).then_some(colour);
        let ends = if stroke.linecap() == usvg::LineCap::Butt { Ends::Flat } else { Ends::Round };
        let stroke_of = |curve| Stroke { ends, colour: own_colour, ..Stroke::new(curve, Width::Constant(width)) };
        self.paint(index, subpaths(&curve).into_iter().map(|curve| Mark::Stroke(stroke_of(curve))));
    }

    /// Adds marks to a layer and to the painting order.
    fn paint(&mut self, layer: usize, marks: impl IntoIterator<Item = Mark>) {
        for mark in marks {
            self.painting.push(Painted::Mark { layer, mark: self.layers[layer].layer.marks.len() });
            self.layers[layer].layer.marks.push(mark);
        }
    }

    /// The layer of a mark: its labelled group, else that of its colour.
    fn layer_for(&mut self, place: Place, colour: Colour) -> usize {
        let index = match place.layer {
            Some(layer) => layer,
            None => {
                if let Some(&(_, index)) = self.by_colour.iter().find(|(c, _)| *c == colour) {
                    index
                } else {
                    let index = self.layers.len();
                    self.layers.push(labelled(&Label { name: colour.to_string(), ..Label::default() }, index as u32 + 1));
                    self.by_colour.push((colour, index));
                    index
                }
            }
        };
        let layer = &mut self.layers[index];
        if layer.layer.marks.is_empty() && colour != Colour::BLACK {
            layer.layer.ink = Ink::Colour(colour);
        }
        index
    }

    /// Layers that hold something; those without a number of their own take the free ones in order.
    fn finish(self) -> (Vec<ImportedLayer>, Vec<Painted>, Dropped) {
        let mut held = 0;
        let number: Vec<usize> = self
            .layers
            .iter()
            .map(|layer| {
                held += usize::from(!layer.layer.marks.is_empty());
                held.saturating_sub(1)
            })
            .collect();
        let renumbered = |painted| match painted {
            Painted::Mark { layer, mark } => Painted::Mark { layer: number[layer], mark },
            white @ Painted::White(_) => white,
        };
        let painting = self.painting.into_iter().map(renumbered).collect();
        let layers = self.layers.into_iter().filter(|layer| !layer.layer.marks.is_empty());
        (layers.collect(), painting, self.dropped)
    }
}

fn is_white(paint: &usvg::Paint) -> bool {
    matches!(paint, usvg::Paint::Color(c) if (c.red, c.green, c.blue) == (255, 255, 255))
}

/// A filled outline within its clip paths.
fn clipped_outline(curve: &BezPath, clips: &[Region]) -> BezPath {
    clips.iter().fold(with_closed_subpaths(curve), |outline, clip| clip.clip_area(&Region::new(&outline, CLIP_TOLERANCE)))
}

fn labelled(label: &Label, number: u32) -> ImportedLayer {
    let pen = label.pen.unwrap_or(number);
    let name = if label.name.is_empty() { format!("layer {number}") } else { label.name.clone() };
    let delay_seconds = label.delay.unwrap_or(0.0).clamp(0.0, 60_000.0) / 1000.0;
    let handling = Handling { pauses: label.pauses, speed_percent: label.speed, delay_seconds };
    let layer = Layer { name, pen, ink: Ink::Black, mixing: Mixing::Paint, handling, marks: Vec::new() };
    ImportedLayer { layer, swells: 0 }
}

/// A path of a `dots` group: a circle by its box when it fills it like one, else a blob.
fn dot(outline: BezPath, colour: Option<Colour>) -> Dot {
    let bounds = outline.bounding_box();
    let area = outline.area().abs();
    let radius = 0.25 * (bounds.width() + bounds.height());
    let disc = std::f64::consts::PI * radius * radius;
    let is_circle = (bounds.width() - bounds.height()).abs() < 0.002 + 0.002 * radius && (area / disc - 1.0).abs() < 0.003;
    if is_circle && outline.elements().len() < 12 {
        Dot { centre: bounds.center(), radius, outline: None, colour }
    } else {
        Dot { centre: bounds.center(), radius: (area / std::f64::consts::PI).sqrt(), outline: Some(Box::new(outline)), colour }
    }
}

fn to_mm(t: usvg::Transform) -> Affine {
    let of = |v: f32| f64::from(v);
    Affine::scale(MM_PER_PX) * Affine::new([of(t.sx), of(t.ky), of(t.kx), of(t.sy), of(t.tx), of(t.ty)])
}

fn bez_path(path: &usvg::tiny_skia_path::Path) -> BezPath {
    let point = |p: usvg::tiny_skia_path::Point| Point::new(f64::from(p.x), f64::from(p.y));
    path.segments()
        .map(|segment| match segment {
            PathSegment::MoveTo(p) => PathEl::MoveTo(point(p)),
            PathSegment::LineTo(p) => PathEl::LineTo(point(p)),
            PathSegment::QuadTo(a, p) => PathEl::QuadTo(point(a), point(p)),
            PathSegment::CubicTo(a, b, p) => PathEl::CurveTo(point(a), point(b), point(p)),
            PathSegment::Close => PathEl::ClosePath,
        })
        .collect()
}

/// The union of a clip path's shapes on the page.
fn clip_region(clip: &usvg::ClipPath, user: Affine) -> Region {
    let t = clip.transform();
    let of = |v: f32| f64::from(v);
    let own = user * Affine::new([of(t.sx), of(t.ky), of(t.kx), of(t.sy), of(t.tx), of(t.ty)]);
    let mut outline = BezPath::new();
    gather(clip.root(), own, &mut outline);
    Region::new(&outline, CLIP_TOLERANCE)
}

fn gather(group: &usvg::Group, own: Affine, outline: &mut BezPath) {
    for node in group.children() {
        match node {
            usvg::Node::Group(group) => gather(group, own, outline),
            usvg::Node::Path(path) => {
                let t = path.abs_transform();
                let of = |v: f32| f64::from(v);
                let placed = own * Affine::new([of(t.sx), of(t.ky), of(t.kx), of(t.sy), of(t.tx), of(t.ty)]);
                outline.extend((placed * bez_path(path.data())).iter());
            }
            _ => {}
        }
    }
}

fn clip_curve(curve: &BezPath, clip: &Region) -> BezPath {
    let mut clipped = BezPath::new();
    for (mut points, closed) in flatten(curve, CLIP_TOLERANCE) {
        if closed {
            points.push(points[0]);
        }
        for piece in clip.clip_line(&points) {
            clipped.move_to(piece[0]);
            piece[1..].iter().for_each(|p| clipped.line_to(*p));
        }
    }
    clipped
}

/// A fill closes every subpath.
fn with_closed_subpaths(curve: &BezPath) -> BezPath {
    let mut closed = BezPath::new();
    for mut piece in subpaths(curve) {
        if !matches!(piece.elements().last(), Some(PathEl::ClosePath)) {
            piece.close_path();
        }
        closed.extend(piece);
    }
    closed
}

/// Each subpath by itself; a bare move is none.
fn subpaths(curve: &BezPath) -> Vec<BezPath> {
    let mut pieces: Vec<BezPath> = Vec::new();
    for element in curve.elements() {
        if let PathEl::MoveTo(_) = element {
            pieces.push(BezPath::new());
        }
        if let Some(piece) = pieces.last_mut() {
            piece.push(*element);
        }
    }
    pieces.retain(|piece| piece.elements().len() > 1);
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(body: &str) -> Imported {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
             xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' width='100mm' height='100mm' viewBox='0 0 100 100'>{body}</svg>"
        );
        read_svg(text.as_bytes()).unwrap()
    }

    fn length(imported: &Imported) -> f64 {
        imported.drawing().marks().map(|m| if let Mark::Stroke(s) = m { s.length() } else { 0.0 }).sum()
    }

    #[test]
    fn layers_by_label_and_the_skipped_one() {
        let imported = read(
            "<g id='a' inkscape:groupmode='layer' inkscape:label='3 red'><path d='M0 0H10' stroke='red' fill='none'/></g>\
             <g id='b' inkscape:groupmode='layer' inkscape:label='% notes'><path d='M0 0H10' stroke='red'/></g>\
             <g id='c' inkscape:groupmode='layer' inkscape:label='hidden' style='display:none'><path d='M0 0H10' stroke='red'/></g>",
        );
        assert_eq!(imported.layers.len(), 1);
        assert_eq!((imported.layers[0].layer.pen, imported.layers[0].layer.name.as_str()), (3, "red"));
        assert_eq!(imported.layers[0].counts(), [0, 1, 0]);
    }

    #[test]
    fn layers_without_ids_and_layers_within_layers() {
        let imported = read(
            "<g inkscape:groupmode='layer' inkscape:label='2 red'><path d='M0 0H10' stroke='red'/>\
             <g inkscape:groupmode='layer' inkscape:label='% guide'><path d='M0 0H10' stroke='red'/></g>\
             <g inkscape:groupmode='layer' inkscape:label='4 inner'><path d='M0 0H10' stroke='red'/></g>\
             <g inkscape:groupmode='layer' inkscape:label='part'><path d='M0 5H10' stroke='red'/></g></g>\
             <g inkscape:groupmode='layer' inkscape:label='%skipped'><path d='M0 0H10' stroke='red'/></g>",
        );
        let layers: Vec<(u32, &str, usize)> =
            imported.layers.iter().map(|l| (l.layer.pen, l.layer.name.as_str(), l.layer.marks.len())).collect();
        assert_eq!(layers, [(2, "red", 2), (4, "inner", 1)]);
    }

    #[test]
    fn what_would_never_end_is_left_out_and_counted() {
        let dashed = read("<path d='M0 0H100' stroke='black' stroke-dasharray='1e-6 1e-6'/>");
        assert_eq!((dashed.layers[0].counts()[1], dashed.dropped.is_empty()), (1, false));
        let far = read("<path d='M0 0C1e30 1e30 2 2 3 3' stroke='black'/><path d='M0 0H1' stroke='black'/>");
        assert_eq!((far.layers[0].counts()[1], far.dropped.of("path beyond 100 m")), (1, 1));
        assert!(read("<g opacity='0'><path d='M0 0H10' stroke='black'/></g>").layers.is_empty());
    }

    #[test]
    fn colours_are_layers_where_there_are_none() {
        let imported = read("<path d='M0 0H10' stroke='red'/><path d='M0 5H10' stroke='blue'/><path d='M0 9H10' stroke='red'/>");
        let names: Vec<&str> = imported.layers.iter().map(|l| l.layer.name.as_str()).collect();
        assert_eq!(names, ["#ff0000", "#0000ff"]);
    }

    #[test]
    fn transforms_units_uses_and_dashes() {
        let imported = read(
            "<defs><path id='p' d='M0 0H10'/></defs><g transform='translate(5 5) scale(2)'><use xlink:href='#p' stroke='black' stroke-width='0.5'/></g>",
        );
        assert!((length(&imported) - 20.0).abs() < 1e-3);
        let Mark::Stroke(stroke) = &imported.layers[0].layer.marks[0] else { panic!() };
        assert!((stroke.widest() - 1.0).abs() < 1e-4);
        let dashed = read("<path d='M0 50H100' stroke='black' stroke-dasharray='10 10'/>");
        assert_eq!(dashed.layers[0].counts(), [0, 5, 0]);
        assert!((length(&dashed) - 50.0).abs() < 1e-3);
    }

    #[test]
    fn clip_paths_are_honoured() {
        let imported = read(
            "<clipPath id='c'><circle cx='50' cy='50' r='20'/></clipPath><g clip-path='url(#c)'><path d='M0 50H100' stroke='black'/></g>",
        );
        assert!((length(&imported) - 40.0).abs() < 0.02, "{}", length(&imported));
    }

    #[test]
    fn what_cannot_be_drawn_is_counted() {
        let imported = read(
            "<rect width='100' height='100' fill='white'/><text x='5' y='5'>hello</text>\
             <linearGradient id='g'><stop offset='0' stop-color='red'/><stop offset='1' stop-color='blue'/></linearGradient>\
             <rect width='10' height='10' fill='url(#g)'/><path d='M0 0H10' stroke='black'/>\
             <image width='10' height='10' xlink:href='data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=='/>",
        );
        assert_eq!(imported.dropped.of("white fill"), 1);
        assert_eq!(imported.dropped.of("text"), 1);
        assert_eq!(imported.dropped.of("gradient fill"), 1);
        assert_eq!(imported.dropped.of("image"), 1);
        assert_eq!(imported.layers.len(), 1);
    }

    #[test]
    fn faults_are_named() {
        assert!(read_svg(b"\xff\xfe").unwrap_err().to_string().contains("UTF-8"));
        assert!(read_svg(b"<svg").is_err());
        assert!(read_svg(b"<html/>").is_err());
    }
}
