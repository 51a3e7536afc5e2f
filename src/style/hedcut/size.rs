//! Step 6: the size of each dot.

use super::{Drawer, SizedDot};
use crate::field::{Sites, cell_polygon};
use crate::geometry::{Point, Rect, polygon_area, radius_for_area};
use crate::raster::Raster;
use rayon::prelude::*;

/// Farthest that a dot's cell is counted from its site, in pitches; beyond the subject's border cells are open.
const CELL_REACH: f64 = 2.5;

/// The radius at which the disc, clipped to the dot's own Voronoi cell, covers the ink that the cell's tone asks for
/// (Bruehl 2023, section 4.4; errata). Dots that would cover nothing are left out.
pub(super) fn exact(drawer: &Drawer<'_>, sites: &[Point], ink: &Raster<f32>) -> Vec<SizedDot> {
    drawer.observer.begin("sizes");
    let (width, height) = drawer.size();
    let field = Rect::new(0.0, 0.0, width as f64, height as f64);
    let grid = Sites::new(sites, field.x1, field.y1, drawer.pitch());
    let wanted = cell_ink(drawer, &grid, sites.len(), ink);
    (0..sites.len())
        .into_par_iter()
        .map(|i| {
            let cell = cell_polygon(&grid, i, field, CELL_REACH * drawer.pitch());
            let area = wanted[i].area(polygon_area(&cell).abs());
            SizedDot { centre: sites[i], radius: radius_for_area(&cell, sites[i], area) }
        })
        .filter(|dot| dot.radius > 0.0)
        .collect()
}

/// The thesis' rule of thumb, `s_max (1 - T)^gamma` at the dot's centre (Bruehl 2023, section 3.4).
pub(super) fn paper(drawer: &Drawer<'_>, sites: &[Point], ink: &Raster<f32>) -> Vec<SizedDot> {
    drawer.observer.begin("sizes");
    let largest = drawer.pixels(drawer.parameters.size_max_mm);
    sites
        .iter()
        .map(|&centre| {
            let ink = f64::from(ink.sample(centre.x, centre.y)).clamp(0.0, 1.0);
            SizedDot { centre, radius: largest * ink.powf(drawer.parameters.size_gamma) }
        })
        .filter(|dot| dot.radius > 0.0)
        .collect()
}

/// What the pixels of one cell ask for.
#[derive(Clone, Copy, Default)]
struct CellInk {
    pixels: f64,
    ink: f64,
    /// Part of the cell lies outside the subject, so that its polygon is larger than what is drawn.
    is_open: bool,
}

impl CellInk {
    /// Ink area in a cell of this area: its mean tone's share, or, at the subject's border, what its pixels ask for.
    fn area(self, cell: f64) -> f64 {
        if self.is_open || self.pixels == 0.0 { self.ink } else { self.ink / self.pixels * cell }
    }
}

fn cell_ink(drawer: &Drawer<'_>, grid: &Sites<'_>, count: usize, ink: &Raster<f32>) -> Vec<CellInk> {
    let subject = &drawer.portrait.subject;
    let nearest = grid.nearest(subject);
    let mut cells = vec![CellInk::default(); count];
    for ((&site, &ink), &subject) in nearest.pixels().iter().zip(ink.pixels()).zip(subject.pixels()) {
        if site != u32::MAX {
            let cell = &mut cells[site as usize];
            cell.pixels += 1.0;
            cell.ink += f64::from(ink);
            cell.is_open |= subject < 0.999;
        }
    }
    cells
}
