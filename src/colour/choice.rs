//! Which few pens of a full box draw a photograph best.
//!
//! ```text
//!   photograph --cells of like colours--> some 100 colours, each by the root of its share
//!   pens: the best one, then whichever helps most, ... ; then exchanges, while one helps
//! ```

use super::eye::{Oklab, look_of_light};
use super::matching::Matching;
use super::pens::{ColourPen, MOST_PENS, Paper, PenSet, PensError, drawing_order};
use super::settings::Settings;
use crate::parallel::mapped;
use crate::raster::Raster;
use std::collections::BTreeMap;

/// Cells along each channel, equal in the square root of light: 6 leave 60 to 110 colours of a photograph. With 4, skin and lips are
/// one colour; more than 8 only take time.
const CELLS: usize = 6;
/// Rounds of exchanges; the third seldom finds one.
const MOST_ROUNDS: usize = 4;
/// An exchange must help by this share, so that nearly equal pens do not alternate.
const HELPS: f32 = 1e-4;

/// The `count` pens, as ascending indices, whose mixtures come nearest to a photograph's colours: linear sRGB light, 0 to 1 per channel.
///
/// Colours count by the root of their area, so that a red hat is not lost beside a grey wall. Pens that cannot be used together, such
/// as two alike, are not chosen together. All pens, if there are no more than `count`; with none that can be used it is an error.
///
/// # Errors
/// What is wrong with the pens, if no `count` of them can be used together.
pub fn choose(
    pens: &[ColourPen],
    paper: Paper,
    settings: &Settings,
    photograph: &Raster<[f32; 3]>,
    count: usize,
) -> Result<Vec<usize>, PensError> {
    let count = count.min(MOST_PENS);
    if pens.len() <= count {
        return Ok((0..pens.len()).collect());
    }
    let colours = main_colours(photograph);
    let choice = Choice { pens, paper, settings, colours: &colours };
    let mut chosen: Vec<usize> = Vec::new();
    let mut cost = f32::INFINITY;
    while chosen.len() < count {
        let sets = others(pens.len(), &chosen).map(|pen| chosen.iter().copied().chain([pen]).collect());
        (chosen, cost) = choice.best(sets.collect())?;
    }
    for _ in 0..MOST_ROUNDS {
        let (exchanged, lower) = choice.best(exchanges(pens.len(), &chosen))?;
        if lower >= cost * (1.0 - HELPS) {
            break;
        }
        (chosen, cost) = (exchanged, lower);
    }
    chosen.sort_unstable();
    Ok(chosen)
}

fn others(pens: usize, chosen: &[usize]) -> impl Iterator<Item = usize> {
    (0..pens).filter(|pen| !chosen.contains(pen))
}

/// All sets with one pen exchanged.
fn exchanges(pens: usize, chosen: &[usize]) -> Vec<Vec<usize>> {
    let exchanged = |place: usize| {
        others(pens, chosen).map(move |pen| {
            let mut set = chosen.to_vec();
            set[place] = pen;
            set
        })
    };
    (0..chosen.len()).flat_map(exchanged).collect()
}

/// A colour and how much it counts.
struct MainColour {
    look: Oklab,
    weight: f32,
}

/// The mean colours of the cells that a photograph uses.
fn main_colours(photograph: &Raster<[f32; 3]>) -> Vec<MainColour> {
    let mut cells: BTreeMap<[usize; 3], ([f64; 3], f64)> = BTreeMap::new();
    for light in photograph.pixels() {
        let light = light.map(|v| if v > 0.0 { v.min(1.0) } else { 0.0 });
        let cell = light.map(|v| ((v.sqrt() * CELLS as f32) as usize).min(CELLS - 1));
        let (sum, count) = cells.entry(cell).or_default();
        sum.iter_mut().zip(light).for_each(|(sum, v)| *sum += f64::from(v));
        *count += 1.0;
    }
    let colour = |(sum, count): &([f64; 3], f64)| MainColour {
        look: look_of_light(sum.map(|v| (v / count) as f32)),
        weight: count.sqrt() as f32,
    };
    cells.values().map(colour).collect()
}

struct Choice<'a> {
    pens: &'a [ColourPen],
    paper: Paper,
    settings: &'a Settings,
    colours: &'a [MainColour],
}

impl Choice<'_> {
    /// The set of least cost, the first of equals.
    fn best(&self, sets: Vec<Vec<usize>>) -> Result<(Vec<usize>, f32), PensError> {
        let costs: Vec<Result<f32, PensError>> = mapped(&sets, &|set| self.cost(set));
        let mut best: Option<(usize, f32)> = None;
        let mut failure = PensError::None;
        for (i, cost) in costs.into_iter().enumerate() {
            match cost {
                Ok(cost) if best.is_none_or(|(_, least)| cost < least) => best = Some((i, cost)),
                Ok(_) => {}
                Err(error) => failure = error,
            }
        }
        let (i, cost) = best.ok_or(failure)?;
        Ok((sets.into_iter().nth(i).unwrap_or_default(), cost))
    }

    /// The visible differences that remain, by the weights of the colours.
    fn cost(&self, set: &[usize]) -> Result<f32, PensError> {
        let pens: Vec<ColourPen> = set.iter().map(|pen| self.pens[*pen].clone()).collect();
        let order = drawing_order(&pens);
        let set = PenSet::new(order.into_iter().map(|pen| pens[pen].clone()).collect(), self.paper, Vec::new())?;
        let matching = Matching::new(&set, self.settings);
        let cost = |colour: &MainColour| colour.weight * (2.0 * matching.nearest(colour.look).cost).sqrt();
        Ok(self.colours.iter().map(cost).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Colour;

    fn chosen(names: &[&str], colours: &[&str], count: usize) -> Vec<String> {
        let pen = |name: &&str| ColourPen::new(*name, 0.3, name.parse::<Colour>().unwrap());
        let pens: Vec<ColourPen> = names.iter().map(pen).collect();
        let light = |name: &&str| ColourPen::new("", 0.3, name.parse::<Colour>().unwrap()).colour.map(|v| v as f32);
        let lights: Vec<[f32; 3]> = colours.iter().map(light).collect();
        let photograph = Raster::from_vec(lights.len(), 1, lights);
        let found = choose(&pens, Paper::WHITE, &Settings::default(), &photograph, count).unwrap();
        found.into_iter().map(|pen| pens[pen].name.clone()).collect()
    }

    const PENS: [&str; 9] = ["black", "#f3d83a", "#1b9fd0", "#bf3a8f", "#d33b33", "#2957a8", "#3f9b4b", "#8a5a35", "#ee8c36"];

    #[test]
    fn pens_are_those_of_the_picture() {
        let forest = ["#0a120a", "#1c3a1c", "#2f6e35", "#6fae6f", "#bfe0bf", "white"];
        let found = chosen(&PENS, &forest, 2);
        assert_eq!(found, ["black", "#3f9b4b"]);
        let fire = ["#120804", "#5a1208", "#a02418", "#d85a20", "#f0a040", "#f6d870", "white"];
        let found = chosen(&PENS, &fire, 3);
        assert!(
            found.contains(&"black".to_owned()) && !found.iter().any(|pen| ["#2957a8", "#1b9fd0", "#3f9b4b"].contains(&&**pen))
        );
    }

    #[test]
    fn few_pens_are_all_chosen_and_pens_alike_not_together() {
        assert_eq!(chosen(&PENS[..3], &["gray"], 4).len(), 3);
        let found = chosen(&["black", "#010101", "#d33b33"], &["black", "#800000", "white"], 2);
        assert_eq!(found.len(), 2);
        assert!(found.contains(&"#d33b33".to_owned()));
    }
}
