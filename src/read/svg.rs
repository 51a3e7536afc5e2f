//! SVG as a drawing: usvg resolves the geometry, one pass over the XML the layers and kinds of marks.

use super::Dropped;
use super::layers::{Label, Outline, outline, with_ids};
use super::text::text_of;
use crate::drawing::{Area, Colour, Dot, Drawing, Ends, Handling, Ink, Layer, Mark, Mixing, Page, Painted, Stroke, Width};
use crate::geometry::{Affine, BezPath, Point, Region, Winding, flatten, untangled};
use kurbo::{PathEl, Shape};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use thiserror::Error;
use usvg::tiny_skia_path::PathSegment;

/// usvg works in CSS pixels.
const MM_PER_PX: f64 = 25.4 / 96.0;
/// Flattening where a path must be clipped or dashed, in millimetres.
const CLIP_TOLERANCE: f64 = 0.005;

/// The least red, green and blue of paint that is taken for paper: no pen's ink is as light.
const WHITE: u8 = 250;
/// Coordinates beyond which a path is not taken, in millimetres.
const FARTHEST: f64 = 100_000.0;
/// Dashes in one path beyond which the pattern is not taken.
const MOST_DASHES: f64 = 20_000.0;

/// Why an SVG could not be read.
#[derive(Debug, Error)]
pub enum SvgError {
    /// Not text.
    #[error("is not an SVG: it is neither UTF-8 nor UTF-16 text")]
    NotText,
    /// Broken gzip.
    #[error("is not an SVG: it begins as gzip (.svgz) and cannot be unpacked")]
    Packed,
    /// More text than can be held.
    #[error("cannot be used as an SVG: it unpacks to more than 1 GB")]
    TooLong,
    /// Groups within groups without end.
    #[error("cannot be used as an SVG: its groups are nested more than 250 deep")]
    TooDeep,
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
    let given = text_of(bytes)?;
    let document = parsed(&given)?;
    let outline = outline(&document).ok_or(SvgError::TooDeep)?;
    let (outline, tree) = match with_ids(&given, &document) {
        Cow::Borrowed(_) => (outline, tree_of(&document)?),
        Cow::Owned(text) => {
            let document = parsed(&text)?;
            (super::layers::outline(&document).ok_or(SvgError::TooDeep)?, tree_of(&document)?)
        }
    };
    let page = Page::new(f64::from(tree.size().width()) * MM_PER_PX, f64::from(tree.size().height()) * MM_PER_PX);
    let mut importer = Importer::new(&outline);
    importer.group(tree.root(), Place { layer: None, kind: Kind::Foreign, opacity: 1.0 }, &[]);
    let is_toolpaths = importer.is_toolpaths;
    let (layers, painting, dropped) = importer.finish();
    Ok(Imported { page, layers, painting, dropped, recipe: outline.recipe.clone(), is_toolpaths })
}

fn parsed(text: &str) -> Result<roxmltree::Document<'_>, SvgError> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    Ok(roxmltree::Document::parse_with_options(text, options)?)
}

/// usvg's tree. Images are counted from the XML: none is decoded, and no file beside this one is opened.
fn tree_of(document: &roxmltree::Document<'_>) -> Result<usvg::Tree, SvgError> {
    let none = usvg::ImageHrefResolver { resolve_data: Box::new(|_, _, _| None), resolve_string: Box::new(|_, _| None) };
    Ok(usvg::Tree::from_xmltree(document, &usvg::Options { image_href_resolver: none, ..usvg::Options::default() })?)
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
    /// Of all groups around.
    opacity: f32,
}

struct Importer<'a> {
    outline: &'a Outline,
    /// One for each label, then one for each colour met outside all labels.
    layers: Vec<ImportedLayer>,
    by_colour: HashMap<[u8; 3], usize>,
    painting: Vec<Painted>,
    dropped: Dropped,
    is_toolpaths: bool,
}

impl<'a> Importer<'a> {
    fn new(outline: &'a Outline) -> Self {
        let layers = outline.layers.iter().enumerate().map(|(i, label)| labelled(label, i as u32 + 1)).collect();
        let mut dropped = outline.dropped.clone();
        dropped.add("pen height (+H)", outline.layers.iter().filter(|label| label.height.is_some()).count());
        Self { outline, layers, by_colour: HashMap::new(), painting: Vec::new(), dropped, is_toolpaths: false }
    }

    fn group(&mut self, group: &usvg::Group, place: Place, clips: &[Region]) {
        let place = Place { opacity: place.opacity * group.opacity().get(), ..self.place_of(group.id(), place) };
        if place.layer.is_some_and(|layer| self.outline.layers.get(layer).is_some_and(|label| label.is_skipped)) {
            return;
        }
        if group.opacity().get() <= 0.0 {
            return self.dropped.count("invisible group");
        }
        let mut clips = Cow::Borrowed(clips);
        let mut clip = group.clip_path();
        while let Some(path) = clip {
            clips.to_mut().push(clip_region(path, to_mm(group.abs_transform())));
            clip = path.clip_path();
        }
        self.dropped.add("mask (its group is drawn whole)", usize::from(group.mask().is_some()));
        self.dropped.add("filter (its group is drawn plain)", group.filters().len());
        for node in group.children() {
            match node {
                usvg::Node::Group(group) => self.group(group, place, &clips),
                usvg::Node::Path(path) => self.path(path, place, &clips),
                // Counted in the XML.
                usvg::Node::Image(_) | usvg::Node::Text(_) => {}
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
        Place { layer, kind, ..place }
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
        let fill = path.fill().map(|fill| (fill, Paint::of(fill.paint(), fill.opacity().get() * place.opacity)));
        let stroke = path.stroke().map(|stroke| (stroke, Paint::of(stroke.paint(), stroke.opacity().get() * place.opacity)));
        let is_stroke_above = path.paint_order() == usvg::PaintOrder::FillAndStroke;
        for is_stroke in [!is_stroke_above, is_stroke_above] {
            match (is_stroke, &fill, &stroke) {
                (false, Some((fill, paint)), _) => self.filled(&curve, fill.rule(), *paint, place, clips),
                (true, _, Some((stroke, paint))) => self.stroked(path, stroke, *paint, place, clips),
                _ => {}
            }
        }
    }

    /// A paint's colour, if it is ink.
    fn ink(&mut self, paint: Paint, what: &str) -> Option<Colour> {
        let reason = match paint.ink {
            _ if paint.opacity <= 0.0 => "transparent",
            Source::Ink(colour) => {
                self.dropped.add("translucent paint (drawn solid)", usize::from(paint.opacity < 1.0));
                return Some(colour);
            }
            Source::White => "white",
            Source::Gradient { .. } => "gradient",
            Source::Pattern => "pattern",
        };
        self.dropped.count(&format!("{reason} {what}"));
        None
    }

    fn filled(&mut self, curve: &BezPath, rule: usvg::FillRule, paint: Paint, place: Place, clips: &[Region]) {
        // A straight line is filled by default in SVG, with nothing.
        if is_flat(curve) {
            return;
        }
        let colour = self.ink(paint, "fill");
        if colour.is_none() && !paint.hides() {
            return;
        }
        let outline = if rule == usvg::FillRule::EvenOdd && has_crossings(curve) {
            clipped_outline(&untangled(curve, Winding::EvenOdd, CLIP_TOLERANCE), clips)
        } else {
            clipped_outline(curve, clips)
        };
        if outline.is_empty() {
            return;
        }
        let Some(colour) = colour else { return self.painting.push(Painted::White(outline)) };
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

    fn stroked(&mut self, path: &usvg::Path, stroke: &usvg::Stroke, paint: Paint, place: Place, clips: &[Region]) {
        let colour = self.ink(paint, "stroke");
        if colour.is_none() && !paint.hides() {
            return;
        }
        let transform = to_mm(path.abs_transform());
        let scale = transform.determinant().abs().sqrt();
        let ends = if stroke.linecap() == usvg::LineCap::Butt { Ends::Flat } else { Ends::Round };
        // A width that stays is in pixels of the whole drawing, and so are its dashes.
        let is_fixed = self.outline.fixed_widths.contains(path.id());
        let width = f64::from(stroke.width().get()) * if is_fixed { MM_PER_PX } else { scale };
        let unit = if is_fixed { MM_PER_PX / scale.max(1e-12) } else { 1.0 };
        let mut curve = transform * self.dashed(bez_path(path.data()), stroke, unit, ends);
        for clip in clips {
            curve = clip_curve(&curve, clip);
        }
        let strokes = subpaths(&curve).into_iter().map(|curve| Stroke { ends, ..Stroke::new(curve, Width::Constant(width)) });
        let Some(colour) = colour else {
            return self.painting.extend(strokes.map(|stroke| Painted::White(stroke.ink_outline(CLIP_TOLERANCE))));
        };
        let index = self.layer_for(place, colour);
        let own_colour = (self.layers[index].layer.ink.colour() != colour).then_some(colour);
        self.paint(index, strokes.map(|stroke| Mark::Stroke(Stroke { colour: own_colour, ..stroke })));
    }

    /// A curve's dashes, in its own units; `unit` is the length there of the pattern's.
    fn dashed(&mut self, curve: BezPath, stroke: &usvg::Stroke, unit: f64, ends: Ends) -> BezPath {
        let Some(pattern) = stroke.dasharray() else { return curve };
        let period = unit * pattern.iter().map(|dash| f64::from(*dash)).sum::<f64>();
        if crate::geometry::curve_length(&curve) > MOST_DASHES * period {
            self.dropped.count("dash pattern too fine (its line is drawn whole)");
            return curve;
        }
        // Dashes without length are dots where ends are round, and nothing where they are flat.
        let least = 1e-5 * period;
        let dashes: Vec<f64> = pattern.iter().map(|dash| (unit * f64::from(*dash)).max(least)).collect();
        let mut dashed: BezPath = kurbo::dash(curve.iter(), f64::from(stroke.dashoffset()) * unit, &dashes).collect();
        if ends == Ends::Flat && pattern.contains(&0.0) {
            let long = subpaths(&dashed).into_iter().filter(|dash| crate::geometry::curve_length(dash) > 2.0 * least);
            dashed = long.flat_map(std::iter::IntoIterator::into_iter).collect();
        }
        dashed
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
        let index = if let Some(layer) = place.layer {
            layer
        } else {
            let key = [colour.r, colour.g, colour.b];
            if let Some(&index) = self.by_colour.get(&key) {
                index
            } else {
                let index = self.layers.len();
                self.layers.push(labelled(&Label { name: colour.to_string(), ..Label::default() }, index as u32 + 1));
                self.by_colour.insert(key, index);
                index
            }
        };
        let layer = &mut self.layers[index];
        if layer.layer.marks.is_empty() && colour != Colour::BLACK {
            layer.layer.ink = Ink::Colour(colour);
        }
        index
    }

    /// Gives the layers that hold something and name no pen the lowest numbers that no label names, in order.
    fn number_pens(&mut self) {
        let named = |index: usize| self.outline.layers.get(index).and_then(|label| label.pen);
        let taken: HashSet<u32> = (0..self.outline.layers.len()).filter_map(named).collect();
        let mut free = (1..).filter(|pen| !taken.contains(pen));
        for (index, layer) in self.layers.iter_mut().enumerate() {
            if self.outline.layers.get(index).is_none_or(|label| label.pen.is_none()) && !layer.layer.marks.is_empty() {
                layer.layer.pen = free.next().unwrap_or(layer.layer.pen);
            }
        }
    }

    /// Layers that hold something; those without a number of their own take the free ones in order.
    fn finish(mut self) -> (Vec<ImportedLayer>, Vec<Painted>, Dropped) {
        self.number_pens();
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

/// What paint is, and how much of it.
#[derive(Clone, Copy)]
struct Paint {
    ink: Source,
    opacity: f32,
}

#[derive(Clone, Copy)]
enum Source {
    Ink(Colour),
    White,
    Gradient { is_opaque: bool },
    Pattern,
}

impl Paint {
    fn of(paint: &usvg::Paint, opacity: f32) -> Self {
        let is_opaque = |stops: &[usvg::Stop]| stops.iter().all(|stop| stop.opacity().get() >= 1.0);
        let ink = match paint {
            usvg::Paint::Color(c) if [c.red, c.green, c.blue].iter().all(|&part| part >= WHITE) => Source::White,
            usvg::Paint::Color(c) => Source::Ink(Colour { r: c.red, g: c.green, b: c.blue }),
            usvg::Paint::LinearGradient(gradient) => Source::Gradient { is_opaque: is_opaque(gradient.stops()) },
            usvg::Paint::RadialGradient(gradient) => Source::Gradient { is_opaque: is_opaque(gradient.stops()) },
            usvg::Paint::Pattern(_) => Source::Pattern,
        };
        Self { ink, opacity }
    }

    /// Whether nothing below it is seen.
    fn hides(self) -> bool {
        self.opacity >= 1.0 && !matches!(self.ink, Source::Pattern | Source::Gradient { is_opaque: false })
    }
}

/// Whether an outline holds nothing: its points lie on one line.
fn is_flat(curve: &BezPath) -> bool {
    let mut area = 0.0;
    let (mut start, mut last) = (Point::ORIGIN, Point::ORIGIN);
    for element in curve.elements() {
        let points: &[Point] = match element {
            PathEl::MoveTo(p) => {
                (start, last) = (*p, *p);
                &[]
            }
            PathEl::LineTo(p) => &[*p],
            PathEl::QuadTo(a, p) => &[*a, *p],
            PathEl::CurveTo(a, b, p) => &[*a, *b, *p],
            PathEl::ClosePath => &[],
        };
        for p in points {
            area += (last - start).cross(*p - start).abs();
            last = *p;
        }
    }
    area < 2e-5
}

/// Whether the two rules of filling could differ: not within one contour of four sides or fewer that is not crossed.
fn has_crossings(curve: &BezPath) -> bool {
    let lines = curve.elements().iter().filter(|element| matches!(element, PathEl::LineTo(_))).count();
    let others = curve.elements().iter().filter(|element| matches!(element, PathEl::QuadTo(..) | PathEl::CurveTo(..))).count();
    lines > 2 || others > 0
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
    Affine::scale(MM_PER_PX) * affine(t)
}

fn affine(t: usvg::Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
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
    let own = user * affine(clip.transform());
    let mut shapes = Vec::new();
    gather(clip.root(), own, &mut shapes);
    Region::new(&shapes.into_iter().flatten().collect(), CLIP_TOLERANCE)
}

/// The outlines of a clip path's shapes, each within its own clip paths, all running the same way.
fn gather(group: &usvg::Group, own: Affine, shapes: &mut Vec<BezPath>) {
    let first = shapes.len();
    for node in group.children() {
        match node {
            usvg::Node::Group(group) => gather(group, own, shapes),
            usvg::Node::Path(path) if path.is_visible() => {
                let placed = own * affine(path.abs_transform()) * bez_path(path.data());
                let is_even_odd = path.fill().is_some_and(|fill| fill.rule() == usvg::FillRule::EvenOdd);
                let winding = if is_even_odd { Winding::EvenOdd } else { Winding::NonZero };
                shapes.push(untangled(&placed, winding, CLIP_TOLERANCE));
            }
            _ => {}
        }
    }
    let mut clip = group.clip_path();
    while let Some(path) = clip {
        let region = clip_region(path, own * affine(group.abs_transform()));
        for shape in &mut shapes[first..] {
            *shape = region.clip_area(&Region::new(shape, CLIP_TOLERANCE));
        }
        clip = path.clip_path();
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
        assert!(read_svg(b"\xff\x00").unwrap_err().to_string().contains("UTF-8"));
        assert!(read_svg(b"<svg").is_err());
        assert!(read_svg(b"<html/>").is_err());
    }
}
