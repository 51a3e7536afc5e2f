//! The steps between photograph and drawing, as pictures.

use super::error::StudioError;
use super::session::Studio;
use serde_json::{Value, json};
use std::path::PathBuf;

impl Studio {
    fn stages_folder(&self) -> PathBuf {
        self.scratch.path().join("stages")
    }

    /// `GET /api/stages`: makes the pictures of the scene as it is, coarse, and lists them in their order.
    pub(super) async fn stages(&self) -> Result<Value, StudioError> {
        let document = self.document()?;
        let (scene, folder) = (document.name(), self.stages_folder());
        let _ = std::fs::remove_dir_all(&folder);
        let words = ["stages", &scene, "-o", &folder.to_string_lossy(), "--draft"];
        self.program.run(document.folder(), &words, |_| {}).await?;
        let entries = std::fs::read_dir(&folder).map_err(StudioError::about(&folder))?;
        let mut files: Vec<String> = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        files.sort();
        let stages = files.iter().map(|file| json!({ "file": file, "name": name_of(file) }));
        Ok(json!({ "stages": stages.collect::<Vec<_>>(), "revision": *self.revision.borrow() }))
    }

    /// `GET /api/stage/FILE`: the picture, and what kind it is.
    pub(super) fn stage(&self, file: &str) -> Result<(&'static str, Vec<u8>), StudioError> {
        let missing = || StudioError::Missing(format!("there is no stage '{file}'; ask for the stages anew"));
        let is_name = !file.starts_with('.') && file.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c));
        if !is_name {
            return Err(missing());
        }
        let bytes = std::fs::read(self.stages_folder().join(file)).map_err(|_| missing())?;
        let is_svg = bytes.starts_with(b"<");
        Ok((if is_svg { "image/svg+xml" } else { "image/png" }, bytes))
    }
}

/// `08-coherent-lines.png` is "coherent lines".
fn name_of(file: &str) -> String {
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    stem.split_once('-').map_or(stem, |(_, name)| name).replace('-', " ")
}

#[cfg(test)]
mod tests {
    #[test]
    fn stages_have_the_names_of_their_steps() {
        assert_eq!(super::name_of("08-coherent-lines.png"), "coherent lines");
        assert_eq!(super::name_of("drawing.svg"), "drawing");
    }
}
