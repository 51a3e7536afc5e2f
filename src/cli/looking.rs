//! Looks at a photograph, or reads what was seen in it.

use super::arguments::PictureOptions;
use super::failure::Failure;
use super::interruption::interrupt;
use super::seen::Seen;
use super::sight_folder;
use crate::see::{SeeError, can_see, look};
use crate::source::Photograph;

/// Value of `--sight` that turns detection off.
const NOTHING: &str = "none";

/// Runs detection, or reads the `--sight` folder.
pub(super) fn seen(options: &PictureOptions, photograph: &Photograph) -> Result<Seen, Failure> {
    match options.sight.as_deref() {
        Some(NOTHING) => Ok(Seen::nothing("--sight none")),
        Some(folder) => sight_folder::read(folder, photograph),
        None if !can_see() => {
            Ok(Seen::nothing("this drypoint was built without the networks that find faces (cargo feature `see`)"))
        }
        None => Ok(Seen::found(&look(photograph, interrupt()).map_err(|error| failure(&options.photo, error))?)),
    }
}

/// The failure for a detection error.
pub(super) fn failure(photo: &str, error: SeeError) -> Failure {
    match error {
        SeeError::Interrupted(stopped) => stopped.into(),
        other => Failure::about(photo)(&other),
    }
}
