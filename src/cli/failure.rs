//! Errors as the user sees them, and their exit statuses.

use super::interruption::{INTERRUPTED, exit_status};
use super::remedies::advised;
use super::words::counted;
use std::io;
use thiserror::Error;

#[derive(Debug, Error)]
pub(super) enum Failure {
    /// The command line is wrong.
    #[error("{0}")]
    Usage(String),
    /// The work failed.
    #[error("{0}")]
    Work(String),
    /// A drawing does not fit its machine; the advice depends on the command.
    #[error("{0}")]
    Misfit(crate::plot::MountingError),
    /// Some pictures of a batch could not be drawn.
    #[error("{} could not be drawn; their lines say why, and a second run tries them again", counted(*failed as usize, "picture"))]
    Some {
        /// How many.
        failed: u64,
    },
    /// The user stopped it.
    #[error("{INTERRUPTED}")]
    Interrupted,
    /// A drawing was stopped at its machine by a key.
    #[cfg(feature = "drive")]
    #[error("stopped")]
    Stopped,
    /// The reader of our output has closed it.
    #[error("closed pipe")]
    ClosedPipe,
}

impl Failure {
    pub(super) fn exit_status(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Work(_) | Self::Misfit(_) => 1,
            Self::Some { .. } => 3,
            Self::Interrupted => exit_status(),
            #[cfg(feature = "drive")]
            Self::Stopped => 130,
            Self::ClosedPipe => 0,
        }
    }

    /// A failure about a file; the message begins with its name.
    pub(super) fn about(name: &str) -> impl Fn(&dyn std::fmt::Display) -> Self {
        move |problem| Self::Work(format!("{name} {problem}"))
    }

    /// The failure for an error while writing.
    pub(super) fn writing(name: &str) -> impl Fn(io::Error) -> Self {
        move |error| match error.kind() {
            io::ErrorKind::BrokenPipe => Self::ClosedPipe,
            io::ErrorKind::Interrupted => Self::Interrupted,
            io::ErrorKind::StorageFull => {
                Self::Work(format!("{name} cannot be written: the disk is full; free some space or choose another folder"))
            }
            io::ErrorKind::PermissionDenied => {
                Self::Work(format!("{name} cannot be written: permission denied; choose another folder with -o"))
            }
            io::ErrorKind::NotFound => Self::Work(format!("{name} cannot be written: its folder does not exist; make it first")),
            _ => Self::Work(format!("{name} cannot be written: {error}")),
        }
    }
}

macro_rules! usage_errors {
    ($($error:ty),*) => { $(impl From<$error> for Failure {
        fn from(error: $error) -> Self {
            Self::Usage(error.to_string())
        }
    })* };
}

usage_errors!(crate::style::ParameterError);

impl From<crate::plot::ProfileError> for Failure {
    fn from(error: crate::plot::ProfileError) -> Self {
        Self::Usage(advised(&error))
    }
}

impl From<crate::interrupt::Interrupted> for Failure {
    fn from(_: crate::interrupt::Interrupted) -> Self {
        Self::Interrupted
    }
}

impl From<crate::plot::MountingError> for Failure {
    fn from(error: crate::plot::MountingError) -> Self {
        Self::Misfit(error)
    }
}
