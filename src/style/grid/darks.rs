//! The darks: where lines and dots would close up, black with a white hole in the middle of each mesh of the grid.
//!
//! Between crossing lines the meshes leave white squares; where lines end, slivers of all sizes. Here the meshes' middles, which are the
//! crossings of both families half a pitch on, get the holes directly, each with the white that its own cell asks for.

use super::Drawer;
use super::cells::{Cell, cells_of};
use super::mixing::Mixing;
use super::parameters::Overlap;
use super::structure::StructureGrid;
use crate::drawing::Mark;
use crate::field::{Sites, StripeLattice};
use crate::geometry::{BezPath, Point, polygon_area};
use crate::raster::{Raster, gaussian_blur};
use crate::style::reversed::{self, Chosen, ReversedCell};
use kurbo::Shape;
use std::f64::consts::PI;

/// Blur of the ink by which cells are called dark, in pitches, so that grain does not mix reversed cells with others.
const DARK_BLUR: f64 = 0.8;
/// How much darker than asked for a cell must be to be reversed whatever surrounds it, and how much lighter it may be in the dark.
const DARK_BAND: f64 = 0.04;
/// How far lines and dots reach into reversed regions, in pitches: there they run between the holes.
const REACH: f64 = 0.5;

/// The reversed regions.
pub(super) struct Darks {
    pub areas: Vec<Mark>,
    /// 1 where no other mark is needed.
    inside: Option<Raster<u8>>,
}

impl Darks {
    pub(super) fn new(drawer: &Drawer<'_>, grid: &StructureGrid, ink: &Raster<f32>) -> Self {
        let (from, mixing) = (drawer.parameters.reversed_from, Mixing::new(drawer));
        let nothing = Self { areas: Vec::new(), inside: None };
        // Lines one way leave slits, and these are even; the paper's dots are there to be compared.
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
        let chosen = Chosen::new(&nearest, &is_dark, pitch);
        let reversed: Vec<ReversedCell> = cells
            .into_iter()
            .zip(&chosen.is_reversed)
            .filter(|(_, reversed)| **reversed)
            .map(|(cell, _)| reversed_cell(cell, &mixing, pitch))
            .collect();
        let areas = reversed::areas(&reversed, &chosen.mask, drawer.portrait, pitch);
        Self { areas, inside: Some(chosen.inside(&drawer.portrait.subject, (REACH * pitch).round() as usize)) }
    }

    /// Whether the reversed regions alone make the ink here.
    pub(super) fn cover(&self, p: Point) -> bool {
        let (x, y) = (p.x.floor() as isize, p.y.floor() as isize);
        self.inside.as_ref().is_some_and(|inside| inside.contains(x, y) && inside.get(x as usize, y as usize) == 1)
    }
}

/// The middles of the grid's meshes.
fn meshes(drawer: &Drawer<'_>, grid: &StructureGrid) -> Vec<Point> {
    let shifted = |family: &StripeLattice| StripeLattice { phase: family.phase.map(|[re, im]| [-re, -im]), ..family.clone() };
    let [along, across] = [0, 1].map(|family| shifted(&grid.stripes[family]));
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

/// What crossing lines leave, turned as they are.
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
