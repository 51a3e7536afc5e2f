//! A photograph's bytes: refused with a reason, or light, tone, masks and depth from 0 to 1.

use super::refusal;
use drypoint::drawing::Page;
use drypoint::geometry::Rect;
use drypoint::raster::Raster;
use drypoint::source::{
    Crop, DepthSense, Limits, MaskRole, Photograph, Placement, Portrait, SourceError, ToneCurve, ToneTarget, fill_box,
};

/// So few pixels that thousands of pictures a second go through; what is beyond must be refused before it is unpacked.
const LIMITS: Limits = Limits { pixels: 250_000, bytes: 4_000_000 };

pub fn check(bytes: &[u8]) {
    match Photograph::decode(bytes, LIMITS) {
        Err(error) => refusal::is_told(&error),
        Ok(photograph) => {
            assert!(u64::from(photograph.width()) * u64::from(photograph.height()) <= LIMITS.pixels, "more pixels than allowed");
            assert_eq!(photograph.info.sha256.len(), 64);
            if let Err(error) = placed(&photograph) {
                refusal::is_told(&error);
            }
        }
    }
}

/// Its working rasters, with the picture as each of its own masks.
fn placed(photograph: &Photograph) -> Result<(), SourceError> {
    let page = Page::new(20.0, 20.0);
    let placement = Placement::new(Rect::new(2.0, 1.0, 14.0, 10.0), 2.0);
    let all = Crop::all(photograph);
    let filled = fill_box(all, 12.0, 9.0);
    for (crop, target) in [(all, ToneTarget::Lightness), (filled, ToneTarget::Linear)] {
        let curve = ToneCurve { black: 0.1, white: 0.8, gamma: 1.5 };
        let mut portrait = match Portrait::new(photograph, crop, page, placement, target, curve) {
            // What fills the box of a picture a pixel high is less than a pixel.
            Err(SourceError::EmptyCrop { .. }) if crop != all => continue,
            portrait => portrait?,
        };
        assert!(portrait.light.pixels().iter().flatten().copied().all(is_unit), "light");
        are_units("tone", &portrait.tone);
        are_units("ink", &portrait.ink());
        for (name, role) in MaskRole::ALL {
            match portrait.add_mask(role, photograph, photograph, crop) {
                Err(error @ SourceError::Scribbles { .. }) => refusal::is_told(&error),
                added => added?,
            }
            if let Some(mask) = portrait.masks.get(&role) {
                are_units(name, mask);
            }
        }
        are_units("subject", &portrait.subject);
        for sense in [DepthSense::NearWhite, DepthSense::FarWhite] {
            portrait.add_depth(photograph, sense, photograph, crop)?;
            are_units("depth", portrait.depth.as_ref().expect("just added"));
        }
    }
    Ok(())
}

fn is_unit(value: f32) -> bool {
    (-1e-3..=1.001).contains(&value)
}

fn are_units(name: &str, raster: &Raster<f32>) {
    assert!(raster.pixels().iter().copied().all(is_unit), "{name} is not from 0 to 1");
}
