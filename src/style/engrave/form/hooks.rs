//! Coiled hair, as engravers cut it: short hooks that turn with the curls, dense where it is dark.

use super::super::Drawer;
use super::runs::Piece;
use super::shares::part_of;
use super::tapered::{Tapered, tapered};
use crate::elementary::Elementary as _;
use crate::field::{Covering, OrientationField, cover};
use crate::geometry::{Ring, smooth_polyline};
use crate::parallel::mapped;
use crate::raster::Raster;
use crate::style::form::with_curls;
use crate::style::random::stream;

/// The share of the darkness that hooks have over lines of hair: with all of it they are a white net.
const SHARE: f32 = 0.6;
/// Size of the curls, length and greatest width of a hook in pitches, and its greatest angle to the curls in degrees.
const CURL: f64 = 3.6;
const LENGTH: f64 = 8.0;
const WIDTH: f64 = 0.34;
const TURN: f64 = 25.0;
/// How much wider than that hooks may become until their ink is the ink wanted.
const WIDEST: f64 = 2.0;
/// A hook tapers at both ends.
const SHAPE: Tapered = Tapered { width: WIDTH, taper: 0.4, tip: 0.2, widest: WIDEST };

impl Drawer<'_> {
    /// Hooks in a region, 0 to 1, that make its ink.
    pub(super) fn hooks(
        &self,
        coils: &Raster<f32>,
        region: &Raster<f32>,
        directions: &Raster<f32>,
        ink: &Raster<f32>,
    ) -> Vec<Piece> {
        let region = region.zip_map(coils, |region, coil| if coil >= 0.5 { region } else { 0.0 });
        if region.pixels().iter().all(|share| *share < 0.5) {
            return Vec::new();
        }
        let pitch = self.pitch();
        let ink = ink.map(|ink| part_of(ink, SHARE));
        let along = OrientationField::new(directions.map(|angle| [(2.0 * angle).cosine(), (2.0 * angle).sine()]));
        let field = with_curls(&along, coils, CURL * pitch, self.seed);
        let covering =
            Covering { width: WIDTH * pitch, length: LENGTH * pitch, length_spread: 0.5, turn: TURN.to_radians(), reach: pitch };
        let lines = cover(&field, &region, &ink, covering, |_| 1.0, &mut stream(self.seed, "hooks", 0));
        mapped(&lines, &|line| tapered(&smooth_polyline(line, Ring::Open, 0.5 * pitch, 0.5 * pitch), SHAPE, pitch))
    }
}

/// The ink of the lines beneath hooks.
pub(super) fn beneath(ink: &Raster<f32>, coils: &Raster<f32>) -> Raster<f32> {
    ink.zip_map(coils, |ink, coil| if coil >= 0.5 { part_of(ink, 1.0 - SHARE) } else { ink })
}
