//! Inks as PDF colours.

use crate::drawing::{Colour, Ink, Layer, Mixing};
use std::fmt::Write as _;

/// Resource names of the graphics states that knock out the ink below, or overprint it.
pub(super) const KNOCK_OUT: &str = "K";
pub(super) const OVERPRINT: &str = "O";

/// The resource name of the i-th spot ink.
pub(super) fn space_name(i: usize) -> String {
    format!("S{i}")
}

/// The paint of a mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    /// `DeviceGray`: the black plate alone.
    Grey(u8),
    /// `DeviceRGB`.
    Rgb(Colour),
    /// A spot ink at full tint, by its number; `overprints` keeps the ink below.
    Spot { number: usize, overprints: bool },
}

impl Paint {
    /// The paint of a mark with or without its own colour. In a layer of black or spot ink, a neutral colour (usually white)
    /// becomes grey, so that it needs no colour plates.
    pub(super) fn of(layer: &Layer, own: Option<Colour>, spots: &[&str]) -> Self {
        match (own, &layer.ink) {
            (Some(colour), Ink::Black | Ink::Spot(_)) if colour.r == colour.g && colour.g == colour.b => Self::Grey(colour.r),
            (Some(colour), _) => Self::Rgb(colour),
            (None, Ink::Colour(colour)) => Self::Rgb(*colour),
            (None, Ink::Black) => Self::Grey(0),
            (None, Ink::Spot(name)) => Self::Spot {
                number: spots.iter().position(|spot| spot == name).unwrap_or(0),
                overprints: layer.mixing == Mixing::Add,
            },
        }
    }

    /// Appends the operators that select it for fills and strokes; the graphics state is written only if the file `has_spots`.
    pub(super) fn select(self, text: &mut String, has_spots: bool) {
        if has_spots {
            let state = if matches!(self, Self::Spot { overprints: true, .. }) { OVERPRINT } else { KNOCK_OUT };
            let _ = write!(text, "/{state} gs ");
        }
        match self {
            Self::Grey(grey) => {
                let grey = fraction(grey);
                let _ = writeln!(text, "{grey} g {grey} G");
            }
            Self::Rgb(Colour { r, g, b }) => {
                let rgb = [r, g, b].map(fraction).join(" ");
                let _ = writeln!(text, "{rgb} rg {rgb} RG");
            }
            Self::Spot { number, .. } => {
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
