//! The Voronoi cells of the crossings: outline, area and target ink.

use super::Drawer;
use super::structure::StructureGrid;
use crate::drawing::Mark;
use crate::field::{Sites, cell_polygon};
use crate::geometry::{Point, Rect, Vec2, polygon_area};
use crate::parallel::collected;
use crate::raster::Raster;
use crate::style::coverage::covered;

/// Maximum reach of a cell from its crossing, in pitches; cells are open at singular points and beyond the subject's border.
const CELL_REACH: f64 = 1.5;

/// One crossing and its cell, in working pixels.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub centre: Point,
    /// Unit vector along the features.
    pub tangent: Vec2,
    /// The Voronoi cell.
    pub polygon: Vec<Point>,
    pub area: f64,
    /// Target ink in square pixels, less the ink of the feature lines.
    pub ink: f64,
    /// True if part of it lies under a feature line or outside the subject.
    pub is_cut: bool,
    /// True if it fills a hole in the grid: no line runs through it.
    pub is_filler: bool,
    /// Target ink as a share, 0 to 1.
    pub darkness: f64,
    /// True if more than half of it belongs to the subject.
    pub is_subject: bool,
    /// For a cell partly outside the subject: the white that the tone leaves inside, in square pixels.
    pub open_white: Option<f64>,
    /// Target ink as a share of its pixels of the subject.
    pub subject_darkness: f64,
    /// Mean linear light of the photograph.
    pub light: [f32; 3],
}

/// The cells of the grid's points, with less ink where lines are drawn.
pub(super) fn cells(drawer: &Drawer<'_>, grid: &StructureGrid, ink: &Raster<f32>, lines: &[Mark]) -> Vec<Cell> {
    drawer.observer.begin("cells");
    let covered = (!lines.is_empty()).then(|| covered(lines, &drawer.portrait.placement));
    cells_of(drawer, grid, &grid.crossings, grid.true_crossings, ink, covered.as_ref())
}

/// The cells of any points, of which the first `true_points` are crossings and the others fill holes.
pub(super) fn cells_of(
    drawer: &Drawer<'_>,
    grid: &StructureGrid,
    points: &[Point],
    true_points: usize,
    ink: &Raster<f32>,
    covered: Option<&Raster<f32>>,
) -> Vec<Cell> {
    if points.is_empty() {
        return Vec::new();
    }
    let (width, height) = drawer.size();
    let field = Rect::new(0.0, 0.0, width as f64, height as f64);
    let sites = Sites::new(points, field.x1, field.y1, drawer.pitch());
    let wanted = sums(drawer, &sites, points.len(), ink, covered);
    collected(points.len(), &|i| {
        let polygon = cell_polygon(&sites, i, field, CELL_REACH * drawer.pitch());
        wanted[i].cell(points[i], grid.tangent(points[i]), polygon, i >= true_points)
    })
}

/// Sums over the pixels of one cell.
#[derive(Clone, Copy, Default)]
struct Sum {
    pixels: f64,
    ink: f64,
    /// Under feature lines.
    covered: f64,
    light: [f64; 3],
    subject: f64,
    /// True if part of the cell lies outside the subject, so that its polygon is larger than the drawn part.
    is_open: bool,
}

impl Sum {
    /// Ink area for a cell of area `cell`: the share of its mean tone or, at the subject's border, the sum over its pixels.
    fn ink(&self, cell: f64) -> f64 {
        let wanted = (self.ink - self.covered).max(0.0);
        if self.is_open || self.pixels == 0.0 { wanted } else { wanted / self.pixels * cell }
    }

    fn cell(&self, centre: Point, tangent: Vec2, polygon: Vec<Point>, is_filler: bool) -> Cell {
        let area = polygon_area(&polygon).abs();
        Cell {
            centre,
            tangent,
            polygon,
            area,
            ink: self.ink(area),
            is_cut: self.covered > 0.0 || self.is_open,
            is_filler,
            darkness: self.ink / self.pixels.max(1.0),
            is_subject: self.subject > 0.5 * self.pixels,
            open_white: self.is_open.then_some(self.subject - self.ink),
            subject_darkness: self.ink / self.subject.max(1e-9),
            light: self.light.map(|v| (v / self.pixels.max(1.0)) as f32),
        }
    }
}

fn sums(drawer: &Drawer<'_>, sites: &Sites<'_>, count: usize, ink: &Raster<f32>, covered: Option<&Raster<f32>>) -> Vec<Sum> {
    let subject = &drawer.portrait.subject;
    let nearest = sites.nearest(subject);
    let mut sums = vec![Sum::default(); count];
    for (pixel, &site) in nearest.pixels().iter().enumerate() {
        if site == u32::MAX {
            continue;
        }
        let sum = &mut sums[site as usize];
        sum.pixels += 1.0;
        sum.ink += f64::from(ink.pixels()[pixel]);
        sum.covered += covered.map_or(0.0, |raster| f64::from(raster.pixels()[pixel]));
        sum.subject += f64::from(subject.pixels()[pixel]);
        sum.is_open |= subject.pixels()[pixel] < 0.999;
        for (total, light) in sum.light.iter_mut().zip(drawer.portrait.light.pixels()[pixel]) {
            *total += f64::from(light);
        }
    }
    sums
}
