//! Inks as PDF colours.

use crate::drawing::{Colour, Ink, Layer, Mixing};
use std::fmt::Write as _;

/// The graphics states that knock out what lies below, or print over it.
pub(super) const KNOCK_OUT: &str = "K";
pub(super) const OVERPRINT: &str = "O";

/// The resource name of the i-th spot ink.
pub(super) fn space_name(i: usize) -> String {
    format!("S{i}")
}

/// What a mark is painted with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    /// `DeviceGray`: the black plate alone.
    Grey(u8),
    /// `DeviceRGB`.
    Rgb(Colour),
    /// A spot ink in full, by its number; `overprints` when what lies below stays.
    Spot { number: usize, overprints: bool },
}

impl Paint {
    /// Of a mark with or without a colour of its own. Beside black or spot ink a neutral colour (white, most often) is grey, so
    /// that no mark calls for colour plates without need.
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

    /// Appends the operators that choose it for fills and strokes; `has_spots` says whether overprinting is an issue at all.
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

/// 0 to 255 as 0 to 1, to four digits, which every byte survives.
fn fraction(byte: u8) -> String {
    let mut text = String::new();
    crate::write::decimal(&mut text, (f64::from(byte) / 255.0 * 10_000.0).round() as i64, 4);
    text
}
