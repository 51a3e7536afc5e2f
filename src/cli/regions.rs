//! The regions of a command line: parts of the picture in manners of their own.

use super::arguments::PictureOptions;
use super::failure::Failure;
use super::known;
use super::manner::{Manner, find_style, fineness, given, resolved};
use super::masks::{RoleMask, mask};
use super::region::{Flow, RegionOption};
use super::seen::Seen;
use super::words::file_name;
use crate::drawing::{Ink, Layer};
use crate::scene::Border;
use crate::source::{MaskRole, Photograph};
use std::path::Path;
use std::sync::Arc;

/// A region that is drawn.
pub(super) struct Region {
    pub manner: Manner,
    pub mask: Arc<Photograph>,
    /// The mask's file for messages; the photograph's if it was found there.
    pub file: String,
    pub border: Border,
    pub flow: Flow,
    pub pen: Option<u32>,
    pub ink: Option<Ink>,
    /// The first part of its layers' names.
    pub name: String,
}

/// The regions of a command line. Those that are not in this photograph are drawn with the rest; a notice says so.
pub(super) fn regions(
    options: &PictureOptions,
    photograph: &Photograph,
    seen: &Seen,
    painted: &[RoleMask],
    notices: &mut Vec<String>,
) -> Result<Vec<Region>, Failure> {
    let mut regions: Vec<Region> = Vec::new();
    for (i, option) in options.region.iter().enumerate() {
        if let Some(twin) = options.region[..i].iter().find(|other| other.mask == option.mask) {
            return Err(Failure::Usage(format!(
                "two regions have the mask {}, so one would hide the other; give each its own mask, or leave one out",
                twin.mask
            )));
        }
        let Some((mask, file)) = mask_of(option, options, seen, painted)? else {
            notices.push(format!("no {0} found: its region is drawn like the rest; --mask {0}=FILE gives one", option.mask));
            continue;
        };
        let style = find_style(option.style.as_deref().unwrap_or(&options.style))?;
        let mut given: Vec<(String, String)> = Vec::new();
        if option.style.as_ref().is_none_or(|style| *style == options.style) {
            given.extend(self::given(options));
        }
        given.extend(option.set.iter().cloned());
        let settings = resolved(style, &given, options)?;
        let own: Vec<RoleMask> = painted.iter().filter(|mask| known::takes(style, mask.role)).cloned().collect();
        let known = known::of(options, style, photograph, own, seen.clone())?;
        let seed = option.seed.unwrap_or(options.seed);
        regions.push(Region {
            manner: Manner { style, settings, known, seed, fineness: fineness(options) },
            mask,
            file,
            border: option.border,
            flow: option.flow,
            pen: option.pen,
            ink: option.ink.clone(),
            name: name_of(option, &regions),
        });
    }
    Ok(regions)
}

/// The mask of a region and its file; none if it was not found.
fn mask_of(
    option: &RegionOption,
    options: &PictureOptions,
    seen: &Seen,
    painted: &[RoleMask],
) -> Result<Option<(Arc<Photograph>, String)>, Failure> {
    let Some(role) = MaskRole::named(&option.mask) else {
        return Ok(Some((Arc::new(mask(&option.mask)?), option.mask.clone())));
    };
    let found = painted.iter().chain(&seen.masks).find(|mask| mask.role == role);
    Ok(found.map(|found| (found.mask.clone(), found.file.clone().unwrap_or_else(|| options.photo.clone()))))
}

/// The region's name: as given, its role, or its file without folder and ending; each once.
fn name_of(option: &RegionOption, others: &[Region]) -> String {
    let stem = Path::new(file_name(&option.mask)).file_stem().and_then(|stem| stem.to_str()).unwrap_or("region");
    let plain = option.name.clone().unwrap_or_else(|| stem.to_owned());
    let numbered = (2..).map(|n| format!("{plain}{n}"));
    let is_free = |name: &String| others.iter().all(|other| other.name != *name);
    std::iter::once(plain.clone()).chain(numbered).find(is_free).unwrap_or(plain)
}

impl Region {
    /// A layer of its drawing with the region's name, pen and ink.
    pub(super) fn named(&self, mut layer: Layer) -> Layer {
        layer.name = format!("{}-{}", self.name, layer.name);
        layer.pen = self.pen.unwrap_or(layer.pen);
        layer
    }
}
