//! Photographs and their masks.

use super::failure::Failure;
use super::words::file_name;
use super::{output, proof, vector_mask};
use crate::source::{Limits, MaskRole, Photograph};
use serde_json::{Value, json};
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

/// A mask of the photograph.
#[derive(Clone)]
pub(super) struct RoleMask {
    pub role: MaskRole,
    /// Its file; `None` if it was found in the photograph.
    pub file: Option<String>,
    pub mask: Arc<Photograph>,
}

impl RoleMask {
    /// Reads a mask of a role. Scribbles are colours, which shapes do not have; thin lines would fade in a small copy.
    pub(super) fn read(role: MaskRole, file: &str) -> Result<Self, Failure> {
        let mask = match role {
            MaskRole::Scribbles => photograph(file)?,
            MaskRole::Edges | MaskRole::Isophotes | MaskRole::Directions => mask(file)?,
            _ => mask_or_copy(file)?,
        };
        Ok(Self { role, file: Some(file.to_owned()), mask: Arc::new(mask) })
    }

    /// The name of its role on the command line.
    pub(super) fn name(&self) -> &'static str {
        self.role.name()
    }

    /// Its origin, for the recipe.
    pub(super) fn recipe(&self) -> Value {
        match &self.file {
            Some(file) => json!({ "file": file_name(file), "sha256": self.mask.info.sha256 }),
            None => json!({ "found": true }),
        }
    }
}

/// Reads a mask, or its small copy.
fn mask_or_copy(file: &str) -> Result<Photograph, Failure> {
    match proof::folder() {
        Some(_) if !is_shapes(file) => Ok(proof::photograph(file)?.photograph),
        _ => mask(file),
    }
}

fn is_shapes(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"))
}

/// Reads a mask: a picture, or the shapes of an SVG.
pub(super) fn mask(name: &str) -> Result<Photograph, Failure> {
    let mut bytes = Vec::new();
    let limits = Limits::default();
    output::open(name)?.take(limits.bytes + 1).read_to_end(&mut bytes).map_err(|error| Failure::about(name)(&error))?;
    if vector_mask::is_svg(&bytes) {
        return vector_mask::vector_mask(&bytes).map_err(|error| Failure::about(name)(&error));
    }
    Photograph::read(bytes.as_slice(), limits).map_err(|error| Failure::about(name)(&error))
}

/// Reads a photograph; `-` is stdin.
pub(super) fn photograph(name: &str) -> Result<Photograph, Failure> {
    let shown = if name == "-" { "stdin" } else { name };
    Photograph::read(output::open(name)?, Limits::default()).map_err(|error| {
        let other = if is_shapes(name) { "; an SVG is plotted with `drypoint plot`" } else { "" };
        Failure::about(shown)(&format_args!("{error}{other}"))
    })
}
