//! Presets as small drawings of the present portrait.

use super::document::Document;
use super::drawings::Quality;
use super::error::StudioError;
use super::folder;
use super::session::Studio;
use std::collections::HashMap;
use std::path::Path;
use toml_edit::{DocumentMut, Item, value};

/// Keys of a scene that say where the picture lies and what plots it: a preset is shown on its own sheet.
const PLACING: [&str; 11] =
    ["page", "margin", "size", "at", "center", "rotate", "profile", "max-time", "set", "region", "preset"];
/// Keys of a preset that draw nothing.
const SAID: [&str; 4] = ["purpose", "photograph", "profile", "max-time"];

/// The thumbnails of one state of the scene. Only one is made at a time: whoever holds the lock makes it.
#[derive(Default)]
pub(super) struct Thumbnails(tokio::sync::Mutex<(u64, HashMap<String, Vec<u8>>)>);

impl Studio {
    /// `GET /api/thumbnail/PRESET`: the portrait as the preset would draw it, coarse, as SVG. A newer change of the scene ends it.
    pub(super) async fn thumbnail(&self, preset: &str) -> Result<Vec<u8>, StudioError> {
        let mut made = self.thumbnails.0.lock().await;
        let mut revisions = self.revision.subscribe();
        let revision = *revisions.borrow_and_update();
        if made.0 != revision {
            *made = (revision, HashMap::new());
        }
        if let Some(picture) = made.1.get(preset) {
            return Ok(picture.clone());
        }
        let picture = tokio::select! {
            picture = self.draw_preset(preset) => picture?,
            _ = revisions.changed() => return Err(StudioError::Refused("the scene has changed; ask anew".to_owned())),
        };
        made.1.insert(preset.to_owned(), picture.clone());
        Ok(picture)
    }

    async fn draw_preset(&self, preset: &str) -> Result<Vec<u8>, StudioError> {
        let is_name = preset.chars().all(|c| c.is_alphanumeric() || "-_.".contains(c)) && !preset.starts_with(['-', '.']);
        if !is_name {
            return Err(StudioError::Missing(format!("there is no preset '{preset}'")));
        }
        let document = self.document()?;
        let whole = self.list(&["presets", preset, "--json"]).await?;
        let values: DocumentMut = whole["toml"].as_str().unwrap_or_default().parse().unwrap_or_default();
        let [scene, output] = ["thumbnail.toml", "thumbnail.svg"].map(|name| self.scratch.path().join(name));
        folder::write(&scene, with_preset(&document, &values).to_string().as_bytes())?;
        let (scene, file) = (scene.to_string_lossy(), output.to_string_lossy());
        let (program, found) = self.drawing_with(&document, Quality::Coarse);
        let mut words = vec!["draw", &scene, "-o", &file, "--draft", "-q"];
        words.extend(found.iter().flat_map(|found| ["--sight", found]));
        program.run(document.folder(), &words, |_| {}).await?;
        std::fs::read(&output).map_err(StudioError::about(&output))
    }
}

/// The scene as choosing the preset would make it, but on the preset's own sheet. It lies elsewhere, so files are named in full.
fn with_preset(document: &Document, preset: &DocumentMut) -> DocumentMut {
    let mut scene: DocumentMut = document.text().parse().unwrap_or_default();
    PLACING.iter().for_each(|key| drop(scene.remove(key)));
    let folder = std::path::absolute(document.folder()).unwrap_or_default();
    for key in ["photograph", "sight", "depth", "pens", "colours"] {
        in_full(scene.get_mut(key), &folder);
    }
    for (_, mask) in scene.get_mut("mask").and_then(Item::as_table_like_mut).into_iter().flat_map(|masks| masks.iter_mut()) {
        in_full(Some(mask), &folder);
    }
    for (key, item) in preset.iter().filter(|(key, _)| !SAID.contains(key)) {
        scene.insert(key, item.clone());
    }
    scene
}

fn in_full(item: Option<&mut Item>, folder: &Path) {
    if let Some(item) = item
        && let Some(name) = item.as_str().filter(|name| *name != "none")
    {
        *item = value(folder.join(name).to_string_lossy().into_owned());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preset_is_drawn_on_its_own_sheet_with_the_scene_s_files() {
        let text = "photograph = 'a.jpg'\npage = 'a4'\ngamma = 2\nstyle = 'glass'\n[set]\npitch = 1\n[mask]\nhair = 'h.png'\n";
        let document = Document::of(Path::new("/nowhere/a.toml"), text).unwrap();
        let preset = "purpose = 'x'\nstyle = 'grid'\nsize = '50x60mm'\n".parse().unwrap();
        let scene = with_preset(&document, &preset).to_string();
        let values: toml::Table = scene.parse().unwrap();
        assert_eq!(values["photograph"].as_str(), Some("/nowhere/a.jpg"));
        assert_eq!(values["mask"]["hair"].as_str(), Some("/nowhere/h.png"));
        assert_eq!((values["style"].as_str(), values["size"].as_str()), (Some("grid"), Some("50x60mm")));
        assert!(
            values["gamma"].as_integer() == Some(2) && !values.contains_key("page") && !values.contains_key("set"),
            "{scene}"
        );
        assert!(!values.contains_key("purpose"), "{scene}");
    }
}
