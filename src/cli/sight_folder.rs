//! The folder that `see` writes and `draw --sight` reads: `sight.json`, a picture for each region, named by its role, and an overlay
//! to look at.

use super::draw::{RoleMask, photograph};
use super::failure::Failure;
use super::lists::roles_of;
use super::overlay::overlay;
use super::stages::png;
use super::{claims, output};
use crate::geometry::{Point, Rect};
use crate::see::{Face, Iris, Sight};
use crate::source::{MaskRole, Photograph};
use crate::style::Style;
use image::GrayImage;
use serde_json::{Value, json};
use std::path::Path;

const SIGHT: &str = "sight.json";
const SUBJECT: &str = "subject.png";
const OVERLAY: &str = "overlay.png";

/// Writes all that was found; what an earlier sight left there and this one has not is removed.
pub(super) fn write(folder: &Path, sight: &Sight, photograph: &Photograph) -> Result<(), Failure> {
    let name = folder.to_string_lossy();
    std::fs::create_dir_all(folder).map_err(|error| Failure::Work(format!("{name} cannot be made: {error}")))?;
    let paths = [SIGHT, SUBJECT, OVERLAY].map(|file| folder.join(file).to_string_lossy().into_owned());
    claims::are_distinct(paths.iter().map(String::as_str))?;
    let [json, subject, overlaid] = &paths;
    let was_a_sight = Path::new(json).exists();
    if let Some(raster) = sight.subject_at_full_size() {
        let grey = GrayImage::from_raw(sight.width, sight.height, raster.into_vec()).expect("a raster's pixels fill it");
        png(subject, &grey.into())?;
        let picture = overlay(sight, photograph).map_err(|error| Failure::about(&name)(&error))?;
        png(overlaid, &picture.into())?;
    } else if was_a_sight {
        for stale in [subject, overlaid].into_iter().filter(|file| Path::new(file).exists()) {
            std::fs::remove_file(stale).map_err(|error| Failure::Work(format!("{stale} cannot be removed: {error}")))?;
        }
    }
    let mut text = serde_json::to_vec_pretty(&as_json(sight, photograph)).expect("a value is JSON");
    text.push(b'\n');
    output::write(json, |out| out.write_all(&text))
}

/// The folder's masks of the roles that a style takes and that are `missing`.
pub(super) fn masks(folder: &str, style: &dyn Style, missing: impl Fn(MaskRole) -> bool) -> Result<Vec<RoleMask>, Failure> {
    let path = |file: &str| Path::new(folder).join(file);
    let of_roles = || MaskRole::ALL.into_iter().map(|(name, role)| (role, path(&format!("{name}.png"))));
    if !path(SIGHT).exists() && !of_roles().any(|(_, file)| file.exists()) {
        return Err(Failure::Work(format!(
            "{folder} holds no {SIGHT} and no picture named by a role such as {SUBJECT}; `drypoint see PHOTO -o {folder}` writes them"
        )));
    }
    roles_of(style)
        .map(|(name, role)| (role, path(&format!("{name}.png"))))
        .filter(|(role, file)| missing(*role) && file.exists())
        .map(|(role, file)| {
            let file = file.to_string_lossy().into_owned();
            Ok(RoleMask { role, mask: photograph(&file)?, file: Some(file) })
        })
        .collect()
}

/// What was found, in pixels of the photograph after its EXIF turn.
pub(super) fn as_json(sight: &Sight, photograph: &Photograph) -> Value {
    let regions = sight.subject.as_ref().map_or_else(|| json!({}), |_| json!({ "subject": SUBJECT }));
    json!({
        "drypoint": env!("CARGO_PKG_VERSION"),
        "photograph": { "width": sight.width, "height": sight.height, "sha256": photograph.info.sha256 },
        "faces": sight.faces.iter().map(face_json).collect::<Vec<_>>(),
        "regions": regions,
    })
}

fn face_json(face: &Face) -> Value {
    let Rect { x0, y0, .. } = face.bounds;
    let [right, left] = face.irises.map(|Iris { centre: Point { x, y }, radius }| json!({ "centre": [x, y], "radius": radius }));
    json!({
        "box": [x0, y0, face.bounds.width(), face.bounds.height()],
        "score": face.score,
        "irises": { "right": right, "left": left },
        "points": face.points,
    })
}
