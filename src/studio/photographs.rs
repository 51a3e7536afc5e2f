//! The photograph as the page shows it.

use super::error::StudioError;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

/// Makes a picture of a photograph for the page, its long side at most so many pixels.
pub type Shower = fn(&Path, u32) -> Result<Shown, String>;

/// Long sides of pictures that are shown, in pixels.
const SIDES: std::ops::RangeInclusive<u32> = 64..=4096;

/// A photograph as the page shows it.
#[derive(Debug)]
pub struct Shown {
    /// Width and height of the photograph itself in pixels, upright.
    pub size: (u32, u32),
    /// The picture.
    pub jpeg: Vec<u8>,
}

/// What tells one state of a file from another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Seal(PathBuf, Option<(SystemTime, u64)>);

impl Seal {
    pub(super) fn of(file: &Path) -> Self {
        let found = std::fs::metadata(file).ok();
        Self(file.to_owned(), found.and_then(|found| Some((found.modified().ok()?, found.len()))))
    }
}

/// The picture that was made last.
pub(super) struct Photographs {
    show: Shower,
    last: Mutex<Option<(Seal, u32, Arc<Shown>)>>,
}

impl Photographs {
    pub(super) const fn new(show: Shower) -> Self {
        Self { show, last: Mutex::new(None) }
    }

    /// The picture with a long side of at most `long` pixels. `None` takes any that is there.
    pub(super) async fn shown(&self, file: &Path, long: Option<u32>) -> Result<Arc<Shown>, StudioError> {
        let seal = Seal::of(file);
        let long = long.map(|long| long.clamp(*SIDES.start(), *SIDES.end()));
        if let Some((known, side, shown)) = &*self.last.lock().unwrap_or_else(PoisonError::into_inner)
            && *known == seal
            && long.is_none_or(|long| long == *side)
        {
            return Ok(Arc::clone(shown));
        }
        let (show, side, file) = (self.show, long.unwrap_or(1600), file.to_owned());
        let made = tokio::task::spawn_blocking(move || show(&file, side)).await;
        let made = made.map_err(|error| StudioError::Failed(error.to_string()))?.map_err(StudioError::Refused)?;
        let made = Arc::new(made);
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some((seal, side, Arc::clone(&made)));
        Ok(made)
    }
}
