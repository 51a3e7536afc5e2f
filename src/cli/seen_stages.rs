//! The first stages: what was found in a photograph, or the given masks instead.

use super::known::Known;
use super::masks::RoleMask;
use super::overlay::{Overlaid, overlay};
use crate::raster::Raster;
use crate::source::grey_image;
use crate::source::{Crop, MaskRole, Photograph, SourceError};
use image::DynamicImage;

/// The regions in display order.
const SHOWN: [MaskRole; 7] = [
    MaskRole::Subject,
    MaskRole::Skin,
    MaskRole::Hair,
    MaskRole::FacialHair,
    MaskRole::Headwear,
    MaskRole::Clothing,
    MaskRole::Detail,
];

/// Each region by its role, the faces over the photograph, and the depth; empty if there is no face.
pub(super) fn pictures(photograph: &Photograph, known: &Known) -> Result<Vec<(&'static str, DynamicImage)>, SourceError> {
    let mut pictures = Vec::new();
    if known.faces.is_empty() {
        return Ok(pictures);
    }
    let mut subject = None;
    for role in SHOWN {
        // In a cut-out, alpha is the subject.
        let Some(mask) = decided(known, role).filter(|_| role != MaskRole::Subject || !photograph.is_cut_out()) else { continue };
        let mask = grey(mask)?;
        if mask.pixels().iter().any(|v| *v > 0) {
            pictures.push((role.name(), picture(&mask)));
        }
        if role == MaskRole::Subject {
            subject = Some(mask);
        }
    }
    let faces: Vec<Overlaid<'_>> = known.faces.iter().map(|landmarks| Overlaid { landmarks, bounds: None }).collect();
    pictures.push(("faces", overlay(photograph, subject.as_ref(), &faces)?.into()));
    if let Some(depth) = known.depth.as_ref().or(known.unused.depth.as_ref()) {
        pictures.push(("depth", picture(&grey(&depth.map)?)));
    }
    Ok(pictures)
}

/// The mask of this role in the drawing, or the unused one if the style does not use the role.
fn decided(known: &Known, role: MaskRole) -> Option<&Photograph> {
    let masks = known.masks.iter().chain(&known.people).chain(&known.unused.masks);
    masks.into_iter().find(|RoleMask { role: other, .. }| *other == role).map(|found| &*found.mask)
}

fn grey(mask: &Photograph) -> Result<Raster<u8>, SourceError> {
    Ok(mask.encoded(Crop::all(mask), mask.width() as usize, mask.height() as usize)?.map(|[_, green, _]| green))
}

fn picture(mask: &Raster<u8>) -> DynamicImage {
    grey_image(mask).into()
}
