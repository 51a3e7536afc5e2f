//! Why a profile could not be used.

use std::fmt;
use thiserror::Error;

/// Why a profile could not be used.
#[derive(Debug, Error, PartialEq)]
pub enum ProfileError {
    /// There is no built-in profile of this name.
    #[error("there is no plotter profile '{name}'; there are {known}, or give the path of a .toml file")]
    Unknown {
        /// The requested name.
        name: String,
        /// All built-in names.
        known: String,
    },
    /// The text is not TOML, or has an unknown key or a value of the wrong type.
    #[error("{place}: {message}")]
    Syntax {
        /// The place of the fault.
        place: KeyPlace,
        /// What is wrong, with the key's name.
        message: String,
    },
    /// A value is out of range or contradicts another.
    #[error("{place}: {key} {problem}")]
    Value {
        /// The place of the fault.
        place: KeyPlace,
        /// The key.
        key: String,
        /// What is wrong with it.
        problem: String,
    },
}

/// The place of a profile's key.
#[derive(Clone, Debug, PartialEq)]
pub enum KeyPlace {
    /// Somewhere in a file, or in the profile of this name.
    File(String),
    /// In a line of a file.
    Line {
        /// The file's name.
        file: String,
        /// The line, from 1.
        line: usize,
    },
    /// Not in a file: the key was set as an override.
    Set,
}

impl fmt::Display for KeyPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(name) => f.write_str(name),
            Self::Line { file, line } => write!(f, "{file}, line {line}"),
            Self::Set => f.write_str("a key set over the profile"),
        }
    }
}
