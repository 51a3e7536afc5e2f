//! Masks: what was found in the photograph, and what was painted over it.

use super::document::{Change, Document};
use super::error::StudioError;
use super::folder;
use super::history::Masks;
use super::session::Studio;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Roles that are shown and painted, as the folder of sight names its pictures.
const ROLES: [&str; 8] = ["subject", "skin", "hair", "facial-hair", "headwear", "clothing", "detail", "depth"];
/// Bytes of a mask.
const MOST_BYTES: usize = 32 << 20;
/// The first bytes of a PNG.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// The file of a role's mask in a folder of sight.
fn file_of(folder: &Path, role: &str) -> Result<PathBuf, StudioError> {
    if ROLES.contains(&role) {
        return Ok(folder.join(format!("{role}.png")));
    }
    Err(StudioError::Missing(format!("there is no mask '{role}'; there are {}", ROLES.join(", "))))
}

/// The folder of sight that a scene names.
fn own_folder(folder: &Path, document: &Document) -> Option<PathBuf> {
    document.string("sight").filter(|name| *name != "none").map(|name| folder.join(name))
}

/// The masks of these roles as they lie in the scene's own folder.
pub(super) fn painted<'a>(
    folder: &Path,
    document: &Document,
    roles: impl Iterator<Item = &'a String>,
) -> Result<Masks, StudioError> {
    let own = own_folder(folder, document);
    roles
        .map(|role| {
            let file = own.as_ref().map(|own| file_of(own, role)).transpose()?;
            Ok((role.clone(), file.and_then(|file| fs::read(file).ok()).map(Arc::from)))
        })
        .collect()
}

/// Writes masks into the scene's own folder, or takes them out of it.
pub(super) fn put(folder: &Path, document: &Document, masks: &Masks) -> Result<(), StudioError> {
    let Some(own) = own_folder(folder, document) else { return Ok(()) };
    for (role, mask) in masks {
        let file = file_of(&own, role)?;
        match mask {
            Some(mask) => folder::write(&file, mask)?,
            None if file.exists() => fs::remove_file(&file).map_err(StudioError::about(&file))?,
            None => {}
        }
    }
    Ok(())
}

impl Studio {
    /// The folder of what was found in the present photograph.
    pub(super) fn found(&self) -> PathBuf {
        self.scratch.path().join("sight")
    }

    /// The folder of sight that holds now: the scene's own, or what was found.
    fn sight(&self, document: &Document) -> PathBuf {
        own_folder(document.folder(), document).unwrap_or_else(|| self.found())
    }

    /// `GET /api/masks`.
    pub(super) fn masks(&self) -> Result<Value, StudioError> {
        let document = self.document()?;
        let (sight, found) = (self.sight(&document), self.found());
        let roles = ROLES.map(|role| {
            let name = format!("{role}.png");
            let (used, first) = (fs::read(sight.join(&name)).ok(), fs::read(found.join(&name)).ok());
            json!({ "role": role, "is_there": used.is_some(), "is_painted": sight != found && used != first })
        });
        Ok(json!({ "roles": roles }))
    }

    /// `GET /api/mask/ROLE`: the picture.
    pub(super) fn mask(&self, role: &str) -> Result<Vec<u8>, StudioError> {
        let file = file_of(&self.sight(&self.document()?), role)?;
        fs::read(&file).map_err(|_| StudioError::Missing(format!("no {role} was found in this photograph; paint it")))
    }

    /// `PUT /api/mask/ROLE`: a painted picture, or the one that was found again.
    pub(super) fn paint(&self, role: &str, picture: Option<Vec<u8>>) -> Result<(), StudioError> {
        file_of(Path::new(""), role)?;
        if let Some(picture) = &picture {
            check(picture)?;
        }
        let document = self.document()?;
        let found = file_of(&self.found(), role)?;
        let picture = picture.or_else(|| fs::read(found).ok());
        let name = own_name(&document);
        if own_folder(document.folder(), &document).is_none() {
            self.begin_own(&document.folder().join(&name))?;
        }
        let masks = BTreeMap::from([(role.to_owned(), picture.map(Arc::from))]);
        let change = [Change::of_key("sight", json!(name))];
        self.step(&format!("{role} painted"), masks, |document| document.changed(&change))
    }

    /// Copies what was found into the scene's own folder.
    fn begin_own(&self, own: &Path) -> Result<(), StudioError> {
        let found = fs::read_dir(self.found())
            .map_err(|_| StudioError::Refused("the photograph has not been looked at yet; try again in a moment".to_owned()))?;
        for entry in found.flatten() {
            let bytes = fs::read(entry.path()).map_err(StudioError::about(&entry.path()))?;
            folder::write(&own.join(entry.file_name()), &bytes)?;
        }
        Ok(())
    }
}

/// The name of the folder of sight that belongs to a scene.
fn own_name(document: &Document) -> String {
    let usual = || format!("{}-sight", document.file.file_stem().unwrap_or_default().to_string_lossy());
    document.string("sight").filter(|name| *name != "none").map_or_else(usual, str::to_owned)
}

fn check(picture: &[u8]) -> Result<(), StudioError> {
    if picture.len() > MOST_BYTES {
        return Err(StudioError::Refused("the mask has more than 32 MB; make it smaller".to_owned()));
    }
    let is_read = picture.starts_with(PNG) && image::load_from_memory_with_format(picture, image::ImageFormat::Png).is_ok();
    if is_read { Ok(()) } else { Err(StudioError::Refused("the mask is no PNG that can be read; save it as PNG".to_owned())) }
}
