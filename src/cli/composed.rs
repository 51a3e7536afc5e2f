//! A drawing of several regions, each in its own style.

use super::arguments::PictureOptions;
use super::failure::Failure;
use super::known::{self, Seen};
use super::recipe::file_name;
use super::region::RegionOption;
use super::task::{Manner, RoleMask, Task, find_style, photograph};
use crate::drawing::{Drawing, Ink, Layer};
use crate::geometry::Rect;
use crate::raster::Raster;
use crate::scene::{Border, Parts};
use crate::source::{MaskRole, Photograph, Placement, mask_on};
use crate::style::{Observer, Settings, StyleError};
use std::path::Path;
use std::sync::Arc;

/// The finest grid of regions in pixels per millimetre, and the most pixels it has.
const FINEST: f64 = 8.0;
const MOST_PIXELS: f64 = 4e6;

/// A region that is drawn.
pub(super) struct Region {
    pub manner: Manner,
    mask: Arc<Photograph>,
    /// The mask's file for messages; the photograph's if it was found there.
    file: String,
    border: Border,
    pen: Option<u32>,
    ink: Option<Ink>,
    /// The first part of its layers' names.
    name: String,
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
            given.extend(super::task::given(options));
        }
        given.extend(option.set.iter().cloned());
        let settings = Settings::resolve(style.name(), style.parameters(), &given)?;
        let own: Vec<RoleMask> = painted.iter().filter(|mask| known::takes(style, mask.role)).cloned().collect();
        let known = known::of(options, style, photograph, own, seen.clone())?;
        let seed = option.seed.unwrap_or(options.seed);
        regions.push(Region {
            manner: Manner { style, settings, known, seed },
            mask,
            file,
            border: option.border,
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
        return Ok(Some((Arc::new(photograph(&option.mask)?), option.mask.clone())));
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

impl Task<'_> {
    /// All parts in one drawing: the rest first, then the regions in their order.
    pub(super) fn composed(
        &self,
        settings: &Settings,
        placement: Placement,
        observer: &dyn Observer,
    ) -> Result<Drawing, Failure> {
        let parts = self.parts(placement.picture)?;
        let mut layers = Vec::new();
        for part in 0..parts.count() {
            let region = part.checked_sub(1).map(|i| &self.regions[i]);
            let (manner, placement) = match region {
                None => (&self.manner, placement),
                Some(Region { manner, .. }) => {
                    (manner, Placement::new(placement.picture, manner.resolution(&manner.settings, placement.picture)))
                }
            };
            let settings = if region.is_some() { &manner.settings } else { settings };
            let mut portrait = self.portrait(&manner.known, placement)?;
            let share = parts.drawn_share(part, &placement);
            if share.pixels().iter().all(|share| *share <= 0.0) {
                continue;
            }
            portrait.tone = portrait.tone.zip_map(&share, |tone, share| 1.0 - (1.0 - tone) * share);
            let drawing = match manner.style.draw(&portrait, settings, manner.seed, observer) {
                Err(StyleError::NothingToDraw(_) | StyleError::NothingLeft { .. }) => continue,
                drawn => drawn.map_err(|error| self.undrawn(&error))?,
            };
            let confined = parts.confined(part, &drawing);
            layers.extend(confined.layers.into_iter().map(|layer| region.map_or(layer.clone(), |region| region.named(layer))));
        }
        if layers.is_empty() {
            return Err(self.undrawn(&StyleError::NothingToDraw("every region is white".to_owned())));
        }
        Ok(Drawing { page: self.layout.page, layers })
    }

    /// Which point belongs to which part.
    fn parts(&self, picture: Rect) -> Result<Parts, Failure> {
        let fineness = FINEST.min((MOST_PIXELS / picture.area()).sqrt());
        let placement = Placement::new(picture, fineness);
        let mask = |region: &Region| {
            let about = Failure::about(&region.file);
            let mask = mask_on(&region.mask, &self.photograph, self.layout.crop, placement);
            Ok((mask.map_err(|error| about(&super::remedies::advised(&error)))?, region.border))
        };
        let masks: Vec<(Raster<f32>, Border)> = self.regions.iter().map(mask).collect::<Result<_, Failure>>()?;
        Ok(Parts::new(placement, &masks))
    }

    /// The ink of a layer whose region has its own.
    pub(super) fn own_ink(&self, layer: &Layer) -> Option<&Ink> {
        let of = |region: &&Region| layer.name.strip_prefix(&region.name).is_some_and(|rest| rest.starts_with('-'));
        self.regions.iter().filter(of).max_by_key(|region| region.name.len())?.ink.as_ref()
    }
}

impl Region {
    /// A layer of its drawing with the region's name, pen and ink.
    fn named(&self, mut layer: Layer) -> Layer {
        layer.name = format!("{}-{}", self.name, layer.name);
        layer.pen = self.pen.unwrap_or(layer.pen);
        layer
    }
}

impl Manner {
    /// Working resolution in pixels per millimetre.
    pub(super) fn resolution(&self, settings: &Settings, picture: Rect) -> f64 {
        let roles: Vec<MaskRole> = self.known.masks.iter().map(|mask| mask.role).collect();
        self.style.resolution(settings, &roles, picture)
    }
}
