//! Faces modelled in strokes over the smudge: brows along their hairs, and the shaded side of a face along its form.
//!
//! The strokes take a share of the ink that is wanted, the grain keeps the rest.

use super::regions::Regions;
use super::{Drawer, Hairs};
use crate::drawing::Mark;
use crate::elementary::Elementary as _;
use crate::field::OrientationField;
use crate::raster::{Raster, gaussian_blur, median};
use crate::style::declaration::Radians;
use crate::style::solids::detail_zone;

/// The share of a brow's ink that its strokes make.
const BROW_SHARE: f32 = 0.42;
/// Width of a brow's hair, as a share of that in a hedcut.
const BROW_WIDTH: f64 = 0.75;
/// Ink over that of a face's median from which its shade is modelled, the range over which strokes set in, and their share of the ink there.
const SHADE: f32 = 0.08;
/// Least ink of shade: fair skin has none, where strokes would be wrinkles.
const LEAST_SHADE: f32 = 0.42;
const SETS_IN: f32 = 0.2;
const SHADE_SHARE: f32 = 0.5;
/// Blur of the shade, so that strokes model form and not spots; the width of a stroke as a share of the stick's; its mean length; in pitches.
const SHADE_BLUR: f64 = 2.0;
const WIDTH: f64 = 0.34;
const LENGTH: f64 = 9.0;
/// Maximum angle to the form, in degrees.
const TURN: f64 = 5.0;

impl Drawer<'_> {
    /// Strokes of the faces that were found.
    pub(super) fn modelling(&self, regions: &Regions, wanted: &Raster<f32>) -> Vec<Mark> {
        if !self.parameters.has_features || self.portrait.faces.is_empty() {
            return Vec::new();
        }
        self.observer.begin("modelling");
        let mut marks = self.brow_strokes(regions, wanted);
        marks.extend(self.shade_strokes(regions, wanted));
        marks
    }

    fn brow_strokes(&self, regions: &Regions, wanted: &Raster<f32>) -> Vec<Mark> {
        let Some(brows) = self.brows(Some(&regions.hair)) else { return Vec::new() };
        let ink = wanted.map(|ink| BROW_SHARE * ink);
        let sizes = Hairs { width: BROW_WIDTH * brows.sizes.width, ..brows.sizes };
        self.hairs(&brows.hairs, &brows.region, &ink, sizes)
    }

    /// Strokes along the form where a face is darker than most of it.
    fn shade_strokes(&self, regions: &Regions, wanted: &Raster<f32>) -> Vec<Mark> {
        let details = detail_zone(self.portrait, self.pitch());
        let skin = regions.skin().zip_map(&details, |skin, details| (skin * (1.0 - details)).clamp(0.0, 1.0));
        let soft = gaussian_blur(wanted, self.pixels(SHADE_BLUR * self.parameters.pitch) as f32);
        let within = soft.pixels().iter().zip(skin.pixels()).filter(|(_, skin)| **skin > 0.5).map(|(ink, _)| *ink);
        let Some(usual) = median(within.collect()) else { return Vec::new() };
        let shade = soft.zip_map(&skin, |ink, skin| skin * ((ink - (usual + SHADE).max(LEAST_SHADE)) / SETS_IN).clamp(0.0, 1.0));
        self.show("shade", &shade);
        let angles = self.directions_on_skin();
        let field = OrientationField::new(angles.map(|angle| [(2.0 * angle).cosine(), (2.0 * angle).sine()]));
        let ink = soft.zip_map(&shade, |ink, shade| SHADE_SHARE * shade * ink);
        let sizes = Hairs {
            width: WIDTH * self.parameters.stroke_width,
            length: LENGTH * self.parameters.pitch,
            turn: Radians(TURN.to_radians()),
        };
        self.hairs(&field, &shade.map(|shade| (4.0 * shade).min(1.0)), &ink, sizes)
    }
}
