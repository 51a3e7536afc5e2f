//! Why a profile could not be used.

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
        /// File and line, or the option.
        place: String,
        /// What is wrong there, the key named.
        message: String,
    },
    /// A value that cannot be.
    #[error("{place}: {key} {problem}")]
    Value {
        /// File and line, or the option.
        place: String,
        /// The key.
        key: String,
        /// What is wrong with it.
        problem: String,
    },
}
