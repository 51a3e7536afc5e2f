//! Reversed dark regions: where lines and dots would close up, black with a white hole in the middle of each mesh of the grid.
//!
//! Crossing lines leave white squares in the meshes, but slivers of all sizes where lines end. Here each mesh's middle, a crossing of
//! both families shifted by half a pitch, gets a hole directly, with the white of its own cell.

use super::Drawer;
use super::cells::{Cell, cells_of};
use super::mixing::Mixing;
use super::parameters::Overlap;
use super::structure::StructureGrid;
use crate::drawing::Mark;
use crate::field::Sites;
use crate::geometry::{BezPath, Point, polygon_area};
use crate::raster::{Raster, gaussian_blur};
use crate::style::reversed::{self, ReversedCell, ReversedCells};
use kurbo::Shape;
use std::f64::consts::PI;

/// Blur of the ink that decides which cells are dark, in pitches, so that grain does not mix reversed cells with others.
const DARK_BLUR: f64 = 0.8;
/// Hysteresis around the threshold: how much darker a cell must be to be reversed regardless of its surroundings, and how much lighter
/// it may be in dark surroundings.
const DARK_BAND: f64 = 0.04;
/// How far lines and dots extend into reversed regions, in pitches: there they run between the holes.
const REACH: f64 = 0.5;

/// The reversed regions.
pub(super) struct Darks {
    pub areas: Vec<Mark>,
    /// 1 where reversed areas alone make the ink.
    inside: Option<Raster<u8>>,
}

impl Darks {
    pub(super) fn new(drawer: &Drawer<'_>, grid: &StructureGrid, ink: &Raster<f32>) -> Self {
        let (from, mixing) = (drawer.parameters.reversed_from, Mixing::new(drawer));
        let nothing = Self { areas: Vec::new(), inside: None };
        // Lines in one direction leave even slits; the paper's dots are kept for comparison.
        if from >= 1.0 || drawer.parameters.overlap == Overlap::Paper || !mixing.closes_up(1.0 - from) {
            return nothing;
        }
        drawer.observer.begin("darks");
        let meshes = meshes(drawer, grid);
        if meshes.is_empty() {
            return nothing;
        }
        let pitch = drawer.pitch();
        let (width, height) = drawer.size();
        let nearest = Sites::new(&meshes, width as f64, height as f64, pitch).nearest(&drawer.portrait.subject);
        let cells = cells_of(drawer, grid, &meshes, meshes.len(), ink, None);
        let around = gaussian_blur(ink, (DARK_BLUR * pitch) as f32);
        let is_dark: Vec<bool> = cells
            .iter()
            .map(|cell| {
                let own = cell.subject_darkness;
                own >= from + DARK_BAND
                    || (own >= from - DARK_BAND && f64::from(around.sample(cell.centre.x, cell.centre.y)) >= from)
            })
            .collect();
        let chosen = ReversedCells::new(&nearest, &is_dark, pitch);
        let reversed: Vec<ReversedCell> = cells
            .into_iter()
            .zip(&chosen.is_reversed)
            .filter(|(_, reversed)| **reversed)
            .map(|(cell, _)| reversed_cell(cell, &mixing, pitch))
            .collect();
        let areas = reversed::areas(&reversed, &chosen.mask, drawer.portrait, pitch);
        Self { areas, inside: Some(chosen.inside(&drawer.portrait.subject, (REACH * pitch).round() as usize)) }
    }

    /// True if the reversed regions alone make the ink at this place.
    pub(super) fn cover(&self, p: Point) -> bool {
        let (x, y) = (p.x.floor() as isize, p.y.floor() as isize);
        self.inside.as_ref().is_some_and(|inside| inside.contains(x, y) && inside.get(x as usize, y as usize) == 1)
    }
}

/// The middles of the grid's meshes.
fn meshes(drawer: &Drawer<'_>, grid: &StructureGrid) -> Vec<Point> {
    let [along, across] = [0, 1].map(|family| grid.stripes[family].between());
    drawer.points(&along, &across, &grid.spacing).0
}

fn reversed_cell(cell: Cell, mixing: &Mixing, pitch: f64) -> ReversedCell {
    let white = cell.open_white.unwrap_or(polygon_area(&cell.polygon).abs() * (1.0 - cell.darkness));
    let radius = (white.max(0.0) / PI).sqrt();
    let hole = if radius < reversed::LEAST_HOLE * pitch {
        BezPath::new()
    } else if mixing.line_share(1.0 - cell.darkness) > 0.5 {
        square(&cell, 0.5 * white.sqrt())
    } else {
        kurbo::Circle::new(cell.centre, radius).to_path(1e-3)
    };
    // A square's corner lies 1.25 of that radius away.
    let is_open = cell.open_white.is_some() || !reversed::holds(&cell.polygon, cell.centre, 1.25 * radius);
    ReversedCell { centre: cell.centre, polygon: cell.polygon, hole, is_open }
}

/// The square that crossing lines leave white, turned with them.
fn square(cell: &Cell, half: f64) -> BezPath {
    let (a, b) = (cell.tangent * half, cell.tangent.turn_90() * half);
    let mut path = BezPath::new();
    path.move_to(cell.centre + a + b);
    for corner in [a - b, -a - b, b - a] {
        path.line_to(cell.centre + corner);
    }
    path.close_path();
    path
}
