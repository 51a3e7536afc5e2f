//! Masks: what was found in the photograph, and what was painted over it.

use super::command::Program;
use super::document::{Change, Document};
use super::drawings::Quality;
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
/// Roles that are only drawn by hand: lines, instead of those that the style detects, and lights. They lie beside the scene, which names
/// them.
const OWN: [&str; 4] = ["edges", "isophotes", "directions", "highlights"];
/// Bytes of a mask.
const MOST_BYTES: usize = 32 << 20;
/// The first bytes of a PNG.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// The file of a role's mask in a folder of sight.
fn file_of(folder: &Path, role: &str) -> Result<PathBuf, StudioError> {
    if ROLES.contains(&role) {
        return Ok(folder.join(format!("{role}.png")));
    }
    Err(StudioError::Missing(format!("there is no mask '{role}'; there are {}", [&ROLES[..], &OWN[..]].concat().join(", "))))
}

/// The file's name of what is drawn by hand.
fn drawn_name(document: &Document, role: &str) -> String {
    format!("{}-{role}.png", document.file.file_stem().unwrap_or_default().to_string_lossy())
}

/// Where the scene's own mask of a role lies, if it has a place.
fn own_file(folder: &Path, document: &Document, role: &str) -> Result<Option<PathBuf>, StudioError> {
    if OWN.contains(&role) {
        return Ok(Some(folder.join(drawn_name(document, role))));
    }
    own_folder(folder, document).map(|own| file_of(&own, role)).transpose()
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
    roles
        .map(|role| {
            let file = own_file(folder, document, role)?;
            Ok((role.clone(), file.and_then(|file| fs::read(file).ok()).map(Arc::from)))
        })
        .collect()
}

/// Writes masks into the scene's own folder, or takes them out of it.
pub(super) fn put(folder: &Path, document: &Document, masks: &Masks) -> Result<(), StudioError> {
    for (role, mask) in masks {
        let Some(file) = own_file(folder, document, role)? else { continue };
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

    /// The folder of what was found, for a command; `None` if the scene says itself what is seen, or nothing was found.
    pub(super) fn usable_sight(&self, document: &Document) -> Option<String> {
        usable(&self.found(), document)
    }

    /// The folder of small copies of photographs and masks, and of what was found.
    pub(super) fn proofs(&self) -> PathBuf {
        self.scratch.path().join("proofs")
    }

    /// The program and the folder of what was found for drawings of a quality: coarse ones are made from small copies.
    pub(super) fn drawing_with(&self, document: &Document, quality: Quality) -> (Program, Option<String>) {
        let proofs = self.proofs();
        match quality {
            Quality::Full => (self.program.clone(), self.usable_sight(document)),
            Quality::Coarse => (self.program.with_proofs(&proofs), usable(&proofs.join("sight"), document)),
        }
    }

    /// The folder of sight that holds now: the scene's own, or what was found.
    fn sight(&self, document: &Document) -> PathBuf {
        own_folder(document.folder(), document).unwrap_or_else(|| self.found())
    }

    /// `GET /api/masks`.
    pub(super) fn masks(&self) -> Result<Value, StudioError> {
        let document = self.document()?;
        let (sight, found) = (self.sight(&document), self.found());
        let found_roles = ROLES.map(|role| {
            let name = format!("{role}.png");
            let (used, first) = (fs::read(sight.join(&name)).ok(), fs::read(found.join(&name)).ok());
            json!({ "role": role, "is_there": used.is_some(), "is_painted": sight != found && used != first })
        });
        let size = ROLES.iter().find_map(|role| imagesize::size(sight.join(format!("{role}.png"))).ok());
        let size = size.map(|size| [size.width, size.height]);
        let own = OWN.map(|role| {
            let is_named = document.mask(role).is_some();
            json!({ "role": role, "is_there": is_named, "is_painted": is_named })
        });
        let roles = [&found_roles[..], &own[..]].concat();
        Ok(json!({ "roles": roles, "size": size }))
    }

    /// `GET /api/mask/ROLE`: the picture.
    pub(super) fn mask(&self, role: &str) -> Result<Vec<u8>, StudioError> {
        let document = self.document()?;
        if OWN.contains(&role) {
            let none = || StudioError::Missing(format!("no {role} are drawn yet; draw them"));
            let name = document.mask(role).ok_or_else(none)?;
            return fs::read(document.folder().join(name)).map_err(|_| none());
        }
        let file = file_of(&self.sight(&document), role)?;
        fs::read(&file).map_err(|_| StudioError::Missing(format!("no {role} was found in this photograph; paint it")))
    }

    /// `PUT /api/mask/ROLE`: a painted picture, or the one that was found again.
    pub(super) fn paint(&self, role: &str, picture: Option<Vec<u8>>) -> Result<(), StudioError> {
        if OWN.contains(&role) {
            return self.draw_own(role, picture);
        }
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

    /// What is drawn by hand, or nothing: then the style detects its own lines again.
    fn draw_own(&self, role: &str, picture: Option<Vec<u8>>) -> Result<(), StudioError> {
        picture.as_deref().map_or(Ok(()), check)?;
        let document = self.document()?;
        let name = picture.as_ref().map(|_| drawn_name(&document, role));
        let change = [Change::of_mask(role, json!(name))];
        let masks = BTreeMap::from([(role.to_owned(), picture.map(Arc::from))]);
        self.step(&format!("{role} drawn"), masks, |document| document.changed(&change))
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

/// A folder of what was found, if the scene leaves it to that.
fn usable(found: &Path, document: &Document) -> Option<String> {
    let is_used = document.string("sight").is_none() && found.join("sight.json").exists();
    is_used.then(|| found.to_string_lossy().into_owned())
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
