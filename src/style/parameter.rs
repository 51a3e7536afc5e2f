//! Parameters as data: name, unit, range, default, meaning, source.

use super::Need;
use super::need::all_text;
use thiserror::Error;

/// One parameter of a style.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its key in `--set KEY=VALUE`.
    pub name: &'static str,
    /// What values it takes.
    pub kind: Kind,
    /// What it does, for a user.
    pub meaning: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// Conditions for it to have an effect; all must hold.
    pub needs: &'static [Need],
}

impl Parameter {
    /// Its conditions in words; empty if it always has an effect.
    pub fn needs_text(&self) -> String {
        all_text(self.needs)
    }
}

/// What values a parameter takes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A length on the page in millimetres.
    Length {
        /// The default.
        default: DefaultLength,
        /// Minimum in millimetres.
        least: f64,
        /// Maximum in millimetres.
        most: f64,
    },
    /// A plain number.
    Number {
        /// The default.
        default: f64,
        /// Minimum.
        least: f64,
        /// Maximum.
        most: f64,
    },
    /// A whole number.
    Count {
        /// The default.
        default: u32,
        /// Minimum.
        least: u32,
        /// Maximum.
        most: u32,
    },
    /// One of these words; the first is the default.
    Choice(&'static [&'static str]),
    /// Places in the picture; none by default.
    Places {
        /// Maximum number, up to [`Places::MOST`](super::Places::MOST).
        most: usize,
    },
}

/// The default of a length.
#[derive(Clone, Copy, Debug)]
pub enum DefaultLength {
    /// In millimetres.
    Millimetres(f64),
    /// As a multiple of the pitch.
    Pitches(f64),
}

/// Why settings were refused.
#[derive(Debug, Error, PartialEq)]
pub enum ParameterError {
    /// No such key.
    #[error("'{key}' is not a parameter of {style}; its parameters are {known}{hint}")]
    Unknown {
        /// The text as given.
        key: String,
        /// The style.
        style: String,
        /// All keys.
        known: String,
        /// The nearest key, if one is near.
        hint: String,
    },
    /// A value of the wrong kind or out of range.
    #[error("{key}={value} is not valid; expected {expected}")]
    Value {
        /// The key.
        key: String,
        /// The text as given.
        value: String,
        /// What would be accepted.
        expected: String,
    },
}

impl Kind {
    /// The default as a number, lengths in millimetres at this pitch; none for choices.
    pub fn default_number(&self, pitch: f64) -> Option<f64> {
        match *self {
            Self::Length { default: DefaultLength::Millimetres(mm), .. } => Some(mm),
            Self::Length { default: DefaultLength::Pitches(pitches), .. } => Some(pitches * pitch),
            Self::Number { default, .. } => Some(default),
            Self::Count { default, .. } => Some(f64::from(default)),
            Self::Choice(_) | Self::Places { .. } => None,
        }
    }

    /// Minimum and maximum in the form that `--set` accepts; none for choices and places.
    pub fn ends(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Length { least, most, .. } | Self::Number { least, most, .. } => Some([least, most]),
            Self::Count { least, most, .. } => Some([f64::from(least), f64::from(most)]),
            Self::Choice(_) | Self::Places { .. } => None,
        }
    }

    /// The default in words.
    pub fn default_text(&self) -> String {
        match *self {
            Self::Length { default: DefaultLength::Millimetres(mm), .. } => format!("{mm} mm"),
            Self::Length { default: DefaultLength::Pitches(pitches), .. } => {
                format!("{} pitches", (pitches * 100.0).round() / 100.0)
            }
            Self::Number { default, .. } => default.to_string(),
            Self::Count { default, .. } => default.to_string(),
            Self::Choice(words) => words[0].to_owned(),
            Self::Places { .. } => "none".to_owned(),
        }
    }

    /// The unit and range in words.
    pub fn range_text(&self) -> String {
        match *self {
            Self::Length { least, most, .. } => format!("length, {least} to {most} mm"),
            Self::Number { least, most, .. } => format!("number, {least} to {most}"),
            Self::Count { least, most, .. } => format!("whole number, {least} to {most}"),
            Self::Choice(words) => format!("one of {}", words.join(", ")),
            Self::Places { most } => format!("up to {most} places x,y;x,y in percent of the picture"),
        }
    }
}
