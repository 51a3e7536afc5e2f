//! Small copies of photographs and masks, from which the studio draws coarsely again and again.
//!
//! The studio names a folder for them in the environment, `DRYPOINT_PROOFS`. A picture's copy is made when it is first read, and again
//! when its file has changed.

use super::failure::Failure;
use super::masks;
use super::png::png;
use crate::source::{Photograph, sha256};
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// The variable that names the folder.
const FOLDER: &str = "DRYPOINT_PROOFS";
/// Longer side of a copy in pixels, that of what is found: a third of it, a head, is still finer than a coarse drawing.
const LONGEST: u32 = 1024;

/// A photograph, or a small copy that stands for it.
pub(super) struct Proof {
    pub photograph: Photograph,
    /// Columns and rows of the photograph itself.
    pub size: [u32; 2],
}

/// The folder of the copies, if drawings shall be made from them.
pub(super) fn folder() -> Option<PathBuf> {
    std::env::var_os(FOLDER).filter(|name| !name.is_empty()).map(PathBuf::from)
}

/// The folder of what was found, small.
pub(super) fn sight(folder: &Path) -> PathBuf {
    folder.join("sight")
}

/// Reads a photograph, or its copy.
pub(super) fn photograph(name: &str) -> Result<Proof, Failure> {
    let place = folder().and_then(|folder| Place::of(name, &folder));
    if let Some(known) = place.as_ref().and_then(Place::known) {
        return Ok(known);
    }
    let photograph = masks::photograph(name)?;
    place.iter().for_each(|place| place.keep(&photograph));
    Ok(Proof { size: [photograph.width(), photograph.height()], photograph })
}

/// Keeps the copy of a photograph that was read for another purpose.
pub(super) fn keep(name: &str, photograph: &Photograph) {
    let place = folder().and_then(|folder| Place::of(name, &folder));
    place.iter().for_each(|place| place.keep(photograph));
}

/// Where the copy of a file lies: its name begins with what the file is now, and ends with the photograph's size.
struct Place {
    folder: PathBuf,
    key: String,
}

impl Place {
    /// None for what is no file.
    fn of(name: &str, folder: &Path) -> Option<Self> {
        let file = Path::new(name).canonicalize().ok()?;
        let known = file.metadata().ok().filter(std::fs::Metadata::is_file)?;
        let changed = known.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        let identity = format!("{} {} {}", file.display(), known.len(), changed.as_nanos());
        Some(Self { folder: folder.to_owned(), key: sha256(identity.as_bytes())[..32].to_owned() })
    }

    fn known(&self) -> Option<Proof> {
        let entries = std::fs::read_dir(&self.folder).ok()?;
        let file = entries
            .flatten()
            .map(|entry| entry.path())
            .find(|path| path.file_name().and_then(|name| name.to_str()).is_some_and(|name| name.starts_with(&self.key)))?;
        let (_, size) = file.file_stem()?.to_str()?.split_once('-')?;
        let (width, height) = size.split_once('x')?;
        let size = [width.parse().ok()?, height.parse().ok()?];
        Some(Proof { photograph: masks::photograph(&file.to_string_lossy()).ok()?, size })
    }

    /// Writes the copy; a small picture needs none. It only saves time, so that a failure is of no interest.
    fn keep(&self, photograph: &Photograph) {
        let Some(copy) = photograph.small_copy(LONGEST) else { return };
        let file = self.folder.join(format!("{}-{}x{}.png", self.key, photograph.width(), photograph.height()));
        let _ = png(&file.to_string_lossy(), &copy);
    }
}
