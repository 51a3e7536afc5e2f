//! Reads the sheet from a photograph or a scan.
//!
//! ```text
//!   grey, reduced -> dark blobs -> rings with discs -> four of them -> perspective -> all dots -> view, code
//!   bare paper -> light in each channel -> patches / light -> copies together -> pens, pairs, all
//! ```

mod blobs;
mod card;
mod chroma;
mod curve;
mod doubts;
mod error;
mod finding;
mod gathering;
mod light;
mod marks;
mod measuring;
mod picture;
mod quad;
mod reading;
mod sensor;
mod sharpness;
mod solve;
mod spotting;
mod tuning;
mod view;

pub use error::ReadError;
pub use picture::Picture;
pub use reading::{Measured, PairReading, PenReading, Quality, RampStep, ReadWarning, SheetReading};

use super::grid::{self, Cell, PATCH, Patch};
use super::lab::linear_to_srgb;
use crate::geometry::Point;
use crate::parallel::mapped;
use crate::raster::Raster;
use card::card;
use curve::Curve;
use finding::{Found, find, resolution};
use gathering::Gathered;
use light::{Light, Spot, spots};
use measuring::{Kind, Sampled, sampled};
use picture::Probe;
use sharpness::blur;
use view::View;

/// What is known besides the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Known<'a> {
    /// Widths of the pens' nibs in millimetres, in the order in which the sheet was laid out.
    pub nibs: &'a [f64],
    /// The paper's colour, linear, white being 1. Without it the paper is the white.
    pub paper: Option<[f64; 3]>,
    /// Reflectance, 0 to 1, of a neutral card that lies in the sheet's outlined field.
    pub grey: Option<f64>,
}

/// Least pixels of a cell.
const LEAST_CELL: f64 = 20.0;
/// Least light of a paper that is given, so that ratios to it stay finite.
const LEAST_PAPER: f64 = 0.01;

/// Reads a picture of the sheet.
pub fn read_sheet(picture: Picture<'_>, known: &Known<'_>) -> Result<SheetReading, ReadError> {
    let found = find(picture)?;
    if found.code.pens != known.nibs.len() {
        return Err(ReadError::WrongPens { found: found.code.pens, expected: known.nibs.len() });
    }
    let have = resolution(&found.tuned.view);
    if have < LEAST_CELL {
        return Err(ReadError::TooSmall { have: PATCH * have, least: PATCH * LEAST_CELL });
    }
    let cells = grid::cells(found.code.pens);
    let plain = Sight::new(picture, Curve::default(), &found, &cells)?;
    let given = known.paper.map(|paper| paper.map(|v| if v.is_finite() { v.max(LEAST_PAPER) } else { 1.0 }));
    let card = known.grey.map(|grey| card(&plain, grey, given));
    // The card may tell the camera's curve; then everything is seen anew.
    let curve = card.flatten().map_or(Curve::default(), |card| card.curve);
    let sight = if curve == Curve::default() { plain } else { Sight::new(picture, curve, &found, &cells)? };
    let paper = card.flatten().map(|card| card.paper).or(given).unwrap_or([1.0; 3]);
    let quality = sight.quality(&found, paper)?;
    let patches = sight.patches(&cells);
    let mut reading = Gathered { known, patches: &patches, quality, cell: found.code.cell, paper }.reading();
    reading.warnings.extend((card == Some(None)).then_some(ReadWarning::NoCard));
    Ok(reading)
}

/// The sheet seen from straight above in even light on white paper, sRGB-encoded, `per_cell` pixels (1 to 200) for each of its ten by fourteen
/// cells: to look at.
pub fn rectified(picture: Picture<'_>, per_cell: usize) -> Result<Raster<[u8; 3]>, ReadError> {
    let found = find(picture)?;
    let sight = Sight::new(picture, Curve::default(), &found, &grid::cells(found.code.pens))?;
    let side = per_cell.clamp(1, 200);
    Ok(Raster::from_fn(grid::COLUMNS * side, grid::ROWS * side, |x, y| {
        let p = Point::new((x as f64 + 0.5) / side as f64, (y as f64 + 0.5) / side as f64);
        let (seen, paper) = (sight.probe.at(sight.view.at(p)), sight.light.at(p));
        std::array::from_fn(|c| (255.0 * linear_to_srgb((f64::from(seen[c]) / paper[c]).clamp(0.0, 1.0) as f32)).round() as u8)
    }))
}

/// A sheet in a picture, with the light on it.
struct Sight<'a> {
    view: View,
    probe: Probe<'a>,
    curve: Curve,
    spots: Vec<Spot>,
    light: Light,
}

impl<'a> Sight<'a> {
    fn new(picture: Picture<'a>, curve: Curve, found: &Found, cells: &[Cell]) -> Result<Self, ReadError> {
        let (view, probe) = (found.tuned.view, Probe::new(picture, curve));
        let spots = spots(&view, &probe, cells);
        let light = Light::fitted(&spots).ok_or(ReadError::NoSheet)?;
        Ok(Self { view, probe, curve, spots, light })
    }

    /// The picture's quality, if it can be used.
    fn quality(&self, found: &Found, paper: [f64; 3]) -> Result<Quality, ReadError> {
        /// Largest blur, in cells: beyond it paper shines into the windows.
        const BLURRED: f64 = 0.055;
        /// Largest share of clipped paper.
        const OVER_EXPOSED: f64 = 0.2;
        /// Largest robust deviation of paper from smooth light.
        const TOO_UNEVEN: f64 = 0.08;
        /// Least sRGB level of paper.
        const TOO_DARK: f64 = 50.0;
        let cell = found.code.cell;
        let blur = blur(&self.view, &self.probe, found.grey);
        if blur > BLURRED {
            return Err(ReadError::Blurred { have: 2.5 * blur * cell, most: 2.5 * BLURRED * cell });
        }
        let level = 255.0 * f64::from(linear_to_srgb(self.middle(|spot| spot.light.into_iter().fold(0.0, f64::max)) as f32));
        let clipped = self.spots.iter().map(|spot| spot.clipped).sum::<f64>() / self.spots.len().max(1) as f64;
        if clipped > OVER_EXPOSED {
            return Err(ReadError::OverExposed { share: clipped });
        }
        if level < TOO_DARK {
            return Err(ReadError::UnderExposed { level });
        }
        if self.light.residual > TOO_UNEVEN {
            return Err(ReadError::UnevenLight { residual: self.light.residual });
        }
        let per_cell = resolution(&self.view);
        let gains = [0, 1, 2].map(|c| self.middle(|spot| spot.light[c]) / paper[c]);
        Ok(Quality {
            pixels_per_mm: per_cell / cell,
            registration_mm: found.tuned.error / per_cell * cell,
            blur_mm: blur * cell,
            marks_seen: found.tuned.share,
            fall_off: self.light.fall_off(),
            residual: self.light.residual,
            noise: self.middle(|spot| spot.noise),
            paper_level: level,
            clipped,
            cast: gains.into_iter().fold(0.0, f64::max) / gains.into_iter().fold(f64::INFINITY, f64::min),
            contrast: f64::from(self.curve.contrast),
        })
    }

    /// The median of a value over the spots of paper.
    fn middle(&self, value: impl Fn(&Spot) -> f64) -> f64 {
        let mut values: Vec<f64> = self.spots.iter().map(value).collect();
        values.sort_unstable_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(0.0)
    }

    /// All patches but paper, as read, sorted so that copies stand together.
    fn patches(&self, cells: &[Cell]) -> Vec<(Patch, Sampled)> {
        let read = |cell: &Cell, kind| (cell.patch, sampled(&self.view, &self.probe, &self.light, cell.window(), kind));
        let films =
            mapped(cells, &|cell| (!matches!(cell.patch, Patch::Paper | Patch::Ramp(..))).then(|| read(cell, Kind::Film)));
        let mut patches: Vec<(Patch, Sampled)> = films.into_iter().flatten().collect();
        let ink = |pen: usize| patches.iter().find(|(patch, _)| *patch == Patch::Solid(pen)).map(|(_, read)| read.colour);
        let ramps = mapped(cells, &|cell| match cell.patch {
            Patch::Ramp(pen, _) => Some(read(cell, Kind::Lines(ink(pen)?))),
            _ => None,
        });
        patches.extend(ramps.into_iter().flatten());
        patches.sort_by_key(|(patch, _)| *patch);
        patches
    }
}
