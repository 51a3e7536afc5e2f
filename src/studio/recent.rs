//! Scenes that were open lately, in a small file of the user's configuration.

use super::folder;
use std::fs;
use std::path::{Path, PathBuf};

/// Scenes that are remembered.
const MOST: usize = 12;
/// Bytes of the file; a larger one is none of ours.
const MOST_BYTES: u64 = 1 << 16;

/// The file of recent scenes, one path on each line; without one nothing is remembered.
pub(super) struct Recent(pub Option<PathBuf>);

impl Recent {
    /// The scenes that are still there, the latest first.
    pub(super) fn list(&self) -> Vec<PathBuf> {
        let Some(file) = self.0.as_ref().filter(|file| fs::metadata(file).is_ok_and(|found| found.len() <= MOST_BYTES)) else {
            return Vec::new();
        };
        let text = fs::read_to_string(file).unwrap_or_default();
        text.lines().map(PathBuf::from).filter(|scene| scene.is_absolute() && scene.is_file()).take(MOST).collect()
    }

    /// Puts a scene first. That it cannot be remembered stops nobody.
    pub(super) fn note(&self, scene: &Path) {
        let Some(file) = &self.0 else { return };
        let Some(name) = scene.to_str().filter(|name| !name.contains('\n')) else { return };
        let mut lines = vec![name.to_owned()];
        lines.extend(self.list().iter().filter(|other| *other != scene).map(|other| other.to_string_lossy().into_owned()));
        lines.truncate(MOST);
        let _ = folder::write(file, format!("{}\n", lines.join("\n")).as_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_comes_first_and_what_is_gone_is_not_listed() {
        let folder = tempfile::tempdir().unwrap();
        let recent = Recent(Some(folder.path().join("configuration/recent")));
        let scenes = ["a.toml", "b.toml"].map(|name| folder.path().join(name));
        for scene in &scenes {
            fs::write(scene, "").unwrap();
            recent.note(scene);
        }
        recent.note(&scenes[0]);
        assert_eq!(recent.list(), scenes);
        fs::remove_file(&scenes[0]).unwrap();
        assert_eq!(recent.list(), scenes[1..]);
        assert!(Recent(None).list().is_empty());
    }
}
