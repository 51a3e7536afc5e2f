//! The feature lines on top, in their detected width (Son et al. 2011, section 3).

use super::Drawer;
use super::features::Features;
use crate::drawing::Layer;
use crate::field::CoherentLine;
use crate::geometry::Point;
use crate::source::MaskRole;
use crate::style::StyleError;
use crate::style::brows;
use crate::style::charcoal;
use crate::style::creases::Creases;
use crate::style::feature_line::feature_stroke;
use crate::style::pearls::are_lined_by;
use crate::style::spectacles::{self, Frames};
use crate::style::strays::mean_along;
use crate::style::under_eyes::{with_thin_folds, without_lines_in_lenses};

/// Maximum length of a line's taper, in pitches.
const LONGEST_TAPER: f64 = 4.0;
/// Mean of the mask of beards along a line from which it is a strand of one. Chosen, and looked at on five beards.
const STRAND: f64 = 0.6;

/// Share of a brow at a place from which lines there are its edges, which make it hollow.
const OF_BROW: f32 = 0.3;

/// Strokes along the features, the hairs of brows, and the frames of spectacles: none along folds of the skin, but beards have strands.
pub(super) fn layer(drawer: &Drawer<'_>, features: &Features) -> Result<Layer, StyleError> {
    drawer.observer.begin("feature lines");
    let brows = drawer.brows(drawer.portrait.masks.get(&MaskRole::Hair));
    let (placement, taper) = (&drawer.portrait.placement, LONGEST_TAPER * drawer.pitch());
    let mut layer = Layer::new("lines", 1);
    let mut lines = drawn(drawer, features);
    if let Some(brows) = &brows {
        let is_beside = |p: &Point| brows.region.sample(p.x, p.y) < OF_BROW;
        lines = lines.iter().flat_map(|line| line.parts_where(is_beside, drawer.pitch())).collect();
    }
    layer.marks = lines.iter().filter_map(|line| feature_stroke(line, placement, taper)).collect();
    if let Some(brows) = &brows {
        // The rest is dots: strokes alone are bushy.
        let ink = drawer.portrait.tone.map(|tone| 1.0 - brows::tone_over_dots(tone));
        layer.marks.extend(charcoal::strokes_along(drawer, &brows.hairs, (&brows.region, &ink), brows.sizes)?);
    }
    layer.marks.extend(spectacles::frames(drawer.portrait, drawer.pitch()));
    Ok(layer)
}

/// The features that are drawn as lines; those along rims of spectacles and pearls are in theirs.
fn drawn(drawer: &Drawer<'_>, features: &Features) -> Vec<CoherentLine> {
    let frames = Frames::of(drawer.portrait);
    let creases = Creases::of(drawer.portrait);
    let beard = drawer.portrait.masks.get(&MaskRole::FacialHair);
    let is_strand = |line: &CoherentLine| beard.is_some_and(|beard| mean_along(beard, &line.curve.points) > STRAND);
    let without_folds = |line: &CoherentLine| match line {
        _ if is_strand(line) => vec![line.clone()],
        _ if creases.have(&line.curve) => Vec::new(),
        _ => creases.cut_from(line),
    };
    let is_framed = |line: &&CoherentLine| frames.have(&line.curve) || are_lined_by(drawer.portrait, drawer.pitch(), &line.curve);
    let lines: Vec<CoherentLine> = features.lines.iter().filter(|line| !is_framed(line)).flat_map(without_folds).collect();
    let lines = without_lines_in_lenses(drawer.portrait, &lines, drawer.pitch());
    with_thin_folds(drawer.portrait, lines)
}
