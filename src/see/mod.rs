//! What is in a photograph: faces with their points, and the person without the background.
//!
//! In: a [`Photograph`]. Out: a [`Sight`] on its pixel grid, or nothing where there is no face. Nothing here knows of styles, pages
//! or files. Four small networks look (`models/`, compiled in with the cargo feature `see`); whatever leaves one is rounded (masks to
//! 8 bits, points to 1/16 pixel, scores to 1/1000), so that neither threads nor the last bits of a processor's arithmetic show.
//!
//! ```text
//!   photograph --1024 px--> detector --box--> mesh, three times --corners of the eyes--> irises
//!                   \           \               \--oval, width--v
//!                    \           \--unsure ones: strangers--v
//!                     \----> person, three looks --> colours of both sides --> guided filter --> what hangs together with a face
//!                                                                                  \--> skin, hair, headwear, clothing by colour
//!                                                                                  \--> depth: the subject bulged, the faces on it
//! ```

#[cfg(feature = "see")]
mod colours;
#[cfg(feature = "see")]
mod depth;
#[cfg(feature = "see")]
mod detail;
#[cfg(feature = "see")]
mod faces;
#[cfg(feature = "see")]
mod head;
#[cfg(feature = "see")]
mod iris;
#[cfg(feature = "see")]
mod looking;
#[cfg(feature = "see")]
mod looks;
#[cfg(feature = "see")]
mod mesh;
#[cfg(feature = "see")]
mod networks;
#[cfg(feature = "see")]
mod regions;
mod sight;
#[cfg(feature = "see")]
mod subject;
#[cfg(feature = "see")]
mod turn;
#[cfg(feature = "see")]
mod view;

#[cfg(feature = "see")]
pub use detail::{DetailRegion, detail_regions};
pub use sight::{Face, Regions, Sight};

use crate::interrupt::{Interrupt, Interrupted};
use crate::source::{Photograph, SourceError};
use thiserror::Error;

/// Why a photograph could not be looked at.
#[derive(Debug, Error)]
pub enum SeeError {
    /// The networks were left out when drypoint was built.
    #[error("cannot be looked at: this drypoint was built without its networks; build it with the cargo feature `see`")]
    WithoutNetworks,
    /// A network does not do what it is there for.
    #[error("cannot be looked at: the network {network} failed: {reason}")]
    Network {
        /// Its file in `models/`, without the ending.
        network: &'static str,
        /// The engine's words.
        reason: String,
    },
    /// The photograph's pixels could not be had.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The user stopped it.
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
}

/// Whether this drypoint can look at photographs.
pub const fn can_see() -> bool {
    cfg!(feature = "see")
}

/// Looks at a photograph: a sight without faces, and so without a subject, where no face was found.
#[cfg(feature = "see")]
pub fn look(photograph: &Photograph, interrupt: &Interrupt) -> Result<Sight, SeeError> {
    looking::look(photograph, interrupt)
}

/// Looks at a photograph, which this drypoint cannot: it was built without the cargo feature `see`.
#[cfg(not(feature = "see"))]
pub fn look(_: &Photograph, _: &Interrupt) -> Result<Sight, SeeError> {
    Err(SeeError::WithoutNetworks)
}
