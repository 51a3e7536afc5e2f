//! Assigns pens when a drawing has more colours than the machine has pens and no `--pens` is given.
//!
//! The most representative colours, one per pen, get a pen each; every other colour goes to the nearest of them (CIE L*a*b*). A
//! warning names the colours that were merged.

use super::messages::warning;
use crate::drawing::{Colour, Drawing, Ink, Layer, Mark, Painted};
use crate::plot::{PenChange, Profile};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// Maximum number of colours for which the user changes pens by hand; more is a picture meant for a screen.
const MOST_CHANGES: u32 = 12;
/// Number of candidate colours for pens, those that draw the most; each is compared with all colours of the drawing.
const MOST_CANDIDATES: usize = 128;
/// Maximum number of colours that a message lists in full.
const MOST_NAMED: usize = 40;
/// Number of colours listed when there are more than that.
const FEW_NAMED: usize = 6;

/// The result of assigning pens to a drawing's layers.
pub(super) struct PenAssignment {
    /// The marks in their original painting order.
    pub painting: Vec<Painted>,
    /// A message naming the colours that were merged.
    pub merge_notice: Option<String>,
}

/// Reduces a drawing's colours to the machine's pens, if there are too many.
pub(super) fn fit_to_pens(drawing: &mut Drawing, profile: &Profile) -> Option<PenAssignment> {
    let most = match profile.pens.change {
        PenChange::Machine => profile.pens.count,
        PenChange::Pause => profile.pens.count.max(MOST_CHANGES),
    };
    let amounts = amounts(drawing);
    let pens: BTreeSet<u32> = drawing.layers.iter().map(|layer| layer.pen).collect();
    let is_beyond = profile.pens.change == PenChange::Machine && pens.iter().any(|pen| *pen > most);
    let is_one = drawing.layers.len() == 1 && profile.pens.count > 1;
    if amounts.len() as u32 <= most || !(pens.len() as u32 > most || is_beyond || is_one) {
        return None;
    }
    let palette = palette(drawing, &amounts, profile.pens.count as usize);
    let sorted = sorted(drawing, &palette);
    let merge_notice = Some(told(amounts.len(), profile, &palette, &sorted.became));
    drawing.layers = sorted.layers;
    Some(PenAssignment { painting: sorted.painting, merge_notice })
}

/// Warns of layers with several colours but one pen.
pub(super) fn warn_of_colours(drawing: &Drawing) {
    for layer in &drawing.layers {
        let colours: Vec<Colour> = colours_of(layer).collect::<BTreeSet<_>>().into_iter().collect();
        if colours.len() > 1 {
            let (name, count, pen, all) = (&layer.name, colours.len(), layer.pen, named(&colours));
            warning!("layer '{name}' has {count} colours and is drawn with pen {pen}; --pens maps colours to pens ({all})");
        }
    }
}

fn colours_of(layer: &Layer) -> impl Iterator<Item = Colour> + '_ {
    layer.marks.iter().map(|mark| mark.colour().unwrap_or(layer.ink.colour()))
}

/// Amount drawn in each colour: millimetres of line plus square millimetres of filled marks.
fn amounts(drawing: &Drawing) -> BTreeMap<Colour, f64> {
    let mut amounts = BTreeMap::new();
    for layer in &drawing.layers {
        for (mark, colour) in layer.marks.iter().zip(colours_of(layer)) {
            let amount = if let Mark::Stroke(stroke) = mark { stroke.length() } else { mark.area() };
            *amounts.entry(colour).or_insert(0.0) += amount;
        }
    }
    amounts
}

/// Chooses `count` colours so that all others lie near one of them. Greedy: each choice is the candidate that most reduces the total
/// colour difference, weighted by amount. Returned in the order in which the drawing first shows them.
fn palette(drawing: &Drawing, amounts: &BTreeMap<Colour, f64>, count: usize) -> Vec<Colour> {
    let mut candidates: Vec<(Colour, f64)> = amounts.iter().map(|(colour, amount)| (*colour, *amount)).collect();
    candidates.sort_by(|a, b| b.1.total_cmp(&a.1));
    candidates.truncate(MOST_CANDIDATES);
    // Difference of each colour from each candidate, weighted by the amount drawn in it.
    let cost = |pen: Colour| amounts.iter().map(|(colour, amount)| amount * colour.difference(pen)).collect::<Vec<f64>>();
    let costs: Vec<Vec<f64>> = candidates.iter().map(|(colour, _)| cost(*colour)).collect();
    let mut least = vec![f64::INFINITY; amounts.len()];
    let mut chosen = Vec::new();
    for _ in 0..count.min(candidates.len()) {
        let total = |of: &[f64]| -> f64 { least.iter().zip(of).map(|(a, b)| a.min(*b)).sum() };
        let left = (0..candidates.len()).filter(|i| !chosen.contains(i)).map(|i| (i, total(&costs[i])));
        let Some((best, _)) = left.min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        chosen.push(best);
        least.iter_mut().zip(&costs[best]).for_each(|(least, cost)| *least = least.min(*cost));
    }
    let mut wanted: BTreeSet<Colour> = chosen.into_iter().map(|i| candidates[i].0).collect();
    drawing.layers.iter().flat_map(colours_of).filter(|colour| wanted.remove(colour)).collect()
}

/// A drawing with one layer per pen.
struct Sorted {
    layers: Vec<Layer>,
    /// The other colours merged into each layer.
    became: Vec<BTreeSet<Colour>>,
    painting: Vec<Painted>,
}

/// Makes one layer per palette colour, with the marks of all colours nearest to it.
fn sorted(drawing: &Drawing, palette: &[Colour]) -> Sorted {
    let mut painting = Vec::new();
    let mut layers: Vec<Layer> = (1_u32..).zip(palette).map(|(pen, colour)| empty(drawing, pen, *colour)).collect();
    let mut became = vec![BTreeSet::new(); palette.len()];
    let mut nearest: BTreeMap<Colour, usize> = BTreeMap::new();
    for layer in &drawing.layers {
        for (mark, colour) in layer.marks.iter().zip(colours_of(layer)) {
            let at = *nearest.entry(colour).or_insert_with(|| nearest_of(colour, palette));
            if colour != palette[at] {
                became[at].insert(colour);
            }
            painting.push(Painted::Mark { layer: at, mark: layers[at].marks.len() });
            let mut mark = mark.clone();
            super::pens::drop_own_colour(&mut mark);
            layers[at].marks.push(mark);
        }
    }
    Sorted { layers, became, painting }
}

fn nearest_of(colour: Colour, palette: &[Colour]) -> usize {
    let distance = |i: &usize| colour.difference(palette[*i]);
    (0..palette.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

fn empty(drawing: &Drawing, pen: u32, colour: Colour) -> Layer {
    let like = drawing.layers.first();
    let layer = Layer { ink: Ink::Colour(colour), ..Layer::new(&colour.to_string(), pen) };
    Layer { mixing: like.map_or(layer.mixing, |like| like.mixing), ..layer }
}

/// The message about merged colours, such as `25 colours became one, the one pen of grbl-servo: #1f77b4, #ff7f0e, ...; --pens FILE ...`.
fn told(count: usize, profile: &Profile, palette: &[Colour], became: &[BTreeSet<Colour>]) -> String {
    let advice = "--pens FILE assigns them differently (drypoint profiles --pens-example)";
    if let ([first], [others]) = (palette, became) {
        let all: Vec<Colour> = std::iter::once(*first).chain(others.iter().copied()).collect();
        return format!("{count} colours became one, the one pen of {}: {}; {advice}", profile.name, named(&all));
    }
    let mut text = format!(
        "{count} colours on the {pens} pens of {}: {pens} of them get a pen each, every other goes to the nearest of these: ",
        profile.name,
        pens = palette.len()
    );
    for (pen, (colour, others)) in palette.iter().zip(became).enumerate() {
        let others: Vec<Colour> = others.iter().copied().collect();
        let with = if others.is_empty() { String::new() } else { format!(" with {}", named(&others)) };
        let _ = write!(text, "pen {} {colour}{with}; ", pen + 1);
    }
    text + advice
}

fn named(colours: &[Colour]) -> String {
    let shown = if colours.len() > MOST_NAMED { FEW_NAMED } else { colours.len() };
    let names: Vec<String> = colours.iter().take(shown).map(Colour::to_string).collect();
    let more = colours.len() - shown;
    names.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}
