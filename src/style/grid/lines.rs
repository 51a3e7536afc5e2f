//! The feature lines on top, in their detected width (Son et al. 2011, section 3).

use super::Drawer;
use super::features::Features;
use crate::drawing::Layer;
use crate::field::CoherentLine;
use crate::source::MaskRole;
use crate::style::creases::Creases;
use crate::style::feature_line::feature_stroke;
use crate::style::spectacles::{self, Frames};
use crate::style::strays::mean_along;

/// Maximum length of a line's taper, in pitches.
pub(super) const LONGEST_TAPER: f64 = 4.0;
/// Mean of the mask of beards along a line from which it is a strand of one. Chosen, and looked at on five beards.
const STRAND: f64 = 0.6;

/// The lines that dots leave room for.
#[derive(Default)]
pub(super) struct Lines {
    /// Features that are drawn as lines: none along folds of the skin, but beards have strands.
    pub drawn: Vec<CoherentLine>,
    /// Features along rims of spectacles, which are drawn as such.
    pub rims: Vec<CoherentLine>,
}

impl Lines {
    pub(super) fn of(drawer: &Drawer<'_>, features: &Features) -> Self {
        let frames = Frames::of(drawer.portrait);
        let creases = Creases::of(drawer.portrait);
        let beard = drawer.portrait.masks.get(&MaskRole::FacialHair);
        let is_strand = |line: &CoherentLine| beard.is_some_and(|beard| mean_along(beard, &line.curve.points) > STRAND);
        let without_folds = |line: &CoherentLine| match line {
            _ if is_strand(line) => vec![line.clone()],
            _ if creases.have(&line.curve) => Vec::new(),
            _ => creases.cut_from(line),
        };
        let (rims, others): (Vec<_>, Vec<_>) = features.lines.iter().partition(|line| frames.have(&line.curve));
        let drawn = others.into_iter().flat_map(without_folds).collect();
        Self { drawn, rims: rims.into_iter().cloned().collect() }
    }
}

pub(super) fn layer(drawer: &Drawer<'_>, lines: &Lines) -> Layer {
    drawer.observer.begin("feature lines");
    let (placement, taper) = (&drawer.portrait.placement, LONGEST_TAPER * drawer.pitch());
    let mut layer = Layer::new("lines", 1);
    layer.marks = lines.drawn.iter().filter_map(|line| feature_stroke(line, placement, taper)).collect();
    layer.marks.extend(spectacles::frames(drawer.portrait, drawer.pitch()));
    layer
}
