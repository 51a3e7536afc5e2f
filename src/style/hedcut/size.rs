//! Step 6: the size of each dot, and of the holes in black regions where dots would close up.

use super::{Drawer, SizedDot};
use crate::drawing::Mark;
use crate::elementary::Elementary as _;
use crate::field::{Sites, cell_polygon};
use crate::geometry::{BezPath, Point, Rect, Vec2, blob, polygon_area, radius_for_area};
use crate::parallel::collected;
use crate::raster::{Raster, gaussian_blur};
use crate::style::random;
use crate::style::reversed::{self, ReversedCell, ReversedCells};
use kurbo::Shape;
use std::f64::consts::PI;

/// Maximum reach of a dot's cell from its site, in pitches; cells are open beyond the subject's border.
const CELL_REACH: f64 = 2.5;

/// Blur of the ink that decides which cells are dark, in pitches, so that grain does not mix reversed cells with others.
const DARK_BLUR: f64 = 0.8;
/// Hysteresis around the threshold: how much darker a cell must be to be reversed regardless of its surroundings, and how much lighter
/// it may be in dark surroundings.
const DARK_BAND: f64 = 0.06;

/// The dots of a drawing and the reversed areas between them.
pub(super) struct Sized {
    pub dots: Vec<SizedDot>,
    pub reversed: Vec<Mark>,
}

/// The radius at which the disc, clipped to the dot's own Voronoi cell, covers the ink of the cell's tone (Bruehl 2023, section 4.4;
/// errata). Dots that would cover nothing are left out; dark cells are black with a hole for the white of the tone.
pub(super) fn exact(drawer: &Drawer<'_>, sites: &[Point], ink: &Raster<f32>) -> Sized {
    drawer.observer.begin("sizes");
    let (width, height) = drawer.size();
    let field = Rect::new(0.0, 0.0, width as f64, height as f64);
    let grid = Sites::new(sites, field.x1, field.y1, drawer.pitch());
    let nearest = grid.nearest(&drawer.portrait.subject);
    let wanted = cell_ink(drawer, &nearest, sites.len(), ink);
    let polygon = |i: usize| cell_polygon(&grid, i, field, CELL_REACH * drawer.pitch());
    let chosen = ReversedCells::new(&nearest, &dark(drawer, sites, &wanted, ink), drawer.pitch());
    let sized: Vec<Result<SizedDot, ReversedCell>> = collected(sites.len(), &|i| {
        let (cell, wanted) = (polygon(i), wanted[i]);
        if chosen.is_reversed[i] {
            return Err(reversed_cell(drawer, i, sites[i], cell, wanted));
        }
        let area = wanted.area(polygon_area(&cell).abs());
        match wanted.middle().filter(|_| !wanted.is_open) {
            Some(middle) => reversed::edge_cell(&cell, middle, area, &chosen.mask, drawer.pitch()),
            None => None,
        }
        .map_or_else(|| Ok(SizedDot { centre: sites[i], radius: radius_for_area(&cell, sites[i], area) }), Err)
    });
    let cells: Vec<ReversedCell> = sized.iter().filter_map(|sized| sized.as_ref().err().cloned()).collect();
    let dots = sized.into_iter().flatten().filter(|dot| dot.radius > 0.0).collect();
    Sized { dots, reversed: reversed::areas(&cells, &chosen.mask, drawer.portrait, drawer.pitch()) }
}

/// True for each cell so dark that its dots would close up.
fn dark(drawer: &Drawer<'_>, sites: &[Point], wanted: &[CellInk], ink: &Raster<f32>) -> Vec<bool> {
    let from = drawer.parameters.reversed_from;
    if from >= 1.0 {
        return vec![false; sites.len()];
    }
    let around = gaussian_blur(ink, (DARK_BLUR * drawer.pitch()) as f32);
    let is_dark = |(site, cell): (&Point, &CellInk)| {
        let own = cell.ink / cell.subject.max(1e-9);
        own >= from + DARK_BAND || (own >= from - DARK_BAND && f64::from(around.sample(site.x, site.y)) >= from)
    };
    sites.iter().zip(wanted).map(is_dark).collect()
}

fn reversed_cell(drawer: &Drawer<'_>, index: usize, centre: Point, polygon: Vec<Point>, wanted: CellInk) -> ReversedCell {
    let white = if wanted.is_open { wanted.subject - wanted.ink } else { polygon_area(&polygon).abs() * (1.0 - wanted.share()) };
    let radius = (white.max(0.0) / PI).sqrt();
    let hole = match drawer.parameters.blob {
        _ if radius < reversed::LEAST_HOLE * drawer.pitch() => BezPath::new(),
        irregularity if irregularity > 0.0 => {
            blob(centre, radius, irregularity, &mut random::stream(drawer.seed, "holes", index as u64))
        }
        _ => kurbo::Circle::new(centre, radius).to_path(1e-3),
    };
    let is_open = wanted.is_open || !reversed::holds(&polygon, centre, radius);
    ReversedCell { centre, polygon, hole, is_open }
}

/// The thesis' rule of thumb, `s_max (1 - T)^gamma` at the dot's centre (Bruehl 2023, section 3.4).
pub(super) fn paper(drawer: &Drawer<'_>, sites: &[Point], ink: &Raster<f32>) -> Sized {
    drawer.observer.begin("sizes");
    let largest = drawer.pixels(drawer.parameters.size_max);
    let dots = sites
        .iter()
        .map(|&centre| {
            let ink = f64::from(ink.sample(centre.x, centre.y)).clamp(0.0, 1.0);
            SizedDot { centre, radius: largest * ink.power(drawer.parameters.size_gamma) }
        })
        .filter(|dot| dot.radius > 0.0)
        .collect();
    Sized { dots, reversed: Vec::new() }
}

/// Sums over the pixels of one cell.
#[derive(Clone, Copy, Default)]
struct CellInk {
    pixels: f64,
    ink: f64,
    /// Pixels of the subject; its soft border counts in part.
    subject: f64,
    /// Sum of the pixels' positions, weighted by ink.
    place: Vec2,
    /// True if part of the cell lies outside the subject, so that its polygon is larger than the drawn part.
    is_open: bool,
}

impl CellInk {
    /// Ink area for a cell of area `cell`: the share of its mean tone or, at the subject's border, the sum over its pixels.
    fn area(self, cell: f64) -> f64 {
        if self.is_open || self.pixels == 0.0 { self.ink } else { self.share() * cell }
    }

    /// Centroid of the ink.
    fn middle(self) -> Option<Point> {
        (self.ink > 0.0).then(|| (self.place / self.ink).to_point())
    }

    /// Mean ink, 0 to 1.
    fn share(self) -> f64 {
        self.ink / self.pixels.max(1.0)
    }
}

fn cell_ink(drawer: &Drawer<'_>, nearest: &Raster<u32>, count: usize, ink: &Raster<f32>) -> Vec<CellInk> {
    let subject = &drawer.portrait.subject;
    let mut cells = vec![CellInk::default(); count];
    let columns = nearest.width();
    for (pixel, ((&site, &ink), &subject)) in nearest.pixels().iter().zip(ink.pixels()).zip(subject.pixels()).enumerate() {
        if site != u32::MAX {
            let cell = &mut cells[site as usize];
            cell.pixels += 1.0;
            cell.ink += f64::from(ink);
            cell.subject += f64::from(subject);
            cell.place += Vec2::new((pixel % columns) as f64 + 0.5, (pixel / columns) as f64 + 0.5) * f64::from(ink);
            cell.is_open |= subject < 0.999;
        }
    }
    cells
}
