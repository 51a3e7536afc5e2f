//! The steps between photograph and drawing, as pictures.

use super::drawings::Quality;
use super::error::StudioError;
use super::session::Studio;
use serde_json::{Value, json};
use std::path::PathBuf;
use tokio::sync::Mutex;

/// The pictures that were made last, and of which state of the scene.
#[derive(Default)]
pub(super) struct Stages {
    coarse: Mutex<Option<(u64, Value)>>,
    full: Mutex<Option<(u64, Value)>>,
}

impl Stages {
    const fn of(&self, quality: Quality) -> &Mutex<Option<(u64, Value)>> {
        match quality {
            Quality::Coarse => &self.coarse,
            Quality::Full => &self.full,
        }
    }
}

impl Studio {
    fn stages_folder(&self, quality: Quality) -> PathBuf {
        self.scratch.path().join(format!("stages-{}", quality.name()))
    }

    /// `GET /api/stages`: makes the pictures of the scene as it is and lists them in their order. They are made once for each state of
    /// the scene; coarse ones say what is done, full ones how well.
    pub(super) async fn stages(&self, quality: Quality) -> Result<Value, StudioError> {
        let mut made = self.stages.of(quality).lock().await;
        let (document, revision) = (self.document()?, *self.revision.borrow());
        if let Some((known, list)) = &*made
            && *known == revision
        {
            return Ok(list.clone());
        }
        // Whoever gives up leaves a part of the pictures: they count only at the end.
        *made = None;
        let (scene, folder) = (document.name(), self.stages_folder(quality));
        let _ = std::fs::remove_dir_all(&folder);
        let (output, found) = (folder.to_string_lossy().into_owned(), self.drawing_with(&document, quality).1);
        let mut words = vec!["stages", &scene, "-o", &output];
        words.extend((quality == Quality::Coarse).then_some("--draft"));
        words.extend(found.iter().flat_map(|found| ["--sight", found]));
        self.program.run(document.folder(), &words, |_| {}).await?;
        let entries = std::fs::read_dir(&folder).map_err(StudioError::about(&folder))?;
        let mut files: Vec<String> = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        files.sort();
        let stages = files.iter().map(|file| json!({ "file": file, "name": name_of(file) }));
        let list = json!({ "stages": stages.collect::<Vec<_>>(), "revision": revision });
        *made = Some((revision, list.clone()));
        Ok(list)
    }

    /// `GET /api/stage/FILE`: the picture, and what kind it is.
    pub(super) fn stage(&self, file: &str, quality: Quality) -> Result<(&'static str, Vec<u8>), StudioError> {
        let missing = || StudioError::Missing(format!("there is no stage '{file}'; ask for the stages anew"));
        let is_name = !file.starts_with('.') && file.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c));
        if !is_name {
            return Err(missing());
        }
        let bytes = std::fs::read(self.stages_folder(quality).join(file)).map_err(|_| missing())?;
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
