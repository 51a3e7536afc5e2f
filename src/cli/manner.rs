//! How a picture or a region of it is drawn.

use super::arguments::PictureOptions;
use super::failure::Failure;
use super::known::Known;
use crate::geometry::Rect;
use crate::source::MaskRole;
use crate::style::{self, Settings, Style};

/// How a picture or a region of it is drawn.
pub(super) struct Manner {
    pub style: &'static dyn Style,
    pub settings: Settings,
    pub known: Known,
    pub seed: u64,
}

impl Manner {
    /// Working resolution in pixels per millimetre.
    pub(super) fn resolution(&self, settings: &Settings, picture: Rect) -> f64 {
        let roles: Vec<MaskRole> = self.known.masks.iter().map(|mask| mask.role).collect();
        self.style.resolution(settings, &roles, picture)
    }
}

/// The style of a name.
pub(super) fn find_style(name: &str) -> Result<&'static dyn Style, Failure> {
    let names: Vec<&str> = style::STYLES.iter().map(|s| s.name()).collect();
    style::find(name).ok_or_else(|| Failure::Usage(format!("there is no style '{name}'; there are {}", names.join(", "))))
}

/// Parameters from --pitch, then from --set; later ones win.
pub(super) fn given(options: &PictureOptions) -> Vec<(String, String)> {
    let pitch = options.pitch.map(|pitch| ("pitch".to_owned(), pitch.to_string()));
    pitch.into_iter().chain(options.set.iter().cloned()).collect()
}
