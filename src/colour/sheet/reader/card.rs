//! A neutral card in the sheet's outlined field.

use super::Sight;
use super::curve::Curve;
use super::measuring::{Kind, Sampled, sampled};
use super::sensor::balanced;
use crate::colour::sheet::grid::{GREY, WINDOW};
use crate::geometry::Rect;

/// What a card tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Card {
    /// The paper's colour: as given, else by the card.
    pub paper: [f64; 3],
    /// The camera's curve, if the paper was given too.
    pub curve: Curve,
}

/// Reflectances that a card may have.
const REFLECTANCE: std::ops::RangeInclusive<f64> = 0.02..=0.98;
/// Largest deviation of a card's samples, and least difference from paper, relative to paper.
const EVEN: f64 = 0.1;
const UNLIKE: f64 = 0.06;
/// Contrasts that are believed, and the halvings that find one.
const CONTRAST: [f64; 2] = [-0.15, 0.45];
const HALVINGS: usize = 30;

/// Reads the card of a known reflectance, beside paper of a known or unknown colour; `None` if nothing even and unlike paper lies there, or it
/// is not what is said.
pub(super) fn card(sight: &Sight<'_>, grey: f64, paper: Option<[f64; 3]>) -> Option<Card> {
    let window = Rect::from_center_size(GREY.center(), (2.0 * WINDOW, 0.8 * WINDOW));
    let read = sampled(&sight.view, &sight.probe, &sight.light, window, Kind::Film);
    let is_even = read.deviation < EVEN && read.colour.iter().all(|v| *v > 0.01);
    let is_unlike = read.colour.iter().any(|v| (v - 1.0).abs() > UNLIKE);
    if !is_even || !is_unlike || !REFLECTANCE.contains(&grey) {
        return None;
    }
    let card: [f64; 3] = std::array::from_fn(|c| read.colour[c] * read.paper[c]);
    match paper {
        None => Some(Card { paper: balanced(read.paper, card, [grey; 3]).map(|v| v.clamp(0.01, 2.0)), curve: Curve::default() }),
        Some(paper) => contrast(&read, card, grey / luminance(paper)).map(|curve| Card { paper, curve }),
    }
}

/// The curve under which card and paper have their true ratio.
fn contrast(read: &Sampled, card: [f64; 3], ratio: f64) -> Option<Curve> {
    let excess = |contrast: f64| {
        let curve = Curve { contrast: contrast as f32 };
        let light = |v: [f64; 3]| luminance(curve.corrected(v.map(|v| v as f32)).map(f64::from));
        light(card) / light(read.paper) - ratio
    };
    let [mut low, mut high] = CONTRAST;
    // A card darker than paper is seen too dark where contrast is high.
    if (excess(low) > 0.0) == (excess(high) > 0.0) {
        return None;
    }
    let rises = excess(high) > 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (excess(middle) > 0.0) == rises { high = middle } else { low = middle }
    }
    Some(Curve { contrast: (0.5 * (low + high)) as f32 })
}

fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
