//! The groups and paths of an SVG as layers of marks, in painting order.

use super::Dropped;
use super::budget::{Budget, LOWERED_POINT, PATH, SEGMENT, TooMuchWork};
use super::clip_paths::{CLIP_TOLERANCE, Clip, FARTHEST, NoClip, clip_curve, clip_region, clipped_outline, untangled_fill};
use super::curves::{MM_PER_PX, bez_path, dot, has_crossings, is_flat, subpaths, to_mm};
use super::imported::ImportedLayer;
use super::layers::{Label, Outline};
use super::paint::{Paint, Source};
use crate::drawing::{Area, Colour, Ends, Handling, Ink, Layer, Mark, Mixing, Painted, Stroke};
use crate::geometry::{BezPath, flattened_points};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

/// The default flattening tolerance of lowering, in millimetres. Used to estimate the cost of curves there.
const LOWERING_TOLERANCE: f64 = 0.02;
/// Maximum number of dash periods in one path; a finer pattern is ignored.
const MOST_DASHES: f64 = 20_000.0;

/// The kind of paths in a group, from drypoint's own group ids.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Foreign,
    Dots,
    Swells,
    Paper,
}

/// The context of a path in the tree.
#[derive(Clone, Copy)]
pub(super) struct Place {
    layer: Option<usize>,
    kind: Kind,
    /// Product of the opacities of all enclosing groups.
    opacity: f32,
}

impl Place {
    /// Outside all groups.
    pub const TOP: Self = Self { layer: None, kind: Kind::Foreign, opacity: 1.0 };
}

/// The walk over usvg's tree: each path becomes marks of a layer; what cannot be drawn is counted.
pub(super) struct Importer<'a> {
    outline: &'a Outline,
    budget: &'a mut Budget,
    /// One for each label, then one for each colour found outside all labels.
    layers: Vec<ImportedLayer>,
    by_colour: HashMap<[u8; 3], usize>,
    painting: Vec<Painted>,
    dropped: Dropped,
    pub is_toolpaths: bool,
}

impl<'a> Importer<'a> {
    pub fn new(outline: &'a Outline, budget: &'a mut Budget) -> Self {
        let layers = outline.layers.iter().enumerate().map(|(i, label)| labelled(label, i as u32 + 1)).collect();
        let mut dropped = outline.dropped.clone();
        dropped.add("pen height (+H)", outline.layers.iter().filter(|label| label.height.is_some()).count());
        Self { outline, budget, layers, by_colour: HashMap::new(), painting: Vec::new(), dropped, is_toolpaths: false }
    }

    pub fn group(&mut self, group: &usvg::Group, place: Place, clips: &[Clip]) -> Result<(), TooMuchWork> {
        let place = Place { opacity: place.opacity * group.opacity().get(), ..self.place_of(group.id(), place) };
        if place.layer.is_some_and(|layer| self.outline.layers.get(layer).is_some_and(|label| label.is_skipped)) {
            return Ok(());
        }
        if group.opacity().get() <= 0.0 {
            self.dropped.count("invisible group");
            return Ok(());
        }
        let mut clips = Cow::Borrowed(clips);
        let mut clip = group.clip_path();
        while let Some(path) = clip {
            match clip_region(path, to_mm(group.abs_transform()), self.budget) {
                Ok(region) => clips.to_mut().push(region),
                Err(NoClip::Work(work)) => return Err(work),
                Err(NoClip::Endless) => {
                    self.dropped.count("clip path of no finite size (its group is left out)");
                    return Ok(());
                }
            }
            clip = path.clip_path();
        }
        self.dropped.add("mask (its group is drawn whole)", usize::from(group.mask().is_some()));
        self.dropped.add("filter (its group is drawn plain)", group.filters().len());
        for node in group.children() {
            match node {
                usvg::Node::Group(group) => self.group(group, place, &clips)?,
                usvg::Node::Path(path) => self.path(path, place, &clips)?,
                // Counted in the XML.
                usvg::Node::Image(_) | usvg::Node::Text(_) => {}
            }
        }
        Ok(())
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

    fn path(&mut self, path: &usvg::Path, place: Place, clips: &[Clip]) -> Result<(), TooMuchWork> {
        if !path.is_visible()
            || (path.id().split('_').next() == Some("paper") && self.outline.recipe.is_some())
            || place.kind == Kind::Paper
        {
            return Ok(());
        }
        let transform = to_mm(path.abs_transform());
        let curve = transform * bez_path(path.data());
        let bounds = curve.control_box();
        if !bounds.is_finite() || [bounds.x0, bounds.y0, bounds.x1, bounds.y1].iter().any(|v| v.abs() > FARTHEST) {
            self.dropped.count("path beyond 100 m");
            return Ok(());
        }
        self.budget.spend(LOWERED_POINT * flattened_points(&curve, LOWERING_TOLERANCE), "curves")?;
        let fill = path.fill().map(|fill| (fill, Paint::of(fill.paint(), fill.opacity().get() * place.opacity)));
        let stroke = path.stroke().map(|stroke| (stroke, Paint::of(stroke.paint(), stroke.opacity().get() * place.opacity)));
        let is_stroke_above = path.paint_order() == usvg::PaintOrder::FillAndStroke;
        for is_stroke in [!is_stroke_above, is_stroke_above] {
            match (is_stroke, &fill, &stroke) {
                (false, Some((fill, paint)), _) => self.filled(&curve, fill.rule(), *paint, place, clips)?,
                (true, _, Some((stroke, paint))) => self.stroked(path, stroke, *paint, place, clips)?,
                _ => {}
            }
        }
        Ok(())
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

    fn filled(
        &mut self,
        curve: &BezPath,
        rule: usvg::FillRule,
        paint: Paint,
        place: Place,
        clips: &[Clip],
    ) -> Result<(), TooMuchWork> {
        // SVG fills straight lines by default, but they enclose no area.
        if is_flat(curve) {
            return Ok(());
        }
        let colour = self.ink(paint, "fill");
        if colour.is_none() && !paint.hides() {
            return Ok(());
        }
        let outline = if rule == usvg::FillRule::EvenOdd && has_crossings(curve) {
            clipped_outline(&untangled_fill(curve, self.budget)?, clips, self.budget)?
        } else {
            clipped_outline(curve, clips, self.budget)?
        };
        if outline.is_empty() {
            return Ok(());
        }
        let Some(colour) = colour else {
            self.painting.push(Painted::White(outline));
            return Ok(());
        };
        let index = self.layer_for(place, colour);
        let layer = &mut self.layers[index];
        let own_colour = (layer.layer.ink.colour() != colour).then_some(colour);
        layer.swells += usize::from(place.kind == Kind::Swells);
        if place.kind == Kind::Dots {
            // Very large drawings put many dots in one path.
            self.paint(index, subpaths(&outline).into_iter().map(|piece| Mark::Dot(dot(piece, own_colour))));
        } else {
            self.paint(index, [Mark::Area(Area { outline, colour: own_colour })]);
        }
        Ok(())
    }

    fn stroked(
        &mut self,
        path: &usvg::Path,
        stroke: &usvg::Stroke,
        paint: Paint,
        place: Place,
        clips: &[Clip],
    ) -> Result<(), TooMuchWork> {
        let colour = self.ink(paint, "stroke");
        if colour.is_none() && !paint.hides() {
            return Ok(());
        }
        let transform = to_mm(path.abs_transform());
        let scale = transform.determinant().abs().sqrt();
        let ends = if stroke.linecap() == usvg::LineCap::Butt { Ends::Flat } else { Ends::Round };
        // A non-scaling stroke's width and dashes are in pixels of the whole drawing.
        let is_fixed = self.outline.fixed_widths.contains(path.id());
        let width = f64::from(stroke.width().get()) * if is_fixed { MM_PER_PX } else { scale };
        if width > FARTHEST {
            self.dropped.count("stroke wider than 100 m");
            return Ok(());
        }
        let unit = if is_fixed { MM_PER_PX / scale.max(1e-12) } else { 1.0 };
        let mut curve = transform * self.dashed(bez_path(path.data()), stroke, unit, ends)?;
        for clip in clips {
            curve = clip_curve(&curve, clip, self.budget)?;
        }
        let strokes = subpaths(&curve).into_iter().map(|curve| Stroke::even(curve, width).with_ends(ends));
        let Some(colour) = colour else {
            self.painting.extend(strokes.map(|stroke| Painted::White(stroke.ink_outline(CLIP_TOLERANCE))));
            return Ok(());
        };
        let index = self.layer_for(place, colour);
        let own_colour = (self.layers[index].layer.ink.colour() != colour).then_some(colour);
        self.paint(index, strokes.map(|stroke| Mark::Stroke(stroke.with_colour(own_colour))));
        Ok(())
    }

    /// A curve's dashes, in the curve's units; `unit` is the length of one unit of the dash pattern.
    fn dashed(&mut self, curve: BezPath, stroke: &usvg::Stroke, unit: f64, ends: Ends) -> Result<BezPath, TooMuchWork> {
        let Some(pattern) = stroke.dasharray() else { return Ok(curve) };
        let period = unit * pattern.iter().map(|dash| f64::from(*dash)).sum::<f64>();
        let periods = crate::geometry::curve_length(&curve) / period;
        // A NaN is also rejected as too fine.
        if !(0.0..=MOST_DASHES).contains(&periods) || !period.is_finite() {
            self.dropped.count("dash pattern too fine (its line is drawn whole)");
            return Ok(curve);
        }
        let dashes = 0.5 * periods * pattern.len() as f64;
        self.budget.spend((PATH + SEGMENT) * dashes + SEGMENT * pattern.len() as f64, "dashes")?;
        // Dashes of zero length are dots with round ends, and nothing with flat ends.
        let least = 1e-5 * period;
        let dashes: Vec<f64> = pattern.iter().map(|dash| (unit * f64::from(*dash)).max(least)).collect();
        // Reduce an offset of many periods to less than one.
        let offset = (f64::from(stroke.dashoffset()) * unit).rem_euclid(dashes.iter().sum());
        let offset = if offset.is_finite() { offset } else { 0.0 };
        // A subpath of zero length is a dot.
        let dashed = subpaths(&curve).into_iter().flat_map(|piece| {
            let has_length = crate::geometry::curve_length(&piece) > 0.0;
            if has_length { kurbo::dash(piece.iter(), offset, &dashes).collect() } else { piece }
        });
        let mut dashed: BezPath = dashed.collect();
        if ends == Ends::Flat && pattern.contains(&0.0) {
            let long = subpaths(&dashed).into_iter().filter(|dash| crate::geometry::curve_length(dash) > 2.0 * least);
            dashed = long.flat_map(std::iter::IntoIterator::into_iter).collect();
        }
        Ok(dashed)
    }

    /// Adds marks to a layer and to the painting order.
    fn paint(&mut self, layer: usize, marks: impl IntoIterator<Item = Mark>) {
        for mark in marks {
            self.painting.push(Painted::Mark { layer, mark: self.layers[layer].layer.marks.len() });
            self.layers[layer].layer.marks.push(mark);
        }
    }

    /// The index of a mark's layer: its labelled group's, else that of its colour.
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

    /// Numbers the non-empty layers that name no pen, in order, with the lowest pen numbers that no label names.
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

    /// The non-empty layers, the painting order and what was dropped. Layers without a pen number take the free ones in order.
    pub fn finish(mut self) -> (Vec<ImportedLayer>, Vec<Painted>, Dropped) {
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

fn labelled(label: &Label, number: u32) -> ImportedLayer {
    let pen = label.pen.unwrap_or(number);
    let name = if label.name.is_empty() { format!("layer {number}") } else { label.name.clone() };
    let delay_seconds = label.delay.unwrap_or(0.0).clamp(0.0, 60_000.0) / 1000.0;
    let handling = Handling { pauses: label.pauses, speed_percent: label.speed, delay_seconds };
    let layer = Layer { name, pen, ink: Ink::Black, mixing: Mixing::Paint, handling, marks: Vec::new() };
    ImportedLayer { layer, swells: 0 }
}
