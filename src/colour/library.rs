//! Common pens, as data.

use super::pens::{ColourPen, Opacity, Paper, light_of};
use crate::drawing::Colour;
use toml::{Table, Value};

/// The data, one table per pen.
const DATA: &str = include_str!("pens.toml");

/// A pen that can be bought, with an estimate of its colour.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownPen {
    /// Who makes it.
    pub maker: String,
    /// Its name, unique in the library.
    pub name: String,
    /// Width of its line in mm.
    pub width_mm: f64,
    /// Colour of an area fully covered by it, on white paper; always an estimate.
    pub colour: Colour,
    /// Whether it covers what lies below.
    pub opacity: Opacity,
    /// Where the estimate comes from.
    pub source: String,
}

impl KnownPen {
    /// The pen on a paper: a transparent ink takes from the paper's light what it takes from white's.
    pub fn on(&self, paper: Paper) -> ColourPen {
        let ink = light_of(self.colour);
        let colour = match self.opacity {
            Opacity::Opaque => ink,
            Opacity::Transparent => [0, 1, 2].map(|i| ink[i] * paper.colour[i]),
        };
        ColourPen { name: format!("{} {}", self.maker, self.name), width_mm: self.width_mm, colour, opacity: self.opacity }
    }
}

/// All pens of the library, by maker and line.
pub fn known_pens() -> Vec<KnownPen> {
    let Ok(data) = DATA.parse::<Table>() else { return Vec::new() };
    let sources = data.get("sources").and_then(Value::as_table);
    let pens = data.get("pens").and_then(Value::as_array);
    pens.into_iter().flatten().filter_map(|pen| known_pen(pen.as_table()?, sources?)).collect()
}

/// The pen of a name, with or without its maker, in any case.
pub fn known_pen_named(name: &str) -> Option<KnownPen> {
    let name = name.trim();
    let is_it =
        |pen: &KnownPen| pen.name.eq_ignore_ascii_case(name) || format!("{} {}", pen.maker, pen.name).eq_ignore_ascii_case(name);
    known_pens().into_iter().find(is_it)
}

fn known_pen(pen: &Table, sources: &Table) -> Option<KnownPen> {
    let text = |key: &str| pen.get(key)?.as_str();
    let is_opaque = pen.get("opaque").and_then(Value::as_bool).unwrap_or(false);
    Some(KnownPen {
        maker: text("maker")?.to_owned(),
        name: text("name")?.to_owned(),
        width_mm: pen.get("width")?.as_float()?,
        colour: text("colour")?.parse().ok()?,
        opacity: if is_opaque { Opacity::Opaque } else { Opacity::Transparent },
        source: sources.get(text("source")?)?.as_str()?.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::pens::PenSet;
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_pen_is_whole() {
        let pens = known_pens();
        assert_eq!(pens.len(), DATA.matches("[[pens]]").count());
        assert!(pens.len() > 50);
        let names: BTreeSet<&str> = pens.iter().map(|pen| pen.name.as_str()).collect();
        assert_eq!(names.len(), pens.len());
        assert!(pens.iter().all(|pen| (0.1..2.0).contains(&pen.width_mm) && !pen.source.is_empty()));
    }

    #[test]
    fn every_pen_can_be_used() {
        let cream = Paper { colour: [0.93, 0.9, 0.8] };
        for pen in known_pens() {
            // White on white is nothing, and said so.
            let paper = if pen.name.ends_with("white") { Paper { colour: [0.5, 0.4, 0.3] } } else { cream };
            let set = PenSet::new(vec![pen.on(paper)], paper, Vec::new());
            assert!(set.is_ok(), "{}: {}", pen.name, set.unwrap_err());
        }
    }

    #[test]
    fn pens_are_found_by_name() {
        assert_eq!(known_pen_named("sakura pigma micron 05 black").map(|pen| pen.width_mm), Some(0.45));
        assert_eq!(known_pen_named(" Pigma Micron 05 Black ").map(|pen| pen.maker), Some("Sakura".to_owned()));
        assert_eq!(known_pen_named("no such pen"), None);
    }
}
