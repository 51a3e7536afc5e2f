//! A style's parameters, declared once: the table that help and checks read, and the values that the style works with.
//!
//! ```text
//! parameters! {
//!     pub(super) struct GridParameters {
//!         pitch: Millimetres = "pitch": millimetres(0.6, 0.1..=50.0),
//!             "distance between neighbouring dots", "Son 5.1, d";
//!         hatching: Hatching = "hatching": Kind::Choice(Hatching::WORDS),
//!             "hatching direction", "Son 6.2", needs [MIXED];
//!     }
//! }
//! ```

use super::{DefaultLength, Kind, Places, Settings};
use crate::geometry::Millimetres;
use std::ops::RangeInclusive;

/// A value that a style reads from its settings.
pub(super) trait Setting {
    fn of(settings: &Settings, name: &str) -> Self;
}

impl Setting for f64 {
    fn of(settings: &Settings, name: &str) -> Self {
        settings.number(name)
    }
}

impl Setting for Millimetres {
    fn of(settings: &Settings, name: &str) -> Self {
        Self(settings.number(name))
    }
}

impl Setting for f32 {
    fn of(settings: &Settings, name: &str) -> Self {
        settings.number(name) as Self
    }
}

impl Setting for u32 {
    fn of(settings: &Settings, name: &str) -> Self {
        settings.number(name) as Self
    }
}

/// True if the word is `on`.
impl Setting for bool {
    fn of(settings: &Settings, name: &str) -> Self {
        settings.word(name) == "on"
    }
}

impl Setting for Places {
    fn of(settings: &Settings, name: &str) -> Self {
        settings.places(name)
    }
}

/// An angle that is set in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Radians(pub f64);

impl Setting for Radians {
    fn of(settings: &Settings, name: &str) -> Self {
        Self(settings.number(name).to_radians())
    }
}

/// Words of a switch that is on by default.
pub(super) const ON: Kind = Kind::Choice(&["on", "off"]);
/// Words of a switch that is off by default.
pub(super) const OFF: Kind = Kind::Choice(&["off", "on"]);

/// A length with a default in millimetres.
pub(super) const fn millimetres(default: f64, range: RangeInclusive<f64>) -> Kind {
    Kind::Length { default: DefaultLength::Millimetres(default), least: *range.start(), most: *range.end() }
}

/// A length whose default follows the pitch; its range is in millimetres.
pub(super) const fn pitches(default: f64, range: RangeInclusive<f64>) -> Kind {
    Kind::Length { default: DefaultLength::Pitches(default), least: *range.start(), most: *range.end() }
}

/// A plain number.
pub(super) const fn number(default: f64, range: RangeInclusive<f64>) -> Kind {
    Kind::Number { default, least: *range.start(), most: *range.end() }
}

/// A whole number.
pub(super) const fn count(default: u32, range: RangeInclusive<u32>) -> Kind {
    Kind::Count { default, least: *range.start(), most: *range.end() }
}

/// Declares a style's parameters, one of them its pitch: the constant `PARAMETERS` and a struct of their values with
/// `new(&Settings)`, which a method of the style may adjust.
macro_rules! parameters {
    (
        $(#[$attribute:meta])*
        $visibility:vis struct $name:ident {
            $($field:ident: $kind_of_value:ty = $key:literal: $kind:expr, $meaning:literal, $source:literal
                $(, needs [$($need:expr),* $(,)?])?;)*
        }
        $(adjusted by $adjust:ident)?
    ) => {
        /// All parameters of the style.
        $visibility const PARAMETERS: &[$crate::style::Parameter] = &[$($crate::style::Parameter {
            name: $key,
            kind: $kind,
            meaning: $meaning,
            source: $source,
            needs: &[$($($need),*)?],
        }),*];

        $(#[$attribute])*
        #[derive(Clone, Copy, Debug)]
        $visibility struct $name {
            $($visibility $field: $kind_of_value,)*
        }

        impl $name {
            /// The values of a drawing's settings.
            $visibility fn new(settings: &$crate::style::Settings) -> Self {
                Self { $($field: $crate::style::declaration::Setting::of(settings, $key),)* }$(.$adjust())?
            }
        }

        impl $crate::style::drawer::Pitched for $name {
            fn pitch(&self) -> $crate::geometry::Millimetres {
                self.pitch
            }
        }
    };
}

/// Declares choices: each an enum and its words, the default first.
macro_rules! choices {
    ($($(#[$attribute:meta])* $visibility:vis enum $name:ident { $($variant:ident = $word:literal),* $(,)? })*) => {$(
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $visibility enum $name {
            $($variant,)*
        }

        impl $name {
            /// Its words, the default first.
            $visibility const WORDS: &'static [&'static str] = &[$($word),*];
        }

        impl $crate::style::declaration::Setting for $name {
            fn of(settings: &$crate::style::Settings, name: &str) -> Self {
                match settings.word(name) {
                    $($word => Self::$variant,)*
                    word => unreachable!("{word} is none of the words that were declared"),
                }
            }
        }
    )*};
}

pub(super) use {choices, parameters};
