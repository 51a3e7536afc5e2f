//! What was found in a photograph.

use super::masks::RoleMask;
use crate::see::Sight;
use crate::source::{Landmarks, MaskRole, Photograph};
use std::sync::Arc;

/// A depth map of the photograph.
#[derive(Clone)]
pub(super) struct Depth {
    /// Its file; `None` if it was found in the photograph.
    pub file: Option<String>,
    pub map: Arc<Photograph>,
}

/// What was found in the photograph, or read from a `--sight` folder.
#[derive(Clone, Default)]
pub(super) struct Seen {
    pub masks: Vec<RoleMask>,
    pub faces: Vec<Landmarks>,
    pub depth: Option<Depth>,
    /// Why nothing was found, for messages.
    pub lack: Option<String>,
}

impl Seen {
    pub(super) fn nothing(lack: &str) -> Self {
        Self { lack: Some(lack.to_owned()), ..Self::default() }
    }

    /// Converts the detected sight.
    pub(super) fn found(sight: &Sight) -> Self {
        if sight.faces.is_empty() {
            return Self::nothing("no face found");
        }
        let masks = sight.masks().into_iter();
        Self {
            masks: masks.map(|(role, mask)| RoleMask { role, file: None, mask: Arc::new(Photograph::from_grey(mask)) }).collect(),
            faces: sight.faces.iter().map(|face| face.landmarks.clone()).collect(),
            depth: sight.depth.as_ref().map(|map| Depth { file: None, map: Arc::new(Photograph::from_deep_grey(map)) }),
            lack: None,
        }
    }

    pub(super) fn take(&mut self, role: MaskRole) -> Option<RoleMask> {
        let place = self.masks.iter().position(|mask| mask.role == role)?;
        Some(self.masks.swap_remove(place))
    }
}
