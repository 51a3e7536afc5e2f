//! Why a profile could not be used.

use std::fmt;
use thiserror::Error;

/// Why a profile could not be used.
#[derive(Debug, Error, PartialEq)]
pub enum ProfileError {
    /// No such name.
    #[error("there is no plotter profile '{name}'; there are {known}, or give the path of a .toml file")]
    Unknown {
        /// What was asked for.
        name: String,
        /// All built-in names.
        known: String,
    },
    /// Not TOML, or a key or value that is not a profile's.
    #[error("{place}: {message}")]
    Syntax {
        /// Where it stands.
        place: KeyPlace,
        /// What is wrong there, the key named.
        message: String,
    },
    /// A value that cannot be.
    #[error("{place}: {key} {problem}")]
    Value {
        /// Where it stands.
        place: KeyPlace,
        /// The key.
        key: String,
        /// What is wrong with it.
        problem: String,
    },
}

/// Where a key of a profile stands.
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
    /// It was set over the file's keys.
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
