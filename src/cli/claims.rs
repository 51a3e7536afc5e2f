//! Checks that no output is an input or another output. Files are compared by device and inode after following links; files that
//! do not exist yet are compared by path.

use super::failure::Failure;
use std::fs::{self, Metadata};
#[cfg(unix)]
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Files read so far.
static READ: Mutex<Vec<(String, Identity)>> = Mutex::new(Vec::new());

#[derive(Clone, Debug, PartialEq)]
enum Identity {
    /// Device and inode.
    #[cfg(unix)]
    Inode(u64, u64),
    /// Path of a file that does not exist yet; on systems without inodes, of any file.
    Place(PathBuf),
}

impl Identity {
    /// The identity of a regular file; `None` for devices and pipes, which may be read and written at the same time.
    #[cfg(unix)]
    fn of(_: &Path, found: &Metadata) -> Option<Self> {
        found.is_file().then(|| Self::Inode(found.dev(), found.ino()))
    }

    #[cfg(not(unix))]
    fn of(path: &Path, found: &Metadata) -> Option<Self> {
        if found.is_file() { fs::canonicalize(path).ok().map(Self::Place) } else { None }
    }

    fn of_output(name: &str) -> Option<Self> {
        let path = if name == "-" { PathBuf::from("/dev/stdout") } else { follow_links(Path::new(name)) };
        match fs::metadata(&path) {
            Ok(found) => Self::of(&path, &found),
            Err(_) if name == "-" => None,
            Err(_) => {
                let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
                let folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
                Some(Self::Place(folder.join(path.file_name()?)))
            }
        }
    }
}

/// Records a file that is read.
pub(super) fn reads(name: &str, path: &Path, found: &Metadata) {
    let Some(identity) = Identity::of(path, found) else { return };
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if !read.iter().any(|(_, known)| *known == identity) {
        read.push((name.to_owned(), identity));
    }
}

/// Records stdin if it is a regular file.
pub(super) fn record_stdin() {
    let path = Path::new("/dev/stdin");
    if let Ok(found) = fs::metadata(path) {
        reads("stdin", path, &found);
    }
}

/// Refuses an output that is an input.
pub(super) fn check_not_input(output: &str) -> Result<(), Failure> {
    let read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(identity) = Identity::of_output(output) else { return Ok(()) };
    let shown = if output == "-" { "stdout" } else { output };
    read.iter().find(|(_, known)| *known == identity).map_or(Ok(()), |(input, _)| {
        Err(Failure::Usage(format!("{shown} would overwrite the input {input}: they are the same file; choose another name")))
    })
}

/// Refuses outputs that are inputs, and outputs that are the same file.
pub(super) fn check_distinct<'a>(outputs: impl IntoIterator<Item = &'a str>) -> Result<(), Failure> {
    let mut claimed: Vec<(&str, Identity)> = Vec::new();
    for output in outputs {
        check_not_input(output)?;
        let Some(identity) = Identity::of_output(output) else { continue };
        if let Some((other, _)) = claimed.iter().find(|(_, known)| *known == identity) {
            return Err(Failure::Usage(format!("{other} and {output} are the same file; give one of them another name")));
        }
        claimed.push((output, identity));
    }
    Ok(())
}

/// The target of a chain of symbolic links, existing or not: writing replaces the target and keeps the links.
pub(super) fn follow_links(path: &Path) -> PathBuf {
    let mut path = path.to_path_buf();
    for _ in 0..40 {
        let Ok(target) = fs::read_link(&path) else { break };
        let next = path.parent().unwrap_or(Path::new("")).join(target);
        // The link of an open pipe or socket (`/dev/stdout`) does not lead to a file; open the link itself.
        if fs::metadata(&path).is_ok() && fs::symlink_metadata(&next).is_err() {
            break;
        }
        path = next;
    }
    path
}
