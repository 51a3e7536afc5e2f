//! Photographs and their masks.

use super::failure::Failure;
use super::output;
use super::words::file_name;
use crate::source::{Limits, MaskRole, Photograph};
use serde_json::{Value, json};
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

/// Reads a photograph or a mask; `-` is stdin.
pub(super) fn photograph(name: &str) -> Result<Photograph, Failure> {
    let shown = if name == "-" { "stdin" } else { name };
    Photograph::read(output::open(name)?, Limits::default()).map_err(|error| {
        let is_svg = Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
        let other = if is_svg { "; an SVG is plotted with `drypoint plot`" } else { "" };
        Failure::about(shown)(&format_args!("{error}{other}"))
    })
}
