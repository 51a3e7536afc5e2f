//! What is in a photograph: faces with their landmarks, and the people without the background.
//!
//! In: a [`Photograph`]. Out: a [`Sight`] on its pixel grid, without faces and subject if no face is found. Nothing here knows of
//! styles, pages or files. Four small networks are used (`models/`, compiled in with the cargo feature `see`). Their outputs are
//! rounded (masks to 8 bits, points to 1/16 pixel, scores to 1/1000), so that neither the number of threads nor a processor's
//! last bits of arithmetic change the result.
//!
//! ```text
//!   photograph --1024 px--> detector --box--> mesh, three times --corners of the eyes--> irises --> spectacles
//!                   \           \               \--oval, width--v
//!                    \           \--unsure ones: strangers--v
//!                     \----> person, small ones from closer --> colours of both sides --> guided filter --> what hangs together with a face
//!                                                                                  \--> skin, hair, headwear, clothing by colour --> pearls
//!                                                                                  \--> depth: the subject bulged, the faces on it
//! ```

#[cfg(feature = "see")]
mod colours;
#[cfg(feature = "see")]
mod depth;
#[cfg(feature = "see")]
mod detail;
#[cfg(feature = "see")]
mod ear_detail;
#[cfg(feature = "see")]
mod faces;
#[cfg(feature = "see")]
mod far_side;
#[cfg(feature = "see")]
mod hat_outline;
#[cfg(feature = "see")]
mod head;
#[cfg(feature = "see")]
mod iris;
#[cfg(feature = "see")]
mod jewellery;
#[cfg(feature = "see")]
mod looking;
#[cfg(feature = "see")]
mod looks;
#[cfg(feature = "see")]
mod mesh;
#[cfg(feature = "see")]
mod networks;
#[cfg(feature = "see")]
mod pearl_shape;
#[cfg(feature = "see")]
mod regions;
#[cfg(feature = "see")]
mod rims;
#[cfg(feature = "see")]
mod shaded_gaps;
mod sight;
#[cfg(feature = "see")]
mod small_people;
#[cfg(feature = "see")]
mod spectacles;
#[cfg(feature = "see")]
mod subject;
#[cfg(feature = "see")]
mod turn;
#[cfg(feature = "see")]
mod unseen_black;
#[cfg(feature = "see")]
mod view;

#[cfg(feature = "see")]
pub use detail::{DetailRegion, detail_regions};
pub use sight::{Face, Regions, Sight};

use crate::interrupt::{Interrupt, Interrupted};
use crate::source::{Photograph, SourceError};
use thiserror::Error;

/// Why a photograph could not be analysed.
#[derive(Debug, Error)]
pub enum SeeError {
    /// drypoint was built without the networks.
    #[error("cannot be analysed: drypoint was built without its networks; rebuild it with the cargo feature `see`")]
    WithoutNetworks,
    /// A network failed or gave unusable output.
    #[error("cannot be analysed: the network {network} failed: {reason}")]
    Network {
        /// The network's file in `models/`, without the extension.
        network: &'static str,
        /// The engine's message.
        reason: String,
    },
    /// The photograph's pixels could not be read.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The user stopped it.
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
}

/// Whether the networks are compiled in.
pub const fn can_see() -> bool {
    cfg!(feature = "see")
}

/// Analyses a photograph. If no face is found, the result has no faces and no subject.
///
/// ```no_run
/// use drypoint::{interrupt::Interrupt, see, source::{Limits, Photograph}};
///
/// # fn example(bytes: &[u8]) -> Result<(), Box<dyn std::error::Error>> {
/// let photograph = Photograph::decode(bytes, Limits::default())?;
/// let sight = see::look(&photograph, &Interrupt::never())?;
/// let pupils = sight.faces.iter().map(|face| face.landmarks.irises[0].centre);
/// assert_eq!(pupils.count(), sight.faces.len());
/// # Ok(())
/// # }
/// ```
#[cfg(feature = "see")]
pub fn look(photograph: &Photograph, interrupt: &Interrupt) -> Result<Sight, SeeError> {
    looking::look(photograph, interrupt)
}

/// Always fails: the networks were not compiled in (cargo feature `see`).
#[cfg(not(feature = "see"))]
pub fn look(_: &Photograph, _: &Interrupt) -> Result<Sight, SeeError> {
    Err(SeeError::WithoutNetworks)
}
