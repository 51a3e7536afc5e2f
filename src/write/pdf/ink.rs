//! Inks as PDF colours.

use crate::drawing::{Colour, Ink, Layer, Mixing};
use std::fmt::Write as _;

/// Resource names of the graphics states: ink that knocks out what is below or overprints it, and layers that are multiplied with it.
pub(super) const KNOCK_OUT: &str = "K";
pub(super) const OVERPRINT: &str = "O";
pub(super) const MULTIPLY: &str = "M";

/// The resource name of the i-th spot ink.
pub(super) fn space_name(i: usize) -> String {
    format!("S{i}")
}

/// The colour of a mark.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Tint {
    /// `DeviceGray`: the black plate alone.
    Grey(u8),
    /// `DeviceRGB`.
    Rgb(Colour),
    /// A spot ink at full tint, by its number.
    Spot(usize),
}

/// The paint of a mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Paint {
    tint: Tint,
    /// It leaves the ink of other plates below it.
    overprints: bool,
}

/// The inks of a drawing, as far as paints depend on one another.
pub(super) struct Inks<'a> {
    /// The distinct spot inks with their colours on screen, in the order of the layers.
    pub spots: Vec<(&'a str, Colour)>,
    /// Layers differ in colour: where they overlap it is seen.
    mixes: bool,
}

impl<'a> Inks<'a> {
    pub fn of(layers: &'a [Layer]) -> Self {
        let mut spots: Vec<(&str, Colour)> = Vec::new();
        for layer in layers {
            if let Ink::Spot { name, shown } = &layer.ink
                && !spots.iter().any(|(known, _)| known == name)
            {
                spots.push((name, *shown));
            }
        }
        Self { spots, mixes: layers.iter().any(|layer| layer.ink.colour() != layers[0].ink.colour()) }
    }

    /// True for a colour on other colours. Having no plates it cannot overprint; as a group it is multiplied, as ink on paper is.
    pub fn is_multiplied(&self, layer: &Layer) -> bool {
        self.mixes && layer.mixing == Mixing::Add && matches!(layer.ink, Ink::Colour(_))
    }
}

impl Paint {
    /// The paint of a mark with or without its own colour. In a layer of black or spot ink, a neutral colour (usually white)
    /// becomes grey, so that it needs no colour plates.
    pub(super) fn of(layer: &Layer, own: Option<Colour>, inks: &Inks<'_>) -> Self {
        let tint = match (own, &layer.ink) {
            (Some(colour), Ink::Black | Ink::Spot { .. }) if colour.r == colour.g && colour.g == colour.b => Tint::Grey(colour.r),
            (Some(colour), _) => Tint::Rgb(colour),
            (None, Ink::Colour(colour)) => Tint::Rgb(*colour),
            (None, Ink::Black) => Tint::Grey(0),
            (None, Ink::Spot { name, .. }) => Tint::Spot(inks.spots.iter().position(|(spot, _)| spot == name).unwrap_or(0)),
        };
        // A mark with a colour of its own is a light in the ink.
        let overprints = own.is_none() && layer.mixing == Mixing::Add && !matches!(tint, Tint::Rgb(_));
        Self { tint, overprints }
    }

    /// A colour that covers what is below.
    pub(super) const fn covering(colour: Colour) -> Self {
        Self { tint: Tint::Rgb(colour), overprints: false }
    }

    /// Appends the operators that select it for fills and strokes; overprinting only matters in a file with spot inks.
    pub(super) fn select(self, text: &mut String, inks: &Inks<'_>) {
        if !inks.spots.is_empty() {
            let state = if self.overprints { OVERPRINT } else { KNOCK_OUT };
            let _ = write!(text, "/{state} gs ");
        }
        match self.tint {
            Tint::Grey(grey) => {
                let grey = fraction(grey);
                let _ = writeln!(text, "{grey} g {grey} G");
            }
            Tint::Rgb(Colour { r, g, b }) => {
                let rgb = [r, g, b].map(fraction).join(" ");
                let _ = writeln!(text, "{rgb} rg {rgb} RG");
            }
            Tint::Spot(number) => {
                let space = space_name(number);
                let _ = writeln!(text, "/{space} cs 1 scn /{space} CS 1 SCN");
            }
        }
    }
}

/// Converts 0 to 255 to 0 to 1 with four decimals, which distinguishes all bytes.
fn fraction(byte: u8) -> String {
    let mut text = String::new();
    crate::write::decimal(&mut text, (f64::from(byte) / 255.0 * 10_000.0).round() as i64, 4);
    text
}
