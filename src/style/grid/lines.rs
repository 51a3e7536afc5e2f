//! The feature lines on top, in their detected width (Son et al. 2011, section 3).

use super::Drawer;
use super::features::Features;
use crate::drawing::Layer;
use crate::style::creases::Creases;
use crate::style::feature_line::feature_stroke;
use crate::style::spectacles::{self, Frames};

/// Maximum length of a line's taper, in pitches.
const LONGEST_TAPER: f64 = 4.0;

pub(super) fn layer(drawer: &Drawer<'_>, features: &Features) -> Layer {
    drawer.observer.begin("feature lines");
    let (placement, taper) = (&drawer.portrait.placement, LONGEST_TAPER * drawer.pitch());
    let mut layer = Layer::new("lines", 1);
    let frames = Frames::of(drawer.portrait);
    let creases = Creases::of(drawer.portrait);
    let drawn = features.lines.iter().filter(|line| !creases.have(&line.curve) && !frames.have(&line.curve));
    let drawn = drawn.flat_map(|line| creases.cut_from(line));
    layer.marks = drawn.filter_map(|line| feature_stroke(&line, placement, taper)).collect();
    layer.marks.extend(spectacles::frames(drawer.portrait, drawer.pitch()));
    layer
}
