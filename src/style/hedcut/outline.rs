//! Step 8: the longest edges alone as strokes that swell in the middle and taper at the ends (Bruehl 2023, section 4.3.2); coherent
//! lines keep their detected width.

use super::Drawer;
use super::features::Features;
use super::parts::Parts;
use super::silhouette::Silhouette;
use crate::drawing::{Layer, Mark, Stroke};
use crate::elementary::Elementary as _;
use crate::field::{CoherentLine, Curve};
use crate::geometry::{catmull_rom, resample};
use crate::style::creases::{Creases, share};
use crate::style::feature_line::feature_stroke;
use crate::style::pearls::are_lined_by;
use crate::style::spectacles::Frames;

/// Distance of an outline's nodes in pitches: far enough for long smooth arcs, near enough for the corner of an eye.
const NODE_SPACING: f64 = 1.2;

/// Maximum length of a coherent line's taper, in pitches.
const LONGEST_TAPER: f64 = 4.0;

/// The outlines, without those inside hair, whose strokes draw it.
pub(super) fn layer(drawer: &Drawer<'_>, features: &Features, parts: &Parts) -> Layer {
    let least = drawer.pixels(drawer.parameters.outline_length);
    let mut layer = Layer::new("outline", 1);
    let frames = Frames::of(drawer.portrait);
    let creases = Creases::of(drawer.portrait);
    let is_of_pearl = |curve: &Curve| are_lined_by(drawer.portrait, drawer.pitch(), curve);
    let is_outline = |curve: &Curve| {
        curve.length() >= least && !is_hair(curve, parts) && !creases.have(curve) && !frames.have(curve) && !is_of_pearl(curve)
    };
    if !features.drawn.is_empty() {
        let widest = drawer.pixels(drawer.parameters.outline_width);
        let taper = LONGEST_TAPER * drawer.pitch();
        let silhouette = Silhouette::of(drawer.portrait);
        let capped =
            |line: &CoherentLine| CoherentLine { widths: line.widths.iter().map(|w| w.min(widest)).collect(), ..line.clone() };
        let longest = features.drawn.iter().filter(|line| is_outline(&line.curve)).flat_map(|line| creases.cut_from(line));
        let longest = longest.flat_map(|line| silhouette.keeps(&line, least));
        let longest = longest.flat_map(|line| silhouette.without_hair(&line, parts, least));
        let strokes =
            longest.filter_map(|line| feature_stroke(&silhouette.holds(capped(&line)), &drawer.portrait.placement, taper));
        layer.marks = strokes.collect();
        return layer;
    }
    layer.marks = features.edges.iter().filter(|edge| is_outline(edge)).filter_map(|edge| stroke(drawer, edge)).collect();
    layer
}

/// True if most of a line runs inside hair.
fn is_hair(line: &Curve, parts: &Parts) -> bool {
    share(line, |p| parts.hair_at(p) >= 0.5) > 0.5
}

fn stroke(drawer: &Drawer<'_>, edge: &Curve) -> Option<Mark> {
    let spacing = NODE_SPACING * drawer.pitch();
    let mut nodes = edge.points.clone();
    if edge.closed {
        nodes.push(nodes[0]);
    }
    let mut nodes = resample(&nodes, spacing);
    if edge.closed {
        nodes.pop();
    }
    if nodes.len() < 3 {
        return None;
    }
    let page: Vec<_> = nodes.iter().map(|p| drawer.portrait.placement.to_page(*p)).collect();
    let curve = catmull_rom(&page, edge.closed.into());
    let widest = drawer.parameters.outline_width.0;
    let count = nodes.len() + usize::from(edge.closed);
    let widths = (0..count).map(|i| widest * if edge.closed { 1.0 } else { swell(i as f64 / (count - 1) as f64) }).collect();
    Stroke::swelling(curve, widths).map(Mark::Stroke)
}

/// Width along the stroke, 0 at both ends and 1 in the middle; fuller than a half sine, as a pen's.
fn swell(along: f64) -> f64 {
    (std::f64::consts::PI * along).sine().max(0.0).power(0.7)
}
