//! A drawing of several regions, each in its own style.

use super::failure::Failure;
use super::known::Known;
use super::region::Flow;
use super::regions::Region;
use super::remedies::advised;
use super::task::Task;
use crate::drawing::{Drawing, Ink, Layer};
use crate::geometry::Rect;
use crate::raster::Raster;
use crate::scene::{Border, Parts};
use crate::source::{Placement, Portrait, mask_on};
use crate::style::{Observer, Settings, StyleError};
use std::ops::Range;

/// The finest grid of regions in pixels per millimetre, and the most pixels it has.
const FINEST: f64 = 8.0;
const MOST_PIXELS: f64 = 4e6;

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
        // The portrait that the last part was drawn from: regions in one style share it.
        let mut prepared: Option<(&Known, Portrait)> = None;
        for part in 0..parts.count() {
            let region = part.checked_sub(1).map(|i| &self.regions[i]);
            let (manner, placement) = match region {
                None => (&self.manner, placement),
                Some(Region { manner, .. }) => {
                    (manner, Placement::new(placement.picture, manner.resolution(&manner.settings, placement.picture)))
                }
            };
            let settings = if region.is_some() { &manner.settings } else { settings };
            let is_same = |(known, portrait): &(&Known, Portrait)| {
                portrait.placement == placement && known.makes_the_same_as(&manner.known)
            };
            // The last one goes before the next is made: they are large.
            prepared = prepared.filter(is_same);
            let portrait = match &mut prepared {
                Some((_, portrait)) => portrait,
                none => &mut none.insert((&manner.known, self.portrait(&manner.known, placement)?)).1,
            };
            let ground = manner.style.draws_ground().then(|| portrait.subject.map(|_| 1.0));
            let drawn = ground.unwrap_or_else(|| whole(&portrait.subject));
            let Some([columns, rows]) = parts.extent(part, &drawn, &placement) else { continue };
            let portrait = of_part(portrait, (&parts, part), &[columns, rows], region.map_or(Flow::Across, |region| region.flow));
            let drawing = match manner.style.draw(&portrait, settings, manner.seed, observer) {
                Err(StyleError::NothingToDraw(_) | StyleError::NothingLeft { .. }) => continue,
                drawn => drawn.map_err(|error| self.undrawn(&error))?,
            };
            let confined = parts.confined(part, &drawing);
            layers.extend(confined.layers.into_iter().map(|layer| match region {
                Some(region) => region.named(layer),
                None => layer,
            }));
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
            Ok((mask.map_err(|error| about(&advised(&error)))?, region.border))
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

/// The portrait of a part within its own box, white where the part is not drawn.
fn of_part(portrait: &Portrait, (parts, part): (&Parts, usize), [columns, rows]: &[Range<usize>; 2], flow: Flow) -> Portrait {
    let share = parts.drawn_share(part, &portrait.placement).part(columns, rows);
    let mut portrait = match flow {
        Flow::Across => portrait.part(columns, rows),
        Flow::Inside => parts.alone(part, portrait).part(columns, rows),
    };
    portrait.tone = portrait.tone.zip_map(&share, |tone, share| 1.0 - (1.0 - tone) * share);
    portrait
}

/// A subject whose most certain place counts in full: a faint one is drawn too.
fn whole(subject: &Raster<f32>) -> Raster<f32> {
    let most = subject.pixels().iter().copied().fold(0.0, f32::max).max(f32::MIN_POSITIVE);
    subject.map(|share| share / most)
}
